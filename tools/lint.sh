#!/usr/bin/env bash
# The house style, checked: clang-format, the rules of tests/rules.sh, shellcheck, clang-tidy.
#   tools/lint.sh [--all]     clang-tidy over the modules that read foreign data, without its analyzer, which takes as long as
#                             all else and follows paths that the fuzzers walk too; or everything over every source (many minutes)
# clang-tidy reads build/release/compile_commands.json: configure with tests first. A file that was clean is not looked at
# again before it, a header that it includes, its flags, the checks or clang-tidy have changed; what is remembered lies in
# $XDG_CACHE_HOME/eyepoint/tidy (else ~/.cache), for every clone of this user.
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

# The modules that read what strangers wrote.
modules='base|link|terrain' checks='-clang-analyzer-*'
[ "${1:-}" = "--all" ] && modules='[a-z]+' checks=''
mapfile -t candidates < <(printf '%s\n' "${sources[@]}" | grep -E "^src/($modules)/.*\.cpp$")
# gcc's precompiled headers are no food for clang: their flags are taken out of a copy of the compilation database.
database=build/lint
remembered=${XDG_CACHE_HOME:-$HOME/.cache}/eyepoint/tidy
mkdir -p "$database" "$remembered"
sed -E 's/ -Winvalid-pch//g; s/ -include [^ ]*cmake_pch\.hxx//g' build/release/compile_commands.json >"$database/compile_commands.json"
common=$({ clang-tidy --version; cat .clang-tidy; echo "$checks"; } | sha256sum)

# What clang-tidy's verdict on a source hangs on, as one number: the source and its headers as the last build has seen
# them, and its flags. Nothing where it has not been built.
key_of() {
  local source=$1 module includes
  module=$(cut -d / -f 2 <<<"$source")
  includes=$(ninja -C build/release -t deps "CMakeFiles/eye_$module.dir/$source.o" 2>/dev/null | sed -n 's/^    //p' | grep -v '/usr/')
  [ -n "$includes" ] || return 0
  {
    echo "$common"
    grep -F -- "-c $PWD/$source\"" "$database/compile_commands.json" | sed "s|$PWD||g"
    (cd build/release && xargs cat <<<"$includes")
  } | sha256sum | cut -d ' ' -f 1
}

# clang-tidy on one source; remembers that it was clean.
tidy() {
  local source=$1 key=$2
  clang-tidy --quiet --checks="$checks" -p "$database" "$source" 2>/dev/null || return 1
  if [ -n "$key" ]; then touch "$remembered/$key"; fi
}
export -f tidy
export database remembered checks

todo=()
for source in "${candidates[@]}"; do
  key=$(key_of "$source")
  [ -n "$key" ] && [ -e "$remembered/$key" ] || todo+=("$source" "$key")
done
echo "Lint: clang-tidy, ${#candidates[@]} files, $((${#todo[@]} / 2)) of them new or changed"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
# shellcheck disable=SC2016  # the arguments are the inner shell's
if [ "${#todo[@]}" -gt 0 ] && ! printf '%s\0' "${todo[@]}" | xargs -0 -n 2 -P "$(nproc)" bash -c 'tidy "$1" "$2"' _ >"$log"; then
  cat "$log"
  echo "lint.sh: clang-tidy has objections; they are above" >&2
  exit 1
fi
echo "Lint: clean"
