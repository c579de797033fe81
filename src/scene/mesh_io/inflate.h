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
    template <class T>
    T read() {
        T value;
        read(&value, sizeof(value));
        return value;
    }

  private:
    void feed();

    const std::string& filename_;
    std::string_view left_;  // not yet given to zlib
    z_stream stream_{};
};

}  // namespace keyhole
