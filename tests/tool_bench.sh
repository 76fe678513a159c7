# SPDX-License-Identifier: MIT
# What `crevice bench` measures: that all is there and agrees with itself, never how fast it
# is; and what is wrong is told before the work.
. "$(dirname "$0")/tool_lib.sh"

# One run of each suffices here.
brief="--seconds 0 --repeats 1"
small="--size 64x36 --threads 1 $brief"

# sound FILE ROWS [--set]
sound() {
    if command -v python3 >/dev/null; then
        python3 "$tests/check_bench.py" "$@" || fail "the numbers in $1"
    fi
}

# Every list at once: 3 methods, 2 presets, 2 filters, 2 radii, scalar once for both
# structures, 2 numbers of threads, 2 sizes.
# shellcheck disable=SC2086 # words
good bench builtin:corner $brief --size 64x36,32x32 --json --method hbao,vo --method alchemy \
    --preset low,medium --filter none,box4 --radius-factor 0.5,1 --isa scalar \
    --structure all --threads 1,2
mv stdout.txt lists.json
sound lists.json $((3 * 2 * 2 * 2 * 2 * 2))
grep -q '^96 of 96: builtin:corner alchemy, box4; 0 s left$' stderr.txt ||
    fail "no progress: $(tail -n 1 stderr.txt)"

# The table has a line for each.
# shellcheck disable=SC2086
good bench builtin:corner $brief --size 64x36 --method hbao,vao --filter none,gauss5 \
    --isa scalar --threads 1,2 --radius-factor 2
[ "$(grep -c '^builtin:corner ' stdout.txt)" -eq 8 ] || fail "lines: $(cat stdout.txt)"
grep -q '^builtin:corner *64 *36 *hbao *medium *gauss5 *scalar *exact *2 *2\.00 ' stdout.txt ||
    fail "no such line in the table: $(cat stdout.txt)"

# All methods with all that this machine has; filters alone.
# shellcheck disable=SC2086
good bench builtin:corner $small --isa all --structure all --json --quiet
[ ! -s stderr.txt ] || fail "not quiet"
sets=$("$tool" devices | sed -n 's/^cpu  *//p' | tr ',' '\n' | grep -c .)
methods=$("$tool" methods --json | grep -c '"weighting":')
mv stdout.txt isas.json
sound isas.json $((methods * (2 * sets - 1)))
# shellcheck disable=SC2086
good bench builtin:corner $small --method none --filter all --isa scalar --json
filters=$(grep -c '"filter"' stdout.txt)
mv stdout.txt filters.json
sound filters.json "$filters"
[ "$filters" -ge 3 ] || fail "$filters filters"

# Options; the radius in scene units, times the factor.
# shellcheck disable=SC2086
good bench builtin:corner $small --method ssao --set samples=5 --set radius=0.25 \
    --radius-factor 2 --isa scalar --json
grep -q '"samples":[[:space:]]*5,' stdout.txt || fail "--set samples"
grep -q '"radius":[[:space:]]*0.5,' stdout.txt || fail "--set radius"

# A frame keeps its size.
good gbuffer builtin:corner --size 72x40 --guard-px 4 -o frame.exr
# shellcheck disable=SC2086
good bench frame.exr builtin:sphere $small --isa scalar --method hbao --filter preset --json
mv stdout.txt frame.json
sound frame.json 2
grep -q '"width":[[:space:]]*72,' frame.json || fail "the frame's width"

# More than ten seconds are announced before the first measurement; an interrupt ends it.
"$tool" bench builtin:corner --size 640x360 --method hbao --isa scalar --repeats 500 \
    --seconds 3600 >stdout.txt 2>stderr.txt &
process=$!
sleep 1
kill -TERM $process
code=0
wait $process || code=$?
[ $code -gt 128 ] || fail "exit code $code after a signal"
grep -q '^1 measurements, about 3600 s' stderr.txt || fail "no announcement"

# A GPU, where there is one; instruction sets are the CPU's.
bad 2 '--isa: is for the CPU' bench --device vulkan --isa all
bad 2 '--structure: is for the CPU' bench --device vulkan --structure exact
bad 2 '--depth-layout: is for a GPU' bench --depth-layout levels
bad 2 '--arithmetic: is for a GPU' bench --arithmetic half
if [ -z "${TSAN_OPTIONS:-}${ASAN_OPTIONS:-}" ] && "$tool" devices 2>/dev/null | grep -q vulkan; then
    # shellcheck disable=SC2086
    good bench builtin:corner $small --device vulkan --method hbao,none --filter box4 --json
    mv stdout.txt gpu.json
    sound gpu.json 2
fi

# Arguments.
bad 2 'did you mean hbao' bench --method hbaoo
bad 2 '--method: ",hbao" is no list' bench --method ,hbao
bad 2 '--method: "hbao," is no list' bench --method hbao,
bad 2 'did you mean medium' bench --preset medum
bad 2 'did you mean box4' bench --filter box
bad 2 'did you mean avx2' bench --isa avx3
bad 2 'there is no filter to measure' bench --method none
case $(uname -m) in
x86_64) bad 2 '--isa neon: not on this machine; there are scalar' bench --isa neon ;;
aarch64) bad 2 '--isa avx2: not on this machine; there are scalar' bench --isa avx2 ;;
esac
bad 2 '--structure: no "quick"' bench --structure quick
bad 2 '--threads: "0"' bench --threads 1,0
bad 2 '--threads: "1.5"' bench --threads 1.5
bad 2 '--size: "8x8"' bench --size 8x8
bad 2 '--radius-factor: "0"' bench --radius-factor 0
bad 2 '--set: "stepz=4" sets no option' bench --set stepz=4
bad 2 '--set: "steps" sets no option' bench --set steps
bad 2 '--set: no chosen method reads steps' bench --method vao --set steps=4
bad 2 'steps' bench builtin:corner --method hbao --set steps=many
bad 2 'builtin:cornr' bench builtin:cornr
bad 1 'missing.glb: ' bench missing.glb
bad 1 'missing.exr: ' bench missing.exr

if [ -e /dev/full ]; then
    code=0
    # shellcheck disable=SC2086
    "$tool" bench builtin:corner $small --method vao --isa scalar --json >/dev/full \
        2>stderr.txt || code=$?
    [ $code -eq 1 ] || fail "exit code $code with standard output full"
fi

# An interrupt keeps what was measured, and ends the run that it finds.
# shellcheck disable=SC2086 # words
"$tool" bench builtin:corner --json --size 320x180 $brief --threads 1 --isa scalar \
    --method vo,hsao --set steps=256 --set normal_rays=64 >stdout.txt 2>stderr.txt &
process=$!
tries=0
while ! grep -q '^2 of 2: ' stderr.txt && [ $tries -lt 600 ]; do
    sleep 0.1
    tries=$((tries + 1))
done
ends_now TERM ''
grep -q '^crevice: bench: interrupted$' stderr.txt || fail "no word of it: $(cat stderr.txt)"
sound stdout.txt 1
