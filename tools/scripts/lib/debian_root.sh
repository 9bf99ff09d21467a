# Clean systems of Debian in folders, for tools/package and tools/validate package. Sourced after setup.sh; needs root.

leonav_release=$(. /etc/os-release && echo "${VERSION_CODENAME:-}")

# bootstrap_root RELEASE ROOT [PACKAGE...]: from the mirror that apt takes this machine's own release from.
bootstrap_root() {
  local release=$1 root=$2 include=() mirror
  shift 2
  [ $# -eq 0 ] || include=(--include="$(IFS=,; echo "$*")")
  mirror=$(apt-get indextargets --format '$(CODENAME) $(REPO_URI)' 'Created-By: Packages' |
    awk -v own="$leonav_release" '$1 == own { print $2; exit }')
  [ -n "$mirror" ] || { echo "apt has no source for $leonav_release; see apt-get indextargets"; return 1; }
  rm -rf --one-file-system "$root"
  mkdir -p "$root"
  debootstrap --variant=minbase "${include[@]}" "$release" "$root" "$mirror" || return 1
  echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/unsafe"  # nothing here outlives a crash
}

# in_root ROOT COMMAND...: without its systemd, with the network of this machine.
in_root() {
  local root=$1
  shift
  systemd-nspawn --quiet --register=no --keep-unit --pipe -D "$root" "$@"
}
