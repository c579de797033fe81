// Uses an installed Keyhole: headers, libraries and all that they depend on must be found.
#include <base/error.h>
#include <base/rng.h>
#include <render/render.h>
#include <scene/scene.h>

#include <cstdio>

int main() {
    keyhole::Rng rng(1, 2);
    const double u = rng.uniform();
    const std::string names = keyhole::valid_names("difuse", {"diffuse", "phong"});
    std::printf("%f %s\n", u, names.c_str());
    return u >= 0 && u < 1 && names.starts_with("did you mean 'diffuse'?") ? 0 : 1;
}
