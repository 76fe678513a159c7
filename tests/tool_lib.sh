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

# Long work ends at a signal within a second. A busy machine stretches that second, so what
# counts is the processor's time that the tool takes after the signal: it waits for nothing
# but the disk. Sanitizers slow it down.
most=1
[ -z "${TSAN_OPTIONS:-}${ASAN_OPTIONS:-}" ] || most=8

# Processor's time of a running process, in seconds.
time_of() {
    awk -v ticks="$(getconf CLK_TCK)" '{ print ($14 + $15) / ticks }' "/proc/$1/stat"
}

# The same of all that has ended before the last `times >FILE`.
time_in() {
    tr 'ms' '  ' <"$1" | awk 'NR == 2 { print $1 * 60 + $2 + $3 * 60 + $4 }'
}

# ends_now SIGNAL LEFT: the tool in $process ends; LEFT is what may be left.
ends_now() {
    taken=0
    times >before.txt
    if [ -r "/proc/$process/stat" ]; then
        taken=$(time_of $process)
    fi
    kill -"$1" $process || fail "it was done before a signal"
    code=0
    wait $process || code=$?
    times >after.txt
    [ $code -gt 128 ] || fail "exit code $code after a signal"
    if [ -r /proc/self/stat ]; then
        awk -v before="$(time_in before.txt)" -v after="$(time_in after.txt)" \
            -v taken="$taken" -v most=$most \
            'BEGIN { exit !(after - before - taken < most) }' ||
            fail "works on after a signal: $(cat before.txt after.txt), $taken before it"
    fi
    found=$(find . -name 'long*' -o -name '.?*')
    [ "$found" = "$2" ] || fail "left after a signal: $found"
}

# ends_soon LINE LEFT WORDS...: LINE is told of it.
ends_soon() {
    line=$1
    left=$2
    shift 2
    "$tool" "$@" >stdout.txt 2>stderr.txt &
    process=$!
    tries=0
    while ! grep -q "$line" stderr.txt && [ $tries -lt 600 ]; do
        sleep 0.1
        tries=$((tries + 1))
    done
    grep -q "$line" stderr.txt || fail "nothing is told of long work: $(cat stderr.txt)"
    ends_now TERM "$left"
}
