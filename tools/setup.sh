#!/bin/sh
# Installs what building, testing and comparing needs; says nothing and does nothing where all of it is there.
# `setup.sh gate`: only what build/gate needs, for those who judge another code.
set -eu
packages="gcc gfortran make libc6-dev libjansson-dev librandom123-dev libgsl-dev libcunit1-dev lammps liblammps-dev openmpi-bin libopenmpi-dev pkg-config gnuplot-nox valgrind gcovr libxml2-utils jq yq perl python3 git"
[ "${1:-}" != gate ] || packages="gcc make libc6-dev libjansson-dev libgsl-dev gnuplot-nox"

missing=""
if command -v dpkg-query >/dev/null 2>&1; then
    for p in $packages; do
        dpkg-query -W -f='${Status}' "$p" 2>/dev/null | grep -q 'ok installed' || missing="$missing $p"
    done
else
    echo "setup: this system has no dpkg; install what corresponds to these Debian packages yourself:" >&2
    echo "  $packages" >&2
    exit 1
fi
[ -n "$missing" ] || { echo "setup: everything is here"; exit 0; }

root=""
[ "$(id -u)" = 0 ] || root=sudo
echo "setup: installing$missing"
$root apt-get update -qq
# shellcheck disable=SC2086
DEBIAN_FRONTEND=noninteractive $root apt-get install -y -qq --no-install-recommends $missing >/dev/null
echo "setup: done"
