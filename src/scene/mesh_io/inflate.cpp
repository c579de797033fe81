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

void InflateReader::read(void* out, std::size_t bytes) {
    auto* target = static_cast<Bytef*>(out);
    while (bytes > 0) {
        feed();
        const std::size_t wanted = std::min(bytes, chunk);
        stream_.next_out = target;
        stream_.avail_out = static_cast<uInt>(wanted);
        const int status = inflate(&stream_, Z_NO_FLUSH);
        const std::size_t got = wanted - stream_.avail_out;
        target += got;
        bytes -= got;
        if (bytes == 0) return;
        if (status == Z_STREAM_END) throw InputError({filename_}, "truncated: the mesh ends early");
        if (status == Z_BUF_ERROR || (status == Z_OK && got == 0 && stream_.avail_in == 0 && left_.empty())) {
            throw InputError({filename_}, "truncated: the file ends early");
        }
        if (status != Z_OK) throw InputError({filename_}, "the compressed data are damaged");
    }
}

}  // namespace keyhole
