#!/usr/bin/env bash
# Bakes in N processes side by side and joins what they made: tools/bake_shards.sh N OUT.eyt OPTIONS-OF-EYEPOINT-BAKE...
# Killed, the same command goes on. EYEPOINT_BAKE names another program.
set -euo pipefail
if [ $# -lt 3 ] || ! [[ $1 =~ ^[1-9][0-9]*$ ]]; then
  echo "usage: $0 N OUT.eyt OPTIONS-OF-EYEPOINT-BAKE..." >&2
  exit 2
fi
count=$1 out=$2
shift 2
bake=${EYEPOINT_BAKE:-$(dirname "${BASH_SOURCE[0]}")/../build/release/bin/eyepoint-bake}
[ -e "$out" ] && { echo "$0: $out exists already; delete it first" >&2; exit 2; }

processes=() parts=()
for index in $(seq "$count"); do
  parts+=("$out.part$index")
  "$bake" "$@" --shard "$index/$count" --out "$out.part$index" --resume &
  processes+=($!)
done
trap 'kill "${processes[@]}" 2>/dev/null || true' EXIT
status=0
for process in "${processes[@]}"; do wait "$process" || status=$?; done
trap - EXIT
[ "$status" = 0 ] || { echo "$0: a shard failed, see above; repeat the command to go on" >&2; exit "$status"; }
"$bake" merge "$out" "${parts[@]}"
rm -f "${parts[@]}"
