// A scene that is scaled and moved as a whole renders the same image, from the same random numbers path by path.
#include <gtest/gtest.h>

#include <cmath>

#include "closed_room.h"
#include "render/render.h"

namespace keyhole {
namespace {

struct Place {
    double scale;
    Vec3 offset;
};

// Places that floats hold with few digits left for the room, were its coordinates not taken from its own middle.
std::vector<Place> places() {
    return {
        {1e-6, {0, 0, 0}}, {1e6, {0, 0, 0}}, {1, {1e4, -2e4, 0.5e4}}, {1e-2, {300, 100, -500}}, {1e6, {2e9, 0, 1e9}}};
}

class ScaledAndMoved : public testing::TestWithParam<Integrator> {};

TEST_P(ScaledAndMoved, RendersTheSameImage) {
    RenderSettings settings;
    settings.integrator = GetParam();
    settings.mutations_per_pixel = 64;
    settings.mix.lengths.max = 6;
    const Image expected = render(*closed_room(), settings).image;
    for (const Place& place : places()) {
        const RenderResult result = render(*closed_room(place.scale, place.offset), settings);
        EXPECT_EQ(result.statistics.non_finite, 0U);
        double difference = 0, sum = 0;
        for (std::size_t i = 0; i < expected.rgb.size(); ++i) {
            difference += std::abs(result.image.rgb[i] - expected.rgb[i]);
            sum += expected.rgb[i];
        }
        // A few of the paths pass an edge on the other side, one in 10^5 or so.
        EXPECT_LE(difference / sum, 2e-3) << "scale " << place.scale << " at " << place.offset.transpose();
    }
}

INSTANTIATE_TEST_SUITE_P(Unbiased, ScaledAndMoved, testing::Values(Integrator::path, Integrator::bdpt));

// Chains part for good at the first step that falls out differently, so only their rates can be compared: those of
// failures and of acceptance, of every strategy, within 6 standard errors of binomial counts, widened for correlated
// steps by the square root of 30.
class ChainsScaledAndMoved : public testing::TestWithParam<const char*> {};

TEST_P(ChainsScaledAndMoved, AcceptAsOften) {
    RenderSettings settings;
    settings.mix = builtin_mix(GetParam());
    settings.mix.lengths.max = 6;
    settings.mutations_per_pixel = 300;
    const auto expected = render(*closed_room(), settings).statistics.strategies;
    for (const Place& place : places()) {
        const RenderStatistics statistics = render(*closed_room(place.scale, place.offset), settings).statistics;
        EXPECT_EQ(statistics.non_finite, 0U);
        ASSERT_EQ(statistics.strategies.size(), expected.size());
        for (std::size_t i = 0; i < expected.size(); ++i) {
            const StrategyStatistics &a = expected[i], &b = statistics.strategies[i];
            const auto failed = [](const StrategyStatistics& of) {
                double sum = 0;
                for (const auto& [kind, count] : of.failures) sum += double(count);
                return sum;
            };
            const auto compare = [&](double count_a, double count_b, const char* what) {
                const double p = (count_a + count_b) / double(a.proposals + b.proposals);
                const double variance = p * (1 - p) * (1 / double(a.proposals) + 1 / double(b.proposals));
                EXPECT_LE(std::abs(count_a / double(a.proposals) - count_b / double(b.proposals)),
                          6 * std::sqrt(30 * variance))
                    << what << " of " << expected[i].name << ", scale " << place.scale << " at "
                    << place.offset.transpose();
            };
            compare(double(a.accepted), double(b.accepted), "acceptance");
            compare(failed(a), failed(b), "failures");
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Mixes, ChainsScaledAndMoved, testing::Values("mmlt", "rjmlt", "cmlt-gibbs", "cmlt-ipsm"),
                         [](const auto& mix) {
                             std::string name = mix.param;
                             std::erase(name, '-');
                             return name;
                         });

}  // namespace
}  // namespace keyhole
