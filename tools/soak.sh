#!/usr/bin/env bash
# A long flight through all of a terrain, ten times as fast as aircraft fly, with little memory: does the process grow?
#   tools/soak.sh [MINUTES [TERRAIN [options of eyepoint]]]     default: 30 minutes over the embedded demo
# Prints the process's memory as it flies and leaves it in build/soak/memory.csv; exit 1 where the last third of the
# flight needed more than 5 % and 8 MB more than the second.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
minutes=${1:-30} terrain=${2:-${XDG_DATA_HOME:-$HOME/.local/share}/eyepoint/demo.eyt}
shift $(($# < 2 ? $# : 2))
if ! [[ "$minutes" =~ ^[1-9][0-9]*$ ]]; then
  echo "soak.sh: '$minutes' is no number of minutes; usage: tools/soak.sh [MINUTES [TERRAIN [options of eyepoint]]]" >&2
  exit 2
fi
bin=build/release/bin out=build/soak
mkdir -p "$out"
extent=$("$bin/eyepoint-bake" info "$terrain" --json)
edge() { sed -n "s/^ *\"$1\": \(-\{0,1\}[0-9.]*\),\{0,1\}\$/\1/p" <<<"$extent" | head -n 1; }

# A Lissajous figure over the middle, 3,000 m/s at most, two seconds a sample: it comes by everywhere, and never the same
# way twice.
awk -v minutes="$minutes" -v w="$(edge west)" -v s="$(edge south)" -v e="$(edge east)" -v n="$(edge north)" 'BEGIN {
  pi = atan2(0, -1)
  print "time,lat,lon,alt"
  lat = (s + n) / 2; lon = (w + e) / 2
  reachLat = (n - s) * 0.45; reachLon = (e - w) * 0.45
  if (reachLat > 2) reachLat = 2
  if (reachLon > 3) reachLon = 3
  along = 3000 / (111200 * (reachLat + reachLon))   # radians a second
  for (t = 0; t <= minutes * 60; t += 2)
    printf "%d,%.7f,%.7f,%.1f\n", t, lat + reachLat * sin(along * t * 1.37), lon + reachLon * sin(along * t), 3500 + 1000 * sin(t / 40)
}' >"$out/track.csv"

"$bin/eyepoint" --headless --terrain "$terrain" --host "file://$out/track.csv" --redraw always --cache-gpu 48 \
  --cache-ram 48 --summary "$out/summary.json" --log-level warn "$@" &
eyepoint=$!
trap 'kill $eyepoint 2>/dev/null || true' EXIT
echo "seconds,rss_kib" >"$out/memory.csv"
began=$SECONDS
while kill -0 $eyepoint 2>/dev/null; do
  rss=$(sed -n 's/^VmRSS:[[:space:]]*\([0-9]*\) kB/\1/p' "/proc/$eyepoint/status" 2>/dev/null || true)
  [ -n "$rss" ] && echo "$((SECONDS - began)),$rss" >>"$out/memory.csv"
  [ $(((SECONDS - began) % 60)) -lt 5 ] && echo "$(((SECONDS - began) / 60)) min: ${rss:-0} KiB"
  sleep 5
done
wait $eyepoint
trap - EXIT
sed -n '/"\(frames\|missing_chunk_frames\|bytes_read\|peak_rss_bytes\)"/p' "$out/summary.json"

# The greatest of the second third and of the last.
awk -F, 'NR > 1 { seconds[NR] = $1; rss[NR] = $2; end = $1 }
END {
  for (i in rss) {
    if (seconds[i] > end * 2 / 3) { if (rss[i] > last) last = rss[i] }
    else if (seconds[i] > end / 3 && rss[i] > middle) middle = rss[i]
  }
  printf "memory: at most %d KiB in the second third, %d KiB in the last\n", middle, last
  exit last > middle * 1.05 && last > middle + 8192
}' "$out/memory.csv"
