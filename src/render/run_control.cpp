#include "render/run_control.h"

#include <algorithm>
#include <cmath>

namespace keyhole {
namespace {
constexpr double pass_seconds = 0.5;
}

RunControl::RunControl(const RenderSettings& settings, const RenderCallbacks& callbacks, std::uint64_t budget)
    : settings_(settings), callbacks_(callbacks), start_(std::chrono::steady_clock::now()), budget_(budget) {}

double RunControl::elapsed() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

std::uint64_t RunControl::next_pass() {
    pass_start_ = elapsed();
    if (loop_start_ < 0) loop_start_ = last_preview_ = pass_start_;
    if (callbacks_.stop && callbacks_.stop()) stopped_ = true;
    if (done_ > 0 && stopped_) return 0;
    // The first pass is short, to learn the speed; later ones never more than double.
    double units = done_ == 0 ? 1 : std::min(pass_seconds / seconds_per_unit_, static_cast<double>(done_));
    if (budget_ > 0) {
        units = std::min(units, static_cast<double>(budget_ - done_));
        return static_cast<std::uint64_t>(std::max(budget_ > done_ ? 1.0 : 0.0, std::floor(units)));
    }
    const double left = settings_.seconds - pass_start_;
    if (done_ > 0) {
        if (left <= 0.5 * seconds_per_unit_) return 0;
        units = std::min(units, left / seconds_per_unit_);
    }
    return static_cast<std::uint64_t>(std::max(1.0, std::floor(units)));
}

void RunControl::finished(std::uint64_t units, double work_per_unit, double acceptance,
                          const std::function<Image()>& develop) {
    done_ += units;
    const double now = elapsed();
    seconds_per_unit_ = std::max(1e-9, (now - pass_start_) / static_cast<double>(units));
    if (callbacks_.progress) {
        Progress p;
        p.phase = "render";
        p.elapsed = now;
        p.rate = static_cast<double>(done_) * work_per_unit / std::max(1e-9, now - loop_start_);
        p.acceptance = acceptance;
        if (budget_ > 0) {
            p.fraction = static_cast<double>(done_) / static_cast<double>(budget_);
            p.remaining = (now - loop_start_) * (1 - p.fraction) / p.fraction;
        } else {
            p.fraction = std::min(1.0, now / settings_.seconds);
            p.remaining = std::max(0.0, settings_.seconds - now);
        }
        callbacks_.progress(p);
    }
    if (callbacks_.preview && settings_.preview_every > 0 && now - last_preview_ >= settings_.preview_every) {
        last_preview_ = now;
        callbacks_.preview(develop());
    }
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
