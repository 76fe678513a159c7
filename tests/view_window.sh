# SPDX-License-Identifier: MIT
# Real windows, driven by scripts: view_window.sh TOOL FOLDER HAS_VIEWER. What is on the
# screen has the pixels that `crevice render` and `crevice ao` write.
has_viewer=$3
. "$(dirname "$0")/tool_lib.sh"

if [ "$has_viewer" != 1 ]; then
    # Without GTK the tool says how to get the window.
    bad 1 'libgtk-4-dev' view builtin:corner
    echo "no GTK 4: the window was not built, and is not tested"
    exit 77
fi
if ! command -v Xvfb >/dev/null; then
    echo "no Xvfb: the window is not tested"
    exit 77
fi

# Nothing of the user's session; software rendering; accessibility wants a session's bus.
unset WAYLAND_DISPLAY DISPLAY
export GDK_BACKEND=x11 GSK_RENDERER=cairo GTK_A11Y=none XDG_RUNTIME_DIR="$PWD"
bad 1 'there is no display' view builtin:corner

Xvfb -displayfd 3 -screen 0 1600x1000x24 -nolisten tcp 3>display.txt 2>xvfb.txt &
server=$!
trap 'kill $server 2>/dev/null' EXIT
for _ in $(seq 100); do
    [ -s display.txt ] && break
    sleep 0.1
done
[ -s display.txt ] || { echo "Xvfb does not start: $(cat xvfb.txt)"; exit 77; }
DISPLAY=:$(cat display.txt)
export DISPLAY

# act INPUT [ARGUMENT...]: does the script on stdin in a window and keeps stdout.txt.
act() {
    cat >script.txt
    good view "$@" --script script.txt
}

# same A B CHANNEL LIMIT: the window's picture A (R, G, B) and the tool's B.
same() {
    good compare --json "$1" "$2" --channel "$3" ${5:+--channel-b "$5"}
    [ "$(number pixels)" -eq $((640 * 400)) ] || fail "$1 has another size"
    at_most "$(number max_error)" "$4" "difference of $1 and $2"
}

# The command that the window gives writes what the window shows, bit by bit: the default,
# then another method with options set by its controls, after the camera was moved.
act builtin:courtyard <<'END'
size 640 400
overlay off
split 1
wait
canvas first.png
command left
view 1.5 2 7 0.3 1.5 0.2
orbit 5 3
show left gtao
slide left thickness 0.25
set left falloff none
preset left low
slide left radius 0.7
wait
canvas second.png
save left saved.png
command left
as left lit
wait
canvas lit.png
command left
half right
dark on
view 1.5 4 3 0.3 0 1
show right vao
as right difference
split 0
wait
canvas difference.png
command right
options right
probe 320 300
overlay on
wait
canvas plain.png
key x
point 320 300
wait
canvas explained.png
screenshot window.png
quit
END
[ "$(grep -c '^crevice render' stdout.txt)" -eq 4 ] || fail "not four commands"
grep -q '^method=vao$' stdout.txt || fail "no options as text"
grep -q '^pixel 320,300  depth [0-9.]*  normal .* left [01]\.' stdout.txt || fail "no probe"
cp stdout.txt said.txt
# run N: runs the Nth command that was said, with the tool under test.
run_said() {
    PATH="$(dirname "$tool"):$PATH" sh -ec "$(grep '^crevice render' said.txt | sed -n "$1p")" \
        2>/dev/null >/dev/null || fail "command $1 does not run"
}
run_said 1
same first.png ao.png R 0 Y
run_said 2
same second.png ao.png R 0 Y
cmp -s saved.png ao.png || fail "Save picture is not what the command writes"
good compare --json first.png second.png --channel R
at_least "$(number rmse)" 0.01 "difference of two views"
# Lit pictures are mixed from two, and the heat map has 2048 colours: a channel may round
# to the next of 255 steps. The view of the heat map is down to the floor: a picture of the
# tool does not tell background from open surfaces, the window does.
mv lit.png shown_lit.png
mv difference.png shown_difference.png
good compare --json explained.png plain.png --channel R
at_least "$(number max_error)" 0.1 "what explains a pixel"
run_said 3
run_said 4
for channel in R G B; do
    same shown_lit.png lit.png $channel 0.00393
    same shown_difference.png difference.png $channel 0.00393
done

# The options that the window copies are those that it shows.
grep -A20 '^method=' said.txt | grep = >options.txt
good render builtin:courtyard --size 64x36 -o a.exr --options options.txt
good render builtin:courtyard --size 64x36 -o b.exr --method vao --radius 0.43
good compare --json a.exr b.exr
at_most "$(number max_error)" 0 "difference of copied options"

# A frame: the same bits as `crevice ao`.
good gbuffer builtin:courtyard --size 640x400 -o frame.exr -q
act frame.exr --normal none --depth Z <<'END'
size 640 400
overlay off
split 1
wait
canvas frame.png
command left
show right truth
wait-truth 2
split 0
key plus
key Left
wait
quit
END
grep -q -- '--depth Z --normal none' stdout.txt || fail "passes are not in the command"
PATH="$(dirname "$tool"):$PATH" sh -ec "$(grep '^crevice ao' stdout.txt)" 2>/dev/null
same frame.png ao.png R 0 Y

# Lenses as `crevice ao` takes them, and what is for meshes only.
act frame.exr --lens 40 --sensor 30 <<'END'
size 640 400
overlay off
split 1
wait
canvas lens.png
command left
quit
END
grep -q -- '--lens 40 --sensor 30' stdout.txt || fail "no lens in the command"
PATH="$(dirname "$tool"):$PATH" sh -ec "$(grep '^crevice ao' stdout.txt)" 2>/dev/null
same lens.png ao.png R 0 Y
good compare --json lens.png frame.png --channel R
at_least "$(number max_error)" 0.01 "difference of two lenses"
bad 2 'contradicts --hfov' view frame.exr --vfov 40 --hfov 40
bad 2 'is for --lens' view frame.exr --sensor 30
bad 2 'are for meshes' view frame.exr --eye 0,0,1
bad 2 'are for frames' view builtin:corner --vfov fit
bad 1 'no.json' view frame.exr --camera no.json

# A shot is scrubbed through; the last frame is damaged, which is told and no more.
cp frame.exr shot.1.exr
good gbuffer builtin:corner --size 640x400 -o shot.2.exr -q
echo nothing >shot.3.exr
act 'shot.#.exr' --frames 1-3 <<'END'
wait
probe 320 200
frame 1
wait
probe 320 200
frame 2
wait
status
frame 0
wait
probe 320 200
quit
END
[ "$(grep -c '^pixel' stdout.txt)" -eq 3 ] || fail "three frames are not probed"
[ "$(grep '^pixel' stdout.txt | sort -u | wc -l)" -eq 2 ] || fail "frames are mixed up"
grep -q 'shot.3.exr' stdout.txt || fail "the damaged frame is not told of"

# Options are fitted to the truth and taken over. The truth stays what they were fitted to
# until there is another method.
act builtin:courtyard --method gtao --radius 0.2 <<'END'
size 640 400
show right truth
wait
tune left 3
take-over left
wait
options left
set left radius 0.7
wait
command right
show left hsao
wait
command right
quit
END
grep -q '^fitted: RMSE 0\.[0-9]* to 0\.[0-9]*, bias' stdout.txt || fail "nothing was fitted"
grep -q '^another view: RMSE 0\.' stdout.txt || fail "no other view"
grep -q '^radius=' stdout.txt || fail "no options"
grep -q '^radius=0.2$' stdout.txt && grep -q '^contrast=1$' stdout.txt &&
    fail "the fitted options are not taken over"
[ "$(grep -c -- 'crevice reference .*--radius 0.2 .*--falloff linear' stdout.txt)" -eq 1 ] ||
    fail "the truth does not stay"
[ "$(grep -c -- 'crevice reference .*--radius 0.7 ' stdout.txt)" -eq 1 ] ||
    fail "the truth stays for another method"
act builtin:corner --tune --size 400x300 <<'END'
wait-tune
quit
END
grep -q '^fitted: RMSE 0\.' stdout.txt || fail "--tune fits nothing"
echo 'take-over left' >take.txt
bad 1 'take.txt:1: take-over left: nothing was fitted' view builtin:corner --script take.txt

# A window whose size changes all the time ends with the right picture.
act builtin:corner <<'END'
wait
resize-storm 60
size 640 400
overlay off
split 1
wait
canvas storm.png
command left
measure left radius 0.1 0.5 3
start
quit
END
grep -q '^radius: 3 changes, median [0-9.]* ms.*method [0-9.]*, colours' stdout.txt ||
    fail "nothing is measured"
grep -q '^start: input read after [0-9]* ms, window' stdout.txt || fail "no start"
PATH="$(dirname "$tool"):$PATH" sh -ec "$(grep '^crevice render' stdout.txt)" 2>/dev/null
same storm.png ao.png R 0 Y

# Odd inputs and scripts are one line and no window.
echo nothing >nothing.glb
printf 'v 0 0 0\nv 1 0 0\nl 1 2\n' >lines.obj
pfm colour.pfm 1 1 nan
bad 1 'nothing.glb' view nothing.glb
bad 1 'no triangles' view lines.obj
bad 1 'not_here.exr' view not_here.exr
bad 1 'vfov' view colour.pfm
bad 2 'add --near and --far' view colour.pfm --depth-encoding reversed
bad 2 'frames' view 'shot.#.exr'
bad 2 'did you mean' view builtin:corner --methd gtao
echo 'as left lit' >lit.txt
bad 1 'lit.txt:1: as left lit: ' view frame.exr --script lit.txt
echo 'size 4000 3000' >huge.txt
bad 1 'huge.txt:1: size 4000 3000: the picture stays at .*, the screen is 1600 x 1000' \
    view builtin:corner --script huge.txt
echo dance >dance.txt
bad 1 'dance.txt:1: dance: no such action' view builtin:corner --script dance.txt
bad 1 'no.txt: cannot be read' view builtin:corner --script no.txt
