// Mesh files: what was written comes back, and what is malformed is reported, never read as something else.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <atomic>

#include "base/error.h"
#include "base/rng.h"
#include "mesh_files.h"

namespace keyhole {
namespace {

using testing::HasSubstr;

void expect_equal(const Mesh& a, const Mesh& b) {
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.normals, b.normals);
    EXPECT_EQ(a.uvs, b.uvs);
    EXPECT_EQ(a.triangles, b.triangles);
    EXPECT_GT(a.positions.capacity(), a.positions.size());  // so that Embree can share them
}

template <class Read>
std::string message_of(const Read& read) {
    try {
        read();
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

std::string obj_message(const std::string& text) {
    const TemporaryFile file("bad.obj", text);
    std::string message = message_of([&] { read_obj(file.path()); });
    const std::size_t at = message.find(file.path());
    return at == std::string::npos ? message : message.replace(at, file.path().size(), "FILE");
}

std::string ply_message(const std::string& text) {
    const TemporaryFile file("bad.ply", text);
    return message_of([&] { read_ply(file.path()); });
}

std::string serialized_message(const std::string& bytes, int shape_index = 0) {
    const TemporaryFile file("bad.serialized", bytes);
    return message_of([&] { read_serialized(file.path(), shape_index); });
}

TEST(MeshIo, ObjComesBack) {
    const TemporaryFile file("square.obj", obj_file(square_mesh()));
    expect_equal(*read_obj(file.path()), square_mesh());
}

TEST(MeshIo, ObjJoinsIndicesToVertices) {
    const TemporaryFile file("joined.obj",
                             "v 0 0 0\r\nv 1 0 0\r\nv 1 1 0\r\nv 0 1 0\r\nvt 0 0\r\nvt .5 1e-1\r\nvn 0 0 1\r\n"
                             "f 1/1/1 2/1/1 3/1/1 4/2/1\r\n"  // a quad: two triangles
                             "f -4/1/1 -2/2/-1 -1/2/1");      // shares 1/1/1 and 4/2/1, not 3; no end of line
    const auto mesh = read_obj(file.path());
    EXPECT_EQ(mesh->positions.size(), 5U);
    const std::vector<std::array<std::uint32_t, 3>> triangles = {{0, 1, 2}, {0, 2, 3}, {0, 4, 3}};
    EXPECT_EQ(mesh->triangles, triangles);
    EXPECT_EQ(mesh->uvs[4], Vec2f(0.5F, 0.1F));
    EXPECT_EQ(mesh->normals.size(), 5U);
}

TEST(MeshIo, ObjWithoutNormalsAndUvHasNone) {
    const TemporaryFile file("bare.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvt 0 0\nf 1 2 3\n");
    const auto mesh = read_obj(file.path());
    EXPECT_TRUE(mesh->normals.empty());
    EXPECT_TRUE(mesh->uvs.empty());
}

TEST(MeshIo, MalformedObjIsReportedWithItsPlace) {
    const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    EXPECT_THAT(obj_message(""), HasSubstr("no triangles"));
    EXPECT_THAT(obj_message(triangle), HasSubstr("no triangles"));
    EXPECT_THAT(obj_message(triangle + "f 1 2 4\n"), HasSubstr("FILE:4: vertex index 4 is out of range"));
    EXPECT_THAT(obj_message(triangle + "f 1 2 -4\n"), HasSubstr("FILE:4: vertex index -4 is out of range"));
    EXPECT_THAT(obj_message(triangle + "f 1 2 0\n"), HasSubstr("FILE:4:7: '0' is not a face corner"));
    EXPECT_THAT(obj_message(triangle + "f 1/2 2/2 3/2\n"), HasSubstr("FILE:4: texture coordinate index 2"));
    EXPECT_THAT(obj_message(triangle + "f 1//1 2//1 3//1\n"), HasSubstr("FILE:4: normal index 1 is out of range"));
    EXPECT_THAT(obj_message(triangle + "f 1 2\n"), HasSubstr("FILE:4:6: a face needs 3 corners, found 2"));
    EXPECT_THAT(obj_message(triangle + "f 1 2 3x\n"), HasSubstr("FILE:4:7: '3x' is not a face corner"));
    EXPECT_THAT(obj_message(triangle + "f 1/1/1/1 2 3\n"), HasSubstr("FILE:4:3:"));
    EXPECT_THAT(obj_message(triangle + "f 4294967297 2 3\n"), HasSubstr("FILE:4:3:"));
    EXPECT_THAT(obj_message("v 0 0 nan\n"), HasSubstr("FILE:1:7: 'nan' is not a number"));
    EXPECT_THAT(obj_message("v 0 0 1e\n"), HasSubstr("FILE:1:7:"));
    EXPECT_THAT(obj_message("v 0 0 1e99999\n"), HasSubstr("FILE:1:7:"));
    EXPECT_THAT(obj_message("v 0 0\n"), HasSubstr("FILE:1:6: a vertex needs 3 numbers, found 2"));
    EXPECT_THAT(obj_message("v 0 0 0\nv 1 1e300 0\n"), HasSubstr("FILE:2: a value is out of the range of float"));
    EXPECT_THAT(obj_message("\r\nvn 0 0 --1\r\n"), HasSubstr("FILE:2:8:"));
    EXPECT_THAT(obj_message("curv 0 1 2\n"), HasSubstr("FILE:1:1: unknown statement 'curv'"));
    EXPECT_THAT(message_of([] { read_obj("/no/such/file.obj"); }), HasSubstr("cannot read the file"));
}

TEST(MeshIo, PlyComesBackInAllEncodings) {
    for (const PlyEncoding encoding : {PlyEncoding::ascii, PlyEncoding::little, PlyEncoding::big}) {
        const TemporaryFile file("square.ply", ply_file(square_mesh(), encoding));
        expect_equal(*read_ply(file.path()), square_mesh());
    }
}

TEST(MeshIo, PlyOfOtherTypesAndElementsIsRead) {
    const std::string text =
        "ply\r\nformat ascii 1.0\r\nobj_info x\r\nelement camera 1\r\nproperty list int8 double a\r\n"
        "element vertex 4\r\nproperty double z\r\nproperty int16 x\r\nproperty int y\r\nproperty float s\r\n"
        "property float t\r\nelement face 1\r\nproperty uchar flag\r\nproperty list uint8 uint16 vertex_index\r\n"
        "end_header\r\n2 0.5 +1\r\n0 0 0 0 0\r\n0 1 0 1 0 0 1 1 1 1 0 0 1 0 1\r\n1 4 0 1 2 3";
    const TemporaryFile file("other.ply", text);
    const auto mesh = read_ply(file.path());
    const std::vector<std::array<std::uint32_t, 3>> triangles = {{0, 1, 2}, {0, 2, 3}};
    EXPECT_EQ(mesh->triangles, triangles);
    EXPECT_EQ(mesh->positions[2], Vec3f(1, 1, 0));
    EXPECT_EQ(mesh->uvs[3], Vec2f(0, 1));
    EXPECT_TRUE(mesh->normals.empty());
}

TEST(MeshIo, MalformedPlyIsReported) {
    const std::string good = ply_file(square_mesh(), PlyEncoding::ascii);
    const auto with = [&](const std::string& found, const std::string& replacement) {
        std::string text = good;
        const std::size_t at = text.find(found);
        EXPECT_NE(at, std::string::npos) << found;
        return ply_message(text.replace(at, found.size(), replacement));
    };
    EXPECT_THAT(ply_message(""), HasSubstr("end_header"));
    EXPECT_THAT(ply_message("obj\n"), HasSubstr(":1: not a PLY file"));
    EXPECT_THAT(with("ascii", "text"), HasSubstr(":2: unknown format"));
    EXPECT_THAT(with("1.0", "2.0"), HasSubstr(":2: unknown version '2.0'"));
    EXPECT_THAT(with("float ny", "half ny"), HasSubstr(":9: unknown type 'half'"));
    EXPECT_THAT(with("property float x", "propertie float x"), HasSubstr(":5: unknown header line"));
    EXPECT_THAT(with("float y", "float x"), HasSubstr("'x' is given twice"));
    EXPECT_THAT(with("float y", "float why"), HasSubstr("some, but not all of the properties x to z"));
    EXPECT_THAT(with("element vertex 4", "element vertex -4"), HasSubstr(":4: '-4' is not a number of elements"));
    EXPECT_THAT(with("element vertex 4", "element vertex 400000000000"), HasSubstr("truncated"));
    EXPECT_THAT(with("element vertex 4", "element point 4"), HasSubstr("no 'vertex'"));
    EXPECT_THAT(with("list uchar", "list float"), HasSubstr("must be an integer"));
    EXPECT_THAT(with("vertex_indices", "indices"), HasSubstr("faces have no list 'vertex_indices'"));
    EXPECT_THAT(with("end_header", "end"), HasSubstr("unknown header line"));
    EXPECT_THAT(with("3 0 1 2", "3 0 1 4"), HasSubstr("vertex index 4 is out of range"));
    EXPECT_THAT(with("3 0 1 2", "3 0 1 -1"), HasSubstr("a vertex index is out of range"));
    EXPECT_THAT(with("3 0 1 2", "2 0 1"), HasSubstr("face 0 has fewer than 3 corners"));
    EXPECT_THAT(with("3 0 1 2", "300 0 1 2"), HasSubstr("the length of the list 'vertex_indices' is not valid"));
    EXPECT_THAT(with("0.500000", "nan"), HasSubstr("vertex 0 is not finite"));
    EXPECT_THAT(with("0.500000", "1e60"), HasSubstr("vertex 0 is not finite"));
    EXPECT_THAT(with("0.500000", "1e600"), HasSubstr(":17:19: a number is out of range"));
    EXPECT_THAT(with("0.500000", "0.5half"), HasSubstr(":17:19: expected a number"));
    EXPECT_THAT(with("3 0 2 3\n", "3 0 2"), HasSubstr("truncated"));
    EXPECT_THAT(with("3 0 2 3\n", "3 0 2 3 3"), HasSubstr("data after the last element"));
    const std::string binary = ply_file(square_mesh(), PlyEncoding::big);
    EXPECT_THAT(ply_message(binary.substr(0, binary.size() - 1)), HasSubstr("truncated"));
    EXPECT_THAT(ply_message(binary + "x"), HasSubstr("data after the last element"));
}

TEST(MeshIo, SerializedComesBackInBothVersionsAndPrecisions) {
    Mesh bare = square_mesh();
    bare.normals.clear();
    bare.uvs.clear();
    for (const int version : {3, 4}) {
        for (const bool doubles : {false, true}) {
            const TemporaryFile file("two.serialized",
                                     serialized_file({serialized_body(square_mesh(), version, doubles),
                                                      serialized_body(bare, version, doubles)},
                                                     version));
            expect_equal(*read_serialized(file.path(), 0), square_mesh());
            expect_equal(*read_serialized(file.path(), 1), bare);
        }
    }
    const TemporaryFile file("flat.serialized", serialized_file({serialized_body(square_mesh(), 4, false, 0x10)}, 4));
    EXPECT_TRUE(read_serialized(file.path(), 0)->normals.empty());  // the face-normals flag
}

TEST(MeshIo, MalformedSerializedIsReported) {
    const std::string body = serialized_body(square_mesh(), 4, false), good = serialized_file({body}, 4);
    EXPECT_THAT(serialized_message(""), HasSubstr("truncated"));
    EXPECT_THAT(serialized_message("PK" + good.substr(2)), HasSubstr("not a serialized mesh"));
    EXPECT_THAT(serialized_message(good.substr(0, 2) + "\x05" + good.substr(3)), HasSubstr("unknown version 5"));
    EXPECT_THAT(serialized_message(good, 1), HasSubstr("shape_index 1 is out of range, the file has 1 meshes"));
    EXPECT_THAT(serialized_message(good, -1), HasSubstr("shape_index -1 is out of range"));
    EXPECT_THAT(serialized_message(good.substr(0, good.size() - 1)), HasSubstr("table of meshes"));
    EXPECT_THAT(serialized_message(serialized_file({body.substr(0, body.size() - 1)}, 4)), HasSubstr("ends early"));
    std::string damaged = good;
    damaged[12] = static_cast<char>(~damaged[12]);
    EXPECT_NE(serialized_message(damaged), "no error");
    EXPECT_THAT(serialized_message(serialized_file({serialized_body(square_mesh(), 4, false, 0x2000)}, 4)),
                HasSubstr("single or double precision"));
    Mesh mesh = square_mesh();
    mesh.triangles[1][2] = 4;
    EXPECT_THAT(serialized_message(serialized_file({serialized_body(mesh, 4, false)}, 4)),
                HasSubstr("vertex index 4 is out of range, there are 4 vertices"));
    mesh = square_mesh();
    mesh.uvs[2].x() = std::numeric_limits<float>::infinity();
    EXPECT_THAT(serialized_message(serialized_file({serialized_body(mesh, 4, true)}, 4)),
                HasSubstr("uv coordinate 2 is not finite"));
    mesh = square_mesh();
    mesh.triangles.clear();
    EXPECT_THAT(serialized_message(serialized_file({serialized_body(mesh, 4, true)}, 4)), HasSubstr("no triangles"));
    std::string huge = body;
    huge[9 + 6] = '\x7f';  // the vertex count
    EXPECT_THAT(serialized_message(serialized_file({huge}, 4)), HasSubstr("more than 2^32 vertices"));
    huge = body;
    huge[9 + 8 + 6] = '\x7f';  // the triangle count
    EXPECT_THAT(serialized_message(serialized_file({huge}, 4)), HasSubstr("ends early"));
}

// Truncated and corrupted files are read or refused; they never crash, and what is read is a valid mesh.
TEST(MeshIo, DamagedFilesNeverCrash) {
    struct Case {
        std::string bytes;
        std::shared_ptr<Mesh> (*read)(const std::string&);
    };
    const auto read_first = [](const std::string& path) { return read_serialized(path, 0); };
    const Mesh square = square_mesh();
    const Case cases[] = {
        {obj_file(square), read_obj},
        {ply_file(square, PlyEncoding::ascii), read_ply},
        {ply_file(square, PlyEncoding::little), read_ply},
        {ply_file(square, PlyEncoding::big), read_ply},
        {serialized_file({serialized_body(square, 4, false)}, 4), read_first},
        {serialized_file({serialized_body(square, 3, true)}, 3), read_first},
    };
    Rng rng(11, 1);
    int refused = 0, accepted = 0;
    for (const Case& c : cases) {
        for (int i = 0; i < 150; ++i) {
            std::string bytes = c.bytes;
            const auto somewhere = [&] { return rng.below(static_cast<std::uint32_t>(bytes.size())); };
            const std::uint32_t kind = rng.below(4);
            if (kind == 0) bytes.resize(somewhere());
            for (std::uint32_t n = rng.below(3) + 1; n > 0 && !bytes.empty(); --n) {
                if (kind == 1) bytes[somewhere()] = static_cast<char>(rng.below(256));
                if (kind == 2) bytes.erase(somewhere(), 1 + rng.below(4));
                if (kind == 3) bytes.insert(somewhere(), 1, "0/-.9eN \n"[rng.below(9)]);
            }
            const TemporaryFile file("damaged", bytes);
            try {
                const auto mesh = c.read(file.path());
                ASSERT_FALSE(mesh->triangles.empty());
                for (const auto& triangle : mesh->triangles) {
                    for (const std::uint32_t index : triangle) ASSERT_LT(index, mesh->positions.size());
                }
                for (const Vec3f& p : mesh->positions) ASSERT_TRUE(p.allFinite());
                ++accepted;
            } catch (const InputError& error) {
                ASSERT_THAT(error.what(), HasSubstr("damaged"));  // the file's name
                ++refused;
            }
        }
    }
    EXPECT_GT(refused, 450);
    EXPECT_GT(accepted, 10);  // a changed digit is not an error
}

TEST(MeshIo, FilesAreReadInParallel) {
    const TemporaryFile obj("a.obj", obj_file(square_mesh())), ply("b.ply", ply_file(square_mesh(), PlyEncoding::big));
    std::atomic<int> good{0};
    tbb::parallel_for(0, 64, [&](int i) {
        const auto mesh = i % 2 ? read_obj(obj.path()) : read_ply(ply.path());
        good += mesh->triangles == square_mesh().triangles;
    });
    EXPECT_EQ(good, 64);
}

}  // namespace
}  // namespace keyhole
