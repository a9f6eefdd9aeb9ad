#!/usr/bin/env bash
# Every suite of the benchmark, quickly, over the terrain that the tests bake, held against what is stored of an earlier run:
#   tools/regress.sh [--update]     --update: stores this run's figures as the baseline instead
# Counts must be the same, CPU times within a band once the machine's speed is divided out (eyepoint-bench compare --help).
# What is slower is measured once more: a busy minute is no slower program. Exit status 1 where something is still off.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
bench=build/release/bin/eyepoint-bench terrain=build/release/testdata/carpathia.eyt out=build/release/bench
baseline=tests/bench/baseline.json

if [ ! -e "$terrain" ]; then
  echo "Benchmark: not run: $terrain is not there; the tests bake it from the elevation in EYE_TEST_DATA (default ../shared/data)"
  exit 0
fi
if [ ! -e "$baseline" ] && [ "${1:-}" != "--update" ]; then
  echo "Benchmark: not run: $baseline is not there; tools/regress.sh --update, with nothing else running, measures and stores it"
  exit 0
fi
measure() { "$bench" all --quick --terrain "$terrain" --out "$out"; }

measure
if [ "${1:-}" = "--update" ]; then
  exec "$bench" compare "$out/report.json" "$baseline" --update
fi
if ! "$bench" compare "$out/report.json" "$baseline"; then
  echo "Benchmark: not as its baseline; measured once more"
  measure
  "$bench" compare "$out/report.json" "$baseline"
fi
