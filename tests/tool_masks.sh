# SPDX-License-Identifier: MIT
# Parts of frames that receive or occlude.
. "$(dirname "$0")/tool_lib.sh"

good gbuffer builtin:courtyard --size 96x54 --guard-px 8 -o frame.exr
good ao frame.exr --radius 0.4 -o plain.exr

# no_change FLAGS...: masks that leave everything in leave everything as it is.
no_change() {
    good ao frame.exr --radius 0.4 "$@" -o masked.exr
    good compare --json plain.exr masked.exr
    at_most "$(number max_error)" 0 "$*: nothing is left out"
}
no_change --receive not:Z=0
no_change --occlude not:Z=0
no_change --receive not:Z=0 --occlude not:Z=0

# Nothing is left: everything is open, and that is told.
for flag in --receive --occlude; do
    good ao frame.exr --radius 0.4 $flag Z=0 -o open.exr
    grep -q "warning: $flag: Z=0 covers nothing" stderr.txt || fail "$flag: nobody is told"
    good compare --json open.exr open.exr
    at_least "$(number mean_a)" 1 "$flag of nothing: mean"
done

# Half a receiver is half as dark; the guard band is no part of the result.
good ao frame.exr --radius 0.4 --append --channel matte -o matte.exr
good compare --json plain.exr plain.exr
mean=$(number mean_a)
good ao matte.exr --radius 0.4 --receive matte -o part.exr
good ao matte.exr --radius 0.4 --receive not:matte -o rest.exr
good compare --json part.exr rest.exr
# Darkness m (1 - a) and (1 - m)(1 - a) add up to 1 - a.
sum=$(awk -v a="$(number mean_a)" -v b="$(number mean_b)" -v m="$mean" \
    'BEGIN { d = (1 - a) + (1 - b) - (1 - m); print d < 0 ? -d : d }')
at_most "$sum" 1e-6 "a matte and the rest add up"
bad 1 'has no channel "nobody"' ao frame.exr --receive nobody -o out.exr
bad 1 'has no Cryptomatte' ao frame.exr --occlude crypto:hero -o out.exr
grep -aq 'receive=matte' part.exr || fail "metadata of a mask"
