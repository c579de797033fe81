#include "app/version.h"

#include <OpenImageIO/imageio.h>

namespace keyhole {

std::string version() { return KEYHOLE_VERSION; }

nlohmann::ordered_json versions() {
    return {{"keyhole", version()},
#ifdef __clang__
            {"compiler", "clang " __clang_version__},
#else
            {"compiler", "g++ " __VERSION__},
#endif
            {"openimageio", OIIO_VERSION_STRING},
            {"embree", KEYHOLE_EMBREE_VERSION}};
}

}  // namespace keyhole
