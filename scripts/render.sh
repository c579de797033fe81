#!/usr/bin/env bash
# Builds Keyhole and renders a scene. Installs what is missing first (see setup.sh).
#
#   scripts/render.sh [SCENE] [OPTIONS]
#
#   SCENE    a scene file, a folder with a scene.xml, or the name of a scene of scenes/ (default: cornell-box)
#   OPTIONS  options of `keyhole render`, such as --time 60s, --size 640x480, -o picture.exr
#
# The picture is written to out/SCENE.exr (linear) and out/SCENE.png, unless -o says otherwise.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
source "$root/scripts/setup.sh"

scene=cornell-box
case ${1:-} in
    -h | --help) sed -n '2,/^set/s/^# \{0,1\}//p' "$0" && exit ;;
    -*) ;;
    ?*) scene=$1 && shift ;;
esac
given=$scene
[ -e "$scene" ] || scene=$root/scenes/${scene%.xml}.xml
[ ! -d "$scene" ] || scene=$(realpath "$scene")/scene.xml
[ -f "$scene" ] || fail "no scene '$given': give a scene file or one of: $(cd "$root/scenes" && echo *.xml)"
name=$(basename "$scene" .xml)
case $name in scene | scene_*) name=$(basename "$(dirname "$(realpath "$scene")")") ;; esac

ensure_requirements "${CXX:-c++}"
(cd "$root" && build_preset release build/release keyhole)

output=(-o "$root/out/$name.exr" -o "$root/out/$name.png")
for option in "$@"; do
    case $option in -o* | --output*) output=() ;; esac
done
mkdir -p "$root/out"
exec "$root/build/release/keyhole" render "$scene" "${output[@]}" "$@"
