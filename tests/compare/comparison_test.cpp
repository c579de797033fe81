#include "compare/comparison.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "compare/metrics.h"
#include "compare/run_store.h"
#include "own_scenes.h"

namespace keyhole {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

class ComparisonTest : public testing::Test {
  protected:
    ComparisonTest() : folder_(fs::temp_directory_path() / ("keyhole-comparison-" + std::to_string(getpid()))) {
        fs::remove_all(folder_);
    }
    ~ComparisonTest() override { fs::remove_all(folder_); }

    ComparisonPlan plan() const {
        ComparisonPlan plan;
        plan.folder = folder_.string();
        plan.equal = EqualCost::mutations;
        plan.budget = 16;
        plan.runs = 2;
        plan.reference_seconds = 0.2;
        ComparedEntry mix{"mmlt", Integrator::mmlt, builtin_mix("mmlt"), {}};
        mix.mix.bootstrap_samples = 5000;
        mix.mix.chain_count = 16;
        ComparedEntry path{"path", Integrator::path, {}, {}};
        mix.mix.lengths.max = path.mix.lengths.max = 4;
        plan.entries = {mix, path};
        return plan;
    }
    std::vector<std::string> files() const {
        std::vector<std::string> names;
        for (const auto& entry : fs::recursive_directory_iterator(folder_))
            if (entry.is_regular_file()) names.push_back(entry.path().lexically_relative(folder_).string());
        std::sort(names.begin(), names.end());
        return names;
    }
    std::string refused(const ComparisonPlan& changed, const Scene& scene) const {
        try {
            run_comparison(scene, changed, {});
        } catch (const InputError& e) {
            return e.what();
        }
        return "";
    }
    Image image(const std::string& name) const { return read_image((folder_ / name).string()); }

    const fs::path folder_;
    const std::unique_ptr<Scene> scene_ = own_scene("cornell-box", 16, 16);
};

TEST_F(ComparisonTest, MakesAllRunsAndWritesResults) {
    const ComparisonOutcome outcome = run_comparison(*scene_, plan(), {});
    EXPECT_TRUE(outcome.complete);
    for (const char* name : {"results.json", "index.html", "reference.exr", "runs/mmlt/run-2.exr",
                             "runs/mmlt/run-1-1of2.exr", "runs/path/run-2.json"})
        EXPECT_TRUE(fs::exists(folder_ / name)) << name;
    const json& entries = outcome.results.at("entries");
    ASSERT_EQ(entries.size(), 2u);
    EXPECT_EQ(entries[0].at("runs"), 2);
    const Image reference = image("reference.exr");
    double relmse = 0;
    for (const char* run : {"runs/mmlt/run-1.exr", "runs/mmlt/run-2.exr"})
        relmse += std::pow(compare_images(image(run), reference).rrmse, 2) / 2;
    EXPECT_NEAR(entries[0].at("metrics").at("relmse").at("mean").get<double>(), relmse, 1e-5 * relmse);
    EXPECT_TRUE(entries[1].contains("speed_up"));
    EXPECT_NE(image("runs/mmlt/run-1.exr").rgb, image("runs/mmlt/run-2.exr").rgb) << "each run has its own seed";
    std::ifstream file(folder_ / "results.json");
    EXPECT_EQ(json::parse(file).at("entries")[0].at("strategies"), entries[0].at("strategies"));
}

// Stopped in the middle of each run in turn, it makes the same images as without: runs of equal mutations repeat.
TEST_F(ComparisonTest, GoesOnWhereItWasStopped) {
    ComparisonPlan p = plan();
    run_comparison(*scene_, p, {});
    const Image expected = image("runs/mmlt/run-2.exr"), reference = image("reference.exr");
    fs::remove_all(folder_ / "runs");
    for (int attempt = 0; attempt < 40; ++attempt) {
        ComparisonCallbacks callbacks;
        int asked = 0;
        callbacks.stop = [&] { return ++asked > 2 + attempt; };
        if (run_comparison(*scene_, p, callbacks).complete) break;
    }
    ComparisonOutcome outcome = run_comparison(*scene_, p, {});
    EXPECT_TRUE(outcome.complete);
    EXPECT_EQ(image("runs/mmlt/run-2.exr").rgb, expected.rgb);
    EXPECT_EQ(image("reference.exr").rgb, reference.rgb) << "the reference was there";

    const auto before = fs::last_write_time(folder_ / "runs/mmlt/run-1.exr");
    p.runs = 3;
    outcome = run_comparison(*scene_, p, {});
    EXPECT_EQ(outcome.results.at("entries")[1].at("runs"), 3);
    EXPECT_EQ(fs::last_write_time(folder_ / "runs/mmlt/run-1.exr"), before);
}

TEST_F(ComparisonTest, NoticesWhatHasChanged) {
    run_comparison(*scene_, plan(), {});
    ComparisonPlan changed = plan();
    changed.entries[0].mix.strategies[0].weight *= 2;
    EXPECT_THAT(refused(changed, *scene_), AllOf(HasSubstr("'mmlt'"), HasSubstr("mix"), HasSubstr("--discard")));
    changed = plan();
    changed.budget = 32;
    EXPECT_THAT(refused(changed, *scene_), HasSubstr("budget (16.0 there, 32.0 now)"));
    changed = plan();
    changed.seed = 1;
    EXPECT_THAT(refused(changed, *scene_), HasSubstr("seed (0 there, 1 now)"));
    EXPECT_THAT(refused(plan(), *own_scene("cornell-box", 16, 15)), HasSubstr("scene"));

    changed = plan();
    changed.entries[0].mix.strategies[0].weight *= 2;
    changed.discard = true;
    const auto of_path = fs::last_write_time(folder_ / "runs/path/run-1.exr");
    EXPECT_TRUE(run_comparison(*scene_, changed, {}).complete);
    EXPECT_EQ(fs::last_write_time(folder_ / "runs/path/run-1.exr"), of_path) << "only what differs is deleted";
}

// A program of another build leaves another hash.
TEST_F(ComparisonTest, NoticesAnotherProgram) {
    run_comparison(*scene_, plan(), {});
    const fs::path record = folder_ / "runs/path/run-1.json";
    std::ifstream in(record);
    json j = json::parse(in);
    j["identity"]["program"] = "0123456789abcdef";
    std::ofstream(record) << j;
    EXPECT_THAT(refused(plan(), *scene_), AllOf(HasSubstr("'path'"), HasSubstr("program")));
}

TEST_F(ComparisonTest, RefusesTwoEntriesOfOneName) {
    ComparisonPlan p = plan();
    p.entries[1].name = "mmlt";
    EXPECT_THAT(refused(p, *scene_), HasSubstr("two entries of the comparison are called 'mmlt'"));
}

TEST_F(ComparisonTest, WarnsWhereTheImagesAreNotTheSame) {
    ComparisonPlan p = plan();
    p.entries[1].mix.lengths.max = 2;
    std::string warnings;
    ComparisonCallbacks callbacks;
    callbacks.warn = [&](const std::string& w) { warnings += w + "\n"; };
    run_comparison(*scene_, p, callbacks);
    EXPECT_THAT(warnings, HasSubstr("not the same image"));
}

double mean_of(const Image& image) {
    double sum = 0;
    for (const float v : image.rgb) sum += v;
    return sum / static_cast<double>(image.rgb.size());
}

class ReferenceTest : public ComparisonTest {
  protected:
    ReferenceTest() {
        fs::create_directories(folder_);
        plan_.filename = (folder_ / "ref.exr").string();
        plan_.lengths = {1, 4, false};
        plan_.seconds = 0.5;
    }
    ReferencePlan plan_;
};

// The variance says how far two references are from one another: their squared difference has the sum of the variances
// for its mean, summed over 768 values that are not all independent (the filter's width is two pixels).
TEST_F(ReferenceTest, KnowsItsNoise) {
    const Reference a = make_reference(*scene_, plan_, {});
    plan_.seed = 1;
    plan_.filename = (folder_ / "other.exr").string();
    const Reference b = make_reference(*scene_, plan_, {});
    ASSERT_TRUE(a.variance && b.variance);
    double chi_square = 0, count = 0;
    for (std::size_t i = 0; i < a.image.rgb.size(); ++i) {
        const double variance = a.variance->rgb[i] + b.variance->rgb[i];
        if (variance == 0) continue;
        chi_square += std::pow(a.image.rgb[i] - b.image.rgb[i], 2) / variance;
        ++count;
    }
    EXPECT_NEAR(chi_square / count, 1, 0.35);
}

TEST_F(ReferenceTest, GoesOnWhereItEnded) {
    const Reference first = make_reference(*scene_, plan_, {});
    EXPECT_EQ(make_reference(*scene_, plan_, {}).image.rgb, first.image.rgb);
    plan_.seconds = 1;
    const Reference longer = make_reference(*scene_, plan_, {});
    EXPECT_GT(longer.samples_per_pixel, first.samples_per_pixel);
    EXPECT_GE(longer.seconds, 1);
    EXPECT_LT(mean_of(*longer.variance), mean_of(*first.variance));
    const Reference read = read_reference(plan_.filename);
    EXPECT_EQ(read.image.rgb, longer.image.rgb);
    EXPECT_EQ(read.samples_per_pixel, longer.samples_per_pixel);
    EXPECT_EQ(read.variance->rgb, longer.variance->rgb);
}

TEST_F(ReferenceTest, RefusesAnother) {
    make_reference(*scene_, plan_, {});
    plan_.lengths.max = 3;
    EXPECT_THROW(make_reference(*scene_, plan_, {}), InputError);
}

TEST_F(ReferenceTest, OfUnknownOriginHasNoKnownNoise) {
    write_image(plan_.filename, Image(16, 16));
    EXPECT_FALSE(read_reference(plan_.filename).variance);
    EXPECT_THROW(make_reference(*scene_, plan_, {}), InputError);
}

}  // namespace
}  // namespace keyhole
