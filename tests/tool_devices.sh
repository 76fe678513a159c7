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
# A row for each step of each method: upload, estimate, two passes of the filter, download.
good bench builtin:corner --device vulkan --sizes 64x36 --seconds 0 --repeats 1 \
    --methods hbao,vo --filters bilateral13 --json bench.json
[ "$(grep -c '"step":' bench.json)" -eq 10 ] || fail "steps: $(grep '"step":' bench.json)"
grep -q '"step":[[:space:]]*"hbao"' bench.json || fail "no step of hbao"
# Every way to compute it has rows of its own, and the steps that only it has.
good bench builtin:corner --device vulkan --sizes 64x36 --seconds 0 --repeats 1 \
    --methods hbao --filters bilateral13 --layouts all --arithmetic both --json bench.json
python3 -c 'import json, sys
rows = json.load(sys.stdin)["device_steps"]
extra = {"plain": [], "apart": ["deinterleave"], "levels": ["levels"]}
for layout, steps in extra.items():
    for arithmetic in ("single", "half"):
        mine = [r for r in rows if (r["layout"], r["arithmetic"]) == (layout, arithmetic)]
        wanted = ["upload"] + steps + ["hbao", "bilateral13", "bilateral13", "download"]
        assert [r["step"] for r in mine] == wanted, mine
' <bench.json || fail "ways to compute"
# The page of a GPU, tried on whatever there is.
python3 "$(dirname "$0")/../docs/performance_gpu.py" "$tool" --brief --size 64x36 --shared "" \
    -o page.md 2>stderr.txt || { cat stderr.txt >&2; fail "docs/performance_gpu.py"; }
for row in '| `hbao` and `bilateral13`, 64x36, ' '| `gauss5` | - | - | half | ' \
    '| `deinterleave` of `hbao` | 3 | apart | '; do
    grep -qF "$row" page.md || fail "the page has no $row"
done
bad 2 '--layouts: is for a GPU' bench --layouts apart
bad 2 '--layouts: no "apar"; did you mean apart' bench --device vulkan --layouts apar
bad 2 '--only device: ' bench --only device
bad 2 '--isas: contradicts --device' bench --device vulkan --isas scalar

good gbuffer builtin:sphere --size 64x36 -o passes.exr
good ao passes.exr -o cpu.exr --exact
good ao passes.exr -o vulkan.exr --device vulkan:0
good compare --json cpu.exr vulkan.exr
at_most "$(number mae)" 0.001 "ao: mean error of vulkan"
