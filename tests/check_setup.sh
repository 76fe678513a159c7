#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# How ./demo and ./check look for packages and install them, in front of a stage set: a
# PATH with stand-ins for dpkg-query, apt-get, sudo and id. Usage: check_setup.sh ROOT
set -uo pipefail
root=$(cd -- "$1" && pwd) || exit 2
stage=$(mktemp -d) || exit 1
trap 'rm -rf "$stage"' EXIT
failed=0
passed=0

# What the script may use of the real system.
mkdir "$stage/tools"
for tool in bash sh sed sort tr head cat env true; do
    ln -s "$(type -P "$tool")" "$stage/tools/$tool"
done

stand_in()
{
    printf '#!/bin/sh\n%s\n' "$2" >"$stage/bin/$1"
    chmod +x "$stage/bin/$1"
}

# set_up: a Debian without root, sudo or any package.
set_up()
{
    rm -rf "${stage:?}/bin" "${stage:?}/log"
    mkdir "$stage/bin"
    : >"$stage/log"
    stand_in dpkg-query 'exit 1'
    stand_in apt-get "echo \"apt-get \$*\" >>'$stage/log'"
    stand_in apt-cache 'exit 1'
    stand_in id 'echo 1000'
}

# install NEEDS: runs needs_install on the stage; output in $stage/out, status in $status.
install()
{
    PATH=$stage/bin:$stage/tools bash -c '. "$1"; needs_install "$2"' - \
        "$root/cmake/setup.sh" "$1" >"$stage/out" 2>&1 </dev/null
    status=$?
}

# expect WHAT STATUS [FILE LINE]...: the exit status, and lines that must be in files.
expect()
{
    local what=$1 good=yes
    [ "$status" -eq "$2" ] || good=
    shift 2
    while [ $# -gt 0 ]; do
        grep -qxF -- "$2" "$stage/$1" || good=
        shift 2
    done
    if [ -n "$good" ]; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        echo "failed: $what (exit $status)"
        cat "$stage/out" "$stage/log"
    fi
}

needs='
cc-x  package-of-cc
-     libx-dev
'
line='apt-get install -y --no-install-recommends libx-dev package-of-cc'
logged='apt-get -q install -y --no-install-recommends libx-dev package-of-cc'

set_up
install "$needs"
expect 'without root and sudo: the command for su' 1 \
    out "  su -c 'apt-get update && $line'"

set_up
stand_in sudo 'exit 1'
install "$needs"
expect 'with a sudo that asks and nobody to answer: the command' 1 \
    out "  sudo apt-get update && sudo $line"

set_up
stand_in sudo '[ "$1" = -n ] && shift; exec "$@"'
install "$needs"
expect 'with a sudo that does not ask: installed' 0 log 'apt-get -q update' log "$logged"

set_up
stand_in id 'echo 0'
install "$needs"
expect 'as root: installed' 0 log 'apt-get -q update' log "$logged"

set_up
stand_in id 'echo 0'
stand_in apt-get 'case "$*" in *install*) exit 100 ;; esac'
install "$needs"
expect 'a package that does not exist: said so' 1 \
    out 'This release has no package named libx-dev.' \
    out "  apt-get update && $line"

set_up
stand_in dpkg-query 'echo installed'
stand_in cc-x ''
install "$needs"
expect 'nothing missing: nothing done' 0
if [ -s "$stage/log" ] || [ -s "$stage/out" ]; then
    echo 'failed: nothing missing, and yet something was done or said'
    failed=$((failed + 1))
fi

set_up
stand_in dpkg-query 'echo config-files'
stand_in cc-x ''
install "$needs"
expect 'a package that was removed is missing' 1 \
    out "  su -c 'apt-get update && apt-get install -y --no-install-recommends libx-dev'"

set_up
rm "$stage/bin/dpkg-query"
install "$needs"
expect 'no Debian: what is missing' 1 \
    out '  cc-x (Debian package package-of-cc)' out '  OpenEXR with its headers' \
    out '  Embree 3 or 4 with its headers'

set_up
rm "$stage/bin/apt-get"
stand_in cc-x ''
stand_in pkg-config ''
stand_in gcc ''
install "$needs"
expect 'no Debian, and all there' 0

set_up
"$root/demo" --sideways >"$stage/out" 2>&1
status=$?
expect 'demo with an unknown option' 2 out 'demo: unknown option --sideways'
(cd "$stage" && "$root/demo" 'no such.glb') >"$stage/out" 2>&1
status=$?
expect 'demo without its model' 1 \
    out 'demo: no such.glb: no such file; name a mesh, or nothing for the built-in scene'
"$root/check" --sideways >"$stage/out" 2>&1
status=$?
expect 'check with an unknown argument' 2 out 'check: unknown argument --sideways'

echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
