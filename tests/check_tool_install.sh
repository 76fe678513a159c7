#!/bin/sh
# SPDX-License-Identifier: MIT
# The installed tool runs from wherever its tree was moved to.
# Usage: check_tool_install.sh BUILD WORK
set -eu
build=$1 work=$2
rm -rf "$work"
mkdir -p "$work"
cmake --install "$build" --prefix "$work/first" >/dev/null
mv "$work/first" "$work/prefix"
"$work/prefix/bin/crevice" --version
