# SPDX-License-Identifier: MIT
# Models to pictures.
. "$(dirname "$0")/tool_lib.sh"

small="--size 160x90"

# One run, three pictures, which differ.
good render builtin:courtyard $small -o ao.png --lit lit.png --unlit plain.png
for file in ao.png lit.png plain.png; do
    [ "$(head -c 4 $file | od -An -c | tr -d ' ')" = '211PNG' ] || fail "$file is no PNG"
done
cmp -s lit.png plain.png && fail "ambient occlusion does not show in the lit picture"
grep -q 'courtyard: [0-9]* triangles' stderr.txt || fail "no line about the model"
grep -q '^bitmask 5x7, radius .*, edges15: ' stderr.txt || fail "no line about the method"
grep -q '^wrote ao.png$' stderr.txt || fail "no line about the file"

# --shade writes the same pictures as the other outputs do.
good render builtin:courtyard $small -o lit2.png --shade lit
cmp -s lit.png lit2.png || fail "--shade lit differs from --lit"
good render builtin:courtyard $small -o plain2.png --shade lit-no-ao
cmp -s plain.png plain2.png || fail "--shade lit-no-ao differs from --unlit"

# Quiet is quiet; the number of threads changes nothing.
good render builtin:courtyard $small -o one.exr --quiet --threads 1
[ ! -s stderr.txt ] || fail "--quiet writes lines"
[ ! -s stdout.txt ] || fail "render writes to stdout"
good render builtin:courtyard $small -o seven.exr --quiet --threads 7
good compare --json one.exr seven.exr
at_most "$(number max_error)" 0 "difference of 1 and 7 threads"

# The camera that a run tells of gives the same picture again.
good render builtin:courtyard $small -o told.exr
camera=$(sed -n 's/^camera: //p' stderr.txt)
radius=$(sed -n 's/^radius: \(--radius [^,]*\),.*/\1/p' stderr.txt)
[ -n "$camera" ] && [ -n "$radius" ] || fail "camera or radius is not told"
# shellcheck disable=SC2086 # words are meant to be split
good render builtin:courtyard $small -o again.exr $camera $radius
good compare --json told.exr again.exr
at_most "$(number max_error)" 0 "difference of the told camera"

# Options in a file are those of the command line, which wins over them.
printf '# a look\nmethod=gtao radius=0.3\nfalloff=none\n\nfilter=none\r\npreset=low\n' >look.txt
good render builtin:courtyard $small -o file.exr --options look.txt --radius 0.2
good render builtin:courtyard $small -o flags.exr --method gtao --preset low --radius 0.2 \
    --falloff none --filter none
good compare --json file.exr flags.exr
at_most "$(number max_error)" 0 "difference of options in a file"
echo 'radius 0.3' >out_bad.txt && mv out_bad.txt bad.txt
bad 2 'bad.txt: "radius" is not key=value' render builtin:plane -o out.png --options bad.txt
echo radios=0.3 >bad.txt
bad 2 'did you mean .radius.' render builtin:plane -o out.png --options bad.txt
bad 1 'no.txt: No such file' render builtin:plane -o out.png --options no.txt

# Two perpendicular planes: open far from the edge, about half closed in it.
good render builtin:corner $small -o corner.exr --radius 0.5
good render builtin:plane $small -o plane.exr --radius 0.5
good compare --json corner.exr corner.exr
at_most "$(number mean_a)" 0.9999 "mean accessibility of a corner"
good compare --json plane.exr plane.exr
at_least "$(number mean_a)" 0.98 "mean accessibility of a plane"

# Scenes made in code have parameters, and wrong ones are wrong usage.
good render builtin:plane,tilt=60 --size 32x18 -o tilted.png
bad 2 'angle=X with X from 10 to 170' render builtin:groove,angle=5 -o out.png
bad 2 'choose one of courtyard, ' render builtin:nowhere -o out.png

# White all over is told of: a plane has nothing that occludes it.
good render builtin:plane,tilt=30 --size 32x18 -o white.png
grep -q '^crevice: warning: .*nothing in view is occluded' stderr.txt || fail "white, no word"

# Antialiasing is the mean of a larger picture.
good render builtin:corner --size 48x28 --aa 3 -o fine.exr --radius 0.5 --guard-px 4
grep -q '^G-buffer 144x84, guard band 12 px' stderr.txt || fail "--aa 3 is not three times"
grep -q 'warning' stderr.txt && fail "--aa warns of what nobody asked for"
good render builtin:corner --size 144x84 -o large.exr --radius 0.5 --guard-px 12
good compare --json fine.exr fine.exr
fine=$(number mean_a)
[ "$(number pixels)" -eq 1344 ] || fail "--aa changes the picture's size"
good compare --json large.exr large.exr
# Sums of floats in another order.
at_most "$(awk -v a="$fine" -v b="$(number mean_a)" 'BEGIN { print (a - b)^2 }')" 1e-11 \
    "mean of the antialiased picture, against the large one"
bad 2 '1 to 16' render builtin:corner --aa 17 -o no.png

# The cameras of a model, by name and by number; names that are not there are told.
{
    printf '{"asset":{"version":"2.0"},"scenes":[{"nodes":[0,1,2]}],"nodes":[{"mesh":0},'
    printf '{"camera":0,"name":"top","translation":[0,9,0],'
    printf '"rotation":[-0.70710678,0,0,0.70710678]},{"camera":0,"translation":[0,0.5,9]}],'
    printf '"cameras":[{"type":"perspective","perspective":{"yfov":0.5}}],'
    printf '"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{'
    printf '"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],'
    printf '"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,'
    printf '"uri":"data:;base64,%s"}]}' "$(floats -1 0 1 1 0 1 0 1 -1 | base64 -w 0)"
} >cameras.gltf
good render cameras.gltf --size 32x18 -o top.exr --camera top
grep -q '^camera: --eye 0,9,0 --target 0,0.5' stderr.txt || fail "the camera called top"
good render cameras.gltf --size 32x18 -o front.exr --camera 2 --vfov 10
grep -q '^camera: --eye 0,0.5,9 --target 0,0.5,0 --up 0,1,0 --vfov 10' stderr.txt ||
    fail "the second camera, with another lens"
bad 1 'has no camera "side"; choose one of top' render cameras.gltf --camera side -o no.png
bad 1 'has no camera; ' render builtin:corner --camera top -o no.png
bad 2 'contradicts --eye' render cameras.gltf --camera top --eye 1,1,1 -o no.png

# Partial cameras, an orthographic one, layers, face normals, no guard band, odd names.
good render builtin:corner $small -o "s p ä.png" --eye 3,4,5
good render builtin:corner $small -o out1.png --target 0,0,0 --up 0,0,1
good render builtin:corner $small -o out2.png --eye 0,9,0 --target 0,0,0
good render builtin:corner $small -o out3.png --ortho 5 --bits 16
good render builtin:corner $small -o out4.exr --vfov 20 --half
good render builtin:corner --size 33x21 -o out5.pfm --layers 4 --layer-kind solid
good render builtin:corner --size 1x1 -o out6.png --guard-px 0 --normals-from face
[ -s "s p ä.png" ] || fail "a name with spaces"

# A camera that looks away is told of.
for command in render gbuffer reference; do
    good $command builtin:corner --size 16x9 -o away.exr --eye 0,9,0 --target 0,99,0
    grep -q '^crevice: warning: builtin:corner: nothing of it is in view' stderr.txt ||
        fail "$command: nothing in view, and no word of it"
done
good render builtin:corner --size 16x9 -o toward.exr
grep -q 'nothing of it' stderr.txt && fail "a warning of a sphere that is in view"

# A mesh from a file, and an option without effect, which is told of but no error.
cat >tetra.obj <<'OBJ'
v 0 0 0
v 1 0 0
v 0 1 0
v 0 0 1
f 1 3 2
f 1 2 4
f 1 4 3
f 2 3 4
OBJ
good render tetra.obj $small -o out7.png --tau 2 --falloff linear --filter none \
    --filter-depth 0.5
grep -q '^crevice: warning: filter_depth' stderr.txt || fail "no warning of a useless option"
[ "$(grep -c '^crevice: warning: filter_depth' stderr.txt)" -eq 1 ] || fail "told twice"
grep -q 'tetra.obj: 4 triangles' stderr.txt || fail "tetra.obj has four triangles"

# A signal while a file is being written waits until it is whole, or half a second.
"$tool" gbuffer builtin:courtyard --size 1600x900 -o big.exr 2>stderr.txt &
pid=$!
until ls .crevice-* >/dev/null 2>&1; do
    kill -0 $pid 2>/dev/null || break # too quick for us: then there is nothing to see
done
kill -TERM $pid 2>/dev/null && caught=yes || caught=no
code=0
wait $pid || code=$?
if [ $caught = yes ] && [ $code -ne 0 ]; then
    [ $code -eq 143 ] || fail "exit code $code after SIGTERM"
    [ -z "$(ls .crevice-* 2>/dev/null)" ] || fail "a temporary file is left behind"
    if [ -e big.exr ]; then
        good compare big.exr big.exr --channel Z
    else
        grep -q '^crevice: big.exr: is not written: interrupted$' stderr.txt ||
            fail "no picture and no line: $(cat stderr.txt)"
    fi
fi
