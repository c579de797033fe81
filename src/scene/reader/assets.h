// The mesh and image files of a scene: each read once, all of them in parallel.
#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "base/error.h"
#include "scene/mesh_io.h"
#include "scene/texture.h"

namespace keyhole {

struct MeshRequest {
    std::string format;    // obj, ply or serialized
    std::string filename;  // as found
    int shape_index = 0;   // serialized only
    bool flip_v = false;   // v of the file is measured from the top of images: replaced by 1 - v
};

// Requests first, then load(), then the rest.
class Assets {
  public:
    void request(const MeshRequest& request);
    void request(const BitmapParams& request);
    // A file that something else reads; it only becomes part of the hash.
    void request(const std::string& filename);

    // Reads everything. What cannot be read is reported by the functions below, when it is used.
    void load();

    // The same pointer for the same request. Throw InputError at `from`, with the file's own error text.
    std::shared_ptr<const Mesh> mesh(const MeshRequest& request, const SourceLocation& from) const;
    std::shared_ptr<const Texture> bitmap(const BitmapParams& request, const SourceLocation& from) const;

    // 64-bit hash of the contents of all files, in the order of their first request.
    std::uint64_t hash() const;

  private:
    struct Asset {
        MeshRequest mesh_request;
        BitmapParams bitmap_request;
        std::shared_ptr<const Mesh> mesh;
        std::shared_ptr<const Texture> bitmap;
        std::string error;
        bool loaded = false;
        void load();
    };
    struct File {
        std::string path;
        std::uint64_t size = 0, hash = 0;
    };

    void add_file(const std::string& filename);
    const Asset& loaded(const std::string& key, const SourceLocation& from) const;

    std::map<std::string, Asset> assets_;  // by request
    std::vector<File> files_;
    std::set<std::string> paths_;  // of files_
};

}  // namespace keyhole
