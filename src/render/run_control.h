// When a render ends and what it says meanwhile: budgets, passes, progress, previews, checkpoints, stopping.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>

#include "render/render.h"

namespace keyhole {

class RunControl {
  public:
    // `budget`: units (samples per pixel, mutations per chain) to make; 0: until the time of the settings has passed
    // since the construction of this object. `work_per_unit`: samples or mutations in a unit.
    RunControl(const RenderSettings& settings, const RenderCallbacks& callbacks, std::uint64_t budget,
               std::uint64_t work_per_unit);

    // How many units the next pass makes, about half a second's worth; 0: finished or stopped. At least one pass is
    // made.
    std::uint64_t next_pass();

    // After a pass: reports progress and, when due, a preview or a checkpoint.
    void finished(std::uint64_t units, double acceptance, const std::function<Image()>& develop);

    void announce(const char* phase, double fraction) const;

    // Sets what it knows of a run that is over.
    void report(RenderStatistics& statistics) const;

    std::uint64_t done() const { return done_; }
    // Since the construction, without the time that checkpoints took.
    double elapsed() const;
    double elapsed_cpu() const;

  private:
    double loop_seconds() const { return elapsed() - loop_start_; }
    std::uint64_t mutations() const { return done_ * work_per_unit_; }
    // The budget, and how much of it is used: in units or in seconds.
    bool counts_units() const { return budget_units_ > 0; }
    double budget() const;
    double used() const;

    double next_checkpoint() const;
    void report_progress(double acceptance) const;
    void make_checkpoint(const std::function<Image()>& develop);

    const RenderSettings& settings_;
    const RenderCallbacks& callbacks_;
    const std::chrono::steady_clock::time_point start_;
    const double cpu_start_;
    const std::uint64_t budget_units_;
    const std::uint64_t work_per_unit_;
    double paused_ = 0, paused_cpu_ = 0;
    double loop_start_ = -1, last_preview_ = 0;
    double pass_start_ = 0, pass_start_used_ = 0;  // the first in wall-clock time, the second as used() counts
    double seconds_per_unit_ = 0, used_per_unit_ = 0;
    std::uint64_t done_ = 0;
    std::size_t checkpoints_done_ = 0;  // of the callbacks' shares
    bool stopped_ = false;
};

}  // namespace keyhole
