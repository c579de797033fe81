#include "experiments/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace keyhole {
namespace {

constexpr double width = 440, height = 330, left = 66, right = 14, top = 30, bottom = 46, title_height = 34,
                 legend_height = 24;
constexpr std::size_t columns = 3;
constexpr const char* colours[] = {"#1f5fa8", "#c8442b", "#2f8f4e", "#8a4fb0", "#b8860b", "#3a9fb5", "#6b6b6b"};

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) result += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
    return result;
}

// A logarithmic axis of `length` pixels.
struct Axis {
    double low = std::numeric_limits<double>::infinity(), high = 0;

    void cover(double v) {
        if (!(v > 0) || !std::isfinite(v)) return;
        low = std::min(low, v);
        high = std::max(high, v);
    }
    void widen() {
        if (!(high > 0)) low = 0.1, high = 1;
        const double room = std::pow(high / low, 0.05) * 1.02;
        low /= room;
        high *= room;
    }
    double at(double v) const { return std::log(v / low) / std::log(high / low); }
    std::vector<double> ticks() const {
        std::vector<double> result;
        const bool few = high / low < 30;
        for (double decade = std::pow(10, std::floor(std::log10(low))); decade <= high; decade *= 10)
            for (const double m : few ? std::vector<double>{1, 2, 5} : std::vector<double>{1})
                if (decade * m >= low && decade * m <= high) result.push_back(decade * m);
        return result;
    }
};

class Panel {
  public:
    Panel(const PlotPanel& plot, double x, double y, const std::vector<std::string>& names)
        : plot_(plot), x0_(x), y0_(y), names_(names) {
        for (const PlotSeries& s : plot.series)
            for (const PlotPoint& p : s.points)
                if (p.y > 0) {
                    x_.cover(p.x);
                    y_.cover(p.y);
                }
        x_.widen();
        y_.widen();
    }

    std::string svg() const {
        std::string s = fmt::format(
            R"(<text x="{}" y="{}" text-anchor="middle" font-weight="bold">{}</text><rect x="{}" y="{}" width="{}" height="{}" fill="none" stroke="#999"/>)",
            x0_ + (left + width - right) / 2, y0_ + 20, escaped(plot_.title), x0_ + left, y0_ + top,
            width - left - right, height - top - bottom);
        s += axes();
        for (const PlotSeries& series : plot_.series) s += curve(series);
        return s;
    }

  private:
    double px(double x) const { return x0_ + left + x_.at(x) * (width - left - right); }
    double py(double y) const { return y0_ + height - bottom - y_.at(y) * (height - top - bottom); }
    double clamped(double y) const { return py(std::clamp(y, y_.low, y_.high)); }

    std::string axes() const {
        std::string s;
        for (const double t : x_.ticks())
            s += fmt::format(
                R"(<line x1="{0}" x2="{0}" y1="{1}" y2="{2}" stroke="#ddd"/><text x="{0}" y="{3}" text-anchor="middle">{4:g}</text>)",
                px(t), y0_ + top, y0_ + height - bottom, y0_ + height - bottom + 15, t);
        for (const double t : y_.ticks())
            s += fmt::format(
                R"(<line x1="{1}" x2="{2}" y1="{0}" y2="{0}" stroke="#ddd"/><text x="{3}" y="{4}" text-anchor="end">{5:g}</text>)",
                py(t), x0_ + left, x0_ + width - right, x0_ + left - 5, py(t) + 4, t);
        s += fmt::format(R"(<text x="{}" y="{}" text-anchor="middle">{}</text>)", x0_ + (left + width - right) / 2,
                         y0_ + height - 12, escaped(plot_.x_label));
        s += fmt::format(R"svg(<text transform="translate({},{}) rotate(-90)" text-anchor="middle">{}</text>)svg",
                         x0_ + 14, y0_ + (top + height - bottom) / 2, escaped(plot_.y_label));
        return s;
    }

    std::string curve(const PlotSeries& series) const {
        const auto index = std::find(names_.begin(), names_.end(), series.name) - names_.begin();
        const std::string colour = colours[static_cast<std::size_t>(index) % std::size(colours)];
        std::string line, s;
        for (const PlotPoint& p : series.points) {
            if (!(p.y > 0)) continue;
            line += fmt::format("{:.1f},{:.1f} ", px(p.x), py(p.y));
            s += fmt::format(R"(<circle cx="{:.1f}" cy="{:.1f}" r="2.5" fill="{}"/>)", px(p.x), py(p.y), colour);
            if (p.high > p.low)
                s += fmt::format(R"(<line x1="{0:.1f}" x2="{0:.1f}" y1="{1:.1f}" y2="{2:.1f}" stroke="{3}"/>)", px(p.x),
                                 clamped(p.low), clamped(p.high), colour);
        }
        return s + fmt::format(R"(<polyline points="{}" fill="none" stroke="{}" stroke-width="1.5"{}/>)", line, colour,
                               series.dashed ? R"( stroke-dasharray="5 4")" : "");
    }

    const PlotPanel& plot_;
    double x0_, y0_;
    const std::vector<std::string>& names_;
    Axis x_, y_;
};

}  // namespace

std::string svg_plot(const std::string& title, const std::vector<PlotPanel>& panels) {
    std::vector<std::string> names;
    for (const PlotPanel& panel : panels)
        for (const PlotSeries& s : panel.series)
            if (std::find(names.begin(), names.end(), s.name) == names.end()) names.push_back(s.name);
    const std::size_t across = std::min(columns, panels.size()), down = (panels.size() + columns - 1) / columns;
    const double w = std::max(1.0, static_cast<double>(across)) * width,
                 h = title_height + legend_height + static_cast<double>(down) * height;
    std::string s = fmt::format(
        R"(<svg xmlns="http://www.w3.org/2000/svg" width="{0}" height="{1}" viewBox="0 0 {0} {1}" font-family="sans-serif" font-size="11"><rect width="{0}" height="{1}" fill="white"/><text x="{2}" y="22" font-size="15" text-anchor="middle">{3}</text>)",
        w, h, w / 2, escaped(title));
    double x = left;
    for (std::size_t i = 0; i < names.size(); ++i) {
        s += fmt::format(R"(<rect x="{}" y="{}" width="14" height="4" fill="{}"/><text x="{}" y="{}">{}</text>)", x,
                         title_height + 8, colours[i % std::size(colours)], x + 19, title_height + 14,
                         escaped(names[i]));
        x += 40 + 6.5 * static_cast<double>(names[i].size());
    }
    for (std::size_t i = 0; i < panels.size(); ++i)
        s += Panel(panels[i], static_cast<double>(i % columns) * width,
                   title_height + legend_height + static_cast<double>(i / columns) * height, names)
                 .svg();
    return s + "</svg>\n";
}

}  // namespace keyhole
