#include "scene/embree.h"

#include <cmath>
#include <stdexcept>

#include "base/parallel.h"
#include "scene/shapes/analytic_shape.h"
#include "scene/shapes/mesh_shape.h"

namespace keyhole {
namespace {

// Embree's boxes are tested in float: grow them by more than its rounding errors.
void analytic_bounds(const RTCBoundsFunctionArguments* args) {
    const auto& shape = *static_cast<const AnalyticShape*>(args->geometryUserPtr);
    const auto [lower, upper] = shape.bounds();
    const double margin = 1e-6 * std::max(lower.lpNorm<Eigen::Infinity>(), upper.lpNorm<Eigen::Infinity>());
    const Vec3f l = (lower.array() - margin).cast<float>(), u = (upper.array() + margin).cast<float>();
    *args->bounds_o = {l.x(), l.y(), l.z(), 0, u.x(), u.y(), u.z(), 0};
}

// The nearest hit in (tnear, tfar), or tfar if there is none.
double query_analytic(const AnalyticShape& shape, const EmbreeScene::Context& context, float tfar) {
    const Ray& ray = context.ray;
    Vec3 o = ray.o + ray.offset, d = ray.d;
    if (context.instID[0] != RTC_INVALID_GEOMETRY_ID) {
        const InstanceTransform& transform = context.scene.instance(context.instID[0]).transform;
        o = transform.to_local * o;
        d = transform.to_local.linear() * d;
    }
    return shape.nearest(o, d, ray.tnear, std::min<double>(ray.tfar, tfar));
}

void intersect_analytic(const RTCIntersectFunctionNArguments* args) {
    if (args->valid[0] == 0) return;
    const auto& context = *static_cast<const EmbreeScene::Context*>(args->context);
    auto& r = *reinterpret_cast<RTCRayHit*>(args->rayhit);  // single rays only, so N is 1
    const double t = query_analytic(*static_cast<const AnalyticShape*>(args->geometryUserPtr), context, r.ray.tfar);
    if (!(t < r.ray.tfar && t < context.ray.tfar)) return;
    r.ray.tfar = static_cast<float>(t);
    r.hit.geomID = args->geomID;
    r.hit.primID = args->primID;
    r.hit.instID[0] = context.instID[0];
}

void occluded_analytic(const RTCOccludedFunctionNArguments* args) {
    if (args->valid[0] == 0) return;
    const auto& context = *static_cast<const EmbreeScene::Context*>(args->context);
    auto& r = *reinterpret_cast<RTCRay*>(args->ray);
    const double t = query_analytic(*static_cast<const AnalyticShape*>(args->geometryUserPtr), context, r.tfar);
    if (t < r.tfar && t < context.ray.tfar) r.tfar = -std::numeric_limits<float>::infinity();
}

bool count_bytes(void* total, ssize_t bytes, bool /*post*/) {
    static_cast<std::atomic<std::int64_t>*>(total)->fetch_add(bytes, std::memory_order_relaxed);
    return true;
}

void store_error(void* text, RTCError /*code*/, const char* message) {
    auto& error = *static_cast<std::string*>(text);
    if (error.empty()) error = message;
}

}  // namespace

EmbreeGroup::EmbreeGroup(RTCDevice device, bool robust) : device_(device), scene_(rtcNewScene(device)) {
    if (robust) rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
}

unsigned EmbreeGroup::attach(RTCGeometry geometry, const Shape* shape) {
    rtcCommitGeometry(geometry);
    const unsigned id = rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    if (shapes_.size() <= id) shapes_.resize(id + 1, nullptr);
    shapes_[id] = shape;
    return id;
}

void EmbreeGroup::add(const MeshShape& shape) {
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, shape.positions().data(), 0,
                               sizeof(Vec3f), shape.positions().size());
    const auto& triangles = shape.triangles();
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, triangles.data(), 0,
                               sizeof(triangles[0]), triangles.size());
    attach(geometry, &shape);
}

void EmbreeGroup::add(const AnalyticShape& shape) {
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, 1);
    rtcSetGeometryUserData(geometry, const_cast<AnalyticShape*>(&shape));  // Embree only hands it back
    rtcSetGeometryBoundsFunction(geometry, analytic_bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersect_analytic);
    rtcSetGeometryOccludedFunction(geometry, occluded_analytic);
    attach(geometry, &shape);
}

EmbreeScene::EmbreeScene(bool robust) : device_(rtcNewDevice(nullptr)), robust_(robust) {
    if (!device_) throw std::runtime_error("Embree cannot create a device on this machine");
    rtcSetDeviceErrorFunction(device_, store_error, &error_);
    rtcSetDeviceMemoryMonitorFunction(device_, count_bytes, &bytes_);
    top_ = std::make_unique<EmbreeGroup>(device_, robust);
}

EmbreeScene::~EmbreeScene() {
    top_.reset();
    groups_.clear();
    rtcReleaseDevice(device_);
}

EmbreeGroup& EmbreeScene::new_group() {
    groups_.push_back(std::make_unique<EmbreeGroup>(device_, robust_));
    return *groups_.back();
}

void EmbreeScene::add_instance(const EmbreeGroup& group, const Shape* shape, const Affine& to_world) {
    auto instance = std::make_unique<EmbreeInstance>(EmbreeInstance{&group, shape, InstanceTransform(to_world)});
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, group.handle());
    rtcSetGeometryTimeStepCount(geometry, 1);
    const Eigen::Matrix<float, 3, 4> matrix = instance->transform.to_world.matrix().cast<float>();  // column major
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, matrix.data());
    const unsigned id = top_->attach(geometry, nullptr);
    if (instances_.size() <= id) instances_.resize(id + 1);
    instances_[id] = std::move(instance);
}

void EmbreeScene::commit() {
    parallel_for(groups_.size(), [&](std::size_t i) { groups_[i]->commit(); });
    top_->commit();
    if (!error_.empty()) throw std::runtime_error("Embree: " + error_);
}

EmbreeBounds EmbreeScene::bounds() const {
    RTCBounds b;
    rtcGetSceneBounds(top_->handle(), &b);
    return {{b.lower_x, b.lower_y, b.lower_z}, {b.upper_x, b.upper_y, b.upper_z}};
}

}  // namespace keyhole
