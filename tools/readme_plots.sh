#!/usr/bin/env bash
# The README's plots and the numbers behind them, out of a report of the benchmark: assets/plots/NAME.svg and NAME.csv.
#   tools/readme_plots.sh REPORT.json      such as: build/release/bin/eyepoint-bench culling pareto panorama --terrain tatra.eyt --out report
# then tools/readme_plots.sh report/report.json
set -euo pipefail
if [ $# -ne 1 ] || [ ! -f "$1" ]; then
  echo "readme_plots.sh: give the report.json of a run of eyepoint-bench with the suites culling, pareto and panorama" >&2
  exit 2
fi
report=$(realpath "$1")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
build/release/bin/eyepoint-bench plots "$report" --out "$folder" >"$folder/list"
mkdir -p assets/plots
# NAME TITLE: the first plot of the report whose title begins so.
take() {
  local base
  base=$(sed -n "s/^\(.*\)\.svg, \.csv: $2.*/\1/p" "$folder/list" | head -n 1)
  if [ -z "$base" ]; then
    echo "readme_plots.sh: the report has no plot '$2 …'" >&2
    exit 1
  fi
  cp "$base.svg" "assets/plots/$1.svg"
  cp "$base.csv" "assets/plots/$1.csv"
  echo "assets/plots/$1.svg: $2"
}
take culling "mountains, 800x600"
take pareto "Distances: relative error of the worst hundredth of the pixels, 800x600"
take panorama "What is told against the truth"
