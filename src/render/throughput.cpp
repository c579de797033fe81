#include "render/throughput.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <stdexcept>

#include "base/process.h"
#include "render/chain_worker.h"
#include "scene/replay.h"

namespace keyhole {
namespace {

constexpr std::uint64_t mutations_per_slice = 200000;  // about a tenth of a second, and 100 MB of recorded rays

struct Stopwatch {
    std::chrono::steady_clock::time_point wall_start = std::chrono::steady_clock::now();
    double cpu_start = cpu_seconds();

    double wall() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_start).count(); }
    double cpu() const { return cpu_seconds() - cpu_start; }
};

// Chains in fixed shares, one per thread, so that a replay repeats each thread's own rays.
class Bench {
  public:
    Bench(const Scene& scene, const RenderSettings& settings, int threads)
        : scene_(scene),
          layout_(scene, settings.mix.lengths.max),
          techniques_(make_techniques(settings.mix)),
          threads_(threads),
          arena_(threads),
          recorded_(threads) {
        auto groups = run_bootstrap(scene, layout_, techniques_, settings.mix).groups;
        if (groups.empty()) throw std::runtime_error("no bootstrap path carries light");
        chains_ = start_chains(groups, settings.mix.seed);
        for (int i = 0; i < threads; ++i)
            workers_.push_back(
                std::make_unique<ChainWorker>(scene, layout_, techniques_, settings.mix, groups.size()));
        mutations_per_chain_ = std::max<std::uint64_t>(1, mutations_per_slice / chains_.size());
    }

    void slice(Throughput& result) {
        const std::vector<RunningChain> before = chains_;
        const double mutations = static_cast<double>(mutations_per_chain_ * chains_.size());
        const Stopwatch run;
        advance();
        const double run_cpu = run.cpu(), run_wall = run.wall();

        const std::vector<RunningChain> after = std::move(chains_);
        chains_ = before;
        std::size_t rays = 0;
        for (int i = 0; i < threads_; ++i) {
            recorded_[i].clear();
            workers_[i]->evaluator->tracer().record_into(&recorded_[i]);
        }
        advance();
        std::vector<std::unique_ptr<RayReplay>> replays;
        for (int i = 0; i < threads_; ++i) {
            workers_[i]->evaluator->tracer().record_into(nullptr);
            rays += recorded_[i].size();
            replays.push_back(std::make_unique<RayReplay>(scene_, recorded_[i]));
        }
        chains_ = after;

        const Stopwatch replay;
        for_each_thread([&](int i) { hits_ += replays[i]->run(0, replays[i]->size()); });
        const double replay_cpu = replay.cpu();

        result.mutations_per_cpu_second.add(mutations / run_cpu);
        result.mutations_per_second.add(mutations / run_wall);
        result.replay_ratio.add(replay_cpu / run_cpu);
        result.replayed_rays_per_cpu_second.add(static_cast<double>(rays) / replay_cpu);
        result.rays_per_mutation = static_cast<double>(rays) / mutations;
    }

    // One slice that is not measured.
    void warm_up() { advance(); }

    double mean_acceptance() const {
        Diagnostics total(workers_[0]->mixture.size());
        for (const auto& worker : workers_) total += worker->diagnostics;
        return total.total().mean_acceptance();
    }

  private:
    template <class Body>
    void for_each_thread(const Body& body) {
        arena_.execute([&] { tbb::parallel_for(0, threads_, 1, body, tbb::static_partitioner()); });
    }
    void advance() {
        for_each_thread([&](int t) {
            const std::size_t n = chains_.size(), first = n * t / threads_, last = n * (t + 1) / threads_;
            for (std::size_t i = first; i < last; ++i) workers_[t]->advance(chains_[i], mutations_per_chain_);
        });
    }

    const Scene& scene_;
    CoordinateLayout layout_;
    TechniqueDistribution techniques_;
    int threads_;
    tbb::task_arena arena_;
    std::vector<RunningChain> chains_;
    std::vector<std::unique_ptr<ChainWorker>> workers_;
    std::vector<std::vector<RecordedRay>> recorded_;
    std::uint64_t mutations_per_chain_ = 1;
    std::atomic<std::uint64_t> hits_{0};  // keeps the replay from being optimised away
};

}  // namespace

Throughput measure_throughput(const Scene& scene, const RenderSettings& settings, int threads, double seconds) {
    Bench bench(scene, resolve(scene, settings), threads);
    bench.warm_up();
    Throughput result;
    result.threads = threads;
    const Stopwatch total;
    do bench.slice(result);
    while (total.wall() < seconds);
    result.mean_acceptance = bench.mean_acceptance();
    return result;
}

}  // namespace keyhole
