#include "render/run_control.h"

#include <algorithm>
#include <cmath>

#include "base/process.h"

namespace keyhole {
namespace {

constexpr double pass_seconds = 0.5;

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

RunControl::RunControl(const RenderSettings& settings, const RenderCallbacks& callbacks, std::uint64_t budget,
                       std::uint64_t work_per_unit)
    : settings_(settings),
      callbacks_(callbacks),
      start_(std::chrono::steady_clock::now()),
      cpu_start_(cpu_seconds()),
      budget_units_(budget),
      work_per_unit_(work_per_unit) {}

double RunControl::elapsed() const { return seconds_since(start_) - paused_; }

double RunControl::elapsed_cpu() const { return cpu_seconds() - cpu_start_ - paused_cpu_; }

double RunControl::budget() const {
    if (counts_units()) return static_cast<double>(budget_units_);
    return settings_.cpu_seconds > 0 ? settings_.cpu_seconds : settings_.seconds;
}

double RunControl::used() const {
    if (counts_units()) return static_cast<double>(done_);
    return settings_.cpu_seconds > 0 ? elapsed_cpu() : elapsed();
}

// As used() counts; the whole budget where none is left to make.
double RunControl::next_checkpoint() const {
    const std::vector<double>& shares = callbacks_.checkpoint_shares;
    if (!callbacks_.checkpoint || checkpoints_done_ >= shares.size()) return budget();
    const double at = shares[checkpoints_done_] * budget();
    return counts_units() ? std::ceil(at) : at;
}

std::uint64_t RunControl::next_pass() {
    pass_start_ = elapsed();
    pass_start_used_ = used();
    if (loop_start_ < 0) loop_start_ = last_preview_ = pass_start_;
    if (callbacks_.stop && callbacks_.stop()) stopped_ = true;
    if (done_ == 0) return 1;  // the first pass is short, to learn the speed; later ones never more than double
    if (stopped_) return 0;
    const double left = budget() - pass_start_used_;
    if (counts_units() ? left <= 0 : left <= 0.5 * used_per_unit_) return 0;
    const double to_checkpoint = next_checkpoint() - pass_start_used_;
    const double units = std::min({pass_seconds / seconds_per_unit_, static_cast<double>(done_),
                                   (to_checkpoint > 0 ? to_checkpoint : left) / used_per_unit_});
    return static_cast<std::uint64_t>(std::max(1.0, std::floor(units)));
}

void RunControl::finished(std::uint64_t units, double acceptance, const std::function<Image()>& develop) {
    done_ += units;
    seconds_per_unit_ = std::max(1e-9, (elapsed() - pass_start_) / static_cast<double>(units));
    used_per_unit_ = std::max(1e-9, (used() - pass_start_used_) / static_cast<double>(units));
    if (callbacks_.progress) report_progress(acceptance);
    if (callbacks_.preview && settings_.preview_every > 0 && elapsed() - last_preview_ >= settings_.preview_every) {
        last_preview_ = elapsed();
        callbacks_.preview(develop());
    }
    if (used() < budget() && used() >= next_checkpoint()) make_checkpoint(develop);
}

void RunControl::report_progress(double acceptance) const {
    Progress p;
    p.phase = "render";
    p.elapsed = elapsed();
    p.rate = static_cast<double>(mutations()) / std::max(1e-9, loop_seconds());
    p.acceptance = acceptance;
    p.fraction = std::min(1.0, used() / budget());
    if (counts_units())
        p.remaining = loop_seconds() * (1 - p.fraction) / p.fraction;
    else
        p.remaining = p.elapsed * (1 - p.fraction) / p.fraction;
    callbacks_.progress(p);
}

void RunControl::make_checkpoint(const std::function<Image()>& develop) {
    const double pause_start = elapsed(), pause_start_cpu = elapsed_cpu();
    do ++checkpoints_done_;
    while (checkpoints_done_ < callbacks_.checkpoint_shares.size() && used() >= next_checkpoint());
    callbacks_.checkpoint(
        {callbacks_.checkpoint_shares[checkpoints_done_ - 1], pause_start, pause_start_cpu, mutations(), develop()});
    paused_ += elapsed() - pause_start;
    paused_cpu_ += elapsed_cpu() - pause_start_cpu;
}

void RunControl::report(RenderStatistics& statistics) const {
    statistics.rounds = done_;
    statistics.mutations = mutations();
    statistics.seconds_render = loop_seconds();
    statistics.cpu_seconds = elapsed_cpu();
    statistics.interrupted = stopped_;
}

void RunControl::announce(const char* phase, double fraction) const {
    if (!callbacks_.progress) return;
    Progress p;
    p.phase = phase;
    p.fraction = fraction;
    p.elapsed = elapsed();
    p.remaining = -1;
    callbacks_.progress(p);
}

}  // namespace keyhole
