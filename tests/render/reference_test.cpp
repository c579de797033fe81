// Against converged images that other renderers made of real scenes (Mitsuba 0.6 and Tungsten). They lie in ../shared;
// where that folder is not, the tests are skipped.
//
// Under the box filter a film of fewer pixels is the larger film's block means, so scenes are rendered at the size of
// the blocks, several times, and their means are held against the reference's by Welch's t-test (replicates.h).
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "render/replicates.h"
#include "scene/reader.h"
#include "strategies/mix_file.h"

namespace keyhole {
namespace {

namespace fs = std::filesystem;

constexpr double family_level = 1e-3;  // false alarms of the whole file
constexpr int runs = 8;

const fs::path shared = fs::path(KEYHOLE_SOURCE_DIR) / ".." / "shared";

struct Case {
    const char *image, *scene;
    int max_length;
    int block;  // pixels along an edge
    Integrator integrator;
    double samples;           // per block and run, of the integrator
    double mutations = 3000;  // the same, of mixes
    // What the reference's noise does not show: relative standard deviation that all its pixels have in common.
    double common_error = 0;
    std::vector<std::pair<int, int>> left_out = {};  // blocks (x, y)
    std::map<std::string, std::string> defines = {};
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.image; }

const std::map<std::string, std::string> fov35 = {{"fov", "35"}};

const Case cases[] = {
    {"cornell-box", "cornell-box", 12, 16, Integrator::mmlt, 4000},
    {"cornell-box_fov35", "cornell-box", 9, 16, Integrator::bdpt, 500, 3000, 0, {}, fov35},
    {"veach-mis", "veach-mis", 5, 20, Integrator::bdpt, 3000},
    {"staircase2", "staircase2", 12, 16, Integrator::path, 1000},
    {"veach-ajar", "veach-ajar", 13, 20, Integrator::bdpt, 500},
    // The outline of the spotlight's housing shines in Mitsuba's image alone, neither here nor in Tungsten's.
    {"veach-bidir", "veach-bidir", 12, 20, Integrator::bdpt, 600, 3000, 0, {{12, 2}, {13, 2}, {12, 3}, {13, 3}}},
    // An image of Metropolis light transport: its brightness has an error too, as large as the stated one of its pixels
    // (0.044). One pixel, (127, 69), is an outlier: it alone adds 41% to the image's mean. Some blocks see their light
    // in few of many short runs, which a t-test takes for a difference: of 4000 sets of eight runs drawn from 40 to 64,
    // it fails 1 to 8 with 3000 mutations, and none (auto) to 3 (mmlt) with 20000.
    {"water-caustic_fov35", "water-caustic", 9, 16, Integrator::mmlt, 30000, 20000, 0.044, {{7, 4}, {8, 4}}, fov35},
};

// The scene with the references' box filter instead of its own, in a folder that links to the scene's files.
class BoxFiltered {
  public:
    explicit BoxFiltered(const fs::path& scene)
        : folder_(fs::temp_directory_path() / ("keyhole-reference-" + std::to_string(getpid()))) {
        fs::create_directory(folder_);
        for (const auto& entry : fs::directory_iterator(scene)) {
            const fs::path here = folder_ / entry.path().filename();
            if (entry.path().extension() == ".xml")
                file_ = here, write_with_box_filter(entry.path());
            else
                fs::create_symlink(fs::canonical(entry.path()), here);
        }
    }
    ~BoxFiltered() { fs::remove_all(folder_); }

    const fs::path& file() const { return file_; }

  private:
    void write_with_box_filter(const fs::path& scene) const {
        std::ostringstream read;
        read << std::ifstream(scene).rdbuf();
        std::string text = read.str();
        const std::string other = "type=\"tent\"";
        const auto at = text.find(other, text.find("<rfilter"));
        ASSERT_NE(at, std::string::npos);
        std::ofstream(file_) << text.replace(at, other.size(), "type=\"box\"");
    }

    fs::path folder_, file_;
};

double luminance_at(const Image& image, int x, int y) {
    const float* p = image.pixel(x, y);
    return luminance({p[0], p[1], p[2]});
}

// Mean of a block of the reference and the variance of that mean. The latter comes from differences of neighbouring
// pixels, those across the block's border included: their noise, and the image's edges with it, which two renderers may
// place some hundredths of a pixel apart. So it is rather too large than too small.
struct BlockMean {
    double mean = 0, variance = 0;

    BlockMean(const Image& image, int x0, int y0, int size) {
        const int n = size * size;
        double squares = 0;
        int pairs = 0;
        for (int y = y0; y < y0 + size; ++y)
            for (int x = x0; x < x0 + size; ++x) {
                const double here = luminance_at(image, x, y);
                mean += here / n;
                for (const auto& [u, v] : {std::pair(x - 1, y), {x + 1, y}, {x, y - 1}, {x, y + 1}}) {
                    if (u < 0 || v < 0 || u >= image.width || v >= image.height) continue;
                    squares += sqr(luminance_at(image, u, v) - here);
                    ++pairs;
                }
            }
        variance = squares / (2.0 * pairs) / n;
    }
};

bool left_out(const Case& c, int x, int y) {
    return std::find(c.left_out.begin(), c.left_out.end(), std::pair(x, y)) != c.left_out.end();
}

// The reference in the form of very many renders: block means and the mean of all, with their variances.
Replicates reference_blocks(const Image& image, const Case& c) {
    Replicates r;
    r.n = 1000000;
    r.width = image.width / c.block;
    r.height = image.height / c.block;
    const auto add = [&](double mean, double variance) {
        variance += sqr(c.common_error * mean);
        r.sum.push_back(r.n * mean);
        r.squares.push_back(r.n * (sqr(mean) + variance * (r.n - 1)));
    };
    const double blocks = r.width * r.height;
    double mean = 0, variance = 0;
    for (int y = 0; y < r.height; ++y)
        for (int x = 0; x < r.width; ++x) {
            if (left_out(c, x, y)) {
                add(0, 0);
                continue;
            }
            const BlockMean block(image, x * c.block, y * c.block, c.block);
            add(block.mean, block.variance);
            mean += block.mean / blocks;
            variance += block.variance / sqr(blocks);
        }
    add(mean, variance);
    return r;
}

// By the case's integrator, or by a mix.
Replicates render_blocks(const Case& c, int width, int height, const std::string& mix = "") {
    const BoxFiltered box_filtered(shared / "scenes" / c.scene);
    ReaderOptions options;
    options.width = width;
    options.height = height;
    options.defines = c.defines;
    const auto scene = read_scene(box_filtered.file().string(), options).scene;
    RenderSettings settings;
    settings.integrator = mix.empty() ? c.integrator : Integrator::mmlt;
    settings.mutations_per_pixel = mix.empty() ? c.samples : c.mutations;
    if (!mix.empty()) settings.mix = builtin_mix(mix);
    settings.mix.lengths.max = c.max_length;
    Replicates replicates;
    for (int i = 0; i < runs; ++i) {
        settings.mix.seed = 1000 + static_cast<std::uint64_t>(i);
        RenderResult result = render(*scene, settings);
        EXPECT_EQ(result.statistics.non_finite, 0u);
        for (const auto& [x, y] : c.left_out) std::fill_n(result.image.pixel(x, y), 3, 0.0f);
        replicates.add(result.image);
    }
    return replicates;
}

class Reference : public testing::TestWithParam<Case> {};

TEST_P(Reference, IsWhatIsRendered) {
    const Case& c = GetParam();
    const fs::path file = shared / "reference" / (std::string(c.image) + ".exr");
    if (!fs::exists(file)) GTEST_SKIP() << "the independent images are not on this machine: no " << file;
    const Replicates reference = reference_blocks(read_image(file.string()), c);
    const double level = sidak_level(family_level, static_cast<int>(3 * std::size(cases)));
    expect_agreement(render_blocks(c, reference.width, reference.height), reference, level, c.image);
    for (const std::string mix : {"fused-all", "auto"})
        expect_agreement(render_blocks(c, reference.width, reference.height, mix), reference, level,
                         c.image + ("-" + mix));
}

INSTANTIATE_TEST_SUITE_P(Independent, Reference, testing::ValuesIn(cases), [](const auto& test) {
    std::string name = test.param.image;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
});

}  // namespace
}  // namespace keyhole
