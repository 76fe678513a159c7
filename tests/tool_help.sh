# SPDX-License-Identifier: MIT
# What the tool says of itself.
. "$(dirname "$0")/tool_lib.sh"

good --version
grep -Eq '^crevice [0-9]+\.[0-9]+\.[0-9]+$' stdout.txt || fail "--version"
good --help
for command in render ao gbuffer reference compare methods devices bench tune; do
    grep -q "^  $command " stdout.txt || fail "$command is not in the overview"
done
for topic in passes camera scenes; do
    grep -q "^  help $topic " stdout.txt || fail "$topic is not in the overview"
done
for command in render ao gbuffer reference compare methods devices bench tune; do
    good help $command
    mv stdout.txt help.txt
    good $command --help
    cmp -s stdout.txt help.txt || fail "help $command differs from $command --help"
    grep -q "^usage: crevice $command" help.txt || fail "no usage: $command"
    grep -q '^Examples:' help.txt || fail "no examples: $command"
    awk 'length > 90 && !/^  crevice/ { exit 1 }' help.txt || fail "line too long: $command"
    good --help
done

# Every scene that is listed can be made.
good help scenes
scenes=$(sed -n 's/^  \([a-z]*\)  .*/\1/p' stdout.txt)
[ "$(echo "$scenes" | wc -l)" -ge 9 ] || fail "few scenes: $scenes"
for name in $scenes; do
    good gbuffer "builtin:$name" --size 8x8 -o "$name.exr"
done

# Every option of the table is a flag of both commands that estimate, and is in their help.
good methods --json
flags=$(sed -n 's/.*"flag":[[:space:]]*"\(--[a-z0-9-]*\)".*/\1/p' stdout.txt | sort -u)
[ "$(echo "$flags" | wc -l)" -ge 10 ] || fail "few flags in methods --json: $flags"
for command in render ao; do
    good help $command
    for flag in $flags --method --preset --filter; do
        grep -q "^  $flag " stdout.txt || fail "$flag is not in the help of $command"
    done
done
if command -v python3 >/dev/null; then
    good methods --json
    python3 -c 'import json, sys
listing = json.load(sys.stdin)
names = [m["name"] for m in listing["methods"]]
assert "hbao" in names, names
assert {"gauss5", "bilateral13", "box4", "edges15"} <= {f["name"] for f in listing["filters"]}
for entry in listing["methods"] + listing["filters"]:
    assert entry["paper"] and entry["title"]
    if entry in listing["methods"]:
        assert list(entry["presets"]) == ["low", "medium", "high", "ultra", "paper"], entry
    for option in entry["options"]:
        if "min" in option:
            assert option["min"] <= option["default"] <= option["max"], option
        if "choices" in option:
            assert option["default"] in option["choices"], option
' <stdout.txt || fail "methods --json"
fi
# Help is of the chosen method: its presets, its own defaults.
for method in hsao containment; do
    good methods $method
    sed -n 's/^ *paper  *//p' stdout.txt >preset.txt
    [ -s preset.txt ] || fail "methods $method lacks its presets"
    good render --method $method --help
    # Long ones go on in the next line.
    grep -q "^ *paper  *$(cut -d ' ' -f 1-3 preset.txt)" stdout.txt ||
        fail "render --method $method --help lacks its presets"
done
grep -A 2 '^  --samples' stdout.txt | grep -q 'default 24' ||
    fail "containment begins with 24 samples"
good methods
grep -q '^hbao: ' stdout.txt || fail "methods does not list hbao"
good methods hbao
grep -q -- '--directions' stdout.txt || fail "methods hbao lacks --directions"
bad 2 'did you mean hbao' methods hbaoo

code=0
"$tool" >stdout.txt 2>stderr.txt || code=$?
[ $code -eq 2 ] || fail "exit code $code without arguments"
[ ! -s stdout.txt ] || fail "usage is not on stderr"
grep -q '^usage: crevice' stderr.txt || fail "no usage without arguments"
bad 2 'did you mean render' rendr model.glb
bad 2 'no such command' frobnicate
bad 2 'no such command or topic' help frobnicate
