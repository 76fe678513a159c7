# SPDX-License-Identifier: MIT
# Every method there is, at its defaults and at its paper's numbers.
. "$(dirname "$0")/tool_lib.sh"

good methods --json
methods=$(sed -n '/"methods":/,/"filters":/s/^[[:space:]]*"name":[[:space:]]*"\([a-z0-9]*\)".*/\1/p' \
    stdout.txt)
[ "$(echo "$methods" | wc -l)" -ge 8 ] || fail "few methods: $methods"

# Contacts are dark, and most of the picture is open; a flat wall is 0.5 by ssao.
plausible() {
    ! grep -q warning stderr.txt || { cat stderr.txt >&2; fail "$1 warns"; }
    good compare --json "$2" "$2"
    at_least "$(number mean_a)" 0.4 "$1: mean accessibility"
    at_most "$(number mean_a)" 0.99 "$1: mean accessibility"
}

scene="builtin:corner --size 160x90"
radius="--radius 0.5"
# shellcheck disable=SC2086 # $scene is words
good gbuffer $scene -o passes.exr
for method in $methods; do
    # shellcheck disable=SC2086
    for preset in "" paper; do
        good render $scene -o "$method$preset.exr" $radius --method "$method" ${preset:+--preset $preset}
        grep -q "^$method " stderr.txt || fail "no line about $method"
        plausible "$method $preset" "$method$preset.exr"
    done
    # shellcheck disable=SC2086
    good ao passes.exr -o default.exr $radius --method "$method"
    for preset in low medium high ultra; do
        # shellcheck disable=SC2086
        good ao passes.exr -o $preset.exr $radius --method "$method" --preset $preset
        plausible "$method $preset" $preset.exr
    done
    # medium is what there is without a preset.
    good compare --json default.exr medium.exr
    at_most "$(number max_error)" 0 "$method: difference of medium and the default"
    # Fewer samples are noisier, but of the same thing.
    good compare --json low.exr ultra.exr
    at_least "$(number max_error)" 0.001 "$method: difference of low and ultra"
    at_most "$(number mae)" 0.1 "$method: difference of low and ultra"
done

# What a method does not read is told of, and changes nothing.
# shellcheck disable=SC2086
good render $scene -o steps.exr $radius --method ssao --steps 5
grep -q '^crevice: warning: steps: .*ssao' stderr.txt || fail "no warning of --steps with ssao"
good compare --json ssao.exr steps.exr
at_most "$(number max_error)" 0 "an option that ssao does not read"

# A single option wins over the preset, wherever it stands.
good render builtin:sphere --size 32x18 -o a.exr --steps 2 --preset ultra --directions 3
grep -q '^bitmask 3x2, ' stderr.txt || fail "options do not win over the preset"
good render builtin:sphere --size 32x18 -o a.exr --samples 3 --preset paper --method vao
grep -q '^vao 3 samples, .*box4' stderr.txt || fail "the preset is not that of the method"
