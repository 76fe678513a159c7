# SPDX-License-Identifier: MIT
# Every method, and every filter, on a Vulkan device against the scalar code, on large meshes
# where the folder of scenes is at hand and on the built-in scene.
command -v python3 >/dev/null || { echo "no python3; skipped"; exit 77; }
. "$(dirname "$0")/tool_lib.sh"

if ! "$tool" devices | grep -q '^vulkan:0'; then
    [ -n "${CI:-}" ] && { echo "no Vulkan device"; exit 1; }
    echo "no Vulkan device; skipped"
    exit 77
fi

# Pixels of two PFM files that differ by more than 2e-3; at most one in a thousand may: where
# a device rounds a division otherwise, a sample falls on the next texel.
cat >beyond.py <<'END'
import array, sys
def pixels(name):
    with open(name, "rb") as file:
        kind, size, scale = file.readline(), file.readline().split(), float(file.readline())
        values = array.array("f", file.read())
    if (scale > 0) == (sys.byteorder == "little"):
        values.byteswap()
    return values[:: 3 if kind.strip() == b"PF" else 1]
a, b = pixels(sys.argv[1]), pixels(sys.argv[2])
beyond = sum(not abs(x - y) <= 2e-3 for x, y in zip(a, b))
print(f"{sys.argv[3]}: {beyond} of {len(a)} pixels beyond 2e-3")
sys.exit(len(a) != len(b) or beyond > len(a) / 1000)
END

# names LIST: of all methods, or filters.
names()
{
    "$tool" methods --json | python3 -c 'import json, sys
print(*(entry["name"] for entry in json.load(sys.stdin)[sys.argv[1]]))' "$1"
}
methods=$(names methods)
filters=$(names filters)

# agrees NAME RADIUS METHOD FILTER: one picture of NAME.exr
agrees()
{
    set -- "$1" "$2" --method "$3" --filter "$4"
    good ao "$1.exr" -o cpu.pfm --radius "$2" "$3" "$4" "$5" "$6" --isa scalar
    good ao "$1.exr" -o vulkan.pfm --radius "$2" "$3" "$4" "$5" "$6" --device vulkan
    python3 beyond.py cpu.pfm vulkan.pfm "$1, $4, $6" || fail "$1, $4, $6"
}

# all_agree NAME RADIUS: every method unfiltered, and one with every filter
all_agree()
{
    for method in $methods; do
        agrees "$1" "$2" "$method" none
    done
    for filter in $filters; do
        agrees "$1" "$2" hbao "$filter"
    done
}

good gbuffer builtin:courtyard -o courtyard.exr --size 320x180
all_agree courtyard 1

# Bent normals. Nineteen of twenty are within a tenth of a degree: the others may have read a
# neighbouring texel.
for method in gtao bitmask hsao raymarch; do
    for device in "cpu --isa scalar" vulkan; do
        # shellcheck disable=SC2086 # words
        good ao courtyard.exr -o "bent_${device%% *}.exr" --radius 1 --method "$method" \
            --bent-normal on --device $device
    done
    good compare --json bent_cpu.exr bent_vulkan.exr
    at_least "$(number bent_pixels)" 30000 "$method: pixels with bent normals"
    at_most "$(number bent_q95_deg)" 0.1 "$method: angle between bent normals"
done

# Long work says how long beforehand, and ends at a signal. A GPU may be done with it within
# ten seconds.
if "$tool" devices | grep '^vulkan:0' | grep -q '; a CPU)$'; then
    ends_soon '^estimation:  *[0-9.]* %, [0-9].* left$' '' render builtin:courtyard \
        --size 320x180 --method bitmask --directions 256 --steps 256 --device vulkan -o long.png
fi

scenes=${CREVICE_SHARED:-}/scenes
[ -e "$scenes/cameras.json" ] || exit 0
python3 -c 'import json, sys
for v in json.load(open(sys.argv[1]))["views"]:
    point = lambda key: ",".join(str(x) for x in v[key])
    print(v["name"], v["file"], point("eye"), point("target"), point("up"),
          v["vfov_degrees"], v["radius"])
' "$scenes/cameras.json" >views.txt
while read -r name file eye target up vfov radius; do
    good gbuffer "$scenes/$file" -o "$name.exr" --size 320x180 --eye "$eye" \
        --target "$target" --up "$up" --vfov "$vfov"
    all_agree "$name" "$radius"
done <views.txt
