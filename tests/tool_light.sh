# SPDX-License-Identifier: MIT
# Sky and key light of the lit pictures.
. "$(dirname "$0")/tool_lib.sh"

# A floor that fills the picture, lit without occlusion: every pixel is albedo * light.
floor="builtin:plane --size 64x36 --shade lit-no-ao --guard-px 0 --eye 0,3,0.5"
floor="$floor --target 0,0,0"
black="--sky constant:0,0,0"

# mean NAME: the mean of channel R, or $2, of NAME.exr.
mean() {
    good compare --json "$1.exr" "$1.exr" --channel "${2:-R}"
    number mean_a
}

# near VALUE EXPECTED WHAT: within rounding of a float's arithmetic.
near() {
    at_least "$1" "$(awk -v x="$2" 'BEGIN { print x - 1e-4 * x - 1e-7 }')" "$3"
    at_most "$1" "$(awk -v x="$2" 'BEGIN { print x + 1e-4 * x + 1e-7 }')" "$3"
}

# A constant sky gives albedo * L: twice the light, twice the picture, a channel at a time.
# shellcheck disable=SC2086 # $floor and $black are words
{
    good render $floor --sky constant:1,1,1 --key-light none -o one.exr
    good render $floor --sky constant:2,0.5,0 --key-light none -o rgb.exr
    good render $floor --sky constant --key-light none -o some.exr
    good render $floor $black --key-light none -o dark.exr
}
albedo=$(mean one)
at_least "$albedo" 0.1 "albedo of the floor"
near "$(mean rgb)" "$(awk -v a="$albedo" 'BEGIN { print 2 * a }')" "twice the light"
near "$(mean rgb G)" "$(awk -v a="$(mean one G)" 'BEGIN { print a / 2 }')" "half the light"
near "$(mean rgb B)" 0 "no blue light"
near "$(mean dark)" 0 "no light"
at_least "$(mean some)" 0.01 "the usual constant sky"

# The key light falls off with the sine of its elevation, and comes from where it is said.
# shellcheck disable=SC2086
{
    good render $floor $black --key-light 0,90 -o above.exr
    good render $floor $black --key-light -70,30 -o low.exr
    good render $floor $black --key-light 0,90,3 -o strong.exr
    good render $floor $black --key-light 0,-10 -o below.exr
}
above=$(mean above)
at_least "$above" 0.1 "light from above"
near "$(mean low)" "$(awk -v a="$above" 'BEGIN { print a / 2 }')" "light at 30 degrees"
near "$(mean strong)" "$(awk -v a="$above" 'BEGIN { print a * 3 }')" "strength 3"
near "$(mean below)" 0 "light from below"

# Walls that face -Z, +X, and a floor for which Z is up.
cat >wall.obj <<'OBJ'
v 1 -1 0
v -1 -1 0
v -1 1 0
v 1 1 0
f 1 2 3 4
OBJ
wall="wall.obj --size 32x18 --shade lit-no-ao --guard-px 0 --ortho 1"
# shellcheck disable=SC2086
{
    good render $wall $black --key-light 0,0 --eye 0,0,-5 --target 0,0,0 -o front.exr
    good render $wall $black --key-light 180,0 --eye 0,0,-5 --target 0,0,0 -o back.exr
    good render $wall $black --key-light 0,0 --eye 0,0,5 --target 0,0,0 -o behind.exr
    good render $wall $black --key-light 60,0 --eye 0,0,-5 --target 0,0,0 -o side.exr
    good render $wall $black --key-light 0,90 --eye 0,3,5 --target 0,0,0 --up 0,0,1 -o zup.exr
    good render $wall $black --key-light 0,90 --eye 0,0,5 --target 0,0,0 --zenith 0,0,9 \
        -o zenith.exr
}
full=$(mean front)
at_least "$full" 0.1 "azimuth 0 is -Z"
near "$(mean back)" 0 "azimuth 180 is +Z"
near "$(mean behind)" 0 "the far side of a wall"
near "$(mean side)" "$(awk -v a="$full" 'BEGIN { print a / 2 }')" "azimuth 60"
near "$(mean zenith)" "$full" "elevation 90 is where --zenith says"
near "$(mean zup)" "$full" "elevation 90 is up, which --up says"

# Pictures of skies: of a constant one, made by looking at nothing but sky, and of one with
# all light from +X, the right half being lit.
up="--eye 0,50,0 --target 0,90,1 --size 64x32 --guard-px 0 --shade lit-no-ao"
# shellcheck disable=SC2086
{
    good render builtin:sphere $up --sky constant:0.5,0.25,1 -o sky.exr
    good render $floor --sky sky.exr --key-light none -o environment.exr
    good render $floor --sky constant:0.5,0.25,1 --key-light none -o constant.exr
}
for channel in R G B; do
    good compare --json environment.exr constant.exr --channel $channel
    at_most "$(number max_error)" 0.0001 "a picture of a constant sky: $channel"
done
printf 'PF\n4 2\n-1.0\n' >right.pfm
floats 0 0 0 0 0 0 1 1 1 1 1 1 0 0 0 0 0 0 1 1 1 1 1 1 >>right.pfm
cat >sides.obj <<'OBJ'
v 0 -1 -1
v 0 -1 1
v 0 1 1
v 0 1 -1
f 1 2 3 4
OBJ
sides="sides.obj --size 32x18 --shade lit-no-ao --guard-px 0 --ortho 1 --key-light none"
# shellcheck disable=SC2086
{
    good render $sides --sky right.pfm --eye 5,0,0 --target 0,0,0 -o right.exr
    good render $sides --sky right.pfm --eye -5,0,0 --target 0,0,0 -o left.exr
}
good compare --json right.exr left.exr --channel R
# By order-2 harmonics of a hemisphere of light: 1 in the middle of it, 0 opposite.
near "$(number mean_b)" 0 "the dark side"
at_least "$(number mean_a)" 0.1 "the lit side"

# Occlusion darkens the sky's light and leaves the key's.
# shellcheck disable=SC2086
{
    scene="builtin:corner --size 64x36 --radius 1"
    good render $scene $black --key-light 40,50 -o ao.exr --lit k1.exr --unlit k2.exr
    good render $scene --sky gradient --key-light none -o ao.exr --lit s1.exr --unlit s2.exr
}
good compare --json k1.exr k2.exr --channel R
at_most "$(number max_error)" 0 "key light and occlusion"
good compare --json s1.exr s2.exr --channel R
at_least "$(number mae)" 0.001 "sky light and occlusion"

# With the light that surfaces pass on: none in black surroundings, more in brighter ones;
# the mesh's own albedo lies between.
lit() {
    # shellcheck disable=SC2086
    good render $scene --sky constant:1,1,1 --key-light none --shade lit -o lit.exr "$@"
    mean lit
}
plain=$(lit)
black=$(lit --albedo 0)
mesh=$(lit --albedo mesh)
white=$(lit --albedo 1)
near "$black" "$plain" "black surroundings"
at_least "$mesh" "$(awk -v x="$plain" 'BEGIN { print x * 1.01 }')" "the mesh's albedo"
at_least "$white" "$(awk -v x="$mesh" 'BEGIN { print x * 1.002 }')" "white surroundings"
near "$(lit --albedo 0,1,0)" "$plain" "red in green surroundings"
bad 2 '--albedo: "2" is none' render builtin:corner --shade lit --albedo 2 -o out.exr
bad 2 '--albedo: "blue" is none' render builtin:corner --shade lit --albedo blue -o out.exr
bad 2 '--albedo: lights no picture' render builtin:corner --albedo 1 -o out.exr
bad 2 '--albedo: is for ambient' render builtin:corner --shade lit-no-ao --albedo 1 -o out.exr

# Sky light by rays: the floor is open, by the corner it is what occlusion says, nearly.
# shellcheck disable=SC2086
good render $floor --sky gradient --key-light none -o open.exr
# shellcheck disable=SC2086
good render ${floor%lit-no-ao*}lit ${floor#*lit-no-ao} --sky gradient --key-light none \
    --radius 1 --sky-rays 1024 -o rays.exr
good compare --json open.exr rays.exr --channel G
at_most "$(number rmse)" "$(awk -v x="$(number mean_a)" 'BEGIN { print 0.01 * x }')" \
    "an open floor by rays"
# shellcheck disable=SC2086
good render $scene --sky gradient --key-light none -o ao.exr --lit t.exr --unlit u.exr \
    --sky-rays 256
cmp -s u.exr s2.exr || fail "--sky-rays changes the picture without occlusion"
good compare --json t.exr s2.exr --channel R
unlit=$(number rmse)
at_least "$unlit" 0.001 "rays that are blocked"
good compare --json t.exr s1.exr --channel R
# Unfiltered, occlusion takes off 54 %; filtered, at 64 x 36 pixels, 49 to 50.
at_most "$(number rmse)" "$(awk -v x="$unlit" 'BEGIN { print 0.55 * x }')" "rays and occlusion"
# shellcheck disable=SC2086
good render $scene --sky gradient --key-light none -o ao.exr --lit other.exr --sky-rays 256 \
    --seed 1
good compare --json t.exr other.exr --channel R
at_least "$(number rmse)" 0.0001 "other rays with another seed"
at_most "$(number rmse)" "$(awk -v x="$unlit" 'BEGIN { print x / 4 }')" "noise of 256 rays"
bad 2 '--sky-rays: is for the lit' render builtin:corner --sky-rays 8 -o out.exr
bad 2 '--sky-rays: traces no light' render builtin:corner --shade lit --sky-rays 8 \
    --albedo 1 -o out.exr
