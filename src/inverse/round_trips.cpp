#include "inverse/round_trips.h"

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <functional>
#include <map>
#include <stdexcept>

#include "pathspace/path.h"

namespace keyhole {
namespace {

constexpr std::size_t cells = 20;
constexpr double negligible_share = 1e-7;
constexpr std::uint64_t paths_for_mean = 500;

struct Counts {
    std::array<double, cells> drawn{}, inverted{};

    CoordinateTest test(const std::string& name) const {
        double sum_drawn = 0, sum_inverted = 0, chi_square = 0, used = 0;
        for (std::size_t i = 0; i < cells; ++i) {
            sum_drawn += drawn[i];
            sum_inverted += inverted[i];
        }
        CoordinateTest result{name, static_cast<std::uint64_t>(sum_inverted), 1};
        if (!(sum_drawn > 0 && sum_inverted > 0)) return result;
        const double a = std::sqrt(sum_inverted / sum_drawn);
        for (std::size_t i = 0; i < cells; ++i) {
            const double both = drawn[i] + inverted[i], difference = drawn[i] * a - inverted[i] / a;
            if (both < 10) continue;
            chi_square += difference * difference / both;
            ++used;
        }
        if (used > 1) result.p_value = boost::math::gamma_q((used - 1) / 2, chi_square / 2);
        return result;
    }
};

class RoundTripping {
  public:
    RoundTripping(const Scene& scene, int max_length, std::uint64_t seed)
        : scene_(scene),
          layout_(scene, max_length),
          chart_(scene, layout_),
          max_length_(max_length),
          rng_(seed, 0),
          u_(layout_),
          inverted_(layout_) {}

    RoundTrips run(std::uint64_t paths, std::uint64_t tries) {
        double mean = 0;
        std::uint64_t found = 0, left = tries;
        find_paths(paths_for_mean, left, [&](const Path&, double target) {
            mean += target;
            ++found;
        });
        if (found > 0) mean /= static_cast<double>(found);
        find_paths(paths, left, [&](const Path& path, double target) {
            ++result_.paths;
            if (target < negligible_share * mean)
                ++result_.negligible;
            else
                round_trips(path);
        });
        for (auto& [key, entry] : samplers_) {
            std::vector<double>& all = entry.deviations;
            std::sort(all.begin(), all.end());
            if (!all.empty()) {
                entry.trips.worst = all.back();
                entry.trips.percentile_99_9 = all[static_cast<std::size_t>(0.999 * static_cast<double>(all.size()))];
            }
            result_.samplers.push_back(entry.trips);
        }
        for (const auto& [name, counts] : counts_) result_.coordinates.push_back(counts.test(name));
        return std::move(result_);
    }

  private:
    struct Sampler {
        SamplerRoundTrips trips;
        std::vector<double> deviations;
    };

    // Calls body(path, target) for up to `wanted` paths of two edges or more with light, of all techniques, whose
    // coordinates are in u_.
    template <class Body>
    void find_paths(std::uint64_t wanted, std::uint64_t& tries, const Body& body) {
        for (; wanted > 0 && tries > 0; --tries) {
            u_.k = 2 + static_cast<int>(rng_.below(static_cast<std::uint64_t>(max_length_) - 1));
            u_.t = 1 + static_cast<int>(rng_.below(static_cast<std::uint64_t>(u_.k) + 1));
            for (int i = 0; i < layout_.count(u_.k, u_.t); ++i) u_.data()[i] = rng_.uniform();
            const Evaluation e = chart_.evaluate(u_);
            if (e.failure != PathFailure::none || !(e.target > 0)) continue;
            --wanted;
            body(join(chart_.path().eye(), chart_.path().light()), e.target);
        }
    }

    void round_trips(const Path& path) {
        const int own = u_.t;
        const bool counts_drawn = rng_.uniform() < 0.5;  // one half of the paths against the other
        if (counts_drawn) count(u_, &Counts::drawn);
        for (int t = 1; t <= path.length() + 1; ++t) {
            const Inversion inversion = invert(scene_, chart_.window(), layout_, path.x, t, inverted_, rng_);
            if (inversion.failure == InverseFailure::impossible) {
                ++result_.impossible;
                continue;
            }
            ++result_.inversions;
            if (inversion.failure != InverseFailure::none) {
                fail(path, t, inversion.vertex, inversion.failure);
                continue;
            }
            if (t == own && !counts_drawn) count(inverted_, &Counts::inverted);
            retrace(path, t);
        }
    }

    // Traces inverted_ and enters, for each vertex, what came of the sampler that drew it. The first vertex that is
    // another one is the one that failed.
    void retrace(const Path& path, int t) {
        const bool traced = chart_.evaluate(inverted_).failure == PathFailure::none;
        const int k = path.length();
        const auto enter = [&](int i) {  // false: it and what follows failed
            Sampler& sampler = sampler_of(path, t, i);
            const double off = traced ? deviation(chart_.path(), path.x, i) : 1;
            ++sampler.trips.tries;
            if (off < largest_deviation) {
                sampler.deviations.push_back(off);
                return true;
            }
            ++sampler.trips.failures[static_cast<std::size_t>(InverseFailure::retrace)];
            return false;
        };
        for (int i = 0; i < t; ++i)
            if (!enter(i)) return;
        for (int i = k; i >= t; --i)
            if (!enter(i)) return;
    }

    void fail(const Path& path, int t, int vertex, InverseFailure failure) {
        // The sampler at a vertex draws the next one of its subpath.
        const int drawn = vertex < t ? std::min(vertex + 1, t - 1) : std::max(vertex - 1, t);
        Sampler& sampler = sampler_of(path, t, drawn);
        ++sampler.trips.tries;
        ++sampler.trips.failures[static_cast<std::size_t>(failure)];
    }

    // What draws vertex i by technique t.
    Sampler& sampler_of(const Path& path, int t, int i) {
        const int k = path.length();
        const int from = i < t ? std::max(i - 1, 0) : std::min(i + 1, k);
        const auto entry = [&](const char* kind, const char* name) -> Sampler& {
            Sampler& s = samplers_[{kind, name}];
            s.trips.kind = kind;
            s.trips.name = name;
            return s;
        };
        if (i < t && from == 0) return entry("sensor", scene_.sensor().name());
        if (i >= t && from == k) return entry("emitter", path.x[k].x.emitter->name());
        return entry("bsdf", path.x[from].x.bsdf->name());
    }

    void count(const PrimarySample& u, std::array<double, cells> Counts::*which) {
        const auto add = [&](const char* name, double number) {
            ++(counts_[name].*which)[std::min(static_cast<std::size_t>(number * cells), cells - 1)];
        };
        const auto add2 = [&](const char* name, const Vec2& v) {
            add(name, v.x());
            add((std::string(name) + " 2").c_str(), v.y());
        };
        const bool lobes = scene_.requirements().bsdfs.chooses_lobe;
        const auto add_block = [&](const CoordinateLayout::Block& block) {
            add2("direction", block.direction);
            if (lobes) add("lobe", block.lobe);
        };
        const double *eye = u.data(), *light = eye + layout_.eye_count(u.t);
        if (layout_.has_lens()) add2("lens", layout_.lens(eye));
        if (u.t >= 2) add2("raster", layout_.raster(eye));
        for (int i = 1; i + 1 < u.t; ++i) add_block(layout_.eye_block(eye, i));
        if (u.s() >= 1) {
            if (scene_.emitters().size() > 1) add("emitter", layout_.emitter(light));
            add("part", layout_.part(light));
            add2("point", layout_.point(light));
        }
        if (u.s() >= 2) add2("ray", layout_.ray(light));
        for (int j = 1; j + 1 < u.s(); ++j) add_block(layout_.light_block(light, j));
    }

    const Scene& scene_;
    CoordinateLayout layout_;
    Chart chart_;
    int max_length_;
    Rng rng_;
    PrimarySample u_, inverted_;
    RoundTrips result_;
    std::map<std::pair<std::string, std::string>, Sampler> samplers_;
    std::map<std::string, Counts> counts_;
};

}  // namespace

RoundTrips measure_round_trips(const Scene& scene, int max_length, std::uint64_t paths, std::uint64_t tries,
                               std::uint64_t seed) {
    if (max_length < 2) throw std::invalid_argument("paths of one edge have one technique: nothing to invert");
    return RoundTripping(scene, max_length, seed).run(paths, tries);
}

}  // namespace keyhole
