// Complex indices of refraction of metals.
//
// Linear sRGB values: published spectra (E. D. Palik, Handbook of Optical Constants of Solids, and the SOPRA n&k
// database), averaged over the CIE 1931 colour matching functions and converted to Rec. 709 primaries. They are the
// values that scenes exported for Mitsuba and Tungsten carry as rgb, so a name and such an rgb give the same image.
#include "scene/reader/materials.h"

namespace keyhole {
namespace {

struct Conductor {
    const char* name;
    double eta[3], k[3];
};

constexpr Conductor conductors[] = {
    {"none", {0, 0, 0}, {1, 1, 1}},
    {"Ag", {0.155265, 0.116723, 0.138381}, {4.82834, 3.12225, 2.14695}},
    {"Al", {1.65746, 0.880369, 0.521229}, {9.22387, 6.26952, 4.83700}},
    {"Au", {0.143119, 0.374957, 1.44248}, {3.98316, 2.38572, 1.60322}},
    {"Be", {4.18506, 3.18506, 2.78409}, {3.83544, 3.01013, 2.86901}},
    {"Cr", {4.36968, 2.91670, 1.65470}, {5.20643, 4.23136, 3.75495}},
    {"Cu", {0.200438, 0.924033, 1.10221}, {3.91295, 2.45285, 2.14219}},
    {"Cu2O", {3.54928, 2.95206, 2.73692}, {0.113218, 0.194666, 0.600168}},
    {"CuO", {3.24538, 2.44963, 2.19741}, {0.520274, 0.570737, 0.717225}},
    {"Hg", {2.39893, 1.44003, 0.909551}, {6.32763, 4.37194, 3.42179}},
    {"HgTe", {4.77953, 3.23100, 2.66003}, {1.63198, 1.58082, 1.72958}},
    {"Ir", {3.08641, 2.08219, 1.61789}, {5.59215, 4.06718, 3.26726}},
    {"K", {0.0640493, 0.0464101, 0.0381842}, {2.10422, 1.34894, 0.913211}},
    {"Li", {0.265787, 0.195610, 0.220920}, {3.54017, 2.31113, 1.66859}},
    {"Mo", {4.48370, 3.52546, 2.77608}, {4.11113, 3.42087, 3.15060}},
    {"Na", {0.0602665, 0.0561412, 0.0619909}, {3.17929, 2.11248, 1.57909}},
    {"Nb", {3.42014, 2.79019, 2.39559}, {3.44138, 2.73764, 2.57991}},
    {"Ni", {2.36728, 1.66336, 1.46706}, {4.49883, 3.05016, 2.34543}},
    {"Rh", {2.58580, 1.86019, 1.55443}, {6.78229, 4.70295, 3.97609}},
    {"Se", {4.05926, 2.84269, 2.82076}, {0.754379, 0.638515, 0.521587}},
    {"Ta", {2.06258, 2.39309, 2.62807}, {2.40805, 1.74137, 1.94704}},
    {"Te", {7.39084, 4.48210, 2.63707}, {3.25614, 3.52739, 3.29217}},
    {"TiC", {3.70047, 2.83744, 2.58230}, {3.26569, 2.35156, 2.17279}},
    {"TiN", {1.64847, 1.15045, 1.37978}, {3.36846, 1.94349, 1.10200}},
    {"V", {4.27751, 3.51315, 2.76113}, {3.49118, 2.88936, 3.11670}},
    {"VC", {3.65757, 2.75273, 2.53268}, {3.06835, 2.19867, 1.96318}},
    {"VN", {2.86560, 2.11918, 1.94008}, {3.03233, 2.05611, 1.61629}},
    {"W", {4.37070, 3.30030, 2.99827}, {3.50068, 2.60487, 2.27319}},
};

}  // namespace

std::optional<ConductorIor> conductor_by_name(const std::string& name) {
    for (const Conductor& c : conductors)
        if (name == c.name) return ConductorIor{{c.eta[0], c.eta[1], c.eta[2]}, {c.k[0], c.k[1], c.k[2]}};
    return std::nullopt;
}

std::vector<std::string> conductor_names() {
    std::vector<std::string> names;
    for (const Conductor& c : conductors) names.emplace_back(c.name);
    return names;
}

}  // namespace keyhole
