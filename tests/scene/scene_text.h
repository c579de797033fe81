// Scenes written as text in the tests of the reader.
#pragma once

#include <unistd.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>

#include "base/error.h"
#include "scene/reader.h"

namespace keyhole::test {

// A folder of its own that disappears with the object.
class Folder {
  public:
    Folder() {
        static int count = 0;
        path_ = std::filesystem::temp_directory_path() /
                ("keyhole-reader-" + std::to_string(getpid()) + "-" + std::to_string(count++));
        std::filesystem::create_directories(path_);
    }
    ~Folder() { std::filesystem::remove_all(path_); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    // Writes a file and returns its path.
    std::string write(const std::string& name, const std::string& text) const {
        std::filesystem::create_directories((path_ / name).parent_path());
        std::ofstream(path_ / name, std::ios::binary) << text;
        return (path_ / name).string();
    }
    std::string path(const std::string& name = "") const { return (path_ / name).string(); }

  private:
    std::filesystem::path path_;
};

// A scene of the 3.x dialect with a sensor and the given elements.
inline std::string scene_with(const std::string& body) {
    return "<scene version=\"3.0.0\">\n<sensor type=\"perspective\"/>\n" + body + "\n</scene>\n";
}

// A diffuse rectangle around a colour, texture or other parameter of its BSDF.
inline std::string diffuse_with(const std::string& parameter) {
    return "<shape type=\"rectangle\"><bsdf type=\"diffuse\">" + parameter + "</bsdf></shape>";
}

}  // namespace keyhole::test
