#include "render/cone_image.h"

#include <chrono>
#include <cmath>
#include <stdexcept>

#include "base/parallel.h"
#include "base/phase.h"

namespace keyhole {
namespace {

double seconds_of(const std::vector<ConeEdge>& edges, ConeFinder& finder, std::vector<double>& angles) {
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < edges.size(); ++i) angles[i] = finder(edges[i]);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

ConeImage cone_image(const Scene& scene, const ConeSettings& settings) {
    if (scene.sensor().traits().infinite)
        throw std::invalid_argument("the primary edges of an orthographic sensor have no apex, so there are no cones");
    const FilmSettings& film = scene.film();
    const SensorPoint eye = scene.sensor().sample_point({0.5, 0.5});
    ConeSettings exact = settings;
    exact.estimator = ConeEstimator::exact;
    const BoxHierarchy& boxes = scene.boxes();

    ConeImage result;
    result.angles = Image(film.crop_width, film.crop_height);
    struct Row {
        std::vector<ConeEdge> edges;
        std::vector<int> columns;
        double sum = 0, worst = 1, seconds = 0, seconds_exact = 0;
    };
    std::vector<Row> rows(static_cast<std::size_t>(film.crop_height));
    parallel_for(rows.size(), [&](std::size_t y) {
        Row& row = rows[y];
        for (int x = 0; x < film.crop_width; ++x) {
            const SensorRay ray = scene.sensor().ray(eye, {film.crop_x + x + 0.5, film.crop_y + double(y) + 0.5});
            SurfacePoint hit;
            if (!scene.intersect({ray.o, ray.d, 0, ray.tfar}, hit)) continue;
            const Vec3 d = hit.p - eye.p;
            row.edges.push_back({eye.p, d.normalized(), d.norm(), hit.ng});
            row.columns.push_back(x);
        }
        std::vector<double> angles(row.edges.size()), exact_angles(row.edges.size());
        ConeFinder finder(boxes, settings), exact_finder(boxes, exact);
        row.seconds = seconds_of(row.edges, finder, angles);
        row.seconds_exact = seconds_of(row.edges, exact_finder, exact_angles);
        for (std::size_t i = 0; i < angles.size(); ++i) {
            const double ratio = angles[i] / exact_angles[i];
            row.sum += ratio;
            if (std::abs(std::log(ratio)) > std::abs(std::log(row.worst))) row.worst = ratio;
            float* pixel = result.angles.pixel(row.columns[i], static_cast<int>(y));
            for (int c = 0; c < 3; ++c) pixel[c] = static_cast<float>(angles[i]);
        }
    });
    result.worst_ratio = 1;
    for (const Row& row : rows) {
        result.edges += row.edges.size();
        result.mean_ratio += row.sum;
        result.seconds += row.seconds;
        result.seconds_exact += row.seconds_exact;
        if (std::abs(std::log(row.worst)) > std::abs(std::log(result.worst_ratio))) result.worst_ratio = row.worst;
    }
    if (result.edges > 0) {
        const auto n = static_cast<double>(result.edges);
        result.mean_ratio /= n;
        result.seconds /= n;
        result.seconds_exact /= n;
    }
    return result;
}

}  // namespace keyhole
