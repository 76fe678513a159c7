# SPDX-License-Identifier: MIT
# Bad input: one clear line, exit code 1 or 2, no output file.
. "$(dirname "$0")/tool_lib.sh"

m=builtin:sphere
small="--size 32x18"
good gbuffer $m $small -o frame.exr
good render $m $small -o picture.png
mkdir folder
: >empty.exr
: >empty.png
: >empty.glb
head -c 700 frame.exr >cut.exr
head -c 60 picture.png >cut.png
echo "this is text" >text.exr
cp text.exr text.png
cp text.exr text.glb
printf 'glTF\002\000\000\000\377\377\000\000cut short' >cut.glb
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\n' >points.obj

# shellcheck disable=SC2086 # $small is two words
render() {
    expected=$1 phrase=$2
    shift 2
    bad "$expected" "$phrase" render "$@" $small -o out.png
}
render 1 'missing.glb: ' missing.glb
render 1 'folder: ' folder
render 1 'empty.glb: ' empty.glb
render 1 'cut.glb: ' cut.glb
render 1 'text.glb: ' text.glb
render 1 'points.obj: ' points.obj # it has no face
render 2 'builtin:spheer: .*sphere' builtin:spheer
render 2 "--import-timeout.*0.01 to 1000000 seconds" $m --import-timeout 0
render 2 'MODEL is missing'
render 2 'radius: 0 ' $m --radius 0
render 2 'radius: -1 ' $m --radius -1
render 2 'radius: .*nan' $m --radius nan
render 2 'radius: 1e+30 ' $m --radius 1e30
render 2 "radius: '12abc'" $m --radius 12abc
render 2 "method: .*did you mean 'hbao'" $m --method hbaoo
render 2 "filter: .*did you mean 'gauss5'" $m --filter gaus5
render 2 "falloff: .*did you mean 'linear'" $m --falloff liner
render 2 "preset: .*did you mean ultra" $m --preset ulrta
render 2 'preset' $m --preset
render 2 'did you mean --preset?' $m --prset low
render 2 'did you mean --radius?' $m --radus 1
render 2 'did you mean --max-radius-px?' $m --max-radius 9
render 2 'no such option' $m --frobnicate 9
render 2 '--shade: .*did you mean lit' $m --shade litt
render 2 '--vfov: "0" ' $m --vfov 0
render 2 '--vfov: "180" ' $m --vfov 180
render 2 '--ortho: contradicts' $m --vfov 30 --ortho 5
render 2 '--eye: ' $m --eye 1,2
render 2 '--eye: is the same point' $m --eye 1,2,3 --target 1,2,3
render 2 '--up: lies along' $m --eye 0,0,5 --target 0,0,0 --up 0,0,1
render 2 '--up: has no length' $m --up 0,0,0
render 2 '--layers: "5"' $m --layers 5
render 2 '--guard-px: ' $m --guard-px 20000
render 2 '--bits: "12"' $m --bits 12
render 2 'its value is missing' $m --radius
render 2 'one argument too many' $m $m
render 2 'directions: ' $m --directions 2.5
for device in gpu vulkan: vulkan:x vulkan:-1 vulkan:1x vulkan:99999 vulkan+1 ''; do
    render 2 '--device: "' $m --device "$device"
done
render 2 '--isa: is for the CPU' $m --device vulkan --isa scalar
render 2 '--isa avx3: not on this machine; there are scalar' $m --isa avx3
render 2 '--exact: is for the CPU' $m --device vulkan:0 --exact

bad 2 '--size: "0x0"' render $m --size 0x0 -o out.png
bad 2 '--size: "100000x100000"' render $m --size 100000x100000 -o out.png
bad 2 '-o OUT is missing' render $m
bad 2 'is missing' render $m -o --quiet
bad 1 'out.jpg: ' render $m -o out.jpg
bad 1 'nowhere/out.png: ' render $m -o nowhere/out.png
bad 1 'folder' render $m -o folder
bad 2 'two pictures' render $m -o out.png --lit out.png
bad 2 'cannot hold a G-buffer' gbuffer $m -o out.png
cp points.obj model.png
bad 2 'is an input' render model.png -o model.png
cmp -s points.obj model.png || fail "the input was touched"

# shellcheck disable=SC2086
ao() {
    expected=$1 phrase=$2
    shift 2
    bad "$expected" "$phrase" ao "$@" -o out.exr
}
ao 1 'missing.exr: ' missing.exr --vfov 60
ao 1 'folder: ' folder --vfov 60
ao 1 'empty.exr: ' empty.exr --vfov 60
ao 1 'empty.png: ' empty.png --vfov 60
ao 1 'cut.exr: ' cut.exr --vfov 60
ao 1 'cut.png: ' cut.png --vfov 60
ao 1 'text.exr: ' text.exr --vfov 60
ao 1 'text.png: ' text.png --vfov 60
ao 1 'frame.exr: .*N.X' frame.exr --depth Depth # lists the channels there are
ao 1 'frame.exr: ' frame.exr --normal Nromal
ao 1 'vfov' picture.png # a picture knows no camera
bad 2 'is an input' ao frame.exr -o frame.exr
ao 2 'add --near and' frame.exr --depth-encoding hardware
ao 2 '--far: ' frame.exr --depth-encoding reversed --near 2 --far 1
ao 2 '--near: ' frame.exr --depth-encoding reversed --near 0 --far 1
ao 2 '--near: is for' frame.exr --near 1
ao 2 '--background: "-1"' frame.exr --background -1
ao 2 '--background: is for' frame.exr --background 9 --depth-encoding disparity
ao 2 'did you mean radial' frame.exr --depth-encoding radia
ao 2 'add --frames' 'shot.####.exr' --vfov 60
ao 2 '--frames: is not a range' 'shot.####.exr' --frames 9-1 --vfov 60
ao 2 '-o: needs one place' 'shot.####.exr' --frames 1-9 --vfov 60
ao 2 'IN: needs one place' shot.exr --frames 1-9 --vfov 60
ao 2 'IN: standard input' - --vfov 60
ao 2 'radius: 0 ' frame.exr --radius 0
bad 1 'nowhere/out.exr: ' ao frame.exr -o nowhere/out.exr
bad 2 'did you mean --json?' compare frame.exr frame.exr --jsno

# Relief and light.
pfm map.pfm 2 1 0 1
render 2 '--height-map: is not read by hbao; give .*vao' $m --height-map map.pfm \
    --height-scale 1 --method hbao
render 2 '--height-map: has no scale' $m --height-map map.pfm
render 2 '--height-scale: "inf"' $m --height-map map.pfm --height-scale inf
render 2 '--height-scale: is for' $m --height-scale 1
render 2 '--height-wrap: is for' $m --height-wrap clamp
render 2 '--height-wrap: ' $m --height-map map.pfm --height-scale 1 --height-wrap clmap
render 1 'missing.png: ' $m --height-map missing.png --height-scale 1
render 1 'text.png: ' $m --height-map text.png --height-scale 1
render 1 'frame.exr: has several channels' $m --height-map frame.exr --height-scale 1
cat >bare.obj <<'OBJ'
v 0 0 0
v 1 0 0
v 0 1 0
f 1 2 3
OBJ
render 1 'bare.obj: .*texture coordinates' bare.obj --height-map map.pfm --height-scale 1
render 1 'bare.obj: .*texture coordinates' bare.obj --height-map map.pfm \
    --height-scale 1 --shade lit-no-ao
render 2 '--sky: lights no picture' $m --sky gradient
render 2 '--key-light: lights no picture' $m --key-light none
render 2 '--zenith: lights no picture' $m --zenith 0,1,0
render 2 '--zenith: has no length' $m --shade lit --zenith 0,0,0
render 2 '--sky: .*did you mean gradient' $m --shade lit --sky gradeint
render 2 '--sky: ' $m --shade lit --sky picture.png
render 2 '--sky: ' $m --shade lit --sky constant:1,2
render 2 '--sky: ' $m --shade lit --sky constant:1,-1,1
render 2 '--sky: ' $m --shade lit --sky constant:nan,1,1
render 1 'missing.exr: ' $m --shade lit --sky missing.exr
render 1 'frame.exr: .*"R"' $m --shade lit --sky frame.exr
render 2 '--key-light: ' $m --shade lit --key-light nonne
render 2 '--key-light: ' $m --shade lit --key-light 10
render 2 '--key-light: ' $m --shade lit --key-light 10,91
render 2 '--key-light: ' $m --shade lit --key-light 10,20,-1
ao 2 '--layer-kind: .*did you mean solid' frame.exr --layer-kind solids

# Inputs of any kind are not overwritten, whatever their path looks like.
cp map.pfm kept.pfm
cp frame.exr kept.exr
relief="--height-map kept.pfm --height-scale 1 --method vao"
bad 2 'kept.pfm: is an input' render $m $small $relief -o kept.pfm
bad 2 'kept.pfm: is an input' render $m $small $relief -o out.png --lit ./kept.pfm
bad 2 'kept.exr: is an input' render $m $small --shade lit --sky kept.exr -o kept.exr
bad 2 'two pictures' render $m $small -o out.png --lit new.png --unlit ./new.png
cmp -s map.pfm kept.pfm && cmp -s frame.exr kept.exr || fail "an input was overwritten"

# A limit on the size of files is told as any full disk; nothing is left behind.
(
    ulimit -f 1000 # half a megabyte: runtimes want some for themselves
    bad 1 'out.pfm: cannot be written' render $m --size 640x360 -o out.pfm
)
# What is replaced keeps its permissions.
good render $m $small -o mode.png
chmod 600 mode.png
good render $m $small -o mode.png
[ "$(ls -l mode.png | cut -c1-10)" = -rw------- ] || fail "the file's mode is lost"

render 2 '--characteristic field: there is no relief' $m --method vao \
    --characteristic field
ao 2 '--characteristic field: frames have no relief' frame.exr --method vao \
    --characteristic field
ao 1 'name normals without' frame.exr --normal N.X --vfov 60
bad 1 'cut.exr: ' bench builtin:corner cut.exr
[ ! -s stdout.txt ] || fail "bench began before it saw that a frame is damaged"

# A name with a line break does not make two lines of one.
bad 1 'missing?' ao "missing
crevice: forged.exr" -o out.exr --vfov 60

# Valid, if odd: background only, NaN and infinite depths, normals that are none.
pfm odd.pfm 2 2 nan inf 1 -inf
good ao odd.pfm --vfov 60 -o odd.exr
