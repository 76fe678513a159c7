# SPDX-License-Identifier: MIT
# The devices there are, and the CPU's picture on each that computes with Vulkan.
. "$(dirname "$0")/tool_lib.sh"

good devices
grep -q '^cpu  *scalar' stdout.txt || fail "no CPU among the devices"
good devices --json
if command -v python3 >/dev/null; then
    python3 -c 'import json, sys
listing = json.load(sys.stdin)
assert "scalar" in listing["cpu"]
for i, device in enumerate(listing["vulkan"]):
    assert device["device"] == "vulkan:%d" % i and device["name"], device
    # A name and a version of the driver, and of Vulkan, that a person can look up.
    assert "0x" not in device["driver"] and ", Vulkan 1." in device["driver"], device
assert listing["vulkan"] or listing["vulkan_missing"].startswith("vulkan: ")
' <stdout.txt || fail "devices --json"
fi

# Without a device there is a reason, and no picture.
VK_DRIVER_FILES=/dev/null VK_ICD_FILENAMES=/dev/null bad 1 'vulkan: ' \
    render builtin:sphere --size 32x18 --device vulkan -o out.exr
bad 1 'vulkan: ' render builtin:sphere --size 32x18 --device vulkan:999 -o out.exr

good devices
if ! grep -q '^vulkan:0 ' stdout.txt; then
    [ -z "${CI:-}" ] || fail "CI has no Vulkan device"
    grep '^vulkan: ' stdout.txt
    exit 77
fi
scene="builtin:courtyard --size 160x90"
for method in hbao vao; do
    # shellcheck disable=SC2086 # $scene is words
    good render $scene -o cpu.exr --method $method --filter bilateral13 --exact
    # shellcheck disable=SC2086
    good render $scene -o vulkan.exr --method $method --filter bilateral13 --device vulkan
    grep -q '^vulkan: on ' stderr.txt || fail "no line about the device"
    good compare --json cpu.exr vulkan.exr
    # 2e-3 but for a pixel in a thousand is the promise; the mean then keeps well below.
    at_most "$(number mae)" 0.001 "$method: mean error of vulkan"
done
# Every way to compute it has a row, and the steps that only it has.
good bench builtin:corner --device vulkan --size 64x36 --seconds 0 --repeats 1 --json \
    --method hbao --filter bilateral13 --depth-layout all --arithmetic all
python3 -c 'import json, sys
rows = json.load(sys.stdin)["rows"]
extra = {"linear": [], "deinterleaved": ["deinterleave"], "levels": ["levels"]}
for layout, steps in extra.items():
    for arithmetic in ("single", "half"):
        mine = [r for r in rows
                if (r["depth_layout"], r["arithmetic"]) == (layout, arithmetic)]
        wanted = ["upload"] + steps + ["hbao", "bilateral13", "bilateral13", "download"]
        assert [[s["name"] for s in r["steps"]] for r in mine] == [wanted], mine
' <stdout.txt || fail "ways to compute"
bad 2 'did you mean levels' bench --device vulkan --depth-layout level

good gbuffer builtin:sphere --size 64x36 -o passes.exr
good ao passes.exr -o cpu.exr --exact
good ao passes.exr -o vulkan.exr --device vulkan:0
good compare --json cpu.exr vulkan.exr
at_most "$(number mae)" 0.001 "ao: mean error of vulkan"
