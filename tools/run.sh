#!/usr/bin/env bash
# From a fresh clone to a flight: installs what is missing, builds, bakes the embedded terrain once, launches eyepoint.
#   tools/run.sh [options of eyepoint]
# With a display: a window. Without: the built-in scenario, its picture, film and statistics in ./out. Your options win.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
bin=$root/build/release/bin

# True where the option was given, as --name or --name=value.
given() {
  local name=$1 word
  shift
  for word in "$@"; do
    case $word in "$name" | "$name"=*) return 0 ;; esac
  done
  return 1
}

build() {
  "$root/tools/install_dependencies.sh" run
  cd "$root"
  if [ ! -f build/release/build.ninja ]; then
    echo "Build: configuring build/release ..."
    cmake --preset release -DEYE_BUILD_TESTS=OFF >/dev/null
  fi
  echo "Build: eyepoint, eyepoint-bake, eyepoint-host ..."
  cmake --build --preset release --target eyepoint eyepoint-bake eyepoint-host
  cd - >/dev/null
}

# The embedded terrain lies where eyepoint looks for it. It is baked under another name, so that what carries the name
# is whole; a file that an older version wrote is baked again.
bake_demo() {
  local demo=${XDG_DATA_HOME:-$HOME/.local/share}/eyepoint/demo.eyt
  if [ -f "$demo" ] && "$bin/eyepoint-bake" info "$demo" >/dev/null 2>&1; then
    echo "Terrain: $demo"
    return
  fi
  mkdir -p "$(dirname "$demo")"
  echo "Terrain: baking the embedded terrain into $demo (once, under a minute) ..."
  rm -f "$demo".baking*
  "$bin/eyepoint-bake" --log-level warn demo --out "$demo.baking"
  mv "$demo.baking" "$demo"
}

# A local X display has a socket; one over the network is taken at its word. Debian's GLFW speaks X11, so a Wayland
# session counts through the DISPLAY of its Xwayland.
display_usable() {
  local display=${DISPLAY:-}
  [ -n "$display" ] || return 1
  case $display in
    :* | unix:*)
      local number=${display##*:}
      [ -S "/tmp/.X11-unix/X${number%%.*}" ] || grep -q "@/tmp/.X11-unix/X${number%%.*}\$" /proc/net/unix 2>/dev/null
      ;;
  esac
}

number_of() { # key, file: the number behind a key of a flat piece of JSON, one decimal
  awk -v key="\"$1\":" '$1 == key { gsub(/,/, "", $2); printf "%.1f", $2; exit }' "$2"
}

report() { # summary file, then "what file" pairs
  local summary=$1 what file
  shift
  echo
  while [ "$#" -gt 0 ]; do
    what=$1 file=$2
    shift 2
    [ -s "$file" ] && printf '%-11s %s\n' "$what" "$file"
  done
  [ -s "$summary" ] || return 0
  echo
  printf '%-28s %s\n' \
    "device" "$(sed -n 's/.*"device": *"\([^"]*\)".*/\1/p' "$summary")" \
    "frames" "$(number_of frames "$summary" | sed 's/\.0$//')" \
    "frame time, median" "$(number_of median "$summary") ms" \
    "frame time, 99th percentile" "$(number_of p99 "$summary") ms" \
    "frame time, longest" "$(number_of max "$summary") ms" \
    "triangles a frame" "$(number_of triangles_mean "$summary" | sed 's/\..*//')" \
    "first frame after" "$(number_of startup_ms "$summary") ms" \
    "memory at its peak" "$(($(number_of peak_rss_bytes "$summary" | sed 's/\..*//') >> 20)) MiB"
}

fly_headless() {
  local out=$PWD/out options=() picture="" film="" statistics="" summary=""
  mkdir -p "$out"
  given --headless "$@" || options+=(--headless)
  # Each default stands back where the user said something else. A configuration file may say all of it.
  if ! given --config "$@"; then
    if ! given --host "$@" && ! given --pose "$@"; then
      options+=(--host demo://)
      given --frames "$@" || given --duration "$@" || options+=(--duration 20)
      given --rate "$@" || given --offline "$@" || options+=(--rate 60)
      if ! given --record "$@" && command -v ffmpeg >/dev/null; then
        film=$out/eyepoint.mp4
        options+=(--record "$film")
      fi
    fi
    given --screenshot "$@" || { picture=$out/eyepoint.png && options+=(--screenshot "$picture"); }
    given --stats "$@" || { statistics=$out/stats.jsonl && options+=(--stats "$statistics"); }
    given --summary "$@" || { summary=$out/summary.json && options+=(--summary "$summary"); }
  fi
  rm -f "$picture" "$film" "$statistics" "$summary"
  echo "Flight, headless: eyepoint ${options[*]} $*"
  "$bin/eyepoint" "${options[@]}" "$@"
  report "$summary" picture "$picture" film "$film" statistics "$statistics" summary "$summary"
}

build
if given --help "$@" || given -h "$@" || given --version "$@" || given --list-devices "$@"; then
  exec "$bin/eyepoint" "$@"
fi
given --terrain "$@" || bake_demo
if ! given --headless "$@" && display_usable; then
  echo "Flight, in a window on $DISPLAY: eyepoint $*"
  exec "$bin/eyepoint" "$@"
fi
fly_headless "$@"
