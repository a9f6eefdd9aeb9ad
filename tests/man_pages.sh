#!/usr/bin/env bash
# Every option of a program stands in its man page, and no other: tests/man_pages.sh FOLDER-OF-PROGRAMS
set -uo pipefail
bin=$1
cd "$(dirname "${BASH_SOURCE[0]}")/../docs/man" || exit
status=0
for program in eyepoint eyepoint-bake eyepoint-bench eyepoint-host eyepoint-panorama; do
  # bake's subcommands have their own help.
  help=$("$bin/$program" --help)
  [ "$program" = eyepoint-bake ] && for sub in info verify demo; do help+=$("$bin/$program" "$sub" --help); done
  offered=$(grep -oE -- '(^|[ ,])--[a-z][a-z-]+' <<<"$help" | tr -d ' ,' | sort -u)
  described=$(sed 's/\\-/-/g' "$program.1" | grep -oE -- '--[a-z][a-z-]+' | sort -u)
  if ! difference=$(diff <(echo "$offered") <(echo "$described")); then
    printf '%s: options (<) and man page (>) differ:\n%s\n' "$program" "$difference" >&2
    status=1
  fi
done
exit "$status"
