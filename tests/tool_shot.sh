# SPDX-License-Identifier: MIT
# Shots that are killed or have bad frames: what can be made is made, with the same bits.
. "$(dirname "$0")/tool_lib.sh"

frames=24

# The camera flies in, so that each frame alone would choose another radius.
frame=1
while [ $frame -le $frames ]; do
    name=shot.$(printf %04d $frame).exr
    good gbuffer builtin:courtyard --size 48x27 --guard-px 0 --eye "6,2,-$((2 + frame))" \
        --target 0,1,0 -o "$name"
    frame=$((frame + 1))
done

# same NAME WHAT: every frame of NAME has the bits of the undisturbed shot.
same() {
    for whole in whole.*.exr; do
        cmp -s "$whole" "$1${whole#whole}" || fail "$2: $1${whole#whole} has other bits"
    done
}

# Killed when a frame of the beginning, the middle or the end has just been written, and
# then at any moment.
good ao "shot.####.exr" --frames 1-$frames --append -o "whole.####.exr"
run="--frames 1-$frames --append --skip-existing -q -o again.####.exr"
for wanted in 0002 0011 0023; do
    # shellcheck disable=SC2086
    "$tool" ao "shot.####.exr" $run 2>killed.txt &
    while [ ! -e again.$wanted.exr ] && kill -0 $! 2>/dev/null; do :; done
    kill -9 $! 2>/dev/null || true
    wait $! 2>/dev/null || true
done
for moment in 0.01 0.03 0.05; do
    rm -f again.00[01]*.exr
    # shellcheck disable=SC2086
    "$tool" ao "shot.####.exr" $run 2>killed.txt &
    sleep $moment
    kill -9 $! 2>/dev/null || true
    wait $! 2>/dev/null || true
done
# shellcheck disable=SC2086
good ao "shot.####.exr" $run
same again "a shot that was killed"
[ -z "$(find . -name '.crevice-*')" ] || fail "temporary files of killed runs"

# A bad frame in the middle costs that frame alone, and can be mended.
cp shot.0012.exr good.exr
head -c 3000 good.exr >shot.0012.exr
code=0
"$tool" ao "shot.####.exr" --frames 1-$frames --append -q -o "hole.####.exr" 2>stderr.txt ||
    code=$?
[ $code -eq 1 ] || fail "exit code $code for a bad frame"
grep -q '^crevice: 1 of 24 frames failed; .*--frames 12$' stderr.txt || fail "no list"
[ ! -e hole.0012.exr ] || fail "a result of a bad frame"
mv good.exr shot.0012.exr
good ao "shot.####.exr" --frames 12 --append --skip-existing --radius-frame 1 \
    -o "hole.####.exr"
same hole "a frame that was mended"

# Several frames at a time give the same bits, also if they are killed, and tell of all
# frames that fail in one line.
good ao "shot.####.exr" --frames 1-$frames --append --jobs 3 -o "jobs.####.exr"
[ "$(grep -c '^wrote' stderr.txt)" -eq $frames ] || fail "--jobs: not every frame is told"
same jobs "--jobs"
jobs="--frames 1-$frames --append --jobs 4 --skip-existing -q -o killed.####.exr"
# shellcheck disable=SC2086
"$tool" ao "shot.####.exr" $jobs 2>killed.txt &
while [ ! -e killed.0005.exr ] && kill -0 $! 2>/dev/null; do :; done
kill -9 $! 2>/dev/null || true
wait $! 2>/dev/null || true
# shellcheck disable=SC2086
good ao "shot.####.exr" $jobs
same killed "--jobs that were killed"
mv shot.0002.exr good2.exr
mv shot.0007.exr good7.exr
code=0
"$tool" ao "shot.####.exr" --frames 1-8 --jobs 64 -q -o "hole.####.png" 2>stderr.txt || code=$?
[ $code -eq 1 ] || fail "exit code $code of --jobs with bad frames"
grep -q '^crevice: 2 of 8 frames failed; .*--frames 2,7$' stderr.txt || fail "--jobs: no list"
for frame in 1 3 4 5 6 8; do
    [ -s hole.000$frame.png ] || fail "--jobs: frame $frame beside bad ones"
done
mv good2.exr shot.0002.exr
mv good7.exr shot.0007.exr

# If the first frame is lost, it gets the radius that the others have.
rm again.0001.exr again.0002.exr
# shellcheck disable=SC2086
good ao "shot.####.exr" $run
same again "the first frames once more"

# A first frame that shows nothing decides no radius, in the second run neither.
pfm empty.0001.pfm 2 2 inf inf inf inf
pfm empty.0002.pfm 2 2 2 1 2 2
pfm empty.0003.pfm 2 2 1 1 2 1
good ao "empty.####.pfm" --frames 1-3 --vfov 90 -o "full.####.exr"
good ao "empty.####.pfm" --frames 1 --vfov 90 -o "rest.####.exr"
good ao "empty.####.pfm" --frames 1-3 --vfov 90 --skip-existing -o "rest.####.exr"
good ao "empty.####.pfm" --frames 1-3 --vfov 90 --jobs 3 -o "many.####.exr"
for frame in 1 2 3; do
    cmp -s full.000$frame.exr many.000$frame.exr || fail "--jobs, empty first frame: $frame"
    cmp -s full.000$frame.exr rest.000$frame.exr || fail "empty first frame: $frame differs"
done
