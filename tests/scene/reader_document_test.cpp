// Documents: variables, includes, ids and places.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/reader/document.h"
#include "scene/reader/files.h"
#include "scene_text.h"

namespace keyhole {
namespace {

using test::Folder;
using testing::ElementsAre;
using testing::HasSubstr;

Document load(const Folder& folder, const std::string& text, const std::map<std::string, std::string>& defines = {}) {
    return load_document(folder.write("scene.xml", text), defines);
}

std::string value_of(const Element& plugin, const std::string& name) {
    for (const Element& child : plugin.children)
        if (*child.attribute("name") == name) return *child.attribute("value");
    return "(none)";
}

const char* with_variables = R"(<scene version="3.0.0">
    <default name="n" value="12"/><default name="size_x" value="$n"/><default name="spare" value="0"/>
    <bsdf type="diffuse" id="b"><string name="a" value="$n-$size_x"/><string name="c" value="x$n.obj"/></bsdf>
</scene>)";

TEST(ReaderDocument, ReplacesVariables) {
    const Folder folder;
    const Document plain = load(folder, with_variables);
    const Element& b = plain.scene.children.at(0);
    EXPECT_EQ(value_of(b, "a"), "12-12");
    EXPECT_EQ(value_of(b, "c"), "x12.obj");
    ASSERT_EQ(plain.unused_defaults.size(), 1u);
    EXPECT_THAT(plain.unused_defaults[0], HasSubstr("default 'spare'"));
    const Document defined = load(folder, with_variables, {{"n", "7"}});
    EXPECT_EQ(value_of(defined.scene.children.at(0), "a"), "7-7");
}

TEST(ReaderDocument, ADefineNeedsNoDefaultWhereItIsUsed) {
    const Folder folder;
    const Document d = load(folder, R"(<scene version="3.0.0"><bsdf type="$kind"/></scene>)", {{"kind", "null"}});
    EXPECT_EQ(*d.scene.children.at(0).attribute("type"), "null");
}

TEST(ReaderDocument, AnUnusedDefineIsAnErrorThatListsTheDefaults) {
    const Folder folder;
    try {
        load(folder, with_variables, {{"size_y", "7"}});
        FAIL() << "an unknown variable was defined";
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), HasSubstr("scene.xml: -D size_y=7"));
        EXPECT_THAT(e.what(), HasSubstr("did you mean 'size_x'? valid names: n, size_x, spare"));
    }
}

TEST(ReaderDocument, SplicesIncludesInOrder) {
    const Folder folder;
    folder.write("parts/walls of stone.xml",
                 R"(<scene version="0.6.0"><default name="n" value="1"/><default name="m" value="2"/>
        <bsdf type="diffuse" id="$n-$m"/><include filename="more.xml"/></scene>)");
    folder.write("parts/more.xml", R"(<scene version="3.0.0"><bsdf type="null" id="more"/></scene>)");
    const Document d =
        load(folder, R"(<scene version="3.0.0"><default name="n" value="9"/><bsdf type="null" id="first"/>
        <include filename="parts/walls of stone.xml"/><bsdf type="null" id="last"/></scene>)");
    std::vector<std::string> ids;
    for (const Element& e : d.scene.children) ids.push_back(*e.attribute("id"));
    EXPECT_THAT(ids, ElementsAre("first", "9-2", "more", "last"));
    EXPECT_EQ(d.scene.children[1].where.file, folder.path("parts/walls of stone.xml"));
    EXPECT_EQ(d.scene.children[1].where.line, 2);
    EXPECT_TRUE(d.scene.children[1].old_dialect);
    EXPECT_FALSE(d.scene.children[2].old_dialect);
}

TEST(ReaderDocument, RefersByIdAndAlias) {
    const Folder folder;
    const Document d = load(folder, R"(<scene version="3.0.0"><alias id="b" as="c"/>
        <bsdf type="null" id="a"><bsdf type="null" id="b"/></bsdf></scene>)");
    ASSERT_EQ(d.ids.size(), 3u);
    EXPECT_EQ(d.ids.at("b"), &d.scene.children.at(1).children.at(0));
    EXPECT_EQ(d.ids.at("c"), d.ids.at("b"));
}

TEST(ReaderDocument, PlacesCountCharactersFromOne) {
    const Folder folder;
    const Document d = load(folder,
                            "<scene version=\"3.0.0\">\r\n<!-- \xC3\xA4\xC3\xB6 --><bsdf type=\"null\"/>\r\n"
                            "\t<bsdf\n type=\"diffuse\"/></scene>");
    EXPECT_EQ(d.scene.where.line, 1);
    EXPECT_EQ(d.scene.where.column, 1);
    EXPECT_EQ(d.scene.children[0].where.line, 2);
    EXPECT_EQ(d.scene.children[0].where.column, 12);
    EXPECT_EQ(d.scene.children[1].where.line, 3);
    EXPECT_EQ(d.scene.children[1].where.column, 2);
}

TEST(ReaderDocument, HashesWhatIsSaidAndNotHowItIsWritten) {
    const Folder folder;
    const auto hash = [&](const std::string& text) { return content_hash(load(folder, text)); };
    const auto a = hash(R"(<scene version="3.0.0"><bsdf type="null" id="a"/></scene>)");
    EXPECT_EQ(a, hash("<scene version=\"3.0.0\">\n  <!-- empty -->\n <bsdf type='null'   id='a'></bsdf></scene>"));
    EXPECT_NE(a, hash(R"(<scene version="3.0.0"><bsdf type="null" id="b"/></scene>)"));
    EXPECT_NE(a, hash(R"(<scene version="3.0.0"><bsdf id="a" type="null"/><bsdf type="null"/></scene>)"));
}

TEST(ReaderHash, DependsOnEveryByteAndOnTheLength) {
    const auto hash = [](const std::string& text) {
        Hash h;
        h.add(text);
        return h.value();
    };
    const std::string text = "twenty-one characters";
    for (std::size_t i = 0; i < text.size(); ++i) {
        std::string changed = text;
        changed[i] ^= 1;
        EXPECT_NE(hash(text), hash(changed)) << i;
    }
    EXPECT_NE(hash(std::string("a")), hash(std::string("a\0", 2)));
    Hash first, second;
    first.add(std::string("ab"));
    first.add(std::string("c"));
    second.add(std::string("a"));
    second.add(std::string("bc"));
    EXPECT_NE(first.value(), second.value());
}

}  // namespace
}  // namespace keyhole
