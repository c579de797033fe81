// Line plots as SVG: enough for the curves of an experiment, without a library.
#pragma once

#include <string>
#include <vector>

namespace keyhole {

struct PlotPoint {
    double x = 0, y = 0;
    double low = 0, high = 0;  // ends of the error bar; both equal to y: none
};

struct PlotSeries {
    std::string name;
    std::vector<PlotPoint> points;
    bool dashed = false;
};

// Both axes are logarithmic; points and ends of bars that are not positive are left out.
struct PlotPanel {
    std::string title, x_label, y_label;
    std::vector<PlotSeries> series;
};

// Panels side by side, three in a row. Series of one name have one colour in all of them.
std::string svg_plot(const std::string& title, const std::vector<PlotPanel>& panels);

}  // namespace keyhole
