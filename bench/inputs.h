// Inputs drawn before the clock starts, and repeated.
#pragma once

#include <array>

#include "base/rng.h"
#include "base/vec.h"

namespace keyhole {

// Reads a table of `make(rng)` over and over. Few enough values for the first cache, and more than a branch predictor
// learns by heart.
template <class T>
class Inputs {
  public:
    template <class Make>
    explicit Inputs(const Make& make) {
        Rng rng(1);
        for (T& value : values_) value = make(rng);
    }
    const T& next() { return values_[i_++ % values_.size()]; }

  private:
    std::array<T, 512> values_;
    std::size_t i_ = 0;
};

inline Vec2 uniform2(Rng& rng) {
    const double x = rng.uniform();
    return {x, rng.uniform()};
}

}  // namespace keyhole
