#include <tiny_obj_loader.h>

#include <cmath>
#include <istream>
#include <streambuf>

#include "scene/mesh_io.h"
#include "scene/mesh_io/file_text.h"
#include "scene/mesh_io/obj_check.h"

namespace keyhole {
namespace {

// A stream buffer over a text in memory that knows how far it has been read.
class TextBuffer : public std::streambuf {
  public:
    explicit TextBuffer(std::string& text) { setg(text.data(), text.data(), text.data() + text.size()); }
    std::size_t position() const { return static_cast<std::size_t>(gptr() - eback()); }
};

// Receives what tinyobjloader reads and joins the separate indices of positions, uv and normals into vertices.
class ObjReader {
  public:
    ObjReader(const std::string& filename, std::string text) : filename_(filename), text_(std::move(text)) {
        const ObjCounts counts = check_obj(filename_, text_);
        positions_.reserve(counts.positions);
        normals_.reserve(counts.normals);
        uvs_.reserve(counts.uvs);
        first_vertex_.reserve(counts.positions);
        mesh_->triangles.reserve(counts.faces);
        reserve_positions(*mesh_, counts.positions);
    }

    std::shared_ptr<Mesh> read() {
        tinyobj::callback_t callbacks;
        callbacks.vertex_cb = [](void* self, float x, float y, float z, float) { get(self).add_position({x, y, z}); };
        callbacks.normal_cb = [](void* self, float x, float y, float z) { get(self).add_normal({x, y, z}); };
        callbacks.texcoord_cb = [](void* self, float u, float v, float) { get(self).add_uv({u, v}); };
        callbacks.index_cb = [](void* self, tinyobj::index_t* corners, int n) { get(self).add_face(corners, n); };
        std::istream stream(&buffer_);
        std::string warning, error;
        if (!tinyobj::LoadObjWithCallback(stream, callbacks, this, nullptr, &warning, &error)) {
            throw InputError({filename_}, error.empty() ? "not an OBJ file" : error);
        }
        if (!has_normals_) mesh_->normals.clear();
        if (!has_uvs_) mesh_->uvs.clear();
        check_read_mesh(*mesh_, filename_);
        reserve_positions(*mesh_, mesh_->positions.size());
        return mesh_;
    }

  private:
    static constexpr std::uint32_t none = ~0u;

    // A vertex of the mesh, linked with the others at the same position.
    struct Variant {
        std::int64_t uv, normal;
        std::uint32_t next;
    };

    static ObjReader& get(void* self) { return *static_cast<ObjReader*>(self); }

    void add_position(const Vec3f& p) {
        check_finite(p.allFinite());
        positions_.push_back(p);
        first_vertex_.push_back(none);
    }
    void add_normal(const Vec3f& n) {
        check_finite(n.allFinite());
        normals_.push_back(n);
    }
    void add_uv(const Vec2f& uv) {
        check_finite(uv.allFinite());
        uvs_.push_back(uv);
    }

    void add_face(const tinyobj::index_t* corners, int n) {
        const std::uint32_t a = vertex(corners[0]);
        std::uint32_t b = vertex(corners[1]);
        for (int i = 2; i < n; ++i) {
            const std::uint32_t c = vertex(corners[i]);
            mesh_->triangles.push_back({a, b, c});
            b = c;
        }
    }

    // Zero-based; OBJ counts from 1, or back from the last one with negative numbers. -1: not given.
    std::int64_t resolve(const char* what, int index, std::size_t size) const {
        if (index == 0) return -1;
        const std::int64_t n = static_cast<std::int64_t>(size);
        const std::int64_t resolved = index > 0 ? index - 1 : n + index;
        if (resolved < 0 || resolved >= n) {
            fail(std::string(what) + " index " + std::to_string(index) + " is out of range, there are " +
                 std::to_string(n) + " so far");
        }
        return resolved;
    }

    std::uint32_t vertex(const tinyobj::index_t& corner) {
        const std::int64_t position = resolve("vertex", corner.vertex_index, positions_.size());
        const std::int64_t uv = resolve("texture coordinate", corner.texcoord_index, uvs_.size());
        const std::int64_t normal = resolve("normal", corner.normal_index, normals_.size());
        std::uint32_t* link = &first_vertex_[static_cast<std::size_t>(position)];
        while (*link != none) {
            Variant& variant = variants_[*link];
            if (variant.uv == uv && variant.normal == normal) return *link;
            link = &variant.next;
        }
        const auto added = static_cast<std::uint32_t>(variants_.size());
        *link = added;
        variants_.push_back({uv, normal, none});
        mesh_->positions.push_back(positions_[static_cast<std::size_t>(position)]);
        // Corners without a normal get none: the surface falls back to the face normal there.
        mesh_->normals.push_back(normal < 0 ? Vec3f(0, 0, 0) : normals_[static_cast<std::size_t>(normal)]);
        mesh_->uvs.push_back(uv < 0 ? Vec2f(0, 0) : uvs_[static_cast<std::size_t>(uv)]);
        has_normals_ |= normal >= 0;
        has_uvs_ |= uv >= 0;
        return added;
    }

    void check_finite(bool finite) const {
        if (!finite) fail("a value is out of the range of float");
    }

    // Called while a statement is handled: its line has just been read.
    [[noreturn]] void fail(const std::string& message) const {
        std::size_t end = buffer_.position();
        while (end > 0 && (text_[end - 1] == '\n' || text_[end - 1] == '\r')) --end;
        SourceLocation where = locate(filename_, text_, end);
        where.column = 0;
        throw InputError(where, message);
    }

    const std::string& filename_;
    std::string text_;
    TextBuffer buffer_{text_};
    std::vector<Vec3f> positions_, normals_;
    std::vector<Vec2f> uvs_;
    std::vector<std::uint32_t> first_vertex_;  // by position; none if unused so far
    std::vector<Variant> variants_;            // by vertex
    std::shared_ptr<Mesh> mesh_ = std::make_shared<Mesh>();
    bool has_normals_ = false, has_uvs_ = false;
};

}  // namespace

std::shared_ptr<Mesh> read_obj(const std::string& filename) {
    return ObjReader(filename, read_whole_file(filename)).read();
}

}  // namespace keyhole
