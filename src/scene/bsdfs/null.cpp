#include "scene/bsdfs.h"
#include "scene/bsdfs/delta.h"

namespace keyhole {
namespace {

// A surface that is not there: light goes straight on.
class Null final : public DeltaBsdf {
  public:
    Null() { traits_.transmissive = true; }

    std::optional<BsdfSample> sample(const SurfacePoint&, const Vec3& w_known, double, const Vec2&,
                                     Mode) const override {
        return delta_sample(-w_known, Spectrum::Ones(), 1);
    }

    std::optional<BsdfNumbers> invert(const SurfacePoint&, const Vec3&, const Vec3&, const BsdfEvent& event,
                                      const InverseNumbers& v, Mode) const override {
        if (!event.delta) return std::nullopt;
        return BsdfNumbers{v.place, v.direction};
    }

    const char* name() const override { return "null"; }
};

}  // namespace

BsdfPtr make_null() { return std::make_shared<Null>(); }

}  // namespace keyhole
