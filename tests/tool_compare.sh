# SPDX-License-Identifier: MIT
# Differences of pictures.
. "$(dirname "$0")/tool_lib.sh"

pfm a.pfm 2 2 1 1 0 0
pfm b.pfm 2 2 1 0 0 0
good compare a.pfm b.pfm
grep -q '^pixels   4 of 4$' stdout.txt || fail "number of pixels"
# One of four is off by 1.
grep -q '^RMSE     0.500000$' stdout.txt || fail "RMSE"
grep -q '^MAE      0.250000$' stdout.txt || fail "MAE"
grep -q '^PSNR     6.02 dB$' stdout.txt || fail "PSNR"
# PFM has its bottom row first, so the second value is the lower right pixel.
grep -q '^largest  1.000000 at (1, 1)$' stdout.txt || fail "largest error"

grep -q '^bias     +0.250000$' stdout.txt || fail "bias"
# Errors 0, 0, 0, 1: 99 % is at 2.97 of 0 to 3.
grep -q '^errors   +0.000000 to +0.970000 but' stdout.txt || fail "quantiles"

good compare --json a.pfm b.pfm
at_most "$(number rmse)" 0.5 rmse
at_least "$(number rmse)" 0.5 rmse
if command -v python3 >/dev/null; then
    python3 -c 'import json, sys
report = json.load(sys.stdin)
assert report["pixels"] == 4 and report["rmse"] == 0.5 and report["ssim"] is None, report
assert (report["max_x"], report["max_y"]) == (1, 1), report
assert report["bias"] == 0.25 and report["error_q01"] == 0, report
assert abs(report["error_q99"] - 0.97) < 1e-12, report
assert 0 < report["flip"] < 1 and report["flip_ppd"] == 67.0206, report
# Black and white stay what they are under every power; an intensity of 0 makes all white.
assert report["fit_power"] == 1 and report["fit_power_rmse"] == 0.5, report
assert report["fit_intensity"] == 1 and report["fit_intensity_rmse"] == 0.5, report
assert report["fit_both_rmse"] <= 0.5, report
assert {"fit_both_intensity", "fit_both_power", "mae", "ssim_windows"} < set(report), report
assert "heat_map" not in report, report
' <stdout.txt || fail "compare --json"
fi
good compare --json a.pfm a.pfm
grep -q '"psnr_db":[[:space:]]*null' stdout.txt || fail "PSNR of equal pictures"

# Black against white: FLIP by hand, 0.96738 (0.95 + 0.05 (100^0.7 - p) / (c - p) where
# c = 203.3017^0.7, p = 0.4 c).
pfm black.pfm 2 2 0 0 0 0
pfm white.pfm 2 2 1 1 1 1
good compare --json black.pfm white.pfm
at_most "$(number flip)" 0.96739 FLIP
at_least "$(number flip)" 0.96737 FLIP
good compare --json black.pfm black.pfm --ppd 20
at_most "$(number flip)" 0 "FLIP of equal pictures"
at_least "$(number flip_ppd)" 20 "pixels per degree"

# The heat map of the errors 1, 0, -1 and 0.
pfm mixed.pfm 2 2 1 0 -1 0
good compare --json mixed.pfm black.pfm --heat-map heat.exr --heat-scale 1
grep -q '"heat_map":[[:space:]]*"heat.exr"' stdout.txt || fail "heat map in the JSON"
at_least "$(number heat_scale)" 1 "scale of the heat map"
# mean_of CHANNEL VALUE TOLERANCE: of the last heat map, of which $map is the file.
mean_of() {
    good compare --json $map white.pfm --channel "$1" --channel-b Y
    at_most "$(number mean_a)" "$(awk "BEGIN { print $2 + $3 }")" "mean $1 of $map"
    at_least "$(number mean_a)" "$(awk "BEGIN { print $2 - $3 }")" "mean $1 of $map"
}
# By hand, in linear light: twice white 0.924403, CIELAB (35, 28, 40) of (0.236941, 0.047872,
# 0.004946) and CIELAB (35, 3, -38) of (0.006471, 0.089185, 0.274709).
map=heat.exr
mean_of R 0.523055 1e-5
mean_of G 0.496466 1e-5
mean_of B 0.532115 1e-5
good compare --json heat.exr mixed.pfm --channel error --channel-b Y
at_most "$(number max_error)" 0 "signed error in the heat map"
# The same in sRGB of 8 bits: 246, 134 and 19; the errors are beyond the default scale.
good compare mixed.pfm black.pfm --heat-map heat.png
[ "$(od -An -tx1 -j16 -N8 heat.png | tr -d ' ')" = 0000000200000002 ] ||
    fail "size of the heat map"
map=heat.png
mean_of R "(246 + 246 + 134 + 19) / 1020" "2 / 1020"

cp mixed.pfm in.png
bad 2 'in.png: is an input' compare in.png black.pfm --heat-map in.png
bad 2 'in.png: is an input' compare black.pfm in.png --heat-map in.png
bad 2 'out.pfm: a heat map is a .png or .exr' compare a.pfm b.pfm --heat-map out.pfm
bad 1 'nowhere' compare a.pfm b.pfm --heat-map nowhere/out.png
bad 2 'no heat map; add --heat-map' compare a.pfm b.pfm --heat-scale 0.1
bad 2 '--heat-scale: "0"' compare a.pfm b.pfm --heat-map out.png --heat-scale 0
bad 2 '--ppd: "0"' compare a.pfm b.pfm --ppd 0

# Background is left out by the depth of either file.
good gbuffer builtin:sphere --size 64x36 --guard-px 0 --eye 0,1,30 --target 0,0.5,0 \
    -o buffer.exr
good ao buffer.exr -o ao.exr
good compare --json buffer.exr buffer.exr --channel Z
seen=$(number pixels)
at_least "$seen" 1 "visible pixels"
at_most "$seen" 2303 "visible pixels, for there is sky"
good compare --json ao.exr buffer.exr --channel AO --channel-b Z
[ "$(number pixels)" -eq "$seen" ] || fail "background of the second file"
good compare --json ao.exr ao.exr
[ "$(number pixels)" -eq 2304 ] || fail "a file without depth has no background"

# It is grey in the heat map: 0.2140 in linear light; where nothing differs it is white.
good compare buffer.exr buffer.exr --channel Z --heat-map heat.exr
good compare --json heat.exr heat.exr --channel R
expected=$(awk "BEGIN { print (0.924403 * $seen + 0.214041 * (2304 - $seen)) / 2304 }")
at_most "$(number mean_a)" "$(awk "BEGIN { print $expected + 1e-5 }")" "grey background"
at_least "$(number mean_a)" "$(awk "BEGIN { print $expected - 1e-5 }")" "grey background"

# Bent normals, if both files have them.
good reference builtin:courtyard --size 64x36 --radius 0.5 --rays 64 -o bent.exr
good reference builtin:courtyard --size 64x36 --radius 0.5 --rays 64 --seed 1 -o other.exr
good compare --json bent.exr bent.exr
[ "$(number bent_pixels)" -eq "$(number pixels)" ] || fail "pixels with bent normals"
at_most "$(number bent_q95_deg)" 1e-5 "bent normals and themselves"
good compare --json bent.exr other.exr
at_least "$(number bent_median_deg)" 0.05 "bent normals of other rays"
# 64 stratified rays know each component of their mean, which is about 0.6 long, to about
# 0.03: two such are 4 degrees apart.
at_most "$(number bent_median_deg)" 6 "bent normals of other rays"
at_least "$(number bent_q95_deg)" "$(number bent_median_deg)" "95 percent"
at_most "$(number bent_open_pixels)" "$(($(number bent_pixels) - 1))" "open surfaces"
good compare --json bent.exr other.exr --open 0
all=$(number bent_open_pixels)
good compare --json bent.exr other.exr --open 0.9
at_most "$(number bent_open_pixels)" "$((all - 1))" "surfaces above 0.9"
at_least "$(number bent_open)" 0.9 "what counts as open"
good compare bent.exr other.exr --open 1
grep -q '^bent     median [0-9.]*, 95 % [0-9.]* degrees of ' stdout.txt || fail "bent normals"
grep -q '^         none above 1 in B$' stdout.txt || fail "no open surface"
bad 2 '--open: is for bent normals' compare a.pfm b.pfm --open 0.5

pfm nan.pfm 2 2 nan 1 inf 0
pfm wide.pfm 4 1 1 1 1 1
bad 1 'nan.pfm: 2 compared values are NaN or infinite' compare a.pfm nan.pfm
bad 1 'nan.pfm: 2 compared values are' compare nan.pfm a.pfm --heat-map out.png
bad 1 'one size' compare a.pfm wide.pfm
bad 1 'missing.exr: ' compare a.pfm missing.exr
# A renderer's file: ambient occlusion, depth and normals by their names.
good ao buffer.exr -o ao_of_frame.exr --radius 0.3
good ao buffer.exr -o passes.exr --radius 0.3 --append --channel "View Layer.AO.R"
good compare --json passes.exr ao_of_frame.exr
grep -q '"View Layer.AO.R" is taken' stderr.txt || fail "a renderer's pass"
at_most "$(number max_error)" 0 "the same pass in both files"

bad 1 'AO' compare ao.exr ao.exr --channel BO
bad 2 '--channel' compare buffer.exr ao.exr
bad 2 'B is missing' compare a.pfm
bad 2 'one argument too many' compare a.pfm b.pfm a.pfm
