// Numbers as people write and read them: durations, sizes, counts.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace keyhole {

// All parsers read the whole text and throw InputError (without a location) that says what would have been valid.

// Seconds, >= 0: a number with ms, s, m, h or d, or several such in falling order ("90s", "1.5h", "1h30m", "500ms"). A
// bare number is in seconds.
double parse_duration(std::string_view text);

// "WxH" in pixels, each in [1, 65536].
std::array<int, 2> parse_size(std::string_view text);

// "x,y,w,h" in pixels; x and y in [0, 65536], w and h in [1, 65536].
std::array<int, 4> parse_crop(std::string_view text);

// A finite number in [min, max], or (min, max] with `above`.
double parse_real(std::string_view text, double min, double max, bool above = false);

// An integer in [min, max].
std::int64_t parse_integer(std::string_view text, std::int64_t min, std::int64_t max);
std::uint64_t parse_unsigned(std::string_view text);

// "850ms", "4.2s", "42s", "4m05s", "1h02m", "3d04h".
std::string format_duration(double seconds);

// Three digits and a decimal prefix: "7", "1.55 M", "12.0 k".
std::string format_count(double count);

// The same in bytes with binary prefixes: "512 B", "1.50 GiB".
std::string format_bytes(std::uint64_t bytes);

// Now, as "2024-05-31T12:00:00Z".
std::string utc_now();

}  // namespace keyhole
