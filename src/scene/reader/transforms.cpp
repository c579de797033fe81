#include "scene/reader/transforms.h"

#include <cmath>

#include "scene/reader/values.h"

namespace keyhole {
namespace {

using Matrix4 = Eigen::Matrix4d;

// Coordinates stay far inside the range of float, in which rays are traced.
constexpr double largest = 1e15;

Vec3 vec3_attribute(const Element& element, const std::string& name) {
    const auto v = parse_numbers(element.required_attribute(name), element.where, "<" + element.tag + "> " + name);
    if (v.size() != 3)
        throw InputError(element.where,
                         "<" + element.tag + "> " + name + " has " + std::to_string(v.size()) + " numbers; it needs 3");
    return {v[0], v[1], v[2]};
}

Affine rotation(const Element& element) {
    const Vec3 axis = parse_xyz(element);
    if (!(axis.norm() > 0)) throw InputError(element.where, "<rotate> about a zero axis; give x, y, z or value");
    const double angle = parse_number(*element.attribute("angle"), element.where, "<rotate> angle");
    return Affine(Eigen::AngleAxisd(angle * (pi / 180), axis.normalized()));
}

// The frame of a camera at `origin`: +z towards the target, +y up, +x to the left.
Affine look_at(const Element& element) {
    const Vec3 origin = vec3_attribute(element, "origin"), target = vec3_attribute(element, "target");
    const Vec3 forward = target - origin;
    if (!(forward.norm() > 0)) throw InputError(element.where, "<lookat> origin and target are the same point");
    const Vec3 z = forward.normalized();
    const Vec3 left = vec3_attribute(element, "up").cross(z);
    if (!(left.norm() > 1e-9))
        throw InputError(element.where, "<lookat> up is zero or parallel to the direction of view");
    Affine t;
    t.linear().col(0) = left.normalized();
    t.linear().col(1) = z.cross(left.normalized());
    t.linear().col(2) = z;
    t.translation() = origin;
    return t;
}

std::vector<double> matrix_values(const Element& element) {
    auto v = parse_numbers(*element.attribute("value"), element.where, "<matrix>");
    if (v.size() != 9 && v.size() != 16)
        throw InputError(element.where, "<matrix> has " + std::to_string(v.size()) + " numbers; it needs 9 or 16");
    return v;
}

// Row-major; nine numbers are the linear part.
Affine matrix(const Element& element) {
    const auto v = matrix_values(element);
    Affine t = Affine::Identity();
    if (v.size() == 9) {
        t.linear() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(v.data());
        return t;
    }
    if (v[12] != 0 || v[13] != 0 || v[14] != 0 || v[15] != 1)
        throw InputError(element.where, "<matrix> is not affine: its last row must be 0 0 0 1");
    t.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(v.data()).topRows<3>();
    return t;
}

Affine operation(const Element& element) {
    if (element.tag == "matrix") return matrix(element);
    if (element.tag == "rotate") return rotation(element);
    if (element.tag == "lookat") return look_at(element);
    if (element.tag == "translate") return Affine(Eigen::Translation3d(parse_xyz(element)));
    const std::string* value = element.attribute("value");  // scale
    if (value && parse_numbers(*value, element.where, "<scale> value").size() == 1)
        return Affine(Eigen::Scaling(parse_number(*value, element.where, "<scale> value")));
    return Affine(Eigen::Scaling(parse_xyz(element, 1)));
}

// Whether the columns are as good as dependent, whatever their lengths are.
template <class Matrix>
bool singular(const Matrix& m) {
    double lengths = 1;
    for (Eigen::Index i = 0; i < m.cols(); ++i) lengths *= m.col(i).norm();
    return !(std::abs(m.determinant()) > 1e-9 * lengths);
}

Eigen::Matrix3d uv_operation(const Element& element) {
    if (element.tag == "matrix") {
        const auto v = matrix_values(element);
        if (v.size() == 9) {
            if (v[6] != 0 || v[7] != 0 || v[8] != 1)
                throw InputError(element.where, "<matrix> is not affine: its last row must be 0 0 1");
            return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(v.data());
        }
    }
    const Affine t = operation(element);
    if (t(0, 2) != 0 || t(1, 2) != 0)
        throw InputError(element.where, "<" + element.tag + "> mixes a third coordinate into a texture's u and v");
    Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
    m << t(0, 0), t(0, 1), t(0, 3), t(1, 0), t(1, 1), t(1, 3), 0, 0, 1;
    return m;
}

template <class Matrix>
void check(const Element& transform, const Matrix& linear, double largest_entry) {
    const std::string name = "transform '" + *transform.attribute("name") + "'";
    if (!(largest_entry < largest))
        throw InputError(transform.where, name + " has an entry larger than " + number_text(largest));
    if (singular(linear)) throw InputError(transform.where, name + " is singular: it flattens space");
}

}  // namespace

Vec3 parse_xyz(const Element& element, double missing) {
    const std::string what = "<" + element.tag + ">";
    if (element.attribute("value")) {
        if (element.attribute("x") || element.attribute("y") || element.attribute("z"))
            throw InputError(element.where, what + " has both value and x, y, z");
        return vec3_attribute(element, "value");
    }
    Vec3 v(missing, missing, missing);
    const char* names[] = {"x", "y", "z"};
    bool any = false;
    for (int i = 0; i < 3; ++i) {
        const std::string* text = element.attribute(names[i]);
        if (!text) continue;
        v[i] = parse_number(*text, element.where, what + " " + names[i]);
        any = true;
    }
    if (!any) throw InputError(element.where, what + " has neither x, y, z nor value");
    return v;
}

Affine parse_transform(const Element& transform) {
    Affine result = Affine::Identity();
    for (const Element& child : transform.children) result = operation(child) * result;
    check(transform, result.linear(), result.matrix().cwiseAbs().maxCoeff());
    return result;
}

Eigen::Matrix3d parse_uv_transform(const Element& transform) {
    Eigen::Matrix3d result = Eigen::Matrix3d::Identity();
    for (const Element& child : transform.children) result = uv_operation(child) * result;
    check(transform, Eigen::Matrix2d(result.topLeftCorner<2, 2>()), result.cwiseAbs().maxCoeff());
    return result;
}

}  // namespace keyhole
