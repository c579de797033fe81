// Vectors, constants and small numeric helpers shared by all folders.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <numbers>

namespace keyhole {

using Vec2 = Eigen::Matrix<double, 2, 1, Eigen::DontAlign>;
using Vec3 = Eigen::Vector3d;
using Vec2f = Eigen::Matrix<float, 2, 1, Eigen::DontAlign>;
using Vec3f = Eigen::Vector3f;
using Affine = Eigen::Transform<double, 3, Eigen::AffineCompact, Eigen::DontAlign>;

inline constexpr double pi = std::numbers::pi;
inline constexpr double inv_pi = std::numbers::inv_pi;

// The largest double below one: coordinates and inverses of warps stay in [0, 1).
inline constexpr double one_minus_epsilon = 0x1.fffffffffffffp-1;

inline double sqr(double x) { return x * x; }
inline double safe_sqrt(double x) { return x > 0 ? __builtin_sqrt(x) : 0; }
inline double clamp01(double x) { return x < 0 ? 0 : (x < one_minus_epsilon ? x : one_minus_epsilon); }

}  // namespace keyhole
