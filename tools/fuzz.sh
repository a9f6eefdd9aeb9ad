#!/usr/bin/env bash
# Fuzzes every parser of foreign data: builds with clang, makes what to begin with, runs, reports.
#   tools/fuzz.sh [SECONDS [NAME...]]     60 seconds for each of all, or for these; exit 1 where one has crashed
# Two at a time for each core, so that all of them take two minutes on two cores.
# What a fuzzer has found stays in $XDG_CACHE_HOME/eyepoint/fuzz (else ~/.cache), for every clone of this user, and is where the
# next run goes on. Recordings are taken from EYE_TEST_DATA (default ../shared/data) where they are.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
seconds=${1:-60}
shift || true
if ! [[ "$seconds" =~ ^[1-9][0-9]*$ ]]; then
  echo "fuzz.sh: '$seconds' is no number of seconds; usage: tools/fuzz.sh [SECONDS [NAME...]]" >&2
  exit 2
fi
names=("$@")
[ "${#names[@]}" -eq 0 ] && names=(native_fdm cigi dis rpos pcap track config chunk)

tools/install_dependencies.sh fuzz
cmake --preset fuzz >/dev/null
cmake --build --preset fuzz --target fuzzers
build/fuzz/bin/fuzz_seeds build/fuzz/seeds "${EYE_TEST_DATA:-../shared/data}"

for name in "${names[@]}"; do
  if [ ! -x "build/fuzz/bin/fuzz_$name" ]; then
    echo "fuzz.sh: there is no fuzzer '$name'; there are:" build/fuzz/bin/fuzz_* >&2
    exit 2
  fi
done

corpora=${XDG_CACHE_HOME:-$HOME/.cache}/eyepoint/fuzz
export UBSAN_OPTIONS=print_stacktrace=1
# One fuzzer, its report to build/fuzz/NAME.log and its exit status to NAME.status.
fuzz() {
  local name=$1 status=0
  local corpus=$corpora/$name
  mkdir -p "$corpus" build/fuzz/crashes
  "build/fuzz/bin/fuzz_$name" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -print_final_stats=1 \
    -artifact_prefix="build/fuzz/crashes/$name-" "$corpus" "build/fuzz/seeds/$name" >"build/fuzz/$name.log" 2>&1 || status=$?
  echo "$status" >"build/fuzz/$name.status"
}

at_once=$((2 * $(nproc)))
echo "Fuzzing ${#names[@]} parsers, $seconds s each, $at_once at once"
for name in "${names[@]}"; do
  while [ "$(jobs -rp | wc -l)" -ge "$at_once" ]; do wait -n; done
  fuzz "$name" &
done
wait

crashes=0
printf '%-12s %14s %10s %10s %8s\n' fuzzer executions per-second edges corpus
for name in "${names[@]}"; do
  log=build/fuzz/$name.log
  status=$(cat "build/fuzz/$name.status")
  executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log" | tail -n 1)
  edges=$(sed -n 's/.* cov: \([0-9]*\) .*/\1/p' "$log" | tail -n 1)
  printf '%-12s %14s %10s %10s %8s\n' "$name" "${executions:-?}" "$((${executions:-0} / seconds))" "${edges:-?}" \
    "$(find "$corpora/$name" -type f | wc -l)"
  if [ "$status" -ne 0 ]; then
    crashes=$((crashes + 1))
    grep -m 4 -E 'invariant broken|ERROR|SUMMARY|runtime error|Test unit written' "$log" >&2 || tail -n 5 "$log" >&2
    echo "fuzz.sh: $name failed with status $status; the whole report: $log" >&2
  fi
done
[ "$crashes" -eq 0 ]
