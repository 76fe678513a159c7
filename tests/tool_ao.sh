# SPDX-License-Identifier: MIT
# Frames to ambient occlusion.
. "$(dirname "$0")/tool_lib.sh"

size="--size 240x135"

# A G-buffer on disk holds all that render needs: camera, guard band, layers, normals.
for extra in "" "--layers 2" "--layers 3 --layer-kind solid" "--normals-from face --guard-px 0"; do
    # shellcheck disable=SC2086
    good render builtin:courtyard $size $extra -o direct.exr --radius 0.4
    # shellcheck disable=SC2086
    good gbuffer builtin:courtyard $size $extra -o buffer.exr
    good ao buffer.exr -o ao.exr --radius 0.4
    good compare --json direct.exr ao.exr
    # Normals turn to world space and back and the camera passes through a float matrix;
    # only at a silhouette can that decide which texel a sample falls on.
    at_most "$(number mae)" 0.0002 "roundtrip ($extra): mean error"
    at_most "$(number rmse)" 0.002 "roundtrip ($extra): RMSE"
    [ "$(number pixels)" -eq 32400 ] || fail "the result is not the inner rectangle"
done

# What layers mean is in the file, and --layer-kind says otherwise.
for kind in solid surfaces; do
    # shellcheck disable=SC2086
    good gbuffer builtin:courtyard $size --layers 2 --layer-kind $kind -o $kind.exr
    good ao $kind.exr -o $kind.found.exr --method vao --radius 0.4
    for other in surfaces solid; do
        good ao $kind.exr -o $kind.$other.exr --method vao --radius 0.4 --layer-kind $other
    done
    good compare --json $kind.solid.exr $kind.surfaces.exr
    at_least "$(number rmse)" 0.001 "surfaces and solids differ"
done
good compare --json solid.found.exr solid.solid.exr
at_most "$(number max_error)" 0 "solids are found to be solids"
good compare --json surfaces.found.exr surfaces.surfaces.exr
at_most "$(number max_error)" 0 "surfaces are found to be surfaces"
good gbuffer builtin:groove $size -o groove.exr
good ao groove.exr -o groove_ao.exr --radius 0.4
good render builtin:groove $size -o groove_direct.exr --radius 0.4
good compare --json groove_direct.exr groove_ao.exr
at_most "$(number rmse)" 0.002 "orthographic roundtrip: RMSE"

# Normals on disk are in world space: a floor's point up, wherever it is seen from.
good gbuffer builtin:plane $size --eye 3,2,-5 --target 0.5,0,0 -o floor.exr
good compare --json floor.exr floor.exr --channel N.Y
at_least "$(number mean_a)" 0.99999 "mean N.Y of a floor"

# Without normals, with the camera by hand.
good gbuffer builtin:sphere $size -o plain.exr --vfov 40 --guard-px 0
good ao plain.exr -o depth_only.exr --normal none --vfov 40 --radius 0.3
good ao plain.exr -o with_normals.exr --radius 0.3
good compare --json depth_only.exr with_normals.exr
at_most "$(number mae)" 0.02 "reconstructed normals: mean error"

# The radius that is chosen suits the picture, whatever the units.
good ao plain.exr -o chosen.exr
grep -Eq '^radius: --radius [0-9.e-]+, 5 %' stderr.txt || fail "the chosen radius is not told"

# A radius in metres and depth in another unit: next to nothing would be dark, or all is.
good ao plain.exr -o suits.exr --radius 0.3
! grep -q 'another unit' stderr.txt || fail "a radius that suits is doubted"
good ao plain.exr -o small.exr --radius 0.0003
grep -q 'warning: plain.exr: the radius 0.0003 is .* pixels wide on near surfaces' stderr.txt ||
    fail "a radius below a pixel is not told"
good ao plain.exr -o large.exr --radius 300
grep -q 'warning: plain.exr: the radius 300 is .* times the height of the view' stderr.txt ||
    fail "a radius beyond the view is not told"

# An angle in radians is taken as degrees, but not without a word.
good ao plain.exr -o radians.exr --normal none --vfov 0.698 --radius 0.01
grep -q 'warning: --vfov: 0.698 is taken as degrees; 0.698 radians are 39.99 degrees' stderr.txt ||
    fail "radians are not told"

# Frames: two of a range, an empty one first, which decides no radius.
pfm shot.0001.pfm 2 2 inf nan 0 -1
pfm shot.0003.pfm 2 2 1 1 1 1
pfm shot.0005.pfm 2 2 2 2 2 2
good ao "shot.####.pfm" --frames 1-6x2 --vfov 90 -o "ao.%03d.exr"
for frame in 001 003 005; do
    [ -s ao.$frame.exr ] || fail "frame $frame is missing"
done
[ ! -e ao.002.exr ] || fail "frame 2 was not asked for"
# 2 px high at 90 degrees: 2 * 1 units are seen at depth 1, a twentieth of them is 0.1.
grep -q '^radius: --radius 0.1, ' stderr.txt || fail "radius of the first frame"
[ "$(grep -c '^radius: ' stderr.txt)" -eq 1 ] || fail "one radius for all frames"

# A missing frame costs itself alone, and the list of failures says which.
code=0
"$tool" ao "shot.####.pfm" --frames 1,9,5 --vfov 90 -o "gap.####.png" 2>stderr.txt || code=$?
[ $code -eq 1 ] || fail "exit code $code for a missing frame"
grep -q '^crevice: shot.0009.pfm: ' stderr.txt || fail "the missing frame is not named"
grep -q '^crevice: 1 of 3 frames failed; .*--frames 9$' stderr.txt || fail "no list of failures"
[ -s gap.0001.png ] && [ -s gap.0005.png ] || fail "frames beside the missing one"
[ ! -e gap.0009.png ] || fail "a picture of a missing frame"

# A shot goes on where it was killed, with the same bits: the radius is taken up from the
# results that are there, and only what is missing, cut off or made otherwise is made.
# Two depths, so that each frame alone would choose another radius.
pfm part.0001.pfm 2 2 1 1 1 1
pfm part.0002.pfm 2 2 2 2 2 2
pfm part.0003.pfm 2 2 2 2 1 2
shot="part.####.pfm --vfov 90 --skip-existing"
# shellcheck disable=SC2086
good ao $shot --frames 1-3 -o "whole.####.exr"
# shellcheck disable=SC2086
good ao $shot --frames 1 -o "again.####.exr"
grep -q 'warning: --radius: these frames choose their own, and part.0002.pfm' stderr.txt ||
    fail "a part of a shot is not told"
# shellcheck disable=SC2086
good ao $shot --frames 1-2 -o "again.####.exr"
head -c 100 whole.0003.exr >again.0003.exr
rm again.0002.exr
# shellcheck disable=SC2086
good ao $shot --frames 1-3 -o "again.####.exr"
grep -q '^again.0001.exr: is there' stderr.txt || fail "a result that is there is not told"
grep -q '^again.0003.exr: is not whole' stderr.txt || fail "a result that is cut off"
for frame in 1 2 3; do
    cmp -s whole.000$frame.exr again.000$frame.exr || fail "frame $frame has other bits"
done
# shellcheck disable=SC2086
good ao $shot --frames 1-3 -o "again.####.exr" --intensity 2
[ "$(grep -c 'made with other settings' stderr.txt)" -eq 3 ] || fail "other settings"
# One frame decides for any part of the shot.
# shellcheck disable=SC2086
good ao $shot --frames 3 --radius-frame 1 -o "third.####.exr"
cmp -s whole.0003.exr third.0003.exr || fail "--radius-frame"

# The camera by its lens: 36 mm over 18 mm is 90 degrees wide.
good ao shot.0003.pfm --hfov 90 --radius 0.1 -o hfov.pfm
good ao shot.0003.pfm --lens 18 --radius 0.1 -o lens.pfm
cmp -s hfov.pfm lens.pfm || fail "--lens and --hfov differ"
bad 2 'contradicts' ao shot.0003.pfm --vfov 60 --lens 18 -o out.exr
bad 2 '--sensor' ao shot.0003.pfm --vfov 60 --sensor 18 -o out.exr

# Cameras of a shot: that of the frame's number is taken, a zoom has other lenses.
printf '1 0 0 0 0 0 0 90\n3 0 0 0 0 0 0 60\n' >zoom.chan
good ao "shot.####.pfm" --frames 1-3x2 --camera zoom.chan --radius 0.1 -o "zoom.####.pfm"
good ao shot.0003.pfm --vfov 60 --radius 0.1 -o sixty.pfm
cmp -s zoom.0003.pfm sixty.pfm || fail "the camera of frame 3"
good ao shot.0003.pfm --camera zoom.chan --radius 0.1 -o named.pfm
cmp -s named.pfm sixty.pfm || fail "the number in a frame's name"
bad 1 'no camera for frame 5' ao shot.0005.pfm --camera zoom.chan -o out.exr
bad 2 'leave out' ao shot.0003.pfm --camera zoom.chan --vfov 60 -o out.exr
bad 1 'no_such.chan: ' ao shot.0003.pfm --camera no_such.chan -o out.exr

# The camera that gbuffer writes is the one that it used, and the frame's normals agree.
good gbuffer builtin:courtyard $size -o first.exr --write-camera cam.json
good gbuffer builtin:courtyard $size -o second.exr --camera cam.json
cmp -s first.exr second.exr || fail "--write-camera and --camera differ"
good ao first.exr --camera cam.json --radius 0.4 -o by_camera.exr
grep -q 'world space, rotation from the camera ' stderr.txt || fail "the camera's rotation"
good ao first.exr --radius 0.4 -o by_metadata.exr
good compare --json by_camera.exr by_metadata.exr
at_most "$(number rmse)" 0.0001 "camera by file and by metadata"
# Turned otherwise than the normals say.
printf '{"eye": [0, 0, 0], "target": [3, -2, -1], "vfov": 45}' >turned.json
good ao first.exr --camera turned.json --radius 0.4 -o turned.exr
grep -q 'warning: .*turned otherwise' stderr.txt || fail "a camera that contradicts"

# The field of view that the normals agree on, for all frames.
good gbuffer builtin:courtyard $size -o fit.0001.exr --guard-px 0 --vfov 37
cp fit.0001.exr fit.0002.exr
good ao "fit.####.exr" --frames 1-2 --vfov fit --radius 0.4 -o "fitted.####.exr"
vfov=$(sed -n 's/^field of view: --vfov \([0-9.]*\), .*/\1/p' stderr.txt)
at_least "$vfov" 36.6 "a field of view of 37 degrees"
at_most "$vfov" 37.4 "a field of view of 37 degrees"
bad 1 'it has no normals' ao shot.0003.pfm --vfov fit -o out.exr
bad 2 'or fit' ao shot.0003.pfm --vfov find -o out.exr

# A later frame of another size is told of; so is one that shows nothing.
pfm shot.0007.pfm 3 2 1 1 1 1 1 1
good ao "shot.####.pfm" --frames 3-7x4 --vfov 90 -o "mix.####.exr"
grep -q 'warning: shot.0007.pfm: is 3x2, the first frame 2x2' stderr.txt ||
    fail "another size is not told"
pfm zero.pfm 2 2 0 0 0 0
good ao zero.pfm --vfov 60 -o zero.exr
grep -q 'warning: zero.pfm: shows nothing' stderr.txt || fail "no depth is not told"

# z of view space is negative; it means the same.
pfm negative.pfm 2 2 -1 -1 -1 -1
good ao negative.pfm --vfov 60 -o negative.exr
grep -q '^negative.pfm: depth is negative everywhere' stderr.txt || fail "negative depth"

# All background is all white: nothing but 255 in an 8-bit grey picture.
good ao shot.0001.pfm --vfov 60 -o white.pfm
tail -c 16 white.pfm >white.raw
floats 1 1 1 1 >expected.raw
cmp -s white.raw expected.raw || fail "an empty frame is not white"

# Depth buffers: 0.5 between near 1 and far inf is 2 units away, in both directions.
pfm half.pfm 3 1 0 1 0
good ao half.pfm --vfov 60 --depth-encoding hardware --near 1 --far 10 -o d1.exr
good ao half.pfm --vfov 60 --depth-encoding reversed --near 1 --far inf -o d2.exr
good ao half.pfm --ortho 3 --depth-encoding disparity -o d3.exr
good ao half.pfm --vfov 60 --depth-encoding radial --background 5 -o d4.exr

good help camera
grep -q 'camera_to_world' stdout.txt || fail "help camera"

# The table of renderers' passes.
good help passes
grep -q 'VRayZDepth' stdout.txt && grep -q 'WorldNormal .*left-handed' stdout.txt ||
    fail "help passes"
