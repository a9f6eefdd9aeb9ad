#!/usr/bin/env bash
# The Debian package has the programs, which run, and what belongs to them: tests/package.sh BUILD-FOLDER
set -euo pipefail
build=$1
for tool in cpack dpkg-shlibdeps dpkg-deb file; do
  command -v "$tool" >/dev/null || { echo "$tool is not there: no package is made"; exit 4; }
done
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cpack --config "$build/CPackConfig.cmake" -B "$folder" >"$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }
package=$(ls "$folder"/*.deb)
dpkg-deb -x "$package" "$folder/root"
status=0
fail() {
  echo "$*" >&2
  status=1
}
for program in "$build"/bin/eyepoint*; do
  name=$(basename "$program")
  "$folder/root/usr/bin/$name" --version | grep -q "^$name [0-9.]* (commit " || fail "$name: does not run"
  [ -s "$folder/root/usr/share/man/man1/$name.1" ] || [ -s "$folder/root/usr/share/man/man1/$name.1.gz" ] || fail "$name: no man page"
  [ -s "$folder/root/usr/share/bash-completion/completions/$name" ] || fail "$name: no completion"
done
for file in share/eyepoint/eyepoint.toml share/eyepoint/selector.toml share/eyepoint/channel-centre.toml share/applications/eyepoint.desktop \
  share/icons/hicolor/scalable/apps/eyepoint.svg share/doc/eyepoint/copyright share/doc/eyepoint/changelog.gz; do
  [ -s "$folder/root/usr/$file" ] || fail "$file is missing"
done
depends=$(dpkg-deb -f "$package" Depends)
for library in libvulkan1 libgdal32 libsqlite3-0; do
  [[ $depends == *"$library"* ]] || fail "it does not depend on $library: $depends"
done
# Completion: options from the program's own help, and the words that an option takes.
complete_with() {
  PATH="$build/bin:$PATH" bash -c 'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _eyepoint; echo "${COMPREPLY[*]}"' _ \
    "$folder/root/usr/share/bash-completion/completions/eyepoint" "$@"
}
[[ $(complete_with eyepoint --culling "") == *dynamic* ]] || fail "completion does not know --culling's words"
[[ $(complete_with eyepoint --log-level w) == warn ]] || fail "completion does not know --log-level's words"
[[ $(complete_with eyepoint --dist) == "--distance-map" ]] || fail "completion does not know --distance-map"
[[ $(complete_with eyepoint-bench com) == *compare* ]] || fail "completion does not know compare"
[[ $(complete_with eyepoint-bench compare --up) == "--update" ]] || fail "completion does not know --update"
[[ $(complete_with eyepoint-bake ver) == *verify* ]] || fail "completion does not know verify"
exit "$status"
