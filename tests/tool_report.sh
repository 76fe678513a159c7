# SPDX-License-Identifier: MIT
# The page that measures everything: each section runs, the page is sound, and what is
# wrong is told before the work.
. "$(dirname "$0")/tool_lib.sh"

small="--size 64x36 --rays 16"

# sound FOLDER: the page there is well-formed and has all its pictures.
sound() {
    if command -v python3 >/dev/null; then
        python3 "$tests/check_page.py" "$1" || fail "the page in $1"
    fi
}

# A sphere is traced fast; every section once, all in one page.
# shellcheck disable=SC2086 # $small is two options
for section in methods missing structure hsao hbao alchemy vao closed-forms stability; do
    good report -o "page-$section" --only $section $small builtin:corner
    sound "page-$section"
done

# The plain code has one structure, so that fast and exact are one picture; the verdict is
# that of the numbers.
# shellcheck disable=SC2086
good report -o plain --only structure --isa scalar $small builtin:corner
if command -v python3 >/dev/null; then
    for page in page-structure plain; do
        python3 -c 'import json, sys
report = json.load(open(sys.argv[1]))
rows = report["structures"]
methods = "hbao", "alchemy", "vo", "containment", "hsao", "raymarch"
assert len(rows) == 2 * len(methods), rows
assert {(r["method"], r["filtered"]) for r in rows} == {
    (m, f) for m in methods for f in (False, True)}, rows
for row in rows:
    assert row["rmse_exact"] > 0 and row["ms_fast"] > 0 and row["ms_exact"] > 0, row
    assert row["holds"] == (row["rmse_fast"] <= 1.01 * row["rmse_exact"]), row
    if sys.argv[1].startswith("plain"):
        assert row["rmse_fast_to_exact"] == 0 and row["ratio"] == 1, row
assert report["structures_hold"] == all(r["holds"] for r in rows), report
' $page/report.json || fail "fast and exact structures in $page"
    done
fi

# The tables of the documentation come from the same numbers, and the page has a place for
# each of them.
if command -v python3 >/dev/null; then
    for section in methods stability; do
        python3 "$tests/../docs/tables.py" --print page-$section/report.json >tables.txt ||
            fail "no tables of the section $section"
        grep -q '^| `hbao` |' tables.txt || fail "hbao in the tables of $section"
    done
    for part in $(sed -n 's/^    "\([a-z-]*\)": (.*/\1/p' "$tests/../docs/tables.py"); do
        grep -q "^<!-- $part -->\$" "$tests/../docs/methods.md" || fail "no part $part"
        grep -q "^<!-- end of $part -->\$" "$tests/../docs/methods.md" || fail "no end of $part"
    done
fi

# Models are views under their names; the main one can be chosen; names do not clash.
# shellcheck disable=SC2086
good report -o two builtin:corner builtin:sphere builtin:corner $small --only methods \
    --main sphere --threads 1
sound two
for name in corner corner-2 sphere; do
    [ -f "two/pictures/view-$name.png" ] || fail "no view $name"
done
grep -q '"main":[[:space:]]*"sphere"' two/report.json || fail "--main"
grep -q 'sphere (main)' two/index.html || fail "the main view on the page"

# A second run overwrites the first and says the same but for times.
cp two/pictures/view-sphere.png before.png
# shellcheck disable=SC2086
good report -o two/ builtin:corner builtin:sphere builtin:corner $small --only methods \
    --main sphere --threads 2
cmp -s before.png two/pictures/view-sphere.png || fail "another picture with more threads"

# Lists of views. Files are meant relative to the list; names are escaped nowhere but here.
mkdir -p lists/deep
cat >lists/flat.obj <<'OBJ'
v -1 0 -1
v 1 0 -1
v 1 0 1
v -1 0 1
v -1 1 -1
v 1 1 -1
f 1 4 3 2
f 1 2 6 5
OBJ
cat >lists/views.json <<'JSON'
{"up_axis": "+Y", "views": [
  {"name": "wall_1", "file": "flat.obj", "eye": [0, 1, 3], "target": [0, 0.4, 0],
   "vfov_degrees": 40, "near": 0.1},
  {"name": "wall_2", "file": "flat.obj", "eye": [1, 2, 2], "target": [0, 0, 0],
   "up": [0, 1, 0], "vfov_degrees": 50, "radius": 0.5, "note": "<&>"}]}
JSON
# shellcheck disable=SC2086
good report -o listed --views lists/views.json --main wall_2 $small --only hbao
sound listed
grep -q '"radius":[[:space:]]*0.5,' listed/report.json || fail "the list's radius"
[ "$(grep -c 'flat.obj: .*triangles' stderr.txt)" -eq 1 ] || fail "loaded more than once"

# list WORDS: a list of one view with these members beside a sound name and file.
list() {
    printf '{"views": [{"name": "a", "file": "flat.obj", %s}]}' "$1" >lists/bad.json
}
sound_eye='"eye": [0, 1, 3], "target": [0, 0, 0]'
refused() {
    # shellcheck disable=SC2086
    bad 1 "$1" report -o out --views lists/bad.json $small
    [ ! -e out ] || fail "a folder is left after: $1"
}
list '"target": [0, 0, 0], "vfov_degrees": 40'
refused 'bad.json: view 1: "eye"'
list '"eye": [0, 1], "target": [0, 0, 0], "vfov_degrees": 40'
refused 'view 1: "eye"'
list '"eye": [0, "1", 2], "target": [0, 0, 0], "vfov_degrees": 40'
refused 'view 1: "eye"'
list '"eye": [0, 1e30, 2], "target": [0, 0, 0], "vfov_degrees": 40'
refused 'view 1: "eye"'
list '"eye": [0, 0, 0], "target": [0, 0, 0], "vfov_degrees": 40'
refused 'is the target'
list '"eye": [0, 2, 0], "target": [0, 0, 0], "vfov_degrees": 40'
refused 'up lies along'
list "$sound_eye"
refused 'view 1: "vfov_degrees"'
list "$sound_eye"', "vfov_degrees": 180'
refused 'view 1: "vfov_degrees"'
list "$sound_eye"', "vfov_degrees": 40, "radius": -1'
refused 'view 1: "radius"'
list "$sound_eye"', "vfov_degrees": 40, "up": 3'
refused 'view 1: "up"'
sed 's/"name": "a"/"name": "a b"/' <lists/bad.json >lists/bad2.json
mv lists/bad2.json lists/bad.json
refused 'view 1: "name" is no word'
sed 's/wall_2/wall_1/' <lists/views.json >lists/bad.json
refused 'view 2: "name" is that of'
sed 's/flat.obj/none.obj/' <lists/views.json >lists/bad.json
refused 'lists/none.obj: '
echo '{"views": []}' >lists/bad.json
refused 'its list "views" is empty'
echo '[1]' >lists/bad.json
refused 'has no list "views"'
echo '{"views": [1]}' >lists/bad.json
refused 'view 1: '
printf '{"views":\n[{"name": }]}' >lists/bad.json
refused 'bad.json: line 2 is no valid JSON'
printf '{"views": \000}' >lists/bad.json
refused 'zero byte'
: >lists/bad.json
refused 'no valid JSON'
bad 1 'is a folder' report -o out --views lists
bad 1 'nowhere.json: cannot be read' report -o out --views nowhere.json

# Arguments.
bad 2 '-o OUT is missing' report
bad 2 'did you mean closed-forms' report -o out --only closed-form
bad 2 'no section "frobnicate"' report -o out --only frobnicate
bad 2 'no view "nave"; choose one of courtyard' report -o out --main nave
bad 2 'did you mean sphere' report -o out builtin:sphere --main sphre
bad 2 'builtin:spheer' report -o out builtin:spheer
bad 2 'too small' report -o out --size 32x18
bad 2 '--rays: "8"' report -o out --rays 8
bad 1 'missing.glb: ' report -o out missing.glb
[ ! -e out ] || fail "a folder is left"

# Folders that cannot be used are told of at once.
: >file
bad 1 'file: is a file, not a folder' report -o file
bad 1 'nowhere/out: the folder cannot be made' report -o nowhere/out
mkdir -p odd/index.html
bad 1 'odd/index.html: is a folder' report -o odd
mkdir taken
: >taken/pictures
bad 1 'taken/pictures: is a file' report -o taken
if [ "$(id -u)" -ne 0 ]; then
    mkdir locked
    chmod a-w locked
    bad 1 'locked: the folder may not be written' report -o locked
fi

# A full disk as well, before anything is traced: files of more than 8 blocks cannot be
# written. ThreadSanitizer itself needs larger files.
if [ -z "${TSAN_OPTIONS:-}" ]; then
    code=0
    (
        trap '' XFSZ
        ulimit -f 8
        exec "$tool" report -o out
    ) >stdout.txt 2>stderr.txt || code=$?
    [ $code -eq 1 ] || fail "exit code $code without room"
    grep -q '^crevice: out.*: cannot be written (' stderr.txt || fail "no room, not told"
    grep -q 'reference' stderr.txt && fail "no room, found after the work"
    [ ! -e out ] || fail "a folder is left without room"
fi

# An interrupt leaves no half-written file, and no page.
"$tool" report -o stopped --only methods builtin:courtyard >stdout.txt 2>stderr.txt &
process=$!
sleep 2
kill -TERM $process
code=0
wait $process || code=$?
[ $code -gt 128 ] || fail "exit code $code after a signal"
[ -z "$(find stopped -name '.?*')" ] || fail "a temporary file is left"
[ ! -e stopped/index.html ] || fail "a page in spite of the interrupt"
