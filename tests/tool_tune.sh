# SPDX-License-Identifier: MIT
# Options that are fitted to a truth.
. "$(dirname "$0")/tool_lib.sh"

# value KEY: of the options that were written last.
value() {
    sed -n "s/^$1=//p" options.txt
}

# A frame whose truth is the method's own, so that the answer is known: radius 0.9, cubic,
# contrast 1.5. Numbers are searched in steps down to 0.2 %; the truth has 32-bit floats.
good gbuffer builtin:courtyard --size 96x54 --guard-px 0 -o frame.exr -q
good ao frame.exr --method gtao --radius 0.9 --falloff cubic --contrast 1.5 --append \
    -o truth.exr -q
good tune frame.exr --method gtao --radius 0.4 --truth truth.exr:AO --evaluations 300 \
    -o options.txt
at_least "$(value radius)" 0.88 "fitted radius"
at_most "$(value radius)" 0.92 "fitted radius"
at_least "$(value contrast)" 1.47 "fitted contrast"
at_most "$(value contrast)" 1.53 "fitted contrast"
[ "$(value falloff)" = cubic ] || fail "fitted falloff: $(value falloff)"
# What it prints holds for the picture that `ao` makes of the file, and of the flags.
cp stdout.txt said.txt
good ao frame.exr --options options.txt -o by_file.exr
after=$(awk '$1 == "fitted" && $2 == "after" { print $3 }' said.txt)
at_most "$after" 0.005 "RMSE after the fit" # a fiftieth of that before
good compare --json truth.exr by_file.exr
at_most "$(number rmse)" "$(awk -v a="$after" 'BEGIN { print a + 0.00001 }')" "RMSE"
at_least "$(number rmse)" "$(awk -v a="$after" 'BEGIN { print a - 0.00001 }')" "RMSE"
# shellcheck disable=SC2046
good ao frame.exr $(sed -n 's/^options: //p' said.txt) -o by_flags.exr
good compare --json by_file.exr by_flags.exr
at_most "$(number max_error)" 0 "difference of the file and the flags"

# Only what is named changes. The frame's own pass is the truth by itself, also of a frame
# whose overscan gets no result. Another frame of another strength tells that the gain is
# of this one alone.
good gbuffer builtin:courtyard --size 96x54 -o guarded.exr -q
good ao guarded.exr --method gtao --radius 0.9 --contrast 3 --append -o both.exr -q
good ao frame.exr --method gtao --radius 0.9 --contrast 0.5 -o other.exr -q
good tune both.exr --method gtao --radius 0.9 --fit contrast --evaluations 60 \
    --check frame.exr --check-truth other.exr -o options.txt
[ "$(value radius)" = 0.9 ] || fail "the radius changed: $(value radius)"
at_least "$(value contrast)" 2.9 "contrast"
at_most "$(value contrast)" 3.1 "contrast"
grep -q '^crevice: warning: the other view got worse' stderr.txt || fail "no warning"
[ "$(grep -c '^other ' stdout.txt)" -eq 2 ] || fail "no errors of the other frame"

# A mesh: truth by rays, another view that was not fitted; the same for the same numbers.
mesh="tune builtin:courtyard --size 96x54 --method hbao --evaluations 40 --rays 32"
good $mesh -o options.txt
cp stdout.txt first.txt
cp options.txt first_options.txt
[ "$(grep -Ec '^(fitted|other) +(before|after) ' stdout.txt)" -eq 4 ] || fail "not four rows"
awk '$2 == "before" { b = $3 } $2 == "after" && !($3 <= b) && $1 == "fitted" { exit 1 }' \
    stdout.txt || fail "the fit made it worse"
grep -q '^method=hbao$' options.txt || fail "no method in the options"
good $mesh -o options.txt --threads 1
cmp -s stdout.txt first.txt || fail "another result of the same numbers"
cmp -s options.txt first_options.txt || fail "other options of the same numbers"
good $mesh --check-orbit 0 --truth-weighting cosine --truth-falloff none
grep -q '^other' stdout.txt && fail "another view that nobody wanted"
grep -q 'truth: crevice reference .*--weighting cosine --falloff none' stderr.txt ||
    fail "the truth is not told"
good $mesh --check-eye 3,2,6 --fit radius,intensity
grep -q '^other' stdout.txt || fail "no view from --check-eye"

# A short budget gives options, too.
good tune builtin:corner --size 64x36 --time 0.5
grep -q '^options: --method bitmask' stdout.txt || fail "nothing in half a second"

# What cannot be fitted is one line.
bad 2 'frame.exr: has no pass of ambient occlusion' tune frame.exr
good ao frame.exr --crop --radius 0.4 -o small.exr -q
good gbuffer builtin:courtyard --size 80x45 -o small_frame.exr -q
good ao small_frame.exr --radius 0.4 -o small.exr -q
bad 1 'small.exr: is 80x45, but the result is 96x54' tune frame.exr --truth small.exr
good ao frame.exr --radius 0.4 --intensity 0 -o white.exr -q
bad 1 'is white' tune frame.exr --truth white.exr
bad 1 'is no accessibility' tune frame.exr --truth frame.exr:Z
bad 1 'no channel' tune frame.exr --truth truth.exr:OA
bad 1 'not_here.exr' tune frame.exr --truth not_here.exr
bad 2 '--time: "0" is not valid' tune frame.exr --truth truth.exr --time 0
bad 2 '--evaluations: "0" is not valid' tune frame.exr --truth truth.exr --evaluations 0
bad 2 '--fit: "radius,depth" is not of bitmask' tune frame.exr --fit radius,depth
bad 2 '--fit: "thickness" is not of' tune frame.exr --method vo --fit thickness
bad 2 "are for meshes" tune frame.exr --eye 1,2,3
bad 2 'is for frames' tune builtin:courtyard --truth truth.exr
bad 2 'contradicts --check-orbit' tune builtin:corner --check-eye 1,2,3 --check-orbit 9
bad 1 'nothing in view is occluded' tune builtin:plane --size 32x18 --radius 0.01
bad 1 'no surface is in view' tune builtin:courtyard --size 32x18 --eye 0,500,0 \
    --target 0,900,1
bad 2 'is an input' tune frame.exr -o frame.exr
bad 1 'cannot be written' tune both.exr --evaluations 3 -o nowhere/options.txt

# An interrupt keeps the best so far. Shells let what runs beside them ignore SIGINT, so
# the signal is another that is held in the same way.
"$tool" tune builtin:courtyard --size 96x54 --rays 32 --time 1000 -v -o kept.txt \
    >stdout.txt 2>stderr.txt &
process=$!
tries=0
while ! grep -q 'run 20:' stderr.txt && [ $tries -lt 300 ]; do
    sleep 0.1
    tries=$((tries + 1))
done
kill -TERM $process || fail "it was done before it could be interrupted"
code=0
wait $process || code=$?
[ $code -gt 128 ] || fail "exit code $code after SIGTERM"
grep -q '^method=bitmask$' kept.txt || fail "no options after an interrupt"
grep -q '^options: --method bitmask' stdout.txt || fail "no line of options"
