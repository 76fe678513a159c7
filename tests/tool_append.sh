# SPDX-License-Identifier: MIT
# Results beside the passes of their frame, and multiplied into them.
. "$(dirname "$0")/tool_lib.sh"

for frame in 1 2 3; do
    good gbuffer builtin:courtyard --size 96x54 --guard-px 0 --layers 2 \
        --eye 3,1.5,-$frame --target 0,0.5,0 -o shot.000$frame.exr
done
good ao shot.0001.exr --radius 0.4 -o plain.exr
good ao shot.0001.exr --radius 0.4 --append -o beside.exr
good compare --json plain.exr beside.exr --channel AO
at_most "$(number max_error)" 0 "AO beside the passes and AO alone"
for channel in Z N.X N.Y N.Z; do
    good compare --json shot.0001.exr beside.exr --channel $channel
    at_most "$(number max_error)" 0 "$channel of the copy"
done
# It says how it was made; so does the G-buffer still.
grep -aq 'crevice\.AO.string.*method=.*append=1.*radius=0.4' beside.exr || fail "no metadata"
grep -aq 'crevice [0-9.]* gbuffer' beside.exr || fail "the input's metadata"

# A name that is taken is refused, before any work.
bad 1 'has a channel "AO" already' ao beside.exr --radius 0.4 --append -o out.exr
bad 1 'has a channel "N.X" already' ao shot.0001.exr --append --channel N.X -o out.exr
good ao beside.exr --radius 0.2 --append --replace -o replaced.exr
good ao beside.exr --radius 0.2 --append --channel "View Layer.AO2" -o two.exr
good compare --json two.exr beside.exr --channel AO
at_most "$(number max_error)" 0 "the first AO beside a second"
good ao shot.0001.exr --radius 0.2 -o other.exr
good compare --json replaced.exr other.exr --channel AO
at_most "$(number max_error)" 0 "AO in place of another"

# Multiplied: a layer by its name is its red, green and blue; a channel is itself.
good ao shot.0001.exr --radius 0.4 --apply N.Y -o applied.exr
good compare --json applied.exr shot.0001.exr --channel N.Y
at_least "$(number max_error)" 0.05 "N.Y is multiplied"
good compare --json applied.exr shot.0001.exr --channel N.X
at_most "$(number max_error)" 0 "N.X is not"
good ao shot.0001.exr --radius 0.4 --apply N.Y --tint 1,1,1 -o white.exr
good compare --json white.exr shot.0001.exr --channel N.Y
at_most "$(number max_error)" 0 "a white tint darkens nothing"
# With the light that surfaces pass on: none in black surroundings, but for the 2e-6 of the
# equation; more in brighter ones; a colour pass says it pixel by pixel.
good ao shot.0001.exr --radius 0.4 --apply N.Y --albedo 0 -o black.exr
good compare --json black.exr applied.exr --channel N.Y
at_most "$(number max_error)" 3e-6 "black surroundings"
good ao shot.0001.exr --radius 0.4 --apply N.Y --albedo 0.5,0.5,0.5 -o grey.exr
good compare --json grey.exr applied.exr --channel N.Y
at_least "$(number max_error)" 0.01 "grey surroundings"
good ao shot.0001.exr --radius 0.4 --apply N.Y --albedo 0.5 -o half.exr
good compare --json grey.exr half.exr --channel N.Y
at_most "$(number max_error)" 0 "one number for three"
grep -aq ' albedo=0.5 ' half.exr || fail "metadata of the albedo"
good ao shot.0001.exr --radius 0.4 --apply N.Y --albedo 1 -o bright.exr
# Nothing is occluded within this radius: a pass of ones.
cp shot.0001.exr ones.exr
for channel in R G B; do
    good ao ones.exr --radius 1e-7 --intensity 0 --append --channel DiffCol.$channel \
        -o more.exr
    mv more.exr ones.exr
done
good ao ones.exr --radius 0.4 --apply N.Y --albedo DiffCol -o pass.exr
good compare --json pass.exr bright.exr --channel N.Y
at_most "$(number max_error)" 0 "a white colour pass"
good ao ones.exr --radius 0.4 --apply N.Y --albedo DiffCol.G -o pass.exr
good compare --json pass.exr bright.exr --channel N.Y
at_most "$(number max_error)" 0 "one channel for three"
bad 1 'no colours "DiffColor"' ao ones.exr --radius 0.4 --apply N.Y --albedo DiffColor -o out.exr
bad 2 '--albedo: is for --apply' ao ones.exr --albedo 0.5 -o out.exr
bad 2 '--albedo: must lie' ao ones.exr --apply N.Y --albedo 1.5 -o out.exr

bad 1 'N.Q' ao shot.0001.exr --radius 0.4 --apply N.Q -o out.exr

# Wrong together.
pfm depth.pfm 2 2 1 1 1 1
bad 2 '--append' ao shot.0001.exr --append -o out.png
bad 1 'no channels to keep' ao depth.pfm --vfov 60 --append -o out.exr
bad 2 '--tint' ao shot.0001.exr --tint 1,0,0 -o out.exr
bad 2 '--tint' ao shot.0001.exr --apply N.X --tint 1,0,2 -o out.exr
bad 2 '--channel' ao shot.0001.exr --channel A -o out.exr
bad 2 '--replace' ao shot.0001.exr --replace -o out.exr

# Shots: a result that is there stays; one under another name is not the same.
shot="shot.####.exr --frames 1-3 --append --skip-existing"
# shellcheck disable=SC2086
good ao $shot -o "copy.####.exr"
cp copy.0002.exr before.exr
# shellcheck disable=SC2086
good ao $shot -o "copy.####.exr"
[ "$(grep -c 'is there, and made' stderr.txt)" -eq 3 ] || fail "results that are there"
head -c 2000 copy.0002.exr >cut.exr
cp cut.exr copy.0002.exr
# shellcheck disable=SC2086
good ao $shot -o "copy.####.exr"
[ "$(grep -c 'is there, and made' stderr.txt)" -eq 2 ] || fail "one that is cut off"
cmp -s before.exr copy.0002.exr || fail "made again, with other bits"
# shellcheck disable=SC2086
good ao $shot --channel AO2 -o "copy.####.exr"
[ "$(grep -c 'is there, and made' stderr.txt)" -eq 0 ] || fail "another name"
