#!/usr/bin/env bash
# The house style, checked: clang-format, the rules of tests/rules.sh, shellcheck, clang-tidy.
#   tools/lint.sh [--all]     clang-tidy over the modules that read foreign data, or over every source (many minutes)
# clang-tidy reads build/release/compile_commands.json: configure with tests first.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# Headers that only shaders include are GLSL, which clang-format does not know.
mapfile -t sources < <({ find src tests tools -name '*.h' -o -name '*.cpp'; grep -L 'GLSL only' shaders/shared/*.h; } | sort)
mapfile -t scripts < <(find tools tests -name '*.sh' | sort)
scripts+=(.ci/run)

echo "Lint: clang-format, ${#sources[@]} files"
clang-format --dry-run --Werror "${sources[@]}"
echo "Lint: shellcheck, ${#scripts[@]} scripts"
shellcheck "${scripts[@]}"
echo "Lint: rules of the house"
tests/rules.sh

# The modules that read what strangers wrote: two minutes on two cores, where every source takes ten.
modules='base|link|terrain'
[ "${1:-}" = "--all" ] && modules='[a-z]+'
mapfile -t tidied < <(printf '%s\n' "${sources[@]}" | grep -E "^src/($modules)/.*\.cpp$")
echo "Lint: clang-tidy, ${#tidied[@]} files"
# gcc's precompiled headers are no food for clang: their flags are taken out of a copy of the compilation database.
database=build/lint
mkdir -p "$database"
sed -E 's/ -Winvalid-pch//g; s/ -include [^ ]*cmake_pch\.hxx//g' build/release/compile_commands.json >"$database/compile_commands.json"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
if ! printf '%s\0' "${tidied[@]}" | xargs -0 -n 1 -P "$(nproc)" clang-tidy --quiet -p "$database" >"$log" 2>/dev/null; then
  cat "$log"
  echo "lint.sh: clang-tidy has objections; they are above" >&2
  exit 1
fi
echo "Lint: clean"
