// The chains of a run and all that they leave behind.
#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <memory>

#include "render/block_record.h"
#include "render/error_statistics.h"
#include "render/exchanges.h"

namespace keyhole {

class ChainRun {
  public:
    // `settings` are resolved, and must outlive it as all else.
    ChainRun(const Scene& scene, const RenderSettings& settings, const CoordinateLayout& layout,
             const TechniqueDistribution& techniques, Bootstrap bootstrap, const Recording& recording = {});

    // Makes at most that many mutations of each chain, and returns how many.
    std::uint64_t advance(std::uint64_t most);

    Diagnostics diagnostics() const;
    std::uint64_t rays() const;
    Image develop() const;
    // Standard errors of the values of develop(). Only where there are films of replicates.
    Image develop_errors() const;
    ReplicateRecord record() const;
    void report(const std::vector<const MixStrategy*>& strategies, RenderStatistics& statistics) const;

  private:
    // By group and replicate.
    template <class T>
    using Cells = std::vector<std::vector<T>>;

    std::size_t replicates() const { return groups_[0].b.size(); }
    template <class T>
    Cells<T> cells(const T& value = T()) const {
        return Cells<T>(groups_.size(), std::vector<T>(replicates(), value));
    }
    static constexpr std::size_t every = ~std::size_t{0};

    template <class Sink>
    void splat_held(Sink& sink, std::size_t group, std::size_t replicate = every) const;
    Cells<Normalization> estimate_b() const;
    Cells<double> mutations() const;
    double chains_of(std::size_t group) const;
    double mutations(std::size_t group) const { return chains_of(group) * static_cast<double>(done_); }
    void report_b(RenderStatistics& statistics) const;

    const Scene& scene_;
    std::vector<ChainGroup> groups_;
    std::vector<RunningChain> chains_;
    Cells<double> chain_counts_;
    BlockGrid grid_;
    BlockRecord blocks_;
    ReplicateFilms replicate_films_;
    tbb::enumerable_thread_specific<std::unique_ptr<ChainWorker>> workers_;
    std::optional<Exchanges> exchanges_;
    std::uint64_t done_ = 0;  // mutations of each chain
};

}  // namespace keyhole
