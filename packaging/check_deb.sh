#!/bin/sh
# SPDX-License-Identifier: MIT
# Builds the Debian packages, checks them with lintian, unpacks them into an empty folder and
# uses what is there: the tool, the Python module, a host in C by pkg-config. With
# --clean-root it installs them with apt into a new system (debootstrap) instead and renders
# the scene of ./demo there. Usage: check_deb.sh OUT [--clean-root]
set -eu
clean_root=${2-}
case $#:$clean_root in
1: | 2:--clean-root) ;;
*)
    echo "usage: check_deb.sh OUT [--clean-root]" >&2
    exit 2
    ;;
esac
root=$(cd -- "$(dirname -- "$0")/.." && pwd)
mkdir -p "$1"
out=$(cd -- "$1" && pwd)
rm -rf "$out"/*.deb "$out/root"

# Nothing here waits for results: -O1 is compiled in half the time.
DEB_CFLAGS_APPEND=-O1
export DEB_CFLAGS_APPEND

echo "-- dpkg-buildpackage"
"$root/packaging/build_deb.sh" "$out" >"$out/build.log" 2>&1 \
    || { tail -40 "$out/build.log" >&2; exit 1; }

echo "-- lintian"
lintian --fail-on error "$out"/*.changes

if [ -n "$clean_root" ]; then
    echo "-- a clean root"
    debootstrap --variant=minbase bookworm "$out/root" >"$out/debootstrap.log"
    cp "$out"/*.deb "$out/root/tmp/"
    chroot "$out/root" sh -c 'apt-get -qq update && apt-get -qq install -y \
        --no-install-recommends $(ls /tmp/*.deb | grep -v dbgsym)' >"$out/install.log" 2>&1
    chroot "$out/root" crevice render builtin:courtyard -o /tmp/ao.png --size 640x360
    chroot "$out/root" crevice view --help | grep -q 'crevice view INPUT'
    chroot "$out/root" python3 -c 'import crevice, numpy
print(crevice.ao(numpy.full((8, 8), 2.0), vfov=60, radius=1).mean())'
    ls -l "$out/root/tmp/ao.png"
    exit 0
fi

echo "-- unpacked and used"
for package in "$out"/*.deb; do
    dpkg-deb -x "$package" "$out/root"
done
libraries=$(dirname "$(find "$out/root" -name 'libcrevice.so.0.1')")
LD_LIBRARY_PATH=$libraries
export LD_LIBRARY_PATH
"$out/root/usr/bin/crevice" render builtin:courtyard -o "$out/ao.png" --size 160x90 -q
[ -s "$out/ao.png" ]
"$out/root/usr/bin/crevice" view --help | grep -q 'crevice view INPUT'
PYTHONPATH=$out/root/usr/lib/python3/dist-packages /usr/bin/python3 -c 'import crevice, numpy
assert abs(crevice.ao(numpy.full((8, 8), 2.0), vfov=60, radius=1) - 1).max() < 1e-3'
PKG_CONFIG_PATH=$libraries/pkgconfig PKG_CONFIG_SYSROOT_DIR=
export PKG_CONFIG_PATH PKG_CONFIG_SYSROOT_DIR
# shellcheck disable=SC2046 # words
cc -std=c11 "$root/tests/consumer_cmake/main.c" -o "$out/host" $(pkg-config --cflags --libs crevice)
"$out/host"
for page in crevice crevice-ao crevice-render; do
    [ -s "$out/root/usr/share/man/man1/$page.1.gz" ]
done
echo "packages: built, clean, used"
