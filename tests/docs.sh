#!/usr/bin/env bash
# What README.md and docs/ name is in the tree: links with their headings, and files in backquotes. Prints what is not.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit
status=0
lacks() {
  echo "$1: there is no $2" >&2
  status=1
}
# A heading as links name it: small letters, dashes for spaces, nothing else but letters and digits.
anchors() { sed -n 's/^##* //p' "$1" | tr '[:upper:] ' '[:lower:]-' | sed 's/[^a-z0-9_-]//g'; }
# Files are named from the root, from src, or by their last parts alone.
known() {
  [ -e "$1" ] || [ -e "src/$1" ] || compgen -G "$1" >/dev/null ||
    [ -n "$(find README.md CMake* src shaders tests tools config docs assets -path "*/$1" -print -quit)" ]
}

for page in README.md docs/*.md; do
  while read -r link; do
    file=$(dirname "$page")/${link%%#*}
    [ -n "${link%%#*}" ] || file=$page
    [ -e "$file" ] || { lacks "$page" "$link" && continue; }
    [[ $link != *#* ]] || anchors "$file" | grep -qx -- "${link#*#}" || lacks "$page" "$link"
  done < <(grep -oE '\]\([^) ]+\)' "$page" | sed 's/^](//; s/)$//' | grep -v '^https\?:')
  # shellcheck disable=SC2016  # backquotes
  while read -r name; do
    known "$name" || lacks "$page" "$name"
  done < <(grep -oE '`[A-Za-z0-9_./*-]+`' "$page" | tr -d '`' | sort -u |
    grep -E '^(src|shaders|tests|tools|config|docs|assets)/|\.(h|cpp|vert|frag|comp|sh|cmake)$')
done
exit "$status"
