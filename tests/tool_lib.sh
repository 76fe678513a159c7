# SPDX-License-Identifier: MIT
# Sourced by the tests of the tool: sh tool_X.sh TOOL FOLDER. Leaves the shell in the empty
# folder, with $tool to run.
set -eu
export LC_ALL=C
tests=$(cd "$(dirname "$0")" && pwd)
tool=$1
rm -rf "$2"
mkdir -p "$2"
cd "$2"

fail() {
    echo "FAILED: $*" >&2
    exit 1
}

# good WORDS...: the run succeeds and writes no error line. Output: stdout.txt, stderr.txt.
good() {
    code=0
    "$tool" "$@" >stdout.txt 2>stderr.txt || code=$?
    [ $code -eq 0 ] || { cat stderr.txt >&2; fail "exit code $code: crevice $*"; }
    if grep '^crevice: ' stderr.txt | grep -qv '^crevice: warning: '; then
        cat stderr.txt >&2
        fail "error line, but exit code 0: crevice $*"
    fi
}

# bad CODE PHRASE WORDS...: the run fails with this exit code and exactly one error line,
# which holds the phrase; nothing named out* or .* is there afterwards.
bad() {
    expected=$1
    phrase=$2
    shift 2
    code=0
    "$tool" "$@" >stdout.txt 2>stderr.txt || code=$?
    [ $code -eq "$expected" ] ||
        { cat stderr.txt >&2; fail "exit code $code, not $expected: crevice $*"; }
    lines=$(grep '^crevice: ' stderr.txt | grep -cv '^crevice: warning: ' || true)
    [ "$lines" -eq 1 ] ||
        { cat stderr.txt >&2; fail "$lines error lines, not one: crevice $*"; }
    grep '^crevice: ' stderr.txt | grep -v '^crevice: warning: ' | grep -q -- "$phrase" ||
        { cat stderr.txt >&2; fail "no \"$phrase\" in the error line: crevice $*"; }
    left=$(find . -name 'out*' -o -name '.?*' | head -n 3)
    [ -z "$left" ] || fail "left behind: $left: crevice $*"
}

# number NAME: a number of the last `compare --json`.
number() {
    sed -n "s/^[[:space:]]*\"$1\":[[:space:]]*\([-0-9.eE+]*\),\{0,1\}\$/\1/p" stdout.txt
}

# at_most VALUE LIMIT WHAT
at_most() {
    awk -v value="$1" -v limit="$2" 'BEGIN { exit !(value != "" && value + 0 <= limit) }' ||
        fail "$3 is $1, above $2"
}

at_least() {
    awk -v value="$1" -v limit="$2" 'BEGIN { exit !(value != "" && value + 0 >= limit) }' ||
        fail "$3 is $1, below $2"
}

# floats VALUE...: 32-bit little-endian floats of what a PFM needs here, on stdout.
floats() {
    for value in "$@"; do
        case $value in
        0) printf '\000\000\000\000' ;;
        1) printf '\000\000\200\077' ;;
        -1) printf '\000\000\200\277' ;;
        2) printf '\000\000\000\100' ;;
        inf) printf '\000\000\200\177' ;;
        -inf) printf '\000\000\200\377' ;;
        nan) printf '\000\000\300\177' ;;
        *) fail "no float: $value" ;;
        esac
    done
}

# pfm FILE WIDTH HEIGHT VALUE...
pfm() {
    file=$1
    printf 'Pf\n%d %d\n-1.0\n' "$2" "$3" >"$file"
    shift 3
    floats "$@" >>"$file"
}
