#include "scene/orthogonal.h"

#include <Eigen/SVD>
#include <stdexcept>
#include <string>

namespace keyhole {

Matrix3 orthogonal_part(const Affine& transform, const char* what) {
    const Eigen::Matrix3d linear = transform.linear();
    const auto fail = [&](const std::string& why) {
        throw std::invalid_argument("to_world of the " + std::string(what) + " " + why);
    };
    if (!transform.matrix().allFinite()) fail("is not finite");
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(linear, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Eigen::Vector3d scales = svd.singularValues();  // largest first
    if (!(scales[2] > 0) || scales[2] < 1e-12 * scales[0]) fail("is singular");
    if (scales[0] - scales[2] > 1e-3 * scales[0]) fail("has a shear or a non-uniform scale");
    return svd.matrixU() * svd.matrixV().transpose();
}

}  // namespace keyhole
