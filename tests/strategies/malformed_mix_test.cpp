// Malformed mix files: each ends with an InputError at the place of the mistake (marked @) that says what was found and
// what would have been valid.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "strategies/mix_file.h"

namespace keyhole {
namespace {

using testing::HasSubstr;

struct Malformed {
    std::string text, message;
};

void PrintTo(const Malformed& mix, std::ostream* out) { *out << mix.text; }

// Removes the mark and gives the line and column it stood at.
SourceLocation take_mark(std::string& text) {
    const auto at = text.find('@');
    EXPECT_NE(at, std::string::npos) << "no mark";
    const auto line_start = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
    const auto lines = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    text.erase(at, 1);
    return {"", static_cast<int>(lines) + 1, static_cast<int>(at - line_start)};  // npos is -1
}

class MalformedMix : public testing::TestWithParam<Malformed> {};

TEST_P(MalformedMix, IsRefused) {
    std::string text = GetParam().text;
    const SourceLocation marked = take_mark(text);
    try {
        parse_mix(text, "odd.toml");
        FAIL() << "it was read";
    } catch (const InputError& e) {
        EXPECT_EQ(e.where().file, "odd.toml");
        EXPECT_EQ(e.where().line, marked.line) << e.what();
        EXPECT_EQ(e.where().column, marked.column) << e.what();
        EXPECT_THAT(e.what(), HasSubstr(GetParam().message));
    }
}

// A mix with one more strategy; with other lines at its head.
Malformed strategy(const std::string& lines, const std::string& message) {
    return {"[[strategy]]\ntype = \"large-step\"\nweight = 1\n" + lines, message};
}
Malformed head(const std::string& lines, const std::string& message) {
    return {lines + "\n[[strategy]]\ntype = \"large-step\"\nweight = 1\n", message};
}
Malformed small_step(const std::string& lines, const std::string& message) {
    return strategy("@[[strategy]]\ntype = \"small-step\"\nweight = 2\n" + lines, message);
}
Malformed small_step_key(const std::string& lines, const std::string& message) {
    return strategy("[[strategy]]\ntype = \"small-step\"\nweight = 2\n" + lines, message);
}

const Malformed cases[] = {
    // TOML itself
    head("name = @mmlt", "Error while parsing"),
    head("name = \"mmlt@\n", "Error while parsing"),
    head("name = \"a\"\nname = @\"b\"", "redefine"),
    head("seed = 1 @2", "Error while parsing"),
    head("seed@\n", "Error while parsing"),
    {"[[strategy]@\n", "Error while parsing"},
    {"[lengths]\nmin = 1\n@[lengths]\n", "redefine"},
    // characters that toml++ mistakes for ones it never meets
    head("seed = @\xd0\x87 5", "Error while parsing"),
    {"@\xcc\xaa", "Error while parsing"},
    {"[@$]", "Error while parsing"},
    // the head
    head("@sed = 1",
         "unknown key 'sed'; did you mean 'seed'? valid names: name, description, target, rectification, walk-steps, "
         "retry-scale, "),
    head("seed = @-1", "'seed' cannot be -1; valid: an integer of at least 0"),
    head("seed = @1.5", "'seed' cannot be 1.5; valid: an integer of at least 0"),
    head("seed = @\"x\"", "'seed' cannot be \"x\"; valid: an integer"),
    head("seed = @[1]", "'seed' cannot be a list; valid: an integer"),
    head("seed = @2020-01-01", "'seed' cannot be a date; valid: an integer"),
    head("name = @5", "'name' cannot be 5; valid: a text in quotes"),
    head("description = @true", "'description' cannot be true; valid: a text in quotes"),
    head("target = @\"luminanse\"", "did you mean 'luminance'? valid names: luminance, max-channel"),
    head("target = @1", "'target' cannot be 1; valid: \"luminance\", \"max-channel\""),
    head("rectification = @\"of\"", "did you mean 'off'? valid names: off, exclude, walk-on, retry"),
    head("rectification = \"walk-on\"\nretry-scale = @0.5",
         "'retry-scale' has no effect here; it needs rectification = \"retry\""),
    head("walk-steps = @5", "'walk-steps' has no effect here; it needs rectification = \"walk-on\""),
    // tables
    head("lengths = @5", "'lengths' is a value; valid: a table [lengths]"),
    head("@[[chains]]\ncount = 5", "'chains' is a list; valid: a table [chains]"),
    head("[@length]\nmin = 1", "unknown key 'length'; did you mean 'lengths'?"),
    head("[lengths]\n@maximum = 5", "unknown key 'maximum' of [lengths]; valid names: min, max, per-chain"),
    head("[lengths]\nmin = @0", "'min' cannot be 0; valid: an integer from 1 to 256 edges"),
    head("[lengths]\nmin = @\"scene\"", "'min' cannot be \"scene\"; valid: an integer from 1 to 256 edges"),
    head("[lengths]\nmax = @257", "'max' cannot be 257; valid: an integer from 1 to 256 edges or \"scene\""),
    head("[lengths]\nmax = @\"auto\"", "'max' cannot be \"auto\"; valid: an integer from 1 to 256 edges or \"scene\""),
    head("[lengths]\nmin = 5\nmax = @4", "'max' = 4 is below 'min' = 5"),
    head("[lengths]\nper-chain = @true", "'per-chain' cannot be true; valid: \"free\", \"fixed\""),
    head("[chains]\ncount = @0", "'count' cannot be 0; valid: an integer from 1 to 1073741824 or \"auto\""),
    head("[chains]\nlength = @inf", "'length' cannot be inf; valid: an integer from 1 to"),
    head("[bootstrap]\nsamples = @3", "'samples' cannot be 3; valid: an integer from 4 to"),
    // strategies
    {"@name = \"nothing\"\n", "a mix needs at least one strategy, as a table [[strategy]]"},
    {"strategy = @[]\n", "a mix needs at least one strategy"},
    {"strategy = @\"large-step\"\n", "'strategy' is a value; valid: tables [[strategy]]"},
    {"@[strategy]\ntype = \"large-step\"\n", "'strategy' is a table; valid: tables [[strategy]]"},
    {"strategy = [@5]\n", "a strategy is a value; valid: a table [[strategy]]"},
    strategy("@[[strategy]]\nweight = 1\n", "the strategy has no 'type'"),
    strategy("[[strategy]]\ntype = @3\nweight = 1\n", "'type' cannot be 3; valid: a text in quotes"),
    strategy("[[strategy]]\ntype = @\"smal-step\"\nweight = 1\n",
             "unknown strategy 'smal-step'; did you mean 'small-step'? valid names: large-step, small-step"),
    strategy("[[strategy]]\ntype = \"small-step\"\n@wieght = 1\n", "did you mean 'weight'?"),
    strategy("@[[strategy]]\ntype = \"small-step\"\n", "'small-step' has no 'weight'; valid: a number from 0"),
    strategy("[[strategy]]\ntype = \"small-step\"\nweight = @-0.1\n",
             "'weight' cannot be -0.1; valid: a number from 0"),
    strategy("[[strategy]]\ntype = \"small-step\"\nweight = @nan\n", "'weight' cannot be nan; valid: a number from 0"),
    strategy("[[strategy]]\ntype = \"small-step\"\nweight = @\"much\"\n",
             "'weight' cannot be \"much\"; valid: a number"),
    strategy("[[strategy]]\ntype = \"large-step\"\n@sigma = 1\nweight = 1\nlabel=\"b\"\n",
             "unknown key 'sigma' of 'large-step'; valid names: type, weight, label"),
    {"@[[strategy]]\ntype = \"large-step\"\nweight = 0\n", "all weights are zero"},
    {"@[[strategy]]\ntype = \"small-step\"\nweight = 1\n",
     "no strategy of positive weight reaches every path; one of these does: large-step"},
    {"@[[strategy]]\ntype = \"technique-change\"\nweight = 1\n[[strategy]]\ntype = \"large-step\"\nweight = 0\n",
     "no strategy of positive weight reaches every path; one of these does: large-step"},
    strategy("@[[strategy]]\ntype = \"large-step\"\nweight = 2\n",
             "'large-step' and 'large-step-2' are the same strategy with the same parameters; give one of them both"),
    strategy("[[strategy]]\ntype = \"small-step\"\nweight = 2\nlabel = @\"large-step\"\n",
             "two strategies have the label 'large-step'"),
    strategy("[[strategy]]\ntype = \"small-step\"\nweight = 2\nlabel = @\"Big\"\n",
             "'label' cannot be \"Big\"; valid: small letters, digits and hyphens"),
    strategy("[[strategy]]\ntype = \"small-step\"\nweight = 2\nlabel = @\"chains\"\n", "which is a key of the file"),
    // parameters
    small_step_key("kernel = @\"gauss\"\n", "'kernel' cannot be \"gauss\"; valid names: kelemen, gaussian"),
    small_step_key("s1 = @0\n", "'s1' cannot be 0; valid: a number above 0 to 0.5 of the unit cube's side"),
    small_step_key("s2 = @0.7\n", "'s2' cannot be 0.7; valid: a number above 0 to 0.5"),
    small_step_key("kernel = \"gaussian\"\nsigma = @\"0.1\"\n", "'sigma' cannot be \"0.1\"; valid: a number above 0"),
    small_step_key("@sigma = 0.1\n", "'sigma' has no effect here; it needs kernel = \"gaussian\""),
    small_step_key("@s1 = 0.1\nkernel = \"gaussian\"\n", "'s1' has no effect here; it needs kernel = \"kelemen\""),
    small_step_key("@step = 0.1\n", "unknown key 'step' of 'small-step'; valid names: type, weight, label, kernel, s1"),
    small_step("s1 = 0.1\ns2 = 0.05\n", "'small-step': s1 = 0.1 is above s2 = 0.05"),
};
static_assert(std::size(cases) >= 40);

INSTANTIATE_TEST_SUITE_P(All, MalformedMix, testing::ValuesIn(cases));

TEST(MixFile, ThatIsNotThereIsAnError) {
    try {
        read_mix_file("nowhere/none.toml");
        FAIL() << "it was read";
    } catch (const InputError& e) {
        EXPECT_STREQ(e.what(), "nowhere/none.toml: the mix file cannot be read");
    }
    EXPECT_THROW(read_mix_file("/"), InputError);
}

}  // namespace
}  // namespace keyhole
