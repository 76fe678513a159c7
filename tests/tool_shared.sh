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
