// When a render ends and what it says meanwhile: budgets, passes, progress, previews, stopping.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>

#include "render/render.h"

namespace keyhole {

class RunControl {
  public:
    // `budget`: units (samples per pixel, mutations per chain) to make; 0: until settings.seconds have passed since the
    // construction of this object.
    RunControl(const RenderSettings& settings, const RenderCallbacks& callbacks, std::uint64_t budget);

    // How many units the next pass makes, about half a second's worth; 0: finished or stopped. At least one pass is
    // made.
    std::uint64_t next_pass();

    // After a pass: reports progress and, when due, a preview. `work_per_unit`: samples or mutations in a unit.
    void finished(std::uint64_t units, double work_per_unit, double acceptance, const std::function<Image()>& develop);

    void announce(const char* phase, double fraction) const;

    std::uint64_t done() const { return done_; }
    bool stopped() const { return stopped_; }
    double elapsed() const;
    double loop_seconds() const { return elapsed() - loop_start_; }

  private:
    const RenderSettings& settings_;
    const RenderCallbacks& callbacks_;
    std::chrono::steady_clock::time_point start_;
    double loop_start_ = -1, pass_start_ = 0, last_preview_ = 0, seconds_per_unit_ = 0;
    std::uint64_t budget_, done_ = 0;
    bool stopped_ = false;
};

}  // namespace keyhole
