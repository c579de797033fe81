// Which primary sample coordinate does what. Each discrete choice has a coordinate of its own, each vertex a block of
// fixed size, and coordinates that the scene never reads do not exist: lens coordinates come with a finite aperture,
// the emitter's choice with a second emitter, lobe coordinates with BSDFs that choose among lobes.
//
// A path of k edges by technique t (t vertices from the eye, s = k + 1 - t from the light) uses a prefix of the eye
// coordinates, followed by a prefix of the light coordinates:
//     eye:   [lens 2] raster 2, then per scattering vertex  direction 2 [lobe 1]
//     light: [emitter 1] part 1, point 2, ray 2, then per scattering vertex  direction 2 [lobe 1]
#pragma once

#include <algorithm>

#include "base/vec.h"
#include "scene/scene.h"

namespace keyhole {

class CoordinateLayout {
  public:
    CoordinateLayout(const Scene& scene, int max_length)
        : lens_(scene.requirements().aperture ? 2 : 0),
          choice_(scene.emitters().size() > 1 ? 1 : 0),
          block_(scene.requirements().bsdfs.chooses_lobe ? 3 : 2),
          max_length_(max_length) {}

    int max_length() const { return max_length_; }

    // How many coordinates a subpath of t (s) vertices uses.
    int eye_count(int t) const { return t <= 0 ? 0 : (t == 1 ? lens_ : lens_ + 2 + (t - 2) * block_); }
    int light_count(int s) const { return s <= 0 ? 0 : choice_ + 3 + (s == 1 ? 0 : 2 + (s - 2) * block_); }

    // By technique t; {0, 0}: of all techniques at once, the longest subpaths from both ends.
    int count(int k, int t) const {
        return t == 0 ? bundle_eye_count() + light_count(max_length_) : eye_count(t) + light_count(k + 1 - t);
    }
    int bundle_eye_count() const { return eye_count(max_length_ + 1); }
    // The largest count of any path.
    int capacity() const {
        int most = 0;
        for (int t = 1; t <= max_length_ + 1; ++t) most = std::max(most, count(max_length_, t));
        return most;
    }
    bool has_lens() const { return lens_ > 0; }

    // Readers of a subpath's coordinates `u`; absent coordinates read as 0.
    Vec2 lens(const double* u) const { return lens_ ? Vec2(u[0], u[1]) : Vec2(0, 0); }
    Vec2 raster(const double* u) const { return {u[lens_], u[lens_ + 1]}; }
    double emitter(const double* u) const { return choice_ ? u[0] : 0; }
    double part(const double* u) const { return u[choice_]; }
    Vec2 point(const double* u) const { return {u[choice_ + 1], u[choice_ + 2]}; }
    Vec2 ray(const double* u) const { return {u[choice_ + 3], u[choice_ + 4]}; }

    struct Block {
        double lobe;
        Vec2 direction;
    };
    // The block of vertex i of its subpath, i >= 1.
    Block eye_block(const double* u, int i) const { return block(u + lens_ + 2 + (i - 1) * block_); }
    Block light_block(const double* u, int i) const { return block(u + choice_ + 5 + (i - 1) * block_); }

    // Writers, for inverses; absent coordinates are left out.
    void set_lens(double* u, const Vec2& v) const {
        if (lens_) set(u, v);
    }
    void set_raster(double* u, const Vec2& v) const { set(u + lens_, v); }
    void set_emitter(double* u, double v) const {
        if (choice_) u[0] = v;
    }
    void set_point(double* u, double part, const Vec2& v) const {
        u[choice_] = part;
        set(u + choice_ + 1, v);
    }
    void set_ray(double* u, const Vec2& v) const { set(u + choice_ + 3, v); }
    double* eye_block_at(double* u, int i) const { return u + lens_ + 2 + (i - 1) * block_; }
    double* light_block_at(double* u, int i) const { return u + choice_ + 5 + (i - 1) * block_; }
    void set_block(double* block, const Block& v) const {
        set(block, v.direction);
        if (block_ == 3) block[2] = v.lobe;
    }

  private:
    static void set(double* u, const Vec2& v) {
        u[0] = v.x();
        u[1] = v.y();
    }
    Block block(const double* u) const { return {block_ == 3 ? u[2] : 0.0, {u[0], u[1]}}; }

    int lens_, choice_, block_, max_length_;
};

}  // namespace keyhole
