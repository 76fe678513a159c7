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

good compare --json a.pfm b.pfm
at_most "$(number rmse)" 0.5 rmse
at_least "$(number rmse)" 0.5 rmse
if command -v python3 >/dev/null; then
    python3 -c 'import json, sys
report = json.load(sys.stdin)
assert report["pixels"] == 4 and report["rmse"] == 0.5 and report["ssim"] is None, report
assert (report["max_x"], report["max_y"]) == (1, 1), report
' <stdout.txt || fail "compare --json"
fi
good compare --json a.pfm a.pfm
grep -q '"psnr_db":[[:space:]]*null' stdout.txt || fail "PSNR of equal pictures"

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

pfm nan.pfm 2 2 nan 1 inf 0
pfm wide.pfm 4 1 1 1 1 1
bad 1 'nan.pfm: 2 compared values are NaN or infinite' compare a.pfm nan.pfm
bad 1 'one size' compare a.pfm wide.pfm
bad 1 'missing.exr: ' compare a.pfm missing.exr
bad 1 'AO' compare ao.exr ao.exr --channel BO
bad 2 '--channel' compare buffer.exr ao.exr
bad 2 'B is missing' compare a.pfm
bad 2 'one argument too many' compare a.pfm b.pfm a.pfm
