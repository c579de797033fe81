// Random changes of a valid scene file: the reader either reads it or throws InputError, whatever the bytes.
#include <gtest/gtest.h>

#include "base/rng.h"
#include "scene_text.h"

namespace keyhole {
namespace {

const std::string valid = R"(<scene version="3.0.0">
<default name="r" value="0.5"/>
<integrator type="path"><integer name="max_depth" value="6"/></integrator>
<sensor type="thinlens"><float name="fov" value="45"/><float name="aperture_radius" value="0.1"/>
<transform name="to_world"><lookat origin="0,1,4" target="0,0,0" up="0,1,0"/></transform>
<film type="hdrfilm"><integer name="width" value="64"/><integer name="crop_width" value="8"/><rfilter type="tent"/></film></sensor>
<bsdf type="twosided" id="a"><bsdf type="roughconductor"><float name="alpha" value="0.1"/><string name="material" value="Au"/></bsdf></bsdf>
<bsdf type="mask" id="b"><float name="opacity" value="$r"/><ref id="a"/></bsdf>
<bsdf type="roughplastic" id="c"><spectrum name="diffuse_reflectance" value="400:0.1, 700:0.9"/></bsdf>
<shape type="obj"><string name="filename" value="t.obj"/><ref id="b"/></shape>
<shape type="sphere"><float name="radius" value="2"/><point name="center" x="1"/><ref id="c"/></shape>
<shape type="shapegroup" id="g"><shape type="cylinder"><point name="p1" z="3"/></shape></shape>
<shape type="instance"><ref id="g"/><transform name="to_world"><rotate y="1" angle="30"/><scale value="2"/></transform></shape>
<shape type="rectangle"><emitter type="area"><blackbody name="radiance" temperature="3000" scale="1e-3"/></emitter></shape>
<emitter type="constant"><rgb name="radiance" value="#102030"/></emitter>
</scene>
)";

// Replaces, removes, inserts or copies a few bytes.
void mutate(std::string& text, Rng& rng) {
    static const std::string useful = "<>/=\"'$&;#.,:- 0123456789eExnaif\n\t\0\x80\xff";
    const std::uint32_t edits = 1 + rng.below(3);
    for (std::uint32_t i = 0; i < edits && !text.empty(); ++i) {
        const auto at = rng.below(static_cast<std::uint32_t>(text.size()));
        const char c = rng.below(2) ? static_cast<char>(rng.below(256))
                                    : useful[rng.below(static_cast<std::uint32_t>(useful.size()))];
        switch (rng.below(4)) {
            case 0:
                text[at] = c;
                break;
            case 1:
                text.erase(at, 1 + rng.below(8));
                break;
            case 2:
                text.insert(at, 1, c);
                break;
            default:
                text.insert(at, text.substr(rng.below(static_cast<std::uint32_t>(text.size())), rng.below(40)));
        }
    }
}

// Replaces characters of numbers by others that numbers are made of: most results can be read, with values that are
// huge, tiny, negative or missing.
void mutate_numbers(std::string& text, Rng& rng) {
    static const std::string useful = "0123456789012345678901234567899.-e, ";
    for (std::uint32_t edits = 1 + rng.below(4); edits > 0;) {
        const auto at = rng.below(static_cast<std::uint32_t>(text.size()));
        if (text[at] < '0' || text[at] > '9') continue;
        text[at] = useful[rng.below(static_cast<std::uint32_t>(useful.size()))];
        if (rng.below(3) == 0) text.insert(at, 1, useful[rng.below(static_cast<std::uint32_t>(useful.size()))]);
        --edits;
    }
}

struct Outcome {
    int read = 0, refused = 0;
};

// Reads 1000 mutants.
Outcome try_all(std::uint64_t seed, void (*change)(std::string&, Rng&)) {
    const test::Folder folder;
    folder.write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_NO_THROW(read_scene(folder.write("scene.xml", valid)));
    Outcome outcome;
    for (std::uint64_t i = 0; i < 1000; ++i) {
        Rng rng(seed, i);
        std::string text = valid;
        change(text, rng);
        const std::string file = folder.write("scene.xml", text);
        try {
            read_scene(file);
            ++outcome.read;
        } catch (const InputError& e) {
            ++outcome.refused;
            EXPECT_EQ(std::string(e.what()).rfind(folder.path(), 0), 0u) << "no place: " << e.what();
        } catch (const std::exception& e) {
            ADD_FAILURE() << e.what() << " was thrown for\n" << text;
        }
    }
    return outcome;
}

TEST(ReaderFuzz, BytesMakeNothingButInputErrors) {
    const Outcome outcome = try_all(7, mutate);
    EXPECT_GT(outcome.refused, 500);
    EXPECT_GT(outcome.read, 1);
}

TEST(ReaderFuzz, NumbersMakeNothingButInputErrors) {
    const Outcome outcome = try_all(8, mutate_numbers);
    EXPECT_GT(outcome.refused, 100);
    EXPECT_GT(outcome.read, 100);
}

}  // namespace
}  // namespace keyhole
