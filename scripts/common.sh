# Shared by the scripts next to it; to be sourced. Changes to the project's root; `caller` is the
# folder from which the script was called.
set -euo pipefail
caller=$PWD
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"

say() { printf '\n==> %s\n' "$*"; }

# fail MESSAGE: prints what to do, and exits.
fail() {
  printf '\n%s: %s\n' "$(basename "$0")" "$*" >&2
  exit 1
}

# install_packages LIST…: installs the missing Debian packages named in the files. npm may have come
# with Node.js instead of as a separate package, and the two exclude each other.
install_packages() {
  command -v dpkg-query >/dev/null || fail "this script installs Debian packages; elsewhere, install the packages listed in $* and build with: cmake --preset release && cmake --build --preset release"
  local missing=() package
  while read -r package; do
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] ||
      { [ "$package" = npm ] && command -v npm >/dev/null; } ||
      missing+=("$package")
  done < <(sed 's/#.*//; /^[[:space:]]*$/d' "$@")
  if [ ${#missing[@]} -eq 0 ]; then
    say "All Debian packages are there"
    return
  fi
  say "Installing missing Debian packages: ${missing[*]}"
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || fail "run this as root, or first: apt-get install ${missing[*]}"
    as_root=(sudo)
  fi
  local log
  log=$(mktemp)
  if ! { "${as_root[@]}" apt-get update &&
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
      apt-get install -y --no-install-recommends "${missing[@]}"; } >"$log" 2>&1; then
    tail -n 15 "$log" >&2
    fail "apt-get could not install them; its log is $log"
  fi
  rm -f "$log"
}

# remember_objects: lets subsequent builds reuse objects compiled from the same sources with the
# same options in any folder, by ccache if it is installed.
remember_objects() {
  command -v ccache >/dev/null || return 0
  export CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache
  # Paths relative to the build folder. The hash covers the preprocessed source, which includes the
  # text of the precompiled headers: batches name their sources by absolute paths, and precompiling
  # the same header never gives the same bytes.
  export CCACHE_BASEDIR=$root CCACHE_NOHASHDIR=1 CCACHE_NODIRECT=1 CCACHE_PCH_EXTSUM=1
  export CCACHE_SLOPPINESS=pch_defines,time_macros
}

# name_precompiled PRESET: the names by which ccache knows a build's precompiled headers, for GCC
# and Clang.
name_precompiled() {
  local header
  while read -r header; do
    echo "$1" | tee "$header.gch.sum" >"$header.pch.sum"
  done < <(find "build/$1" -name cmake_pch.hxx)
}

# build PRESET [options of cmake --build]: configures and builds a preset of CMakePresets.json.
build() {
  say "Building the preset '$1' into build/$1"
  remember_objects
  mkdir -p build
  cmake --preset "$1" >"build/$1.log" 2>&1 || {
    tail -n 25 "build/$1.log" >&2
    fail "cmake could not configure; see build/$1.log, or remove build/$1 and try again"
  }
  name_precompiled "$1"
  cmake --build --preset "$1" "${@:2}" -- --quiet ||
    fail "the build failed; the compiler's first error is above"
}
