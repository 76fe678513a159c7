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
# Manual pages and completions are made by the tool when it is built for this machine.
for file in share/man/man1/crevice.1 share/man/man1/crevice-render.1 \
    share/bash-completion/completions/crevice share/zsh/site-functions/_crevice \
    share/fish/vendor_completions.d/crevice.fish; do
    [ -s "$work/prefix/$file" ] || { echo "FAILED: $file is not installed" >&2; exit 1; }
done
