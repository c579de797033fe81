#include "scene/reader/assets.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <functional>

#include "base/parallel.h"
#include "scene/reader/files.h"

namespace keyhole {
namespace {

std::string key_of(const MeshRequest& r) {
    return fmt::format("{}\n{}\n{} {}", r.format, canonical_path(r.filename), r.shape_index, r.flip_v);
}

std::string key_of(const BitmapParams& r) {
    std::string key = fmt::format("bitmap\n{}\n{} {} {}", canonical_path(r.filename), r.raw, static_cast<int>(r.filter),
                                  static_cast<int>(r.wrap));
    for (const double entry : r.to_uv.reshaped()) key += fmt::format(" {}", entry);
    return key;
}

std::shared_ptr<const Mesh> read(const MeshRequest& r) {
    std::shared_ptr<Mesh> mesh = r.format == "obj"   ? read_obj(r.filename)
                                 : r.format == "ply" ? read_ply(r.filename)
                                                     : read_serialized(r.filename, r.shape_index);
    if (r.flip_v)
        for (Vec2f& uv : mesh->uvs) uv.y() = 1 - uv.y();
    return mesh;
}

std::uint64_t file_size(const std::string& path) {
    std::error_code failure;
    const auto size = std::filesystem::file_size(path, failure);
    return failure ? 0 : size;
}

// 0 if it cannot be read: whoever uses the file says so.
std::uint64_t hash_of_file(const std::string& path) {
    try {
        Hash hash;
        hash.add(read_file(path, {}));
        return hash.value();
    } catch (const InputError&) {
        return 0;
    }
}

}  // namespace

void Assets::add_file(const std::string& filename) {
    const std::string path = canonical_path(filename);
    if (paths_.insert(path).second) files_.push_back({path, file_size(path), 0});
}

void Assets::request(const MeshRequest& request) {
    assets_[key_of(request)].mesh_request = request;
    add_file(request.filename);
}

void Assets::request(const BitmapParams& request) {
    assets_[key_of(request)].bitmap_request = request;
    add_file(request.filename);
}

void Assets::request(const std::string& filename) { add_file(filename); }

void Assets::load() {
    struct Job {
        std::uint64_t size;
        std::function<void()> run;
    };
    std::vector<Job> jobs;
    for (auto& entry : assets_) {
        Asset& asset = entry.second;
        const bool is_mesh = !asset.mesh_request.filename.empty();
        const std::string& filename = is_mesh ? asset.mesh_request.filename : asset.bitmap_request.filename;
        jobs.push_back({file_size(filename), [&asset] { asset.load(); }});
    }
    for (File& file : files_) jobs.push_back({file.size / 100, [&file] { file.hash = hash_of_file(file.path); }});
    // The largest first, and each thread takes the next: no thread is left alone with a large one at the end.
    std::stable_sort(jobs.begin(), jobs.end(), [](const Job& a, const Job& b) { return a.size > b.size; });
    std::atomic<std::size_t> next = 0;
    parallel_for(jobs.size(), [&](std::size_t) { jobs[next++].run(); });
}

void Assets::Asset::load() {
    try {
        if (mesh_request.filename.empty())
            bitmap = make_bitmap(bitmap_request);
        else
            mesh = read(mesh_request);
    } catch (const std::exception& e) {
        error = e.what();
    }
    loaded = true;
}

const Assets::Asset& Assets::loaded(const std::string& key, const SourceLocation& from) const {
    const auto found = assets_.find(key);
    if (found == assets_.end() || !found->second.loaded) throw std::logic_error("an asset that was not requested");
    if (!found->second.error.empty()) throw InputError(from, found->second.error);
    return found->second;
}

std::shared_ptr<const Mesh> Assets::mesh(const MeshRequest& request, const SourceLocation& from) const {
    return loaded(key_of(request), from).mesh;
}

std::shared_ptr<const Texture> Assets::bitmap(const BitmapParams& request, const SourceLocation& from) const {
    return loaded(key_of(request), from).bitmap;
}

std::uint64_t Assets::hash() const {
    Hash hash;
    for (const File& file : files_) {
        hash.add(file.size);
        hash.add(file.hash);
    }
    return hash.value();
}

}  // namespace keyhole
