// What the emitters at one point of space share: their endpoint is certain, and no ray can hit them.
#pragma once

#include "scene/emitter.h"

namespace keyhole {

class DeltaPositionEmitter : public Emitter {
  public:
    explicit DeltaPositionEmitter(const Vec3& position) : position_(position) { traits_.delta = true; }

    EmitterPoint sample_point(double, const Vec2&) const final { return {position_, Vec3::Zero(), {0, 0}, 1}; }
    std::optional<EmitterNumbers> invert_point(const EmitterPoint&, const InverseNumbers& v) const final {
        return EmitterNumbers{v.place, v.direction};
    }
    double pdf_point(const EmitterPoint&) const final { return 0; }
    Spectrum radiance(const EmitterPoint&, const Vec3&) const final { return Spectrum::Zero(); }

  private:
    Vec3 position_;
};

}  // namespace keyhole
