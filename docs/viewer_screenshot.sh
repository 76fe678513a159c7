#!/bin/sh
# SPDX-License-Identifier: MIT
# Makes docs/viewer.png, the README's picture of the window, on a display of its own:
# docs/viewer_screenshot.sh [CREVICE]. Needs Xvfb, python3 and a build with GTK 4.
set -eu
root=$(cd -- "$(dirname -- "$0")/.." && pwd)
crevice=${1:-$root/build/release/tools/crevice/crevice}
work=$(mktemp -d)
server=
trap 'kill $server 2>/dev/null; rm -rf "$work"' EXIT

cat >"$work/script.txt" <<END
size 600 450
view 3.2 2.1 4.2 0.7 0.75 0
wait-truth 16
screenshot $root/docs/viewer.png
quit
END

# Nothing of the user's session; software rendering.
unset WAYLAND_DISPLAY DISPLAY
export GDK_BACKEND=x11 GSK_RENDERER=cairo GTK_A11Y=none XDG_RUNTIME_DIR="$work"
Xvfb -displayfd 3 -screen 0 1600x1000x24 -nolisten tcp 3>"$work/display" 2>/dev/null &
server=$!
while [ ! -s "$work/display" ]; do
    kill -0 $server || { echo "viewer_screenshot.sh: Xvfb does not start" >&2; exit 1; }
    sleep 0.1
done
DISPLAY=:$(cat "$work/display")
export DISPLAY
"$crevice" view builtin:courtyard --script "$work/script.txt" -q
python3 "$root/docs/fewer_colours.py" "$root/docs/viewer.png"
ls -l "$root/docs/viewer.png"
