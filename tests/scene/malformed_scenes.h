// Malformed scenes, for the tests of the reader and of the command.
#pragma once

#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

namespace keyhole::test {

struct MalformedScene {
    std::string name;          // of the test
    std::string text;          // in the table of malformed_scenes.cpp a mark @ stands at the place of the mistake
    std::string message;       // part of what is said about it, with what would have been valid
    int line = 0, column = 0;  // from 1; 0 where the mistake is not at one place of this file

    bool unknown_parameter = false;  // named or not; such a mistake is a warning for a lenient reader

    // "FILE:LINE:COLUMN: ", as the message begins; empty if the mistake is not at one place of this file.
    std::string place(const std::string& file) const;
};

inline void PrintTo(const MalformedScene& scene, std::ostream* out) { *out << scene.text; }

std::vector<MalformedScene> malformed_scenes();

// Writes the files that these scenes refer to, and returns their names.
std::vector<std::string> write_malformed_parts(const std::filesystem::path& folder);

}  // namespace keyhole::test
