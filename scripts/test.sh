#!/usr/bin/env bash
# Builds everything and runs all tests. Installs what is missing first (see setup.sh).
#
#   scripts/test.sh [PRESET] [--werror] [--compiler CXX] [--bench] [--build-only]
#
#   PRESET          release (default), debug, asan (address and undefined-behaviour sanitizers), tsan, or fuzz (the fuzz
#                   targets of tests/fuzz alone, half a minute each; needs --compiler clang++)
#   --werror        treat warnings as errors
#   --compiler CXX  compile with CXX, in build/PRESET-CXX (default: $CXX or c++, in build/PRESET)
#   --bench         build the micro-benchmarks of bench/ as well
#   --build-only    run no tests
#
# Ends with ctest's summary; the exit code is 0 only if everything was built and every test passed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/setup.sh

preset=release
compiler=
options=(-DKEYHOLE_WERROR=OFF -DKEYHOLE_BENCH=OFF)
run_tests=yes
while [ $# -gt 0 ]; do
    case $1 in
        release | debug | asan | tsan | fuzz) preset=$1 ;;
        --werror) options+=(-DKEYHOLE_WERROR=ON) ;;
        --compiler) compiler=${2:?--compiler needs a name} && shift ;;
        --bench)
            options+=(-DKEYHOLE_BENCH=ON)
            libraries+=$'\nlibbenchmark-dev|Google Benchmark|benchmark/benchmark.h'
            ;;
        --build-only) run_tests=no ;;
        -h | --help) sed -n '2,/^set/s/^# \{0,1\}//p' "$0" && exit ;;
        *) fail "unknown argument '$1'; valid: release, debug, asan, tsan, fuzz, --werror, --compiler CXX, --bench, --build-only" ;;
    esac
    shift
done

folder=build/$preset
if [ -n "$compiler" ]; then
    folder+=-$(basename "$compiler")
    options+=(-DCMAKE_CXX_COMPILER="$compiler")
fi
ensure_requirements "${compiler:-${CXX:-c++}}"
target=all
[ "$preset" != fuzz ] || target=fuzzers
build_preset "$preset" "$folder" "$target" "${options[@]}"
if [ "$run_tests" = yes ]; then
    ctest --test-dir "$folder" --output-on-failure --parallel "$(nproc)" </dev/null
fi
