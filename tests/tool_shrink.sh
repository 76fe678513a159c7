# SPDX-License-Identifier: MIT
# Frames that were rendered larger than the result.
. "$(dirname "$0")/tool_lib.sh"

good gbuffer builtin:courtyard --size 96x64 --guard-px 8 --eye 3,1,-4 --target 0,0.5,0 \
    -o frame.exr
good ao frame.exr --radius 0.5 -o large.exr
good ao frame.exr --radius 0.5 --aa 4 -o small.exr
good compare --json small.exr small.exr
[ "$(number pixels)" -eq $((24 * 16)) ] || fail "not 24x16 pixels"
small=$(number mean_a)
good compare --json large.exr large.exr
difference=$(awk -v a="$small" -v b="$(number mean_a)" 'BEGIN { d = a - b; print d < 0 ? -d : d }')
# Equal, but for blocks at the sky, whose covered pixels count for the whole block.
at_most "$difference" 0.01 "means of both sizes"
good ao frame.exr --radius 0.5 --aa 4 -o small.png
grep -aq ' aa=4 ' small.exr || fail "metadata"

bad 1 '--aa 5 does not divide' ao frame.exr --radius 0.5 --aa 5 -o out.exr
bad 2 '--aa' ao frame.exr --aa 2 --append -o out.exr
