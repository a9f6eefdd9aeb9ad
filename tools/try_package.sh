#!/usr/bin/env bash
# Installs the Debian package on a bare Debian 12 of its own, uses every program there, and removes it again.
#   tools/try_package.sh [PACKAGE.deb [FOLDER]]     root; needs mmdebstrap, lintian and the network; some minutes
# Without PACKAGE one is made of build/release. FOLDER (default: a temporary one, removed at the end) is where the system
# lies; it is kept, and used again, where it is given.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
die() {
  echo "try_package.sh: $*" >&2
  exit 1
}
for tool in mmdebstrap lintian cpack; do
  command -v "$tool" >/dev/null || die "$tool is not there: apt install $tool"
done
[ "$(id -u)" -eq 0 ] || die "a system in a folder wants root"
work=$(mktemp -d)
root=${2:-$work/root}
# Not over a mounted /proc.
clean() {
  ! mountpoint -q "$root/proc" || umount "$root/proc" || return
  rm -rf --one-file-system "$work"
}
trap clean EXIT
package=${1:-}
if [ -z "$package" ]; then
  cmake build/release >/dev/null  # or --version says the commit of the configuration before
  cmake --build build/release --target eyepoint eyepoint-bake eyepoint-bench eyepoint-host eyepoint-panorama eye_package_files
  cpack --config build/release/CPackConfig.cmake -B "$work" >/dev/null
  package=$(ls "$work"/*.deb)
fi

step() { printf '\n== %s\n' "$*"; }
inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/tmp/trial DEBIAN_FRONTEND=noninteractive LANG=C.UTF-8 "$@"; }
install() { inside apt-get -qq install -y --no-install-recommends "$@" >"$work/apt.log" 2>&1 || { cat "$work/apt.log"; die "apt fails"; }; }
# But for what packages and their tools leave beside files of their own, drivers in root's home, and this script.
listed() { (cd "$root" && find . -xdev \( -path ./proc -o -path ./sys -o -path ./dev -o -path ./tmp -o -path ./var/cache -o -path ./var/log -o -path './var/lib/dpkg/*-old' -o -path ./root \) -prune -o -print | sort); }
written() {
  local file
  for file in "$@"; do [ -s "$root/tmp/trial/$file" ] || die "$file was not written"; done
}

step "lintian"
lintian --fail-on error,warning "$package" 2>/dev/null || die "lintian complains"
dpkg-deb -f "$package" Package Version Depends Recommends

step "apt install"
[ -e "$root/etc/debian_version" ] || mmdebstrap --variant=minbase --mode=root bookworm "$root" http://deb.debian.org/debian
mountpoint -q "$root/proc" || mount -t proc proc "$root/proc"
cp "$package" "$root/tmp/eyepoint.deb"
inside apt-get -qq update
mapfile -t depends < <(dpkg-deb -f "$package" Depends | tr ',' '\n' | sed 's/[(|].*//; s/ //g')
install ca-certificates "${depends[@]}" mesa-vulkan-drivers fonts-dejavu-core man-db desktop-file-utils bash-completion
# What a run before left.
inside apt-get -qq purge -y eyepoint >/dev/null 2>&1 || true
rm -rf "$root/tmp/trial"
mkdir "$root/tmp/trial"
listed >"$work/before"
install /tmp/eyepoint.deb

step "programs, their pages and completion"
# Bash looks completions up as its users' do: by the program's name, when that is first completed.
cat >"$root/tmp/complete.sh" <<'END'
source /usr/share/bash-completion/bash_completion
_completion_loader "$1"
COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
_eyepoint && echo "${COMPREPLY[*]}"
END
for program in eyepoint eyepoint-bake eyepoint-bench eyepoint-host eyepoint-panorama; do
  inside "$program" --version
  ! inside ldd "/usr/bin/$program" | grep 'not found' || die "$program lacks libraries"
  inside man "$program" | grep -q '^SYNOPSIS' || die "$program has no page (slim images of Debian leave them out: path-exclude in dpkg.cfg.d)"
  [[ $(inside bash /tmp/complete.sh "$program" --ver) == *--version* ]] || die "bash does not complete $program"
done
[ "$(inside bash /tmp/complete.sh eyepoint --culling d)" = dynamic ] || die "bash does not complete --culling"
inside desktop-file-validate /usr/share/applications/eyepoint.desktop
inside eyepoint --list-devices

step "demo terrain and a picture"
inside eyepoint-bake demo --log-level warn
inside eyepoint --headless --offline --frames 10 --screenshot /tmp/trial/picture.png --log-level warn
inside eyepoint --config /usr/share/eyepoint/eyepoint.toml --headless --frames 2 --log-level warn
written picture.png

step "a raster of one's own"
# shellcheck disable=SC2016  # Perl's variables
inside perl -e 'for $y (0..1200) { print pack("s>*", map { 1500 + 900 * sin($_ / 60) * sin($y / 40) } 0..1200) }' >"$root/tmp/trial/N46E007.hgt"
inside eyepoint-bake --elevation /tmp/trial/N46E007.hgt --region 7.4,46.4,7.6,46.6 --out /tmp/trial/mine.eyt --log-level warn
inside eyepoint-bake verify /tmp/trial/mine.eyt
inside eyepoint --terrain /tmp/trial/mine.eyt --pose 46.4,7.5,3500,0,-10,0 --headless --screenshot /tmp/trial/mine.png --distance-map /tmp/trial/mine.tif --log-level warn
written mine.png mine.tif

step "a host over loopback"
inside sh -c 'eyepoint --headless --host native-fdm://127.0.0.1:15550 --duration 6 --size 160x120 --stats /tmp/trial/run.jsonl --log-level warn &
  eyepoint-host --protocol native-fdm --to 127.0.0.1:15550 --scenario low-level --duration 5 --log-level warn >/dev/null; wait'
tail -n 1 "$root/tmp/trial/run.jsonl" | grep -oE '"packets": *[0-9]{3,}' || die "the host's packets did not arrive"

step "a panorama"
inside eyepoint-panorama --at 36.7,128.4,+200 --out /tmp/trial/panorama --width 720 --log-level warn
written panorama.png panorama.distance.tif panorama.peaks.csv
ls -l "$root"/tmp/trial/*.png

step "apt purge"
inside apt-get -qq purge -y eyepoint >"$work/apt.log" 2>&1 || { cat "$work/apt.log"; die "purge fails"; }
listed >"$work/after"
diff "$work/before" "$work/after" || die "purge leaves or takes these"
echo "purge leaves nothing"
