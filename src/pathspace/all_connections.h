// All techniques at once: an eye subpath and a light subpath, as long as they get, and every connection between them
// [Veach 1997, chapter 10].
#pragma once

#include <concepts>
#include <vector>

#include "pathspace/connect.h"

namespace keyhole {

struct LengthRange {
    int min = 1, max = 12;  // edges
    bool contains(int k) const { return k >= min && k <= max; }
};

// Where the subpaths' numbers in [0, 1) come from. Each function is called once at most for each subpath and vertex, in
// the order of its vertices, the light's first.
template <class T>
concept SubpathNumbers = requires(T& numbers, int vertex) {
    { numbers.emitter() } -> std::convertible_to<double>;
    { numbers.part() } -> std::convertible_to<double>;
    { numbers.point() } -> std::convertible_to<Vec2>;
    { numbers.ray() } -> std::convertible_to<Vec2>;
    { numbers.lens() } -> std::convertible_to<Vec2>;
    { numbers.raster() } -> std::convertible_to<Vec2>;  // a raster position
    { numbers.light_lobe(vertex) } -> std::convertible_to<double>;
    { numbers.light_direction(vertex) } -> std::convertible_to<Vec2>;
    { numbers.eye_lobe(vertex) } -> std::convertible_to<double>;
    { numbers.eye_direction(vertex) } -> std::convertible_to<Vec2>;
};

class AllConnections {
  public:
    AllConnections(const Scene& scene, LengthRange lengths, TechniqueSet techniques = all_techniques)
        : tracer_(scene),
          window_(scene.film()),
          lengths_(lengths),
          techniques_(techniques),
          eye_(lengths.max + 1),
          light_(lengths.max) {}

    // Calls visit(t, raster, contribution w_t f / p_t) for each connection that passes light.
    template <SubpathNumbers Numbers, class Visit>
    void trace(Numbers& numbers, const Visit& visit) {
        const int s_max = trace_light(numbers);
        const Vec2 raster = numbers.raster();
        const int t_max = trace_eye(raster, numbers);
        for (int t = 2; t <= t_max; ++t) {
            if (eye_[t - 1].x.emitter) connect_and_visit(t, 0, raster, visit);
            if (eye_[t - 1].infinite) continue;
            for (int s = 1; s <= s_max; ++s) connect_and_visit(t, s, raster, visit);
        }
        for (int s = 2; s <= s_max; ++s) connect_and_visit(1, s, raster, visit);
    }

    Tracer& tracer() { return tracer_; }
    const Tracer& tracer() const { return tracer_; }
    const RasterWindow& window() const { return window_; }

  private:
    // The subpath's vertex j; the vertices stand in the path's order.
    Vertex& light(int j) { return light_[light_.size() - 1 - j]; }

    // How many vertices there are.
    template <class Numbers>
    int trace_light(Numbers& numbers) {
        if (techniques_.max_light == 0) return 0;
        const double u_choice = numbers.emitter(), u_part = numbers.part();
        if (!start_light(tracer_.scene(), u_choice, u_part, numbers.point(), light(0))) return 0;
        if (lengths_.max < 2) return 1;
        Extension e = first_light_edge(tracer_, numbers.ray(), light(0), light(1));
        int s = 1;
        while (e == Extension::surface && ++s < lengths_.max) {
            const double u_lobe = numbers.light_lobe(s - 1);
            const Vec2 u = numbers.light_direction(s - 1);
            e = extend(tracer_, Mode::light, light(s - 2), light(s - 1), light(s), u_lobe, u);
        }
        return s;
    }
    template <class Numbers>
    int trace_eye(const Vec2& raster, Numbers& numbers) {
        start_eye(tracer_.scene(), numbers.lens(), eye_[0]);
        Extension e = first_eye_edge(tracer_, window_, raster, eye_[0], eye_[1]);
        int t = 2;
        for (; e == Extension::surface && t <= lengths_.max; ++t) {
            const double u_lobe = numbers.eye_lobe(t - 1);
            const Vec2 u = numbers.eye_direction(t - 1);
            e = extend(tracer_, Mode::eye, eye_[t - 2], eye_[t - 1], eye_[t], u_lobe, u);
        }
        const bool last_counts = e == Extension::surface || (e == Extension::escaped && tracer_.scene().environment());
        return last_counts ? t : t - 1;
    }

    template <class Visit>
    void connect_and_visit(int t, int s, const Vec2& raster, const Visit& visit) {
        if (!lengths_.contains(s + t - 1) || !techniques_.holds(s)) return;
        const std::span<const Vertex> eye(eye_.data(), t), light(light_.data() + light_.size() - s, s);
        Connection c;
        if (connect(tracer_, window_, eye, light, c) != PathFailure::none) return;
        visit(t, t == 1 ? c.raster : raster, c.throughput * mis_weight(eye, light, c.junction, techniques_));
    }

    Tracer tracer_;
    RasterWindow window_;
    LengthRange lengths_;
    TechniqueSet techniques_;
    std::vector<Vertex> eye_, light_;
};

}  // namespace keyhole
