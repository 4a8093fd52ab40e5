# Sourced by tools/run, tools/test and others: installs what is missing on Debian 12, configures and builds presets. Quick when nothing is to do.
# shellcheck shell=bash
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

say() { printf '== %s\n' "$*"; }

# install_packages NAME...: those that are missing
install_packages() {
  local missing=() package
  for package in "$@"; do
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)" = installed ] || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "these packages are missing and neither root nor sudo is at hand: ${missing[*]}" >&2; exit 1; }
    as_root=(sudo)
  fi
  say "installing ${missing[*]}"
  "${as_root[@]}" apt-get -qq update
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq install -y --no-install-recommends "${missing[@]}" >/dev/null
}

# install_for_tests PART: what tools/packages-test.txt lists for that part of the tests
install_for_tests() {
  local part package stand_in wanted=()
  while read -r part package stand_in _; do
    if [ "$part" = "$1" ] && ! command -v "$stand_in" >/dev/null; then wanted+=("$package"); fi
  done < <(sed 's/#.*//' tools/packages-test.txt)
  [ ${#wanted[@]} -eq 0 ] || install_packages "${wanted[@]}"
}

# build PRESET [TARGET...]: configures (again only if CMake asks for it) and builds with all cores
build() {
  local preset=$1 folder=build launcher=()
  shift
  [ "$preset" = release ] || folder=build/$preset
  say "building preset $preset in $folder"
  if [ ! -f "$folder/build.ninja" ]; then
    command -v ccache >/dev/null && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
    cmake --preset "$preset" "${launcher[@]}" >"/tmp/sunfleck-configure.$$" 2>&1 || { cat "/tmp/sunfleck-configure.$$" >&2; rm -f "/tmp/sunfleck-configure.$$"; exit 1; }
    rm -f "/tmp/sunfleck-configure.$$"
  fi
  if [ $# -gt 0 ]; then cmake --build "$folder" --target "$@"; else cmake --build "$folder"; fi
}

# shellcheck disable=SC2046  # one word a package
install_packages $(sed 's/#.*//' tools/packages.txt)
