#!/usr/bin/env bash
# Everything that is checked: installs what is missing, builds, lints, measures, then every test. The last lines are ctest's
# summary.
#   tools/test.sh [--sanitizers] [--long] [options of ctest]
# --sanitizers: before that the modules that read foreign data or share memory between threads, under ASan and UBSan and
# under TSan: three more builds' time. --long: also what takes minutes (ten million filter steps, thousands of compared
# pictures, the error of every tolerance).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
jobs=$(nproc)
sanitizers=no long=no
while [ "${1:-}" = "--sanitizers" ] || [ "${1:-}" = "--long" ]; do
  [ "$1" = "--long" ] && long=yes || sanitizers=yes
  shift
done

step() { printf '\n== %s (%d s so far)\n' "$1" "$SECONDS"; }

# A preset, the libraries' tests that run under it; each test program is run as a whole.
sanitize() {
  local preset=$1 name
  shift
  step "$preset: $*"
  cmake --preset "$preset" >/dev/null
  cmake --build --preset "$preset" --target "${@/#/test_}"
  for name in "$@"; do "build/$preset/bin/test_$name" --durations no; done
}

# All threads at once: a live host, the pager short of memory, a minute at 300 m/s through mountains.
fly_under_tsan() {
  local terrain=build/release/testdata/carpathia.eyt host=127.0.0.1:15599 track=build/tsan/track.csv sender
  ctest --test-dir build/release -R "bake carpathia"
  if [ ! -e "$terrain" ]; then
    echo "tsan: no flight, its elevation is not there"
    return
  fi
  step "tsan: a flight"
  cmake --build --preset tsan --target eyepoint
  awk 'BEGIN { print "time,lat,lon,alt"
    for (t = 0; t <= 90; ++t) printf "%d,%.6f,%.6f,2600\n", t, 49.05 + 0.0027 * t, 20 + 0.3 * sin(t / 15) }' >"$track"
  build/release/bin/eyepoint-host --protocol native-fdm --to "$host" --track "$track" --loop >/dev/null &
  sender=$!
  build/tsan/bin/eyepoint --headless --terrain "$terrain" --host "native-fdm://$host" --duration 60 --size 320x240 \
    --redraw always --cache-gpu 64 --cache-ram 32
  kill "$sender"
}

tools/install_dependencies.sh test
step "build: release"
cmake --preset release -DEYE_BUILD_TESTS=ON >/dev/null
cmake --build --preset release
step "lint"
tools/lint.sh

# A report of a sanitizer ends the program with an error, so it ends this script.
export ASAN_OPTIONS=detect_leaks=1 UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1
export TSAN_OPTIONS=halt_on_error=1:suppressions=$PWD/tests/tsan.supp
if [ "$sanitizers" = yes ]; then
  sanitize asan base geo predict terrain bake paging link
  sanitize tsan telemetry paging link
  fly_under_tsan
fi

if [ "$long" = yes ]; then
  step "long tests"
  # They need the terrain that the programs' tests bake.
  ctest --test-dir build/release -R "bake carpathia"
  build/release/bin/test_predict "[long]"
  build/release/bin/test_culling "[by hand]"
  build/release/bin/test_system "truth: time against error"
fi

# Before the tests, so that their summary is what one reads last; a subset of the tests does without.
measured=yes
if [ $# -eq 0 ]; then
  step "benchmark against its baseline"
  ctest --test-dir build/release -R "bake carpathia"
  tools/regress.sh || measured=no
fi

step "every test"
# Two at a time; those that draw or measure hold a lock and go one by one.
status=0
ctest --test-dir build/release --output-on-failure --parallel "$jobs" "$@" || status=$?
if [ "$measured" = no ]; then
  echo "test.sh: the benchmark is not as its baseline; its table stands before the tests. tools/regress.sh repeats it alone" >&2
  status=1
fi
exit "$status"
