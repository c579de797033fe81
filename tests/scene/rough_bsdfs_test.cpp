// Rough conductor, dielectric and plastic: the suite of every BSDF, and their values against the published formulas.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/rng.h"
#include "bsdf_harness.h"
#include "scene/bsdfs/rough_transmittance.h"

namespace keyhole {
namespace {

const ConductorIor gold{{0.143, 0.375, 1.442}, {3.983, 2.386, 1.603}};
const Spectrum white(1, 1, 1);

const char* type_name(MicrofacetType type) { return type == MicrofacetType::ggx ? "ggx" : "beckmann"; }

std::vector<BsdfCase> cases() {
    std::vector<BsdfCase> list;
    for (const MicrofacetType type : {MicrofacetType::ggx, MicrofacetType::beckmann}) {
        for (const double alpha : {0.02, 0.1, 0.25, 0.5, 1.0}) {
            const std::string suffix = std::string("_") + type_name(type) + "_" + std::to_string(int(100 * alpha));
            list.push_back({"conductor" + suffix, make_rough_conductor(type, alpha, alpha, gold, white)});
            list.push_back({"dielectric" + suffix, make_rough_dielectric(type, alpha, alpha, 1.5, white, white), 1.5});
            list.push_back({"plastic" + suffix,
                            make_rough_plastic(type, alpha, 1.5, Spectrum(0.7, 0.3, 0.1), white, alpha < 0.3)});
        }
        const std::string suffix = std::string("_") + type_name(type);
        list.push_back({"anisotropic_conductor" + suffix, make_rough_conductor(type, 0.1, 0.5, gold, white)});
        list.push_back({"anisotropic_dielectric" + suffix,
                        make_rough_dielectric(type, 0.6, 0.2, 1.3, Spectrum(0.9, 0.5, 0.1), white), 1.3});
        list.push_back({"inverted_dielectric" + suffix, make_rough_dielectric(type, 0.3, 0.3, 0.7, white, white), 0.7});
        list.push_back({"inverted_plastic" + suffix, make_rough_plastic(type, 0.3, 0.7, white, white, true)});
        list.push_back({"white_plastic" + suffix, make_rough_plastic(type, 0.05, 1.9, white, white, true)});
    }
    const auto grey = constant_texture({0.3, 0.3, 0.3});
    list.push_back({"textured_conductor", make_rough_conductor(MicrofacetType::ggx, ScalarInput(grey), 0.1, gold,
                                                               ColorInput(constant_texture({0.9, 0.8, 0.7})))});
    list.push_back({"black_coat", make_rough_plastic(MicrofacetType::ggx, 0.2, 1.5, white, Spectrum(0, 0, 0), false)});
    list.push_back({"black_base", make_rough_plastic(MicrofacetType::ggx, 0.2, 1.5, Spectrum(0, 0, 0), white, false)});
    return list;
}

INSTANTIATE_TEST_SUITE_P(Rough, BsdfTest, testing::ValuesIn(cases()), bsdf_case_name);

}  // namespace
}  // namespace keyhole
