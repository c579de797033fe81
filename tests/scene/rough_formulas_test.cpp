// Values and densities of the rough BSDFs against the published formulas, written out with angles as in the papers, and
// their albedos and limits.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <vector>

#include "base/error.h"
#include "base/rng.h"
#include "base/warp.h"
#include "bsdf_harness.h"
#include "scene/bsdfs/rough_transmittance.h"
#include "scene/fresnel.h"

namespace keyhole {
namespace {

const ConductorIor gold{{0.143, 0.375, 1.442}, {3.983, 2.386, 1.603}};
const Spectrum white(1, 1, 1);
constexpr std::array types = {MicrofacetType::ggx, MicrofacetType::beckmann};

double theta(const Vec3& w) { return std::acos(std::abs(w.z())); }
double phi(const Vec3& w) { return std::atan2(w.y(), w.x()); }

// [Walter et al. 2007, eq. 25 and 33], anisotropic as in [Heitz 2014, eq. 83 and 85].
double d(MicrofacetType type, double ax, double ay, const Vec3& m) {
    const double t = std::tan(theta(m)), c4 = std::pow(std::cos(theta(m)), 4);
    const double slope2 = t * t * (sqr(std::cos(phi(m)) / ax) + sqr(std::sin(phi(m)) / ay));
    const double shape = type == MicrofacetType::ggx ? 1 / sqr(1 + slope2) : std::exp(-slope2);
    return shape / (pi * ax * ay * c4);
}

// [Walter et al. 2007, eq. 34; 26 with the exact Lambda]
double g1(MicrofacetType type, double ax, double ay, const Vec3& w, const Vec3& m) {
    if (w.dot(m) * w.z() <= 0) return 0;
    const double alpha = std::hypot(ax * std::cos(phi(w)), ay * std::sin(phi(w)));
    const double a = 1 / (alpha * std::tan(theta(w)));
    if (type == MicrofacetType::ggx) return 2 / (1 + std::sqrt(1 + 1 / (a * a)));
    return 2 / (1 + std::erf(a) + std::exp(-a * a) / (a * std::sqrt(pi)));
}

// [Walter et al. 2007, eq. 22]
double fresnel(double c, double eta) {
    const double g2 = eta * eta - 1 + c * c;
    if (g2 < 0) return 1;
    const double g = std::sqrt(g2);
    return 0.5 * sqr((g - c) / (g + c)) * (1 + sqr((c * (g + c) - 1) / (c * (g - c) + 1)));
}

double fresnel_metal(double c, double eta, double k) {
    const std::complex<double> n(eta, k), ct = std::sqrt(1.0 - (1 - c * c) / (n * n));
    return 0.5 * (std::norm((c - n * ct) / (c + n * ct)) + std::norm((n * c - ct) / (n * c + ct)));
}

Vec3 random_direction(Rng& rng) {
    const double first = rng.uniform();
    return square_to_sphere({first, rng.uniform()});
}

// 1e-9: acos and tan of angles near the normal lose half the digits there.
void expect_close(double a, double b) { EXPECT_NEAR(a, b, 1e-9 * std::abs(b) + 1e-200); }

TEST(RoughConductor, IsTheFormulaOfWalter) {
    Rng rng(1);
    for (const MicrofacetType type : types)
        for (const auto& [ax, ay] : {std::pair(0.1, 0.1), {0.02, 0.02}, {1.0, 1.0}, {0.2, 0.7}}) {
            const BsdfPtr bsdf = make_rough_conductor(type, ax, ay, gold, Spectrum(0.9, 0.8, 0.7));
            for (int i = 0; i < 500; ++i) {
                Vec3 e = random_direction(rng), l = random_direction(rng);
                e.z() = std::abs(e.z());
                l.z() = std::abs(l.z());
                const Vec3 m = (e + l).normalized();
                const double density = d(type, ax, ay, m), ge = g1(type, ax, ay, e, m), gl = g1(type, ax, ay, l, m);
                const BsdfValue v = bsdf->eval(flat_point(), e, l);
                for (int c = 0; c < 3; ++c) {
                    const double f = fresnel_metal(e.dot(m), gold.eta[c], gold.k[c]) * (0.9 - 0.1 * c);
                    expect_close(v.f[c], f * density * ge * gl / (4 * e.z() * l.z()));
                }
                expect_close(v.pdf_light, density * ge / (4 * e.z()));
                expect_close(v.pdf_eye, density * gl / (4 * l.z()));
                EXPECT_TRUE(is_black(bsdf->eval(flat_point(), Vec3(-e), l).f));
                EXPECT_TRUE(is_black(bsdf->eval(flat_point(), Vec3(-e), Vec3(-l)).f));
            }
        }
}

// Incident i = w_light, outgoing o = w_eye, as light travels [eq. 16-21]; densities with the probabilities F and 1 - F.
TEST(RoughDielectric, IsTheFormulaOfWalter) {
    Rng rng(2);
    for (const MicrofacetType type : types)
        for (const double eta : {1.5, 1.1, 0.6})
            for (const auto& [ax, ay] : {std::pair(0.3, 0.3), {1.0, 1.0}, {0.2, 0.7}}) {
                const BsdfPtr bsdf = make_rough_dielectric(type, ax, ay, eta, Spectrum(0.5, 0.5, 0.5), white);
                for (int n = 0; n < 1000; ++n) {
                    const Vec3 o = random_direction(rng), i = random_direction(rng);
                    const BsdfValue v = bsdf->eval(flat_point(), o, i);
                    const double n_i = i.z() > 0 ? 1 : eta, n_o = o.z() > 0 ? 1 : eta;
                    const bool reflects = i.z() * o.z() > 0;
                    Vec3 m = reflects ? Vec3(i + o) : Vec3(-(n_i * i + n_o * o));
                    m = (m.z() < 0 ? Vec3(-m) : m).normalized();
                    const double go = g1(type, ax, ay, o, m), gi = g1(type, ax, ay, i, m), im = i.dot(m), om = o.dot(m);
                    const double density = d(type, ax, ay, m), f = fresnel(std::abs(im), i.z() > 0 ? eta : 1 / eta);
                    double value, jacobian_o, jacobian_i;
                    if (reflects) {
                        jacobian_o = jacobian_i = 1 / (4 * std::abs(im));
                        value = 0.5 * f * gi * go * density / (4 * std::abs(i.z() * o.z()));
                    } else {
                        const double square = sqr(n_i * im + n_o * om);
                        jacobian_o = n_o * n_o * std::abs(om) / square;
                        jacobian_i = n_i * n_i * std::abs(im) / square;
                        value = std::abs(im * om / (i.z() * o.z())) * n_o * n_o * (1 - f) * gi * go * density / square;
                    }
                    const double chance = reflects ? f : 1 - f;
                    // Cancellation in 1 - F of the published form, and near the critical angle.
                    const auto near = [](double a, double b) { EXPECT_NEAR(a, b, 1e-7 * std::abs(b) + 1e-200); };
                    if (gi * go == 0) {
                        EXPECT_EQ(v.f[0], 0);
                        continue;
                    }
                    near(v.f[0], value);
                    near(v.pdf_eye, chance * gi * std::abs(im / i.z()) * density * jacobian_o);
                    near(v.pdf_light, chance * go * std::abs(om / o.z()) * density * jacobian_i);
                }
            }
}

// Shares of a beam from `i` that a rough boundary reflects and transmits, by quadrature of Walter's formulas over polar
// angles and azimuths of the outgoing direction: nothing of the sampler of visible normals is in it.
struct Shares {
    double reflected = 0, transmitted = 0;
};

Shares scattered(MicrofacetType type, double alpha, double eta, const Vec3& i) {
    constexpr int rings = 300, spokes = 100;
    Shares sum;
    const double n_o = i.z() > 0 ? eta : 1, n_i = i.z() > 0 ? 1 : eta;
    const auto facets = [&](const Vec3& m, const Vec3& o) {
        return d(type, alpha, alpha, m) * g1(type, alpha, alpha, i, m) * g1(type, alpha, alpha, o, m);
    };
    for (int a = 0; a < rings; ++a)
        for (int b = 0; b < spokes; ++b) {
            const double polar = pi / 2 * (a + 0.5) / rings, azimuth = pi * (b + 0.5) / spokes, s = std::sin(polar);
            const double solid_angle = s * (pi / 2 / rings) * (2 * pi / spokes);
            Vec3 o(s * std::cos(azimuth), s * std::sin(azimuth), std::copysign(std::cos(polar), i.z()));
            Vec3 m = (i + o).normalized();
            if (m.z() < 0) m = -m;
            const double f = fresnel(std::abs(i.dot(m)), n_o / n_i);
            sum.reflected += solid_angle * f * facets(m, o) / (4 * std::abs(i.z()));
            o.z() = -o.z();
            m = (n_i * i + n_o * o).normalized();
            if (m.z() < 0) m = -m;
            const double im = i.dot(m), om = o.dot(m), t = 1 - fresnel(std::abs(im), n_o / n_i);
            sum.transmitted +=
                solid_angle * std::abs(im * om / i.z()) * n_o * n_o * t * facets(m, o) / sqr(n_i * im + n_o * om);
        }
    return sum;
}

Vec3 beam(double degrees) { return {std::sin(degrees * pi / 180), 0, std::cos(degrees * pi / 180)}; }

TEST(RoughTransmittance, IsTheIntegralOfTheFormula) {
    for (const MicrofacetType type : types)
        for (const double alpha : {0.2, 0.5, 1.0})
            for (const double eta : {1.5, 2.4}) {
                const RoughTransmittance table(type, alpha, eta);
                for (const double degrees : {0.0, 31.0, 62.0, 80.0, 88.0})  // 1e-3: midpoint rule on narrow lobes
                    EXPECT_NEAR(table(beam(degrees).z()), scattered(type, alpha, eta, beam(degrees)).transmitted, 1e-3)
                        << degrees << " degrees, alpha " << alpha << ", eta " << eta;
            }
}

TEST(RoughTransmittance, SmoothLimitIsThatOfFresnel) {
    for (const MicrofacetType type : types)
        for (const double eta : {1.3, 1.5, 2.4}) {
            const RoughTransmittance table(type, 0, eta);
            for (double c = 0.01; c <= 1; c += 0.03) EXPECT_NEAR(table(c), 1 - fresnel(c, eta), 2e-4) << c;
            EXPECT_NEAR(table.internal_diffuse_reflectance(), fresnel_diffuse_reflectance(1 / eta), 1e-4);
        }
}

TEST(RoughTransmittance, IsSharedByEqualCoats) {
    const auto first = rough_transmittance(MicrofacetType::ggx, 0.1, 1.5);
    EXPECT_EQ(first, rough_transmittance(MicrofacetType::ggx, 0.1, 1.5));
    EXPECT_NE(first, rough_transmittance(MicrofacetType::beckmann, 0.1, 1.5));
    EXPECT_NE(first, rough_transmittance(MicrofacetType::ggx, 0.2, 1.5));
}

TEST(RoughPlastic, IsCoatPlusBaseSeenThroughTheCoat) {
    Rng rng(3);
    const Spectrum diffuse(0.8, 0.5, 0.2), specular(0.9, 0.6, 0.3);
    for (const MicrofacetType type : types)
        for (const bool nonlinear : {false, true}) {
            const double alpha = 0.25, eta = 1.6;
            const BsdfPtr bsdf = make_rough_plastic(type, alpha, eta, diffuse, specular, nonlinear);
            const RoughTransmittance table(type, alpha, eta);
            const double internal = table.internal_diffuse_reflectance();
            for (int i = 0; i < 500; ++i) {
                Vec3 e = random_direction(rng), l = random_direction(rng);
                e.z() = std::abs(e.z());
                l.z() = std::abs(l.z());
                const Vec3 m = (e + l).normalized();
                const double density = d(type, alpha, alpha, m), f = fresnel(e.dot(m), eta);
                const double ge = g1(type, alpha, alpha, e, m), gl = g1(type, alpha, alpha, l, m);
                const BsdfValue v = bsdf->eval(flat_point(), e, l);
                for (int c = 0; c < 3; ++c) {
                    const double base = diffuse[c] / (1 - (nonlinear ? diffuse[c] : 1) * internal);
                    expect_close(v.f[c], specular[c] * f * density * ge * gl / (4 * e.z() * l.z()) +
                                             base * table(e.z()) * table(l.z()) / (pi * eta * eta));
                }
            }
        }
}

// The smooth plastic has the same base; its coat is a delta lobe, and the narrow one is invisible off the mirror angle.
TEST(RoughPlastic, SmoothLimitHasTheBaseOfSmoothPlastic) {
    for (const bool nonlinear : {false, true}) {
        const Spectrum diffuse(0.8, 0.5, 0.2);
        const BsdfPtr rough = make_rough_plastic(MicrofacetType::beckmann, 0, 1.5, diffuse, white, nonlinear);
        const BsdfPtr smooth = make_plastic(1.5, diffuse, white, nonlinear);
        for (const double degrees : {5.0, 40.0, 85.0}) {
            const Spectrum a = rough->eval(flat_point(), beam(degrees), beam(20)).f;
            const Spectrum b = smooth->eval(flat_point(), beam(degrees), beam(20)).f;
            EXPECT_TRUE(((a - b).abs() < 1e-3 * b).all()) << a.transpose() << " and " << b.transpose();
        }
    }
}

// Scattered share of the light from `w`: the mean over a grid of facets of both lobes' weights times their
// probabilities. Mode::light has no radiance scaling.
double dielectric_albedo(const Bsdf& bsdf, double eta, const Vec3& w) {
    constexpr int n = 20000;
    double sum = 0;
    for (int i = 0; i < n; ++i) {
        const Vec2 u(std::fmod(0.5 + i * 0.7548776662466927, 1.0), std::fmod(0.5 + i * 0.5698402909980532, 1.0));
        const auto through = bsdf.sample(flat_point(), w, one_minus_epsilon, u, Mode::light);
        const auto back = bsdf.sample(flat_point(), w, 0, u, Mode::light);
        if (!through && !back) continue;
        const bool refracted = through && through->lobe == 1;  // not so under total internal reflection
        const Vec3 h = refracted ? Vec3(w + through->eta * through->w) : Vec3(w + back->w);
        const double f = fresnel(std::abs(w.dot(h)) / h.norm(), w.z() > 0 ? eta : 1 / eta);
        sum += (back ? f * back->weight[0] : 0) + (refracted ? (1 - f) * through->weight[0] : 0);
    }
    return sum / n;
}

// Single scattering loses exactly what the formulas say it does, and a nearly smooth surface next to nothing.
TEST(RoughDielectric, AlbedoIsTheIntegralOfTheFormula) {
    for (const MicrofacetType type : types)
        for (const double alpha : {0.25, 0.5, 1.0})
            for (const double degrees : {0.0, 30.0, 60.0, 80.0})
                for (const double side : {1.0, -1.0}) {
                    const Vec3 w = side * beam(degrees);
                    const BsdfPtr bsdf = make_rough_dielectric(type, alpha, alpha, 1.5, white, white);
                    const double a = dielectric_albedo(*bsdf, 1.5, w);
                    const Shares shares = scattered(type, alpha, 1.5, w);
                    EXPECT_LE(a, 1);
                    // The quadratures' errors where lobes end abruptly at the horizon.
                    EXPECT_NEAR(a, shares.reflected + shares.transmitted, 1.5e-3) << alpha << " " << w.transpose();
                }
}

// The loss vanishes with the roughness.
TEST(RoughDielectric, NearlySmoothSurfacesLoseNothing) {
    for (const MicrofacetType type : types)
        for (const double alpha : {1e-4, 1e-3, 0.02})
            for (const double degrees : {0.0, 30.0, 60.0, 80.0})
                for (const double side : {1.0, -1.0}) {
                    const BsdfPtr bsdf = make_rough_dielectric(type, alpha, alpha, 1.5, white, white);
                    const double a = dielectric_albedo(*bsdf, 1.5, side * beam(degrees));
                    EXPECT_LE(a, 1 + 1e-12);
                    EXPECT_GT(a, 1 - alpha) << alpha << " " << degrees << " " << side;
                }
}

TEST(RoughConductor, SmoothLimitIsAMirror) {
    for (const MicrofacetType type : types) {
        const BsdfPtr bsdf = make_rough_conductor(type, 0, 0, gold, white);
        for (const double degrees : {0.0, 45.0, 85.0}) {
            const Spectrum expected = fresnel_conductor(beam(degrees).z(), gold.eta, gold.k);
            const auto s = bsdf->sample(flat_point(), beam(degrees), 0, {0.4, 0.6}, Mode::eye);
            ASSERT_TRUE(s);
            EXPECT_LT((s->w - reflect(beam(degrees))).norm(), 1e-3);
            EXPECT_TRUE(((s->weight - expected).abs() < 1e-3).all()) << degrees;
        }
    }
}

// Lobes too narrow for the chi-square test's cells: the pointwise checks. Their tolerance of 1e-9 holds down to
// alpha = 1e-3; below, half vectors of unit directions have too few digits for it.
TEST(RoughBsdfs, NarrowLobesPassThePointwiseChecks) {
    for (const MicrofacetType type : types)
        for (const BsdfCase& c :
             {BsdfCase{"conductor", make_rough_conductor(type, 1e-3, 1e-3, gold, white)},
              BsdfCase{"dielectric", make_rough_dielectric(type, 1e-3, 1e-3, 1.5, white, white), 1.5},
              BsdfCase{"plastic", make_rough_plastic(type, 1e-3, 1.5, white, white, true)}}) {
            EXPECT_TRUE(sample_agrees_with_eval(c));
            EXPECT_TRUE(is_reciprocal(c));
            EXPECT_TRUE(conserves_energy(c));
            EXPECT_TRUE(survives_extremes(c));
        }
}

TEST(RoughBsdfs, ExtremesOfRoughnessAreFinite) {
    for (const MicrofacetType type : types)
        for (const auto& [ax, ay] : {std::pair(0.0, 0.0), {0.0, 1.0}, {1.0, 0.0}, {5.0, 5.0}}) {
            EXPECT_TRUE(survives_extremes({"conductor", make_rough_conductor(type, ax, ay, gold, white)}));
            EXPECT_TRUE(survives_extremes({"dielectric", make_rough_dielectric(type, ax, ay, 1.5, white, white), 1.5}));
            EXPECT_TRUE(survives_extremes({"plastic", make_rough_plastic(type, ax, 1.5, white, white, true)}));
        }
}

TEST(RoughBsdfs, AskOnlyForWhatTheyUse) {
    const auto texture = constant_texture({0.3, 0.3, 0.3}), other = constant_texture({0.3, 0.3, 0.3});
    const auto traits = [&](ScalarInput u, ScalarInput v) {
        return make_rough_conductor(MicrofacetType::ggx, std::move(u), std::move(v), gold, white)->traits();
    };
    EXPECT_FALSE(traits(0.1, 0.1).needs_tangents);
    EXPECT_TRUE(traits(0.1, 0.2).needs_tangents);
    EXPECT_FALSE(traits(ScalarInput(texture), ScalarInput(texture)).needs_tangents);
    EXPECT_TRUE(traits(ScalarInput(texture), ScalarInput(other)).needs_tangents);
    EXPECT_TRUE(traits(ScalarInput(texture), 0.3).needs_tangents);
    EXPECT_FALSE(traits(0.1, 0.1).needs_uv);
    EXPECT_TRUE(traits(0.1, ScalarInput(texture)).needs_uv);
    EXPECT_FALSE(traits(0.1, 0.1).chooses_lobe);
    EXPECT_TRUE(make_rough_dielectric(MicrofacetType::ggx, 0.1, 0.1, 1.5, white, white)->traits().transmissive);
    EXPECT_TRUE(
        make_rough_plastic(MicrofacetType::ggx, 0.1, 1.5, ColorInput(texture), white, false)->traits().needs_uv);
}

TEST(RoughBsdfs, RefuseIndicesWithoutABoundary) {
    for (const double eta : {0.0, -1.5, 1.0, std::nan("")})
        EXPECT_THROW(make_rough_dielectric(MicrofacetType::ggx, 0.1, 0.1, eta, white, white), InputError) << eta;
    EXPECT_THROW(make_rough_plastic(MicrofacetType::ggx, 0.1, 0, white, white, false), InputError);
}

}  // namespace
}  // namespace keyhole
