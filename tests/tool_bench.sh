# SPDX-License-Identifier: MIT
# What `crevice bench` measures: that all is there and agrees with itself, never how fast it
# is; and what is wrong is told before the work.
. "$(dirname "$0")/tool_lib.sh"

mkdir tmp
TMPDIR=$PWD/tmp
export TMPDIR
# One run of each suffices here.
brief="--sizes 64x36 --seconds 0 --repeats 1 --threads 1"

# sound FILE SECTION ROWS...
sound() {
    if command -v python3 >/dev/null; then
        python3 "$tests/check_bench.py" "$@" || fail "the numbers in $1"
    fi
    [ -z "$(ls tmp)" ] || fail "left in the folder for temporary files: $(ls tmp)"
}

# Every list at once: 4 methods, 2 presets, 2 filters, 2 radii, scalar once for both
# structures, 2 numbers of threads.
good bench builtin:corner --sizes 64x36 --seconds 0 --repeats 1 --json methods.json \
    --methods hbao,hsao --methods alchemy,vao --presets low,medium --filters none,box4 \
    --radii 0.5,1 --isas scalar --structures both --threads-list 1,2 --only methods
sound methods.json methods $((4 * 2 * 2 * 2 * 2))
grep -q '^corner  *64  *hsao  *medium  *box4  *scalar  *exact  *2  *0.50 ' stdout.txt ||
    fail "no row of that in the table"
grep -q 'wrote methods.json' stderr.txt || fail "silent about the file"

# All sections; all methods with what this machine has, on numbers to standard output alone.
# 12 passes; growth: 5 numbers of samples, 6 radii, 1 thread, 4 sizes twice.
# shellcheck disable=SC2086 # $brief is words
good bench builtin:sphere builtin:corner $brief --isa scalar --methods hbao --json - \
    --only methods,passes,memory,growth,embree,whole
mv stdout.txt all.json
sound all.json methods 2 passes 12 memory 2 growth 20 embree 4 whole 3
# shellcheck disable=SC2086
good bench builtin:corner $brief --isas all --only methods,memory --json isas.json --quiet
[ ! -s stderr.txt ] || fail "not quiet"
sets=$(sed -n 's/.*"isas":[[:space:]]*\[\([^]]*\)\].*/\1/p' isas.json | tr , '\n' | wc -l)
methods=$(grep -c '"structure"' isas.json)
sound isas.json methods $((8 * sets)) memory 16
[ "$methods" -eq $((8 * sets + 16)) ] || fail "$methods rows with $sets sets"
# shellcheck disable=SC2086
good bench builtin:corner $brief --only methods --methods ssao --set samples=5 --exact \
    --json exact.json
grep -q '"samples":[[:space:]]*5,' exact.json || fail "--set"
! grep -q '"structure":[[:space:]]*"fast"' exact.json || fail "--exact"

# A frame keeps its size; nothing can be traced in it.
good gbuffer builtin:corner --size 72x40 --guard-px 4 -o frame.exr
# shellcheck disable=SC2086
good bench frame.exr $brief --isa scalar --methods hbao --filters preset --json frame.json \
    --only methods,passes,memory,embree,whole
sound frame.json methods 1 passes 12 memory 2 whole 3
grep -q '"width":[[:space:]]*72,' frame.json || fail "the frame's width"
grep -q 'frame.exr: has no scene' stderr.txt || fail "silent about what a frame cannot tell"

# The page of docs/ is made by a script; sanitizers find nothing new in what it runs.
if command -v python3 >/dev/null && [ -z "${TSAN_OPTIONS:-}${ASAN_OPTIONS:-}" ]; then
    python3 "$tests/../docs/performance.py" "$tool" --brief --shared "" -o page.md \
        --keep kept 2>stderr.txt || { cat stderr.txt >&2; fail "docs/performance.py"; }
    for part in methods threads growth parts; do
        [ -s kept/$part.json ] || fail "no numbers of $part"
    done
    sound kept/methods.json methods $((8 * (2 * sets - 1)))
    python3 "$tests/../docs/performance.py" --from kept -o again.md --brief --shared ""
    cmp page.md again.md || fail "another page of the same numbers"
    [ "$(grep -c '^## ' page.md)" -eq 11 ] || fail "sections of the page"
    # A table whose rows have other columns than its head is none.
    awk -F '|' '/^[|]/ { if (n && NF != n) exit 1; n = NF; next } { n = 0 }' page.md ||
        fail "a broken table"
    ! grep -n '{\|nan\|None' page.md || fail "the page has gaps"
fi

# A GPU, where there is one; instruction sets are the CPU's.
bad 2 '--isas: contradicts --device' bench --device vulkan --isas all
bad 2 '--structures: contradicts --device' bench --device vulkan --structures fast
bad 2 '--only device: ' bench --only device
if [ -z "${TSAN_OPTIONS:-}${ASAN_OPTIONS:-}" ] && "$tool" devices 2>/dev/null | grep -q vulkan; then
    # shellcheck disable=SC2086
    good bench builtin:corner $brief --device vulkan --methods hbao --json gpu.json \
        --only methods,passes,memory,whole
    sound gpu.json methods 1 passes 12 memory 2 whole 3
fi

# Views of a list, by name.
cat >views.json <<'JSON'
{"views": [
  {"name": "near", "file": "builtin:corner", "eye": [3, 3, 3], "target": [0, 0, 0],
   "vfov_degrees": 40, "radius": 0.25},
  {"name": "far", "file": "builtin:corner", "eye": [9, 9, 9], "target": [0, 0, 0],
   "vfov_degrees": 40}]}
JSON
# shellcheck disable=SC2086
good bench --views views.json --view near $brief --methods vao --isa scalar --radii 2 \
    --only methods --json views-numbers.json
sound views-numbers.json methods 1
grep -q '"radius":[[:space:]]*0.5,' views-numbers.json || fail "twice the view's radius"

# Arguments.
bad 2 'did you mean hbao' bench --methods hbaoo
bad 2 '--methods: ",hbao" is no list' bench --methods ,hbao
bad 2 '--methods: "hbao," is no list' bench --methods hbao,
bad 2 'did you mean medium' bench --presets medum
bad 2 'did you mean box4' bench --filters box
bad 2 'did you mean avx2' bench --isas avx3
case $(uname -m) in
x86_64) bad 2 '--isas neon: not on this machine; there are scalar' bench --isas neon ;;
aarch64) bad 2 '--isas avx2: not on this machine; there are scalar' bench --isas avx2 ;;
esac
bad 2 '--structures: no "quick"' bench --structures quick
bad 2 '--threads-list: "0"' bench --threads-list 1,0
bad 2 '--sizes: "8x8"' bench --sizes 8x8
bad 2 '--radii: "0"' bench --radii 0
bad 2 'did you mean growth' bench --only growths
bad 2 '--isas: contradicts --isa;' bench --isa scalar --isas all
bad 2 '--structures: contradicts --exact;' bench --exact --structures fast
bad 2 '--threads-list: contradicts --threads;' bench --threads 1 --threads-list 2
bad 2 '--set: "stepz=4" sets no option' bench --set stepz=4
bad 2 '--set: "steps" sets no option' bench --set steps
bad 2 '--set: no chosen method reads steps' bench --methods vao --set steps=4
bad 2 'steps' bench builtin:corner --methods hbao --set steps=many --only memory
bad 2 'did you mean near' bench --views views.json --view nearr
bad 2 'builtin:cornr' bench builtin:cornr
bad 1 'missing.glb: ' bench missing.glb
bad 1 'missing.exr: ' bench missing.exr --only methods
bad 1 'nowhere.json: cannot be read' bench --views nowhere.json
bad 1 'nowhere/out.json' bench --json nowhere/out.json
bad 1 'tmp: is no file' bench --json tmp

# No room: told of, and nothing is left. Files of more than 8 blocks cannot be written.
# ThreadSanitizer itself needs larger files.
# without_room PHRASE WORDS...
without_room() {
    phrase=$1
    shift
    code=0
    (
        trap '' XFSZ
        ulimit -f 8
        exec "$tool" "$@"
    ) >stdout.txt 2>stderr.txt || code=$?
    [ $code -eq 1 ] || fail "exit code $code without room: $*"
    grep -q "^crevice: .*$phrase" stderr.txt || fail "no \"$phrase\" without room: $*"
    [ ! -e out.json ] || fail "a file is left without room: $*"
    [ -z "$(ls tmp)" ] || fail "a folder is left without room: $*"
}
if [ -z "${TSAN_OPTIONS:-}" ]; then
    # shellcheck disable=SC2086
    without_room 'out.json: ' bench builtin:corner $brief --methods all --isa scalar \
        --only methods --json out.json
    # shellcheck disable=SC2086
    without_room 'frame.exr: ' bench builtin:corner --sizes 640x360 --threads 1 --only whole
fi
if [ -e /dev/full ]; then
    code=0
    # shellcheck disable=SC2086
    "$tool" bench builtin:corner $brief --only memory --methods vao --json - >/dev/full \
        2>stderr.txt || code=$?
    [ $code -eq 1 ] || fail "exit code $code with standard output full"
fi
TMPDIR=$PWD/nowhere
# shellcheck disable=SC2086
bad 1 'set TMPDIR to another' bench builtin:corner $brief --only whole
TMPDIR=$PWD/tmp

# An interrupt leaves no folder behind.
"$tool" bench builtin:corner --sizes 64x36 --only whole --repeats 500 --seconds 3600 \
    >stdout.txt 2>stderr.txt &
process=$!
sleep 4
kill -TERM $process
code=0
wait $process || code=$?
[ $code -gt 128 ] || fail "exit code $code after a signal"
[ -z "$(ls tmp)" ] || fail "a folder is left after a signal"
