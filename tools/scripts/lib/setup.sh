# Shared by tools/demo and tools/check: installs what is missing, configures, builds.
# Sourced, with `set -euo pipefail` in force and the current folder anywhere.

leonav_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)

say() { printf '\n== %s\n' "$*"; }
fail() { printf '%s: %s\n' "$(basename "$0")" "$*" >&2; exit 1; }

# as_root COMMAND...: directly as root, otherwise through sudo.
as_root() {
  if [ "$(id -u)" = 0 ]; then "$@"
  elif command -v sudo >/dev/null; then sudo "$@"
  else fail "needs root or sudo to run: $*"
  fi
}

# install_packages NAME...: only those that are missing, so that a second run asks nothing.
install_packages() {
  local missing=() name
  for name in "$@"; do
    dpkg-query -W -f='${Status}' "$name" 2>/dev/null | grep -q 'ok installed' || missing+=("$name")
  done
  [ ${#missing[@]} -eq 0 ] && return
  command -v apt-get >/dev/null || fail "not a Debian system; install by hand: ${missing[*]}"
  say "Installing ${missing[*]}"
  as_root env DEBIAN_FRONTEND=noninteractive apt-get update -qq
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
}

# install_oracles: a Python with the independent decoders of test/oracle/requirements.txt in
# build/oracles, which the tests find by LEONAV_PYTHON; without it they say what they skip.
install_oracles() {
  local folder=$leonav_root/build/oracles list=$leonav_root/test/oracle/requirements.txt
  if [ -z "${LEONAV_PYTHON:-}" ]; then
    if ! cmp -s "$list" "$folder/installed.txt"; then
      say "Installing independent decoders from PyPI"
      rm -rf "$folder"
      if ! { (install_packages python3-venv) && /usr/bin/python3 -m venv "$folder" &&
             "$folder/bin/pip" install --quiet --disable-pip-version-check --no-deps --only-binary :all: -r "$list" &&
             cp "$list" "$folder/installed.txt"; }; then
        say "No independent decoders: PyPI could not be reached, or does not have them for this Python; the tests that need them are skipped"
        return
      fi
    fi
    export LEONAV_PYTHON=$folder/bin/python
  fi
}

leonav_build_packages=(g++ cmake ninja-build libeigen3-dev libboost-dev liblcm-dev liblcm-bin
                       libyaml-cpp-dev libspdlog-dev libceres-dev libssl-dev nettle-dev)
leonav_test_packages=(catch2)
leonav_live_packages=(gpsd gpsd-clients openssl)
leonav_package_packages=(lintian dpkg-dev file default-jdk-headless liblcm-java libjchart2d-java
                         python3-numpy python3-pandas python3-matplotlib python3-yaml python3-distributed)
leonav_fleet_packages=(python3-distributed python3-dask python3-cryptography python3-numpy python3-yaml)

# build PRESET [CMAKE_ARGUMENT...] [-- TARGET...]
build() {
  local preset=$1; shift
  local configure=() targets=()
  while [ $# -gt 0 ] && [ "$1" != -- ]; do configure+=("$1"); shift; done
  [ $# -lt 2 ] || targets=(--target "${@:2}")
  mkdir -p "$leonav_root/build"
  # One at a time: two that configure the same folder fail in each other's steps.
  local lock
  exec {lock}>"$leonav_root/build/$preset.lock"
  flock --nonblock "$lock" || { say "Waiting for another build of $preset"; flock "$lock"; }
  say "Building ($preset)"
  cmake -S "$leonav_root" --preset "$preset" "${configure[@]}" -B "$leonav_root/build/$preset" >"$leonav_root/build/$preset.configure.log" 2>&1 ||
    { cat "$leonav_root/build/$preset.configure.log" >&2; fail "configuration failed"; }
  (cd "$leonav_root" && cmake --build --preset "$preset" "${targets[@]}" -- --quiet) || fail "the build failed"
  exec {lock}>&-
}

# in_namespace COMMAND...: in a network namespace of its own, with LCM's multicast route on loopback.
in_namespace() {
  local enter=(unshare -n)
  unshare -n true 2>/dev/null || enter=(unshare -rn)
  "${enter[@]}" true 2>/dev/null ||
    fail "cannot make a network namespace here; run as root, or in a container with the capability SYS_ADMIN"
  "${enter[@]}" bash -c '
    ip link set lo up multicast on || exit 90
    ip route add 224.0.0.0/4 dev lo || exit 90
    exec "$@"' in_namespace "$@"
}
