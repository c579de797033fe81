#include "base/units.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <ctime>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "base/error.h"

namespace keyhole {
namespace {

[[noreturn]] void refuse(std::string_view text, const std::string& what, const std::string& valid) {
    throw InputError({}, fmt::format("'{}' is not {}; valid: {}", text, what, valid));
}

// Takes a number off the front of `text`; empty if there is none.
template <class T>
std::optional<T> take_number(std::string_view& text) {
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc()) return {};
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return value;
}

template <class T>
std::optional<T> whole_number(std::string_view text) {
    const std::optional<T> value = take_number<T>(text);
    return text.empty() ? value : std::nullopt;
}

bool take(std::string_view& text, std::string_view prefix) {
    if (!text.starts_with(prefix)) return false;
    text.remove_prefix(prefix.size());
    return true;
}

// "a<separator>b<separator>..." with N numbers; empty if that is not what it is.
template <std::size_t N>
std::optional<std::array<int, N>> take_list(std::string_view text, std::string_view separator) {
    std::array<int, N> values{};
    for (std::size_t i = 0; i < N; ++i) {
        if (i > 0 && !take(text, separator)) return {};
        const std::optional<int> value = take_number<int>(text);
        if (!value || *value < 0 || *value > 65536) return {};
        values[i] = *value;
    }
    if (!text.empty()) return {};
    return values;
}

// The units of a duration in falling order, so that "1h30m" is read and "30m1h" is not. "ms" is tried before "m".
constexpr std::array<std::pair<std::string_view, double>, 5> duration_units = {
    {{"d", 86400}, {"h", 3600}, {"m", 60}, {"s", 1}, {"ms", 1e-3}}};

std::optional<std::size_t> take_unit(std::string_view& text) {
    for (std::size_t i = duration_units.size(); i-- > 0;)
        if (take(text, duration_units[i].first)) return i;
    return {};
}

std::optional<double> duration(std::string_view text) {
    if (const std::optional<double> bare = whole_number<double>(text)) return bare;
    double seconds = 0;
    for (std::size_t next = 0; !text.empty();) {
        const std::optional<double> value = take_number<double>(text);
        const std::optional<std::size_t> unit = take_unit(text);
        if (!value || !unit || *unit < next) return {};
        seconds += *value * duration_units[*unit].second;
        next = *unit + 1;
    }
    return seconds;
}

std::string with_prefix(double value, double base, std::span<const char* const> prefixes) {
    std::size_t i = 0;
    // 999.5 would be printed as 1000.
    while (value >= (base == 1000 ? 999.5 : base) && i + 1 < prefixes.size()) value /= base, ++i;
    const int digits = i == 0 || value >= 99.95 ? 0 : value >= 9.995 ? 1 : 2;
    return fmt::format("{:.{}f}{}", value, digits, prefixes[i]);
}

}  // namespace

double parse_duration(std::string_view text) {
    const std::optional<double> seconds = text.empty() ? std::nullopt : duration(text);
    if (!seconds || !std::isfinite(*seconds) || *seconds < 0)
        refuse(text, "a duration", "a number with ms, s, m, h or d, such as 60s, 1.5h, 1h30m or 500ms");
    return *seconds;
}

std::array<int, 2> parse_size(std::string_view text) {
    const auto size = take_list<2>(text, "x");
    if (!size || (*size)[0] < 1 || (*size)[1] < 1)
        refuse(text, "a size", "WIDTHxHEIGHT in pixels, each from 1 to 65536, such as 640x480");
    return *size;
}

std::array<int, 4> parse_crop(std::string_view text) {
    const auto crop = take_list<4>(text, ",");
    if (!crop || (*crop)[2] < 1 || (*crop)[3] < 1)
        refuse(text, "a crop window", "X,Y,WIDTH,HEIGHT in pixels, such as 100,50,64,64");
    return *crop;
}

double parse_real(std::string_view text, double min, double max, bool above) {
    const std::optional<double> value = whole_number<double>(text);
    if (value && std::isfinite(*value) && *value <= max && (above ? *value > min : *value >= min)) return *value;
    const std::string lower = fmt::format("{} {}", above ? "above" : "from", min);
    const std::string upper = max < std::numeric_limits<double>::max() ? fmt::format(" to {}", max) : "";
    refuse(text, "valid here",
           "a number " + (above || !upper.empty() ? lower : fmt::format("of at least {}", min)) + upper);
}

std::int64_t parse_integer(std::string_view text, std::int64_t min, std::int64_t max) {
    const std::optional<std::int64_t> value = whole_number<std::int64_t>(text);
    if (!value || *value < min || *value > max)
        refuse(text, "valid here", fmt::format("an integer from {} to {}", min, max));
    return *value;
}

std::uint64_t parse_unsigned(std::string_view text) {
    const std::optional<std::uint64_t> value = whole_number<std::uint64_t>(text);
    if (!value)
        refuse(text, "valid here", fmt::format("an integer from 0 to {}", std::numeric_limits<std::uint64_t>::max()));
    return *value;
}

std::string format_duration(double seconds) {
    if (seconds < 0.9995) return fmt::format("{:.0f}ms", 1000 * seconds);
    if (seconds < 9.95) return fmt::format("{:.1f}s", seconds);
    const auto s = static_cast<std::int64_t>(std::lround(seconds));
    if (s < 60) return fmt::format("{}s", s);
    if (s < 3600) return fmt::format("{}m{:02}s", s / 60, s % 60);
    if (s < 86400) return fmt::format("{}h{:02}m", s / 3600, s / 60 % 60);
    return fmt::format("{}d{:02}h", s / 86400, s / 3600 % 24);
}

std::string format_count(double count) {
    static constexpr std::array prefixes = {"", " k", " M", " G", " T"};
    return with_prefix(count, 1000, prefixes);
}

std::string format_bytes(std::uint64_t bytes) {
    static constexpr std::array prefixes = {" B", " KiB", " MiB", " GiB", " TiB"};
    return with_prefix(static_cast<double>(bytes), 1024, prefixes);
}

std::string utc_now() { return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))); }

}  // namespace keyhole
