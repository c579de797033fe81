#!/usr/bin/env bash
# Checks that web/template.html is what its sources give, and tests the page in headless Chromium, with made-up results and
# with real ones.
#
#   run.sh SAMPLE_REPORT KEYHOLE FOLDER    the two programs; FOLDER: where pages, comparisons and screenshots go
#
# Exit code 77, with the reason, if npm, the packages of web/ or Chromium are not to be had.
set -euo pipefail
sample=$1 keyhole=$2 folder=$3
cd "$(dirname "${BASH_SOURCE[0]}")/../../web"

skip() {
    echo "SKIPPED: $*"
    exit 77
}
command -v npm >/dev/null || skip "npm is not installed"
# The packages are those of the lock file; installed anew only when that is newer.
if [ ! node_modules/.package-lock.json -nt package-lock.json ]; then
    npm ci --no-audit --no-fund --ignore-scripts || skip "npm could not install the packages of web/"
fi
npm run --silent check

CHROMIUM=$(command -v chromium || command -v chromium-browser || command -v google-chrome) ||
    skip "Chromium is not installed; the template was checked, the page was not opened"
mkdir -p "$folder"
"$sample" "$folder/small.html" 96 54 3
"$sample" "$folder/sweep.html" 96 54 6 sweep
"$sample" "$folder/bare.html" 96 54 1 bare
"$sample" "$folder/large.html" 1280 720 12

# Enough to see that all is there; too little to say which is better.
rm -rf "$folder/comparisons"
common=(-q --size 48x48 --max-length 5 --runs 2 -n 64 --reference-time 1s --set bootstrap.samples=20000)
for scene in cornell-box keyhole-room glossy-room; do
    "$keyhole" compare "../scenes/$scene.xml" --mixes mmlt --integrators path,bdpt "${common[@]}" \
        -o "$folder/comparisons/$scene"
done
"$keyhole" sweep ../scenes/cornell-box.xml --vary small-step.s2=0.002..0.2 --steps 3 "${common[@]}" \
    -o "$folder/comparisons/sweep"
"$keyhole" tradeoff ../scenes/three-planes.xml --mix fused-geo --knobs cones,max-length "${common[@]}" \
    -o "$folder/comparisons/tradeoff"
CHROMIUM=$CHROMIUM PAGES=$folder COMPARISONS=$folder/comparisons node --test test/page.test.mjs test/comparison.test.mjs
