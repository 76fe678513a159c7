# SPDX-License-Identifier: MIT
# Bent normals: what ao and render write, and how near it is to the ray-traced ones.
. "$(dirname "$0")/tool_lib.sh"

camera="builtin:corner --size 96x54 --guard-px 0"
bent="--radius 1 --method gtao --bent-normal on"
# shellcheck disable=SC2086 # $camera, $bent and others are words
{
    good gbuffer $camera -o frame.exr
    good reference $camera --radius 1 -o truth.exr
    good ao frame.exr $bent -o ao.exr
    good ao frame.exr --radius 1 --method gtao -o plain.exr
}
good compare --json ao.exr plain.exr
at_most "$(number max_error)" 0 "accessibility with and without bent normals"

# In world space by default, as the frame's normals are and the reference is.
good compare --json ao.exr truth.exr
at_most "$(number bent_open_median_deg)" 5 "median angle on open surfaces"
at_least "$(number bent_median_deg)" 0.1 "median angle"
grep -aq ' bent=world' ao.exr || fail "the space in the metadata"
# shellcheck disable=SC2086
good ao frame.exr $bent --bent-space view -o view.exr
bad 1 'bent normals are in view space' compare view.exr truth.exr
# shellcheck disable=SC2086
good ao frame.exr $bent --bent-space world -o world.exr
good compare --json world.exr ao.exr
at_most "$(number bent_q95_deg)" 1e-4 "the space that was asked for and the default one"
# Surfaces that are seen face the viewer: +Z in view space.
good compare --json view.exr view.exr --channel bent.Z
at_least "$(number mean_a)" 0.3 "view space"

# render computes the same.
# shellcheck disable=SC2086
good render $camera $bent -o render.exr --bent-output eye.png
good compare --json render.exr ao.exr
at_most "$(number max_error)" 1e-5 "accessibility of render and of ao"
at_most "$(number bent_q95_deg)" 0.01 "bent normals of render and of ao"
# For the eye: n / 2 + 1/2, in steps of 1/255.
for axis in X:R Y:G Z:B; do
    good compare --json render.exr render.exr --channel "bent.${axis%:*}"
    vector=$(number mean_a)
    good compare --json eye.png eye.png --channel "${axis#*:}"
    half=$(awk -v x="$vector" 'BEGIN { print 0.5 + 0.5 * x }')
    at_most "$(number mean_a)" "$(awk -v x="$half" 'BEGIN { print x + 0.002 }')" "${axis#*:}"
    at_least "$(number mean_a)" "$(awk -v x="$half" 'BEGIN { print x - 0.002 }')" "${axis#*:}"
done
# shellcheck disable=SC2086
{
    good ao frame.exr $bent -o ao.png --bent-output own.exr
    good render $camera $bent --bent-space view -o seen.exr
    good render $camera $bent --aa 2 -o smooth.exr
}
good compare --json own.exr ao.exr --channel bent.X
at_most "$(number max_error)" 0 "bent normals in a file of their own"
good compare --json seen.exr view.exr
at_most "$(number bent_q95_deg)" 0.01 "render in view space"
good compare --json smooth.exr render.exr
at_most "$(number bent_median_deg)" 10 "antialiased"

# Beside the passes of the frame; where there is no result there is no direction.
# shellcheck disable=SC2086
{
    good ao frame.exr $bent --append -o beside.exr
    good ao frame.exr $bent --append --channel "View Layer.AO" -o layer.exr
    good ao beside.exr $bent --append --channel AO2 --bent-channel bent2 -o two.exr
}
for pair in beside.exr:bent.Y "layer.exr:View Layer.bent.Y" two.exr:bent2.Y; do
    good compare --json "${pair%%:*}" ao.exr --channel "${pair#*:}" --channel-b bent.Y
    at_most "$(number max_error)" 0 "$pair"
done
# shellcheck disable=SC2086
{
    bad 1 'has a channel "bent.X" already' ao beside.exr $bent --append --channel AO2 -o out.exr
    bad 2 '--bent-normal: has no place beside --apply' ao frame.exr $bent --apply N.X -o out.exr
    bad 2 '--bent-normal: only an .exr' ao frame.exr $bent -o out.png
    bad 2 '--bent-normal: only an .exr' render $camera $bent -o out.png
    bad 2 '--bent-output: is the file' ao frame.exr $bent -o out.exr --bent-output out.exr
}
bad 2 'is not read by vo; give --method' ao frame.exr --method vo --bent-normal on -o out.exr
bad 2 'is not read by vo; give --method' render builtin:corner --method vo --bent-normal on \
    -o out.exr
bad 2 '--bent-space: is for bent' ao frame.exr --bent-space view -o out.exr
bad 2 '--bent-output: is for bent' ao frame.exr --bent-output out.png -o out.exr
bad 2 '--bent-channel: is for' ao frame.exr --bent-channel b -o out.exr

# Without normals there is only view space.
pfm depth.pfm 4 4 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1
# shellcheck disable=SC2086
{
    good ao depth.pfm --vfov 60 $bent -o flat.exr
    bad 1 'does not say how its camera' ao depth.pfm --vfov 60 $bent --bent-space world -o out.exr
}
grep -aq ' bent=view' flat.exr || fail "the space without normals"
good compare --json flat.exr flat.exr --channel bent.Z
at_least "$(number mean_a)" 0.999 "a wall faces the viewer"

# What receives nothing faces along its normal.
# shellcheck disable=SC2086
good ao frame.exr $bent --receive Z=0 -o none.exr
for axis in X Y Z; do
    good compare --json frame.exr none.exr --channel N.$axis --channel-b bent.$axis
    at_most "$(number max_error)" 1e-5 "bent.$axis of what receives nothing"
done

# Shots, both eyes, with results that are there.
for eye in left right; do
    cp frame.exr eye.$eye.1.exr
done
stereo="--views left,right --frames 1 --skip-existing"
# shellcheck disable=SC2086
{
    good ao "eye.%V.#.exr" $stereo $bent -o "stereo.#.exr" --bent-output "bent.%V.#.png"
    good ao "eye.%V.#.exr" $stereo $bent -o "stereo.#.exr" --bent-output "bent.%V.#.png"
}
[ "$(grep -c 'is there, and made' stderr.txt)" -eq 1 ] || fail "a result that is there"
good compare --json stereo.1.exr ao.exr --channel right.bent.Z --channel-b bent.Z
at_most "$(number max_error)" 0 "one eye in one file"
rm bent.left.1.png
# shellcheck disable=SC2086
{
    good ao "eye.%V.#.exr" $stereo $bent -o "stereo.#.exr" --bent-output "bent.%V.#.png"
    [ -s bent.left.1.png ] || fail "a missing picture is not made again"
    bad 2 '--bent-output: needs a file for each' ao "eye.%V.#.exr" $stereo $bent \
        -o "out.#.exr" --bent-output "out.#.png"
    bad 2 '--bent-output: needs one place' ao "eye.%V.#.exr" $stereo $bent \
        -o "out.#.exr" --bent-output "out.%V.png"
}
