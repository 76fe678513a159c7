# SPDX-License-Identifier: MIT
# What must neither hang, crash nor break an output: pipes in a checkpoint's place, limits,
# absurd numbers of threads, names that are no text, signals in the middle of long work.
. "$(dirname "$0")/tool_lib.sh"

tiny="builtin:corner --size 16x12"

# within SECONDS WORDS...: the exit code of a run that must end by itself; 137 if not.
within() {
    seconds=$1
    shift
    code=0
    timeout -s KILL "$seconds" "$tool" "$@" >stdout.txt 2>stderr.txt || code=$?
}

# A pipe that nobody writes to is no checkpoint.
mkfifo z.exr.checkpoint
# shellcheck disable=SC2086 # words
within 10 reference $tiny -o z.exr --rays 4 --resume
[ $code -eq 1 ] || fail "exit code $code with a pipe as checkpoint"
grep -q '^crevice: z.exr.checkpoint: cannot be read as a file; ' stderr.txt ||
    fail "the pipe is not told of: $(cat stderr.txt)"
rm z.exr.checkpoint

# A limit on the size of files is called what it is. ThreadSanitizer needs larger files.
if [ -z "${TSAN_OPTIONS:-}" ]; then
    code=0
    (
        ulimit -f 8
        exec "$tool" reference builtin:corner --size 160x90 -o out.exr --rays 4
    ) >stdout.txt 2>stderr.txt || code=$?
    [ $code -eq 1 ] || fail "exit code $code at the limit"
    grep -q '^crevice: out.exr.checkpoint: cannot be written (.*; raise the limit' stderr.txt ||
        fail "the limit is not told of: $(cat stderr.txt)"
fi

# Threads from the environment that no system can make.
# shellcheck disable=SC2086
OMP_NUM_THREADS=100000 within 60 render $tiny -o many.exr
[ $code -eq 0 ] || fail "exit code $code with 100000 threads"
if grep -q '^crevice: warning: ' stderr.txt; then # built with OpenMP
    grep -q '^crevice: warning: OMP_NUM_THREADS: 100000 are more' stderr.txt ||
        fail "the warning: $(cat stderr.txt)"
fi
# shellcheck disable=SC2086
good render $tiny -o few.exr --threads 1
cmp -s many.exr few.exr || fail "another picture with other threads"

# JSON and messages stay text if a file's name is none: 0xff, ESC, and U+009B.
odd=$(printf 'a\377b\033c\302\233d.exr')
cp few.exr "$odd"
good compare --json "$odd" few.exr
if command -v python3 >/dev/null; then
    python3 -c 'import json, sys
name = json.loads(sys.stdin.buffer.read().decode("utf-8"))["a"]
assert name == "a\ufffdb\x1bc\x9bd.exr", ascii(name)' <stdout.txt || fail "JSON of a name"
fi
rm "$odd"
bad 1 'a?b?c?d.exr: ' compare --json "$odd" few.exr
LC_ALL=C grep -q "$(printf '[\033\377\233]')" stderr.txt && fail "bytes for the terminal"

# Two outputs that are one file, through a link to what is not there yet.
ln -s new.png link.png
bad 2 'two pictures' render $tiny -o new.png --lit link.png
rm link.png

# Work that takes longer than ten seconds says how long beforehand and ends at a signal; with
# no terminal, one thread, and a slow instruction set.
out="--threads 1 -o long.exr"
# shellcheck disable=SC2086 # words
ends_soon '^estimation:  *[0-9.]* %, [0-9].* left$' '' render builtin:courtyard $out \
    --size 1280x720 --method containment --samples 2000 --isa scalar
# shellcheck disable=SC2086
ends_soon '^reference:  *[0-9.]* %, [0-9].* left$' ./long.exr.checkpoint reference \
    builtin:courtyard $out --size 640x360 --rays 65536
rm long.exr.checkpoint
# shellcheck disable=SC2086
ends_soon '^G-buffer:  *[0-9.]* %, [0-9].* left$' '' gbuffer builtin:courtyard $out --size 6000x4000 --layers 4

# A measurement of which each run takes long.
ends_soon '^containment: about ' '' bench builtin:courtyard --threads 1 --size 640x360 \
    --method containment --set samples=4000 --isa scalar
ends_soon '^run:  *[0-9.]* %, [0-9].* left$' '' bench builtin:courtyard \
    --threads 1 --size 640x360 --method containment --set samples=4000 --isa scalar

# A pixel of which takes so many samples that a large tile of them would take seconds.
# shellcheck disable=SC2086
ends_soon '^estimation:  *[0-9.]* %, [0-9].* left$' '' render builtin:courtyard $out \
    --size 1280x720 --method bitmask --directions 256 --steps 256 --isa scalar
at_most "$taken" $((3 * most)) "the processor's time before anything is told"

# A search for options: its truth, the runs of which each takes long, the search itself.
ends_soon '^truth:  *[0-9.]* %, [0-9].* left$' '' tune builtin:courtyard --threads 1 \
    --size 320x180 --rays 65536
ends_soon '^estimation:  *[0-9.]* %, [0-9].* left$' '' tune builtin:courtyard --threads 1 \
    --size 320x180 --rays 16 --method containment --samples 4000 --isa scalar
ends_soon '^fit: about ' '' tune builtin:corner --size 32x18 --rays 16 --time 100

# A comparison, too.
printf 'Pf\n6000 4000\n-1.0\n' >big.pfm
dd if=/dev/zero bs=1000000 count=96 2>/dev/null >>big.pfm
ends_soon '^compare: about ' '' compare big.pfm big.pfm --ppd 500 --heat-map long.png
rm big.pfm

# A model whose importer waits for ever, for a material that is a pipe.
mkfifo pipe.mtl
printf 'mtllib pipe.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >waits.obj
"$tool" gbuffer waits.obj -o long.exr >stdout.txt 2>stderr.txt &
process=$!
sleep 1
ends_now TERM ''
