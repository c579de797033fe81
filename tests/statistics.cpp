#include "statistics.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/gamma.hpp>

namespace keyhole {

double chi_square_tail(double statistic, double degrees_of_freedom) {
    return statistic > 0 ? boost::math::gamma_q(degrees_of_freedom / 2, statistic / 2) : 1;
}

double student_two_sided_tail(double t, double degrees_of_freedom) {
    return 2 * boost::math::cdf(boost::math::students_t(degrees_of_freedom), -std::abs(t));
}

double normal_two_sided_quantile(double level) {
    return -boost::math::quantile(boost::math::normal(), level / 2);
}

double chi_square_p_value(const std::vector<double>& expected, const std::vector<double>& observed) {
    double statistic = 0, pool_expected = 0, pool_observed = 0;
    int cells = 0;
    const auto add = [&](double e, double o) {
        statistic += (o - e) * (o - e) / e;
        ++cells;
    };
    for (std::size_t i = 0; i < expected.size(); ++i) {
        if (expected[i] >= 5) {
            add(expected[i], observed[i]);
        } else {
            pool_expected += expected[i];
            pool_observed += observed[i];
        }
    }
    if (pool_expected == 0 && pool_observed > 0) return 0;
    if (pool_expected >= 5) add(pool_expected, pool_observed);
    const bool small_pool = pool_expected > 0 && pool_expected < 5;
    // P(at least `pool_observed` events) of the Poisson distribution.
    const double pool_p = small_pool && pool_observed > 0 ? boost::math::gamma_p(pool_observed, pool_expected) : 1;
    if (cells < 2) return pool_p;
    const double p = chi_square_tail(statistic, cells - 1);
    return small_pool ? std::min(1.0, 2 * std::min(p, pool_p)) : p;
}

}  // namespace keyhole
