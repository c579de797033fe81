// The files of mixes/, as the build put them into the program (src/CMakeLists.txt writes the definition).
#pragma once

#include <vector>

namespace keyhole {

struct BuiltinMixText {
    const char* filename;  // "mixes/mmlt.toml"
    const char* text;
};
const std::vector<BuiltinMixText>& builtin_mix_texts();

}  // namespace keyhole
