#!/usr/bin/env bash
# Checks that web/template.html is what its sources give, and tests the page in headless Chromium.
#
#   run.sh SAMPLE_REPORT FOLDER    SAMPLE_REPORT: the program; FOLDER: where pages and screenshots go
#
# Exit code 77, with the reason, if npm, the packages of web/ or Chromium are not to be had.
set -euo pipefail
sample=$1 folder=$2
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
CHROMIUM=$CHROMIUM PAGES=$folder node --test test/
