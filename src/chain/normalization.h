// The normalisation b of a chain's target, by bridge sampling [Meng and Wong 1996, Simulating ratios of normalizing
// constants via a simple identity].
#pragma once

#include <span>

#include "chain/running_mean.h"

namespace keyhole {

// a(x) = c / (c + w(x)) for some c > 0, where w = C / p is the weight that x would have as an independent sample.
struct BridgeFunction {
    double scale = 1;  // c
    double operator()(double w) const { return scale / (scale + w); }
};

// Independent samples of weight w, 0 for those that failed, have the mean b. Where few of them carry much of the light,
// that mean is rough. The density of a chain's states is C / b, so for any function a of the state as well
//     b = E_p[w a] / E_chain[a].
// With BridgeFunction no sample counts as more than c: what the heavy ones carry is told by the share of its states
// that the chain has there. Consistent, whatever c is; not unbiased.
struct Normalization {
    RunningMean weights;  // w of the samples
    RunningMean bridged;  // w a
    RunningMean visited;  // a of the chain's states

    void add_sample(double w, const BridgeFunction& a) {
        weights.add(w);
        bridged.add(w * a(w));
    }
    void add_state(double w, const BridgeFunction& a) { visited.add(a(w)); }
    void merge(const Normalization& other) {
        weights.merge(other.weights);
        bridged.merge(other.bridged);
        visited.merge(other.visited);
    }

    // By the samples alone as long as there are no states.
    double b() const { return visited.count() ? bridged.mean() / visited.mean() : weights.mean(); }
};

// How many samples of equal weight would know the sum of several b as well: (sum of b)^2 / sum of E[w^2] / n.
inline double effective_samples(std::span<const RunningMean> weights) {
    double sum = 0, squares = 0;
    for (const RunningMean& w : weights) {
        const double n = static_cast<double>(w.count()), mean = w.mean();
        sum += mean;
        squares += (w.variance() * (n - 1) / n + mean * mean) / n;
    }
    return sum * sum / squares;
}

// The function by which no sample counts as more than about `most` times the mean of all. It is near 1 for all where
// none comes near that: then b is the mean of the samples, and the chain's noise does not enter.
inline BridgeFunction bridge_for(std::span<const double> weights, double most) {
    RunningMean plain, bounded;
    for (const double w : weights) plain.add(w);
    BridgeFunction a{most * plain.mean()};
    // Once more without what single samples have added: any of them can be larger than all the others.
    for (const double w : weights) bounded.add(w * a(w));
    a.scale = most * bounded.mean();
    return a;
}

}  // namespace keyhole
