#!/bin/sh
# SPDX-License-Identifier: MIT
# Builds the Debian packages from the sources as git tracks them, in a folder of its own.
# Usage: build_deb.sh OUT; needs debhelper and what debian/control names. Nothing in the
# source tree changes.
set -eu
if [ $# -ne 1 ]; then
    echo "usage: build_deb.sh OUT" >&2
    exit 2
fi
root=$(cd -- "$(dirname -- "$0")/.." && pwd)
mkdir -p "$1"
out=$(cd -- "$1" && pwd)
rm -rf "$out/crevice"
mkdir "$out/crevice"
(cd "$root" && git ls-files -z | tar --null -T - -cf -) | tar -xf - -C "$out/crevice"
cd "$out/crevice"
home=$(sed -n 's/^set(CREVICE_HOMEPAGE "\(.*\)")$/\1/p' CMakeLists.txt)
cp -r packaging/debian debian
sed -i "s|@HOMEPAGE@|$home|" debian/control debian/copyright
dpkg-buildpackage -us -uc -b -ui
