#include "scene/mesh_io/inflate.h"

#include <algorithm>

#include "base/error.h"

namespace keyhole {
namespace {

constexpr std::size_t chunk = std::size_t{1} << 30;  // zlib counts in 32 bits

}  // namespace

InflateReader::InflateReader(const std::string& filename, std::string_view compressed)
    : filename_(filename), left_(compressed) {
    if (inflateInit(&stream_) != Z_OK) throw InputError({filename_}, "zlib cannot be initialised");
}

InflateReader::~InflateReader() { inflateEnd(&stream_); }

void InflateReader::feed() {
    if (stream_.avail_in > 0 || left_.empty()) return;
    const std::size_t n = std::min(left_.size(), chunk);
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(left_.data()));  // zlib only reads it
    stream_.avail_in = static_cast<uInt>(n);
    left_.remove_prefix(n);
}

bool InflateReader::inflate_some(void* out, std::size_t bytes, std::size_t& got) {
    feed();
    const std::size_t wanted = std::min(bytes, chunk);
    stream_.next_out = static_cast<Bytef*>(out);
    stream_.avail_out = static_cast<uInt>(wanted);
    const int status = inflate(&stream_, Z_NO_FLUSH);
    got = wanted - stream_.avail_out;
    if (status == Z_STREAM_END) return false;
    if (status == Z_BUF_ERROR || (got == 0 && stream_.avail_in == 0 && left_.empty())) {
        throw InputError({filename_}, "truncated: the file ends early");
    }
    if (status != Z_OK) throw InputError({filename_}, "the compressed data are damaged");
    return true;
}

void InflateReader::read(void* out, std::size_t bytes) {
    auto* target = static_cast<char*>(out);
    while (bytes > 0) {
        std::size_t got = 0;
        const bool more = !ended_ && inflate_some(target, bytes, got);
        ended_ = !more;
        target += got;
        bytes -= got;
        if (ended_ && bytes > 0) throw InputError({filename_}, "truncated: the mesh ends early");
    }
}

void InflateReader::finish() {
    char rest[4096];
    std::size_t ignored = 0;
    while (!ended_) ended_ = !inflate_some(rest, sizeof(rest), ignored);
}

}  // namespace keyhole
