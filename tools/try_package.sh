#!/usr/bin/env bash
# Installs the Debian package on a bare Debian 12 of its own, uses every program there, and removes it again.
#   tools/try_package.sh [PACKAGE.deb [FOLDER]]     root; needs mmdebstrap and the network; some minutes
# Without PACKAGE one is made of build/release. FOLDER (default: a temporary one, removed at the end) is where the system
# lies; it is kept, and used again, where it is given.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
for tool in mmdebstrap cpack; do
  command -v "$tool" >/dev/null || { echo "try_package.sh: $tool is not there: apt install $tool" >&2; exit 1; }
done
[ "$(id -u)" -eq 0 ] || { echo "try_package.sh: a system in a folder wants root" >&2; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
package=${1:-}
if [ -z "$package" ]; then
  cpack --config build/release/CPackConfig.cmake -B "$work" >/dev/null
  package=$(ls "$work"/*.deb)
fi
root=${2:-$work/root}
[ -e "$root/etc/debian_version" ] || mmdebstrap --variant=minbase --mode=root bookworm "$root" http://deb.debian.org/debian

inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root DEBIAN_FRONTEND=noninteractive LANG=C.UTF-8 "$@"; }
step() { printf '\n== %s\n' "$*"; }
# What packages and their tools leave beside files of their own, and this script.
listed() { (cd "$root" && find . -xdev \( -path ./proc -o -path ./sys -o -path ./dev -o -path ./tmp -o -path ./var -o -path ./root \) -prune -o -print | sort); }

step "apt install"
mount -t proc proc "$root/proc" 2>/dev/null && trap 'umount "$root/proc"; rm -rf "$work"' EXIT
cp "$package" "$root/tmp/eyepoint.deb"
inside apt-get -qq update
inside apt-get -qq install -y --no-install-recommends ca-certificates >/dev/null 2>&1
mapfile -t depends < <(dpkg-deb -f "$package" Depends | tr ',' '\n' | sed 's/[(|].*//; s/ //g')
inside apt-get -qq install -y --no-install-recommends "${depends[@]}" mesa-vulkan-drivers fonts-dejavu-core man-db \
  desktop-file-utils bash-completion >/dev/null 2>&1
listed >"$work/before"
inside apt-get -qq install -y --no-install-recommends /tmp/eyepoint.deb >/dev/null 2>&1
dpkg-deb -f "$package" Package Version Depends Recommends

step "programs"
for program in eyepoint eyepoint-bake eyepoint-bench eyepoint-host eyepoint-panorama; do
  inside "$program" --version
  inside sh -c "ldd /usr/bin/$program | grep 'not found'" && { echo "$program lacks libraries" >&2; exit 1; }
  inside man -w "$program"
  inside bash -c "source /usr/share/bash-completion/completions/$program; complete -p $program" >/dev/null
done
inside desktop-file-validate /usr/share/applications/eyepoint.desktop
inside eyepoint --list-devices

step "demo terrain, a picture, a host, a panorama"
inside eyepoint-bake demo --out /root/.local/share/eyepoint/demo.eyt --log-level warn
inside eyepoint --headless --frames 10 --screenshot /root/picture.png --log-level warn
inside eyepoint --config /usr/share/eyepoint/eyepoint.toml --headless --frames 2 --log-level warn
inside sh -c 'eyepoint --headless --host native-fdm://127.0.0.1:15550 --duration 6 --redraw always --size 160x120 --summary /root/run.json --log-level warn &
  eyepoint-host --protocol native-fdm --to 127.0.0.1:15550 --scenario low-level --duration 5 --log-level warn >/dev/null; wait'
grep '"frames"' "$root/root/run.json"
inside eyepoint-panorama --at 36.7,128.4,+200 --out /root/panorama --width 720 --log-level warn
for file in picture.png panorama.png panorama.distance.tif panorama.peaks.csv; do
  [ -s "$root/root/$file" ] || { echo "try_package.sh: $file was not written" >&2; exit 1; }
done
ls -l "$root"/root/*.png

step "apt purge"
inside apt-get -qq purge -y eyepoint >/dev/null
listed >"$work/after"
if ! left=$(diff "$work/before" "$work/after"); then
  echo "try_package.sh: purge leaves or takes:" >&2
  echo "$left" >&2
  exit 1
fi
echo "purge leaves nothing"
