#!/usr/bin/env bash
# Every option of a program stands in its man page and in docs/OPTIONS.md, and no other: tests/man_pages.sh FOLDER-OF-PROGRAMS
set -uo pipefail
bin=$(realpath "$1")
cd "$(dirname "${BASH_SOURCE[0]}")/../docs" || exit
status=0
differ() { # PROGRAM WHERE OFFERED DESCRIBED
  local difference
  difference=$(diff <(echo "$3") <(echo "$4")) && return
  printf '%s: options (<) and %s (>) differ:\n%s\n' "$1" "$2" "$difference" >&2
  status=1
}
for program in eyepoint eyepoint-bake eyepoint-bench eyepoint-host eyepoint-panorama; do
  # Subcommands have their own help.
  help=$("$bin/$program" --help)
  [ "$program" = eyepoint-bake ] && for sub in info verify demo; do help+=$("$bin/$program" "$sub" --help); done
  [ "$program" = eyepoint-bench ] && for sub in compare plots; do help+=$("$bin/$program" "$sub" --help); done
  offered=$(grep -oE -- '(^|[ ,])--[a-z][a-z-]+' <<<"$help" | tr -d ' ,' | sort -u)
  differ "$program" "its man page" "$offered" "$(sed 's/\\-/-/g' "man/$program.1" | grep -oE -- '--[a-z][a-z-]+' | sort -u)"
  # A row an option; its example is of that option.
  rows=$(sed -n "/^## $program\$/,/^## /s/^| \`\(--[a-z-]*\)\` |/\1/p" OPTIONS.md)
  differ "$program" "docs/OPTIONS.md" "$offered" "$(cut -d ' ' -f 1 <<<"$rows" | sort -u)"
  while read -r option example; do
    [[ $example == *"$option"* ]] || { echo "docs/OPTIONS.md: $program: the example of $option does not have it" >&2; status=1; }
  done <<<"$rows"
done
exit "$status"
