# SPDX-License-Identifier: MIT
# Height maps.
. "$(dirname "$0")/tool_lib.sh"

# A flat quad, 4 units large, and the same with ridges that are really there. The map has
# two texels for a unit, 0 and 1: between their centres it rises and falls in a straight
# line, so ridges of height 0.3 have their feet at u = 1/4 and their crests at u = 3/4.
cat >flat.obj <<'OBJ'
v -2 0 2
v 2 0 2
v 2 0 -2
v -2 0 -2
vt 0 0
vt 4 0
vt 4 4
vt 0 4
vn 0 1 0
f 1/1/1 2/2/1 3/3/1 4/4/1
OBJ
awk 'BEGIN {
    for (i = 0; i <= 9; i++) {
        x = -2.25 + i / 2; y = i % 2 == 0 ? 0.3 : 0
        print "v", x, y, 2.25; print "v", x, y, -2.25
    }
    for (i = 1; i < 19; i += 2) print "f", i, i + 2, i + 3, i + 1
}' >ridges.obj
pfm map.pfm 2 1 0 1
view="--size 120x120 --eye 0,5,0 --target 0,0,0 --up 0,0,-1 --ortho 3 --radius 0.5"
view="$view --normals-from face"

# shellcheck disable=SC2086 # $view is words
for method in "containment --falloff none" vao; do
    many="--method $method --samples 256 --filter none"
    good render flat.obj $view $many -o flat.exr
    good render ridges.obj $view $many -o ridges.exr
    good render flat.obj $view $many -o relief.exr --height-map map.pfm --height-scale 0.3
    good compare --json relief.exr flat.exr
    at_most "$(number mean_a)" 0.99 "$method: mean with relief"
    at_least "$(number mean_b)" 0.9999 "$method: mean without relief"
    good compare --json relief.exr ridges.exr
    # The same points are tested for both, but in depth for the texel that they fall on: 1
    # px is 1/40 unit, on a slope of 1.2 at most 0.015 units, 3 % of the radius. Pipes stop
    # in the tangent sphere, which on slopes this gentle touches one side of a ridge only.
    at_most "$(number mae)" 0.005 "$method: relief and real ridges"
    at_least "$(number ssim)" 0.95 "$method: relief and real ridges, SSIM"
done

# Lit from above, where no ridge shadows another, relief looks as real ridges do. Albedo is
# the same, and there is no sky.
light="--shade lit-no-ao --sky constant:0,0,0 --key-light 90,60 --zenith 0,1,0"
# shellcheck disable=SC2086
{
    good render ridges.obj $view $light -o ridges.exr
    good render flat.obj $view $light -o relief.exr --height-map map.pfm --height-scale 0.3
    good render flat.obj $view $light -o flat.exr
}
good compare --json relief.exr ridges.exr --channel R
at_most "$(number mae)" 0.001 "lit: relief and real ridges"
good compare --json relief.exr flat.exr --channel R
at_least "$(number mae)" 0.05 "lit: relief and flat"

# No height is no map; a height map makes vao the method.
small="--size 160x90 --radius 0.4"
# shellcheck disable=SC2086
{
    good render builtin:plane $small -o zero.exr --height-map map.pfm --height-scale 0
    grep -q '^vao 12 samples, ' stderr.txt || fail "vao is not the default with a map"
    good render builtin:plane $small -o none.exr --method vao
    good compare --json zero.exr none.exr
    at_most "$(number max_error)" 0.0001 "no height and no map" # rounding
}

# One map in four formats: the only channel of an EXR, 8 and 16 bits of grey.
# shellcheck disable=SC2086
{
    good render builtin:courtyard --size 64x64 -o bumps.exr
    good render builtin:courtyard --size 64x64 -o bumps.pfm
    good render builtin:courtyard --size 64x64 -o bumps8.png
    good render builtin:courtyard --size 64x64 -o bumps16.png --bits 16
    for map in bumps.exr bumps.pfm bumps8.png bumps16.png; do
        good render builtin:relief $small -o "$map.exr" --height-map $map \
            --height-scale -1
    done
}
good compare --json bumps.exr.exr bumps.pfm.exr
at_most "$(number max_error)" 0 "EXR and PFM"
good compare --json bumps.exr.exr bumps16.png.exr
at_most "$(number mae)" 0.0001 "EXR and 16-bit PNG"
good compare --json bumps.exr.exr bumps8.png.exr
# Steps of 1/255 over texels of 1/32 unit are slopes of up to 0.13 that are not there.
at_most "$(number mae)" 0.005 "EXR and 8-bit PNG"
# shellcheck disable=SC2086
good render builtin:relief $small -o none.exr --method vao
good compare --json bumps.exr.exr none.exr
at_least "$(number mae)" 0.02 "a relief that shows"

# Parts without coordinates are told of.
# shellcheck disable=SC2086
good render builtin:courtyard $small -o part.exr --height-map map.pfm --height-scale 0.1
grep -q 'has no texture coordinates and stays flat' stderr.txt ||
    fail "parts without coordinates are not told of"
