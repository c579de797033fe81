// The few largest of many samples.
#pragma once

#include <array>
#include <cstddef>

namespace keyhole {

// In descending order; zeros where there were fewer. The same whatever the order of the samples.
template <std::size_t N>
class Largest {
  public:
    void add(double x) {
        if (!(x > values_[N - 1])) return;
        std::size_t i = N - 1;
        for (; i > 0 && values_[i - 1] < x; --i) values_[i] = values_[i - 1];
        values_[i] = x;
    }
    Largest& operator+=(const Largest& other) {
        for (const double x : other.values_) add(x);
        return *this;
    }
    const std::array<double, N>& values() const { return values_; }

  private:
    std::array<double, N> values_{};
};

}  // namespace keyhole
