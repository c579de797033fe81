# shellcheck shell=bash
# Sourced by render.sh and test.sh: finds what is missing on this machine and installs it where that is possible.
# Debian 12, Ubuntu 24.04 and newer: apt-get, as root or through sudo. Elsewhere: says what is missing and stops.

fail() {
    printf '%s: %s\n' "$(basename "$0")" "$*" >&2
    exit 1
}

# What Keyhole needs: Debian package | what it is | headers, one of which must be there.
libraries="\
libembree-dev|Embree 3.13 or 4|embree4/rtcore.h embree3/rtcore.h
libtbb-dev|oneTBB|tbb/version.h
libopenimageio-dev|OpenImageIO 2.4|OpenImageIO/imageio.h
libeigen3-dev|Eigen 3.4|eigen3/Eigen/Core Eigen/Core
libpugixml-dev|pugixml|pugixml.hpp
libtinyobjloader-dev|tinyobjloader 2|tiny_obj_loader.h
zlib1g-dev|zlib|zlib.h
libfmt-dev|fmt|fmt/format.h
nlohmann-json3-dev|nlohmann JSON|nlohmann/json.hpp
libcli11-dev|CLI11|CLI/CLI.hpp
libtomlplusplus-dev|toml++ 3|toml++/toml.h
librandom123-dev|Random123|Random123/philox.h
libboost-dev|Boost (math)|boost/math/special_functions/gamma.hpp
libgtest-dev|GoogleTest|gtest/gtest.h
libgmock-dev|GoogleMock|gmock/gmock.h"

have() { command -v "$1" >/dev/null 2>&1; }

# The Debian package of a compiler: clang++-14 is in clang-14, g++-13 in g++-13.
compiler_package() {
    case $(basename "$1") in
        clang++*) basename "${1/clang++/clang}" ;;
        g++-*) basename "$1" ;;
        *) echo g++ ;;
    esac
}

# The Debian package of its fuzzer runtime: libclang-rt-14-dev for clang++-14.
fuzzer_package() {
    local version
    version=$(basename "$1" | sed -n 's/^clang++\(-[0-9]*\)$/\1/p')
    echo "libclang-rt${version}-dev"
}

# Whether a compiler that is clang can build fuzz targets: their runtime is a package of its own.
has_fuzzer_runtime() {
    echo 'extern "C" int LLVMFuzzerTestOneInput(const unsigned char*, unsigned long) { return 0; }' |
        "$1" -fsanitize=fuzzer,address -x c++ - -o /dev/null 2>/dev/null
}

# A program for the preprocessor that is left with the lines of the libraries whose headers are not there.
probe() {
    local package name headers header condition
    while IFS='|' read -r package name headers; do
        condition=1
        for header in $headers; do condition+=" && !__has_include(<$header>)"; done
        printf '#if %s\nmissing|%s|%s\n#endif\n' "$condition" "$package" "$name"
    done <<<"$libraries"
}

# Prints "package|what it is" for everything that is missing. $1: the compiler.
missing_requirements() {
    have cmake || echo "cmake|CMake 3.25"
    have ninja || echo "ninja-build|Ninja"
    if have "$1" && echo 'int main() {}' | "$1" -x c++ -fsyntax-only - 2>/dev/null; then
        probe | "$1" -std=c++20 -E -P -x c++ - | sed -n 's/^missing|//p'
        if [ "${preset:-}" = fuzz ] && ! has_fuzzer_runtime "$1"; then
            echo "$(fuzzer_package "$1")|clang with the runtime of libFuzzer"
        fi
    else
        echo "$(compiler_package "$1")|a C++20 compiler: $1 (g++ 12, clang 14, or newer)"
        [ "${preset:-}" != fuzz ] || echo "$(fuzzer_package "$1")|the runtime of libFuzzer"
        cut -d'|' -f1,2 <<<"$libraries"
    fi
}

install_packages() {
    local as_root=()
    if [ "$(id -u)" -ne 0 ]; then
        have sudo || return 1
        as_root=(sudo)
        [ -t 0 ] || as_root+=(-n)
    fi
    echo "Installing with apt-get: $*"
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive sh -c '
        apt-get update -q && apt-get install -q -y --no-install-recommends "$@"' apt "$@" </dev/null
}

# Makes sure that everything is there, or ends the script with the list of what is not. $1: the compiler.
ensure_requirements() {
    local missing packages version
    missing=$(missing_requirements "$1")
    if [ -n "$missing" ]; then
        mapfile -t packages <<<"$(cut -d'|' -f1 <<<"$missing")"
        if have apt-get && install_packages "${packages[@]}"; then missing=$(missing_requirements "$1"); fi
    fi
    if [ -n "$missing" ]; then
        {
            echo "Keyhole needs libraries or tools that this machine does not have:"
            sed 's/^\([^|]*\)|\(.*\)$/  \2 (Debian package \1)/' <<<"$missing"
            if have apt-get; then
                echo "They could not be installed from here (no root and no sudo, or apt-get failed). As root:"
                echo "  apt-get update && apt-get install --no-install-recommends $(cut -d'|' -f1 <<<"$missing" | xargs)"
            else
                echo "This is not Debian or Ubuntu: install them with the system's package manager, then start this again."
            fi
        } >&2
        fail "set-up is not complete"
    fi
    version=$(cmake --version | sed -n '1s/[^0-9]*\([0-9]*\.[0-9]*\).*/\1/p')
    if [ "$(printf '3.25\n%s\n' "$version" | sort -V | head -1)" != 3.25 ]; then
        fail "CMake 3.25 or newer is needed, this is $version (Debian 12 and Ubuntu 24.04 have it)"
    fi
}

# Configures a preset and builds it: build_preset PRESET FOLDER TARGET [arguments for CMake].
build_preset() {
    local preset=$1 folder=$2 target=$3
    shift 3
    cmake --preset "$preset" -B "$folder" "$@"
    cmake --build "$folder" --target "$target"
}
