#include "scene/reader/files.h"

#include <filesystem>
#include <fstream>

namespace keyhole {

namespace fs = std::filesystem;

std::string read_file(const std::string& filename, const SourceLocation& from) {
    std::error_code failure;
    if (!fs::is_regular_file(filename, failure)) {
        const bool exists = fs::exists(filename, failure);
        throw InputError(from, "'" + filename + (exists ? "' is not a file" : "' does not exist"));
    }
    std::ifstream stream(filename, std::ios::binary);
    std::string text;
    if (stream) {
        text.resize(fs::file_size(filename, failure));
        stream.read(text.data(), static_cast<std::streamsize>(text.size()));
        text.resize(static_cast<std::size_t>(stream.gcount()));
    }
    if (!stream) throw InputError(from, "'" + filename + "' cannot be read");
    return text;
}

std::string find_file(const std::string& name, const SourceLocation& from, const std::string& scene_file) {
    if (name.empty()) throw InputError(from, "the name of the file is empty");
    std::string looked_in;
    for (const std::string& origin : {from.file, scene_file}) {
        const fs::path folder = fs::path(origin).parent_path();
        const fs::path path = folder / name;  // an absolute name replaces the folder
        std::error_code failure;
        if (fs::is_regular_file(path, failure)) return path.string();
        if (fs::is_directory(path, failure)) throw InputError(from, "'" + path.string() + "' is a folder, not a file");
        const std::string place = folder.empty() ? "." : folder.string();
        if (looked_in.empty())
            looked_in = place;
        else if (looked_in != place)
            looked_in += " and " + place;
    }
    throw InputError(from, "file '" + name + "' not found" +
                               (fs::path(name).is_absolute() ? std::string() : " (looked in " + looked_in + ")"));
}

std::string canonical_path(const std::string& filename) {
    std::error_code failure;
    const fs::path path = fs::weakly_canonical(filename, failure);
    return failure ? filename : path.string();
}

}  // namespace keyhole
