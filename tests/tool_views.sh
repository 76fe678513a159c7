# SPDX-License-Identifier: MIT
# Stereo frames: both eyes in one run.
. "$(dirname "$0")/tool_lib.sh"

size="--size 64x36 --guard-px 0 --target 0,0.5,0"
for frame in 1 2; do
    # shellcheck disable=SC2086
    good gbuffer builtin:courtyard $size --eye "-0.1,1.5,-$((2 + frame))" -o eye.left.$frame.exr
    # shellcheck disable=SC2086
    good gbuffer builtin:courtyard $size --eye "0.1,1.5,-$((2 + frame))" -o eye.right.$frame.exr
done

# A file for each eye. The right one gets the radius of the left one.
both="--views left,right --frames 1-2"
# shellcheck disable=SC2086
good ao "eye.%V.#.exr" $both -o "ao.%v.#.exr"
radius=$(sed -n 's/^radius: --radius \([0-9.e-]*\),.*/\1/p' stderr.txt)
for eye in left right; do
    for frame in 1 2; do
        good ao eye.$eye.$frame.exr --radius "$radius" -o one.$eye.$frame.exr
        good compare --json one.$eye.$frame.exr "ao.${eye%"${eye#?}"}.$frame.exr"
        at_most "$(number max_error)" 0 "$eye, frame $frame"
    done
done

# Both in one file, in which each has a channel.
# shellcheck disable=SC2086
good ao "eye.%V.#.exr" $both -o "stereo.#.exr"
for eye in left right; do
    good compare --json stereo.2.exr one.$eye.2.exr --channel $eye.AO --channel-b AO
    at_most "$(number max_error)" 0 "$eye in one file"
done
# shellcheck disable=SC2086
good ao "eye.%V.#.exr" $both --append --channel "VL.AO2.V" -o "beside.%V.#.exr"
good compare --json beside.right.1.exr one.right.1.exr --channel VL.AO2.V --channel-b AO
at_most "$(number max_error)" 0 "beside the passes of its eye"

# What is there stays; if one eye is missing, both are made.
# shellcheck disable=SC2086
good ao "eye.%V.#.exr" $both --skip-existing -o "ao.%v.#.exr"
[ "$(grep -c 'is there, and made' stderr.txt)" -eq 4 ] || fail "results that are there"
cp ao.r.1.exr before.exr
rm ao.r.1.exr
# shellcheck disable=SC2086
good ao "eye.%V.#.exr" $both --skip-existing -o "ao.%v.#.exr"
cmp -s before.exr ao.r.1.exr || fail "the missing eye has other bits"

bad 2 '--views' ao "eye.%V.1.exr" -o out.exr
bad 2 '--views' ao eye.left.1.exr --views left,,right -o out.exr
bad 2 '--views' ao eye.left.1.exr --views left,right --depth Z -o out.exr
bad 2 '-o' ao "eye.%V.1.exr" --views left,right -o out.png
bad 2 'one file name' ao "eye.%V.1.exr" --views left,lower -o "out.%v.exr"
bad 2 '-o' ao "eye.%V.1.exr" --views left,right --append -o out.exr
bad 1 'has no view "left"' ao eye.left.1.exr --views left,right -o out.exr
# shellcheck disable=SC2086
good gbuffer builtin:courtyard $size --eye 0.1,1.5,-3 --size 60x36 -o eye.right.3.exr
cp eye.left.1.exr eye.left.3.exr
bad 1 'different windows' ao "eye.%V.3.exr" --views left,right -o out.exr
