# SPDX-License-Identifier: MIT
# The ray-traced reference from the command line: what it writes, what interrupts leave.
. "$(dirname "$0")/tool_lib.sh"

small="reference builtin:courtyard --size 80x45"

# The channels, and a known value: the plane is open, the groove's mean is not.
good reference builtin:plane --size 64x36 -o plane.exr --rays 64 --radius 2
for channel in AO N.Y; do
    good compare --json plane.exr plane.exr --channel $channel
    at_least "$(number mean_a)" 0.99999 "mean $channel of a plane"
done
good compare --json plane.exr plane.exr --channel AO.stderr
at_most "$(number mean_a)" 0.015626 "1/64, the least error of 64 rays"
# The bent normal of an open plane is its normal, to what 64 rays know: in world space.
for channel in X Y Z; do
    good compare --json plane.exr plane.exr --channel bent.$channel --channel-b N.$channel
    at_most "$(number mae)" 0.04 "bent.$channel of a plane against its normal"
done
# Z and camera serve `ao`: every method sees the plane as the reference does.
good ao plane.exr -o plane_ao.exr --radius 2
good compare --json plane.exr plane_ao.exr
at_most "$(number rmse)" 0.05 "hbao of the reference's own depth"

# Each integral is another picture; one layer does not hold all that occludes.
good $small -o cosine.exr --radius 0.4
good $small -o uniform.exr --radius 0.4 --weighting uniform --falloff linear
good $small -o sphere.exr --radius 0.4 --definition tangent-sphere
good $small -o visible.exr --radius 0.4 --kind visible
good $small -o cubic.exr --radius 0.4 --falloff cubic
for other in uniform visible; do
    good compare --json cosine.exr $other.exr
    at_least "$(number rmse)" 0.02 "$other against cosine"
done
# Tangent sphere and cubic falloff agree where a ray meets at most one surface.
good compare --json sphere.exr cubic.exr
at_most "$(number mae)" 0.15 "tangent sphere against the cubic falloff"

# More rays: nearer. The seed is another draw of the same.
good $small -o many.exr --radius 0.4 --rays 2048
good $small -o few.exr --radius 0.4 --rays 64 --seed 1
good compare --json many.exr few.exr
few=$(number rmse)
good compare --json many.exr cosine.exr
at_most "$(number rmse)" "$(awk -v few="$few" 'BEGIN { print few * 0.5 }')" "256 rays"
good $small -o stop.exr --radius 0.4 --rays 65536 --max-error 0.01
good compare --json stop.exr stop.exr --channel AO.stderr
at_most "$(number mean_a)" 0.01 "the error that was asked for"
good compare --json many.exr stop.exr
at_most "$(number rmse)" 0.011 "the error that was asked for, measured"

# Bits do not depend on threads, and nothing is left behind.
good $small -o threads.exr --radius 0.4 --threads 3
cmp -s cosine.exr threads.exr || fail "another picture with three threads"
[ -z "$(find . -name '*.checkpoint*')" ] || fail "a checkpoint is left"

# Killed twice, once without warning: the same file in the end. One thread works on this for
# seconds on any machine, so that there is something to interrupt.
work="$small --radius 0.4 --rays 8192"
# shellcheck disable=SC2086
good $work -o whole.exr
interrupt() {
    signal=$1
    shift
    # shellcheck disable=SC2086
    "$tool" $work --threads 1 -o killed.exr "$@" >stdout.txt 2>stderr.txt &
    process=$!
    tries=0
    while [ ! -e killed.exr.checkpoint ] && [ $tries -lt 300 ]; do
        sleep 0.1
        tries=$((tries + 1))
    done
    sleep 1
    kill -"$signal" $process || fail "it was done before it could be interrupted"
    code=0
    wait $process || code=$?
    [ $code -gt 128 ] || fail "exit code $code after SIG$signal"
    [ ! -e killed.exr ] || fail "a picture after SIG$signal"
    [ -s killed.exr.checkpoint ] || fail "no checkpoint after SIG$signal"
}
interrupt TERM
grep -q '^crevice: killed.exr.checkpoint: interrupted at .*--resume' stderr.txt ||
    fail "the interrupt is not told"
code=0
# shellcheck disable=SC2086
"$tool" $work -o killed.exr 2>stderr.txt || code=$?
[ $code -eq 2 ] || fail "exit code $code where a checkpoint is in the way"
grep -q 'holds unfinished work' stderr.txt || fail "the checkpoint is not named"
code=0
# shellcheck disable=SC2086
"$tool" $work -o killed.exr --seed 1 --resume 2>stderr.txt || code=$?
[ $code -eq 1 ] || fail "exit code $code for a checkpoint of another seed"
grep -q 'another scene, view or setting' stderr.txt || fail "a foreign checkpoint"
interrupt KILL --resume
# shellcheck disable=SC2086
good $work -o killed.exr --resume
grep -q 'killed.exr.checkpoint: resumed at ' stderr.txt || fail "it did not resume"
grep -q 'resumed at 0.0 %' stderr.txt && fail "the work before the interrupt is lost"
cmp -s whole.exr killed.exr || fail "another picture after interrupts"
[ ! -e killed.exr.checkpoint ] || fail "the checkpoint is left"
good $small -o anew.exr --radius 0.4 --resume
cmp -s cosine.exr anew.exr || fail "--resume without a checkpoint"

# A damaged checkpoint is refused, and kept.
echo damaged >hurt.exr.checkpoint
code=0
# shellcheck disable=SC2086
"$tool" $small -o hurt.exr --radius 0.4 --resume 2>stderr.txt || code=$?
[ $code -eq 1 ] || fail "exit code $code for a damaged checkpoint"
grep -q '^crevice: hurt.exr.checkpoint: is damaged' stderr.txt || fail "damage is not told"
rm hurt.exr.checkpoint

# No room is known before the work, whose end is told of in a line: files cannot be larger
# than 8 blocks of 512 bytes, less than a checkpoint, or than 200, less than the picture.
# ThreadSanitizer itself needs larger files.
if [ -z "${TSAN_OPTIONS:-}" ]; then
    for room in 8:out.exr.checkpoint 200:out.exr; do
        code=0
        (
            trap '' XFSZ
            ulimit -f "${room%%:*}"
            # shellcheck disable=SC2086
            exec "$tool" $small -o out.exr --radius 0.4 --rays 2048
        ) >stdout.txt 2>stderr.txt || code=$?
        [ $code -eq 1 ] || fail "exit code $code without room"
        grep -q "^crevice: ${room#*:}: cannot be written (" stderr.txt || fail "no room"
        grep -q 'reference, radius' stderr.txt && fail "no room, found after the work"
        [ -z "$(find . -name 'out.exr*' -o -name '.out*')" ] || fail "a file without room"
    done
fi
bad 1 'its folder cannot be used' $small -o nowhere/out.exr

# Arguments that contradict each other or are impossible.
bad 2 'name it with .exr' $small -o out.png
bad 2 'tangent-sphere has no' $small -o out.exr --definition tangent-sphere --falloff linear
bad 2 '--tau: is of the exponential' $small -o out.exr --tau 1
bad 2 '--u: is of the alchemy' $small -o out.exr --u 0.5
bad 2 '1 to 65536' $small -o out.exr --rays 65537
bad 2 '--max-error' $small -o out.exr --max-error -1
bad 2 'did you mean cosine' $small -o out.exr --weighting cosin
