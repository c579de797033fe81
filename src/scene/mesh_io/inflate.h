// A zlib stream in memory, read value by value.
#pragma once

#include <zlib.h>

#include <cstddef>
#include <string>
#include <string_view>

namespace keyhole {

class InflateReader {
  public:
    // Throws InputError naming `filename` for a stream that is damaged or ends early, here and below.
    InflateReader(const std::string& filename, std::string_view compressed);
    ~InflateReader();
    InflateReader(const InflateReader&) = delete;
    InflateReader& operator=(const InflateReader&) = delete;

    void read(void* out, std::size_t bytes);
    // Reads what is left and checks the stream's checksum.
    void finish();
    template <class T>
    T read() {
        T value;
        read(&value, sizeof(value));
        return value;
    }

  private:
    void feed();
    bool inflate_some(void* out, std::size_t bytes, std::size_t& got);  // false at the end of the stream

    const std::string& filename_;
    std::string_view left_;  // not yet given to zlib
    z_stream stream_{};
    bool ended_ = false;
};

}  // namespace keyhole
