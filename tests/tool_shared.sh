# SPDX-License-Identifier: MIT
# Large meshes and a renderer's frames, where the folder of scenes is at hand.
if [ -z "${CREVICE_SHARED:-}" ] || [ ! -e "$CREVICE_SHARED/scenes/cameras.json" ]; then
    echo "CREVICE_SHARED is not set to a folder with scenes; skipped"
    exit 77
fi
command -v python3 >/dev/null || { echo "no python3; skipped"; exit 77; }
. "$(dirname "$0")/tool_lib.sh"

scenes=$CREVICE_SHARED/scenes
python3 -c 'import json, sys
for v in json.load(open(sys.argv[1]))["views"]:
    point = lambda key: ",".join(str(x) for x in v[key])
    print(v["name"], v["file"], point("eye"), point("target"), point("up"),
          v["vfov_degrees"], v["radius"])
' "$scenes/cameras.json" >views.txt

while read -r name file eye target up vfov radius; do
    good render "$scenes/$file" -o "$name.exr" --size 640x360 --eye "$eye" \
        --target "$target" --up "$up" --vfov "$vfov" --radius "$radius"
    good compare --json "$name.exr" "$name.exr"
    # Every view shows contacts, and none is mostly closed.
    at_least "$(number mean_a)" 0.5 "$name: mean accessibility"
    at_most "$(number mean_a)" 0.995 "$name: mean accessibility"
    [ -e "$scenes/blender/$name.exr" ] || continue

    # The renderer's passes need the field of view and nothing else.
    good ao "$scenes/blender/$name.exr" --vfov "$vfov" --radius "$radius" \
        --falloff none -o "b_$name.exr"
    good compare --json "b_$name.exr" "$scenes/blender/$name.exr"
    echo "$name: RMSE $(number rmse), SSIM $(number ssim), mean $(number mean_a)," \
        "the renderer's $(number mean_b)"
    # The renderer's is ray-traced and cosine-weighted, and sees what depth does not, so
    # only the structure agrees. Frames of two different scenes are 0.24 or more apart.
    at_most "$(number rmse)" 0.15 "$name: RMSE from the renderer's"
    at_least "$(number ssim)" 0.8 "$name: SSIM with the renderer's"
done <views.txt

# A shot of Blender keeps all its channels, bit by bit, and gets AO beside them.
cases=$CREVICE_SHARED/cases/blender_shot
[ -e "$cases/shot.0001.exr" ] || exit 0
good ao "$cases/shot.####.exr" --frames 1,8,16,24 --lens 35 --append -o "shot.####.exr"
for frame in 0001 0008 0016 0024; do
    python3 - "$cases/shot.$frame.exr" shot.$frame.exr <<'END' || fail "the copy of $frame"
# Uncompresses both files by the rules of the format: scanlines, ZIP, 16 at a time.
import struct, sys, zlib

def read(path):
    data = open(path, "rb").read()
    at, attributes = 8, {}
    while data[at]:
        name, _, rest = data[at:at + 600].partition(b"\0")
        kind = rest.partition(b"\0")[0]
        at += len(name) + len(kind) + 2
        size, = struct.unpack_from("<i", data, at)
        attributes[name] = (kind, data[at + 4:at + 4 + size])
        at += 4 + size
    assert attributes[b"compression"][1] == b"\3"
    x0, y0, x1, y1 = struct.unpack("<4i", attributes[b"dataWindow"][1])
    width, channels, p = x1 - x0 + 1, [], attributes[b"channels"][1]
    while p[0]:
        name, _, rest = p.partition(b"\0")
        channels.append((name, struct.unpack_from("<i", rest)[0]))
        p = rest[16:]
    pixels = {name: b"" for name, _ in channels}
    for i in range((y1 - y0) // 16 + 1):
        offset, = struct.unpack_from("<Q", data, at + 1 + 8 * i)
        y, size = struct.unpack_from("<2i", data, offset)
        lines = min(16, y1 + 1 - y)
        row = sum(width * (2 if kind == 1 else 4) for _, kind in channels)
        chunk = data[offset + 8:offset + 8 + size]
        if size < row * lines:
            raw = bytearray(zlib.decompress(chunk))
            for k in range(1, len(raw)):
                raw[k] = (raw[k - 1] + raw[k] - 128) & 255
            half = (len(raw) + 1) // 2
            chunk = bytearray(len(raw))
            chunk[0::2], chunk[1::2] = raw[:half], raw[half:]
        k = 0
        for _ in range(lines):
            for name, kind in channels:
                size = width * (2 if kind == 1 else 4)
                pixels[name] += bytes(chunk[k:k + size])
                k += size
    return attributes, dict(channels), pixels

before, kinds_before, pixels_before = read(sys.argv[1])
after, kinds_after, pixels_after = read(sys.argv[2])
assert len(pixels_before) == 39 and len(pixels_after) == 40
for name, kind in kinds_before.items():
    assert kinds_after[name] == kind and pixels_after[name] == pixels_before[name], name
for name, value in before.items():
    assert name == b"channels" or after[name] == value, name
END
    good compare --json shot.$frame.exr shot.$frame.exr --channel AO \
        --channel-b "View Layer.AO.R"
    echo "shot.$frame: RMSE $(number rmse) from Blender's pass of 4 samples," \
        "mean $(number mean_a), Blender's $(number mean_b)"
    # Noise of 4 samples is most of it.
    at_most "$(number rmse)" 0.25 "shot.$frame: RMSE from Blender's pass"
done

# How its world normals are read, which no metadata say, is decided once: resumed, in
# several processes and on a farm there are the same bits.
shot="$cases/shot.####.exr"
good ao "$shot" --frames 1,8,16,24 --lens 35 -o "whole.####.exr"
good ao "$shot" --frames 1,8 --lens 35 -o "again.####.exr"
good ao "$shot" --frames 1,8,16,24 --lens 35 --skip-existing -o "again.####.exr"
good ao "$shot" --frames 1,8,16,24 --lens 35 --jobs 3 -o "jobs.####.exr"
good ao "$shot" --frames 24 --lens 35 --radius-frame 1 -o "farm.####.exr"
for frame in 0001 0008 0016 0024; do
    cmp -s whole.$frame.exr again.$frame.exr || fail "resumed: $frame has other bits"
    cmp -s whole.$frame.exr jobs.$frame.exr || fail "--jobs: $frame has other bits"
done
cmp -s whole.0024.exr farm.0024.exr || fail "--radius-frame: 0024 has other bits"
