#!/usr/bin/env bash
# Installs the Debian 12 packages that Eyepoint needs; does nothing, and touches no network, when all of them are there.
#   tools/install_dependencies.sh [run|test|fuzz]   run (default): build and fly; test: also build and run the tests;
#                                                   fuzz: build and run the fuzzers
set -euo pipefail
exec </dev/null # no question is ever asked, and a closed stdin is no obstacle

build_and_fly=(
  ccache cmake g++ ninja-build pkg-config
  glslang-tools libvulkan-dev mesa-vulkan-drivers spirv-tools
  catch2 fonts-dejavu-core libcairo2-dev libcli11-dev libeigen3-dev libexpected-dev libfmt-dev libgdal-dev libgeographiclib-dev libglfw3-dev libglm-dev
  libimgui-dev libmeshoptimizer-dev libspdlog-dev libsqlite3-dev libtomlplusplus-dev libzstd-dev nlohmann-json3-dev zlib1g-dev
  ffmpeg # films of flights; eyepoint flies without it
)
tests_only=(
  clang-format clang-tidy shellcheck # the house style
  dpkg-dev file                      # the Debian package
  sqlite3                            # damages databases on purpose
  tshark                             # judges the packets that are sent
  vulkan-validationlayers
  xauth xvfb # a display for the window's tests
)
fuzz_only=(
  clang libclang-rt-14-dev # libFuzzer
)

case "${1:-run}" in
  run) packages=("${build_and_fly[@]}") ;;
  test) packages=("${build_and_fly[@]}" "${tests_only[@]}") ;;
  fuzz) packages=("${build_and_fly[@]}" "${fuzz_only[@]}") ;;
  *)
    echo "install_dependencies.sh: '$1' is none of run, test and fuzz" >&2
    exit 2
    ;;
esac

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  echo "install_dependencies.sh: this is no Debian; install the likes of these yourself, then use cmake: ${packages[*]}" >&2
  exit 1
fi

installed=$(dpkg-query --show --showformat='${db:Status-Status} ${Package}\n' "${packages[@]}" 2>/dev/null || true)
missing=()
for package in "${packages[@]}"; do
  grep -qxF "installed $package" <<<"$installed" || missing+=("$package")
done
if [ "${#missing[@]}" -eq 0 ]; then
  echo "Packages: all ${#packages[@]} are installed."
  exit 0
fi

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "install_dependencies.sh: packages are missing and there is no sudo; run as root: apt-get install ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi

# apt's own words are of interest only when it fails.
log=$(mktemp)
trap 'rm -f "$log"' EXIT
quietly() {
  if ! "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive "$@" >"$log" 2>&1; then
    tail -n 20 "$log" >&2
    echo "install_dependencies.sh: '$*' failed; its last words are above" >&2
    exit 1
  fi
}
echo "Packages: installing ${missing[*]} (once, some minutes) ..."
quietly apt-get -qq update
quietly apt-get -qq install -y --no-install-recommends "${missing[@]}"
echo "Packages: done."
