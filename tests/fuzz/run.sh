#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# run.sh FUZZER FOLDER SECONDS CORPUS...: runs a libFuzzer program and says what it reached.
# Every run begins alike; FUZZ_SEED=0 draws another beginning, for long runs.
# The number of edges is that of all code in the program, reached by this target or not.
# What it finds is kept in FOLDER/found; so is the corpus, for the next run, in FOLDER/corpus.
set -euo pipefail
here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
fuzzer=$(readlink -f "$1")
folder=$2
seconds=$3
shift 3
corpora=()
for corpus in "$@"; do
    if [ -d "$corpus" ]; then
        corpora+=("$(readlink -f "$corpus")")
    fi
done
mkdir -p "$folder/corpus" "$folder/found"
cd "$folder"

# Readers are told to expect NULL from malloc; the import's child has no limit of its own
# under a sanitizer. Importers leave memory behind in that child, which ends then.
export ASAN_OPTIONS=allocator_may_return_null=1:max_allocation_size_mb=1024:detect_stack_use_after_return=1
export UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1
export LSAN_OPTIONS=suppressions=$here/leaks.txt:print_suppressions=0
status=0
"$fuzzer" -seed="${FUZZ_SEED:-1}" -max_total_time="$seconds" -rss_limit_mb=2048 -timeout=10 -print_final_stats=1 \
    -max_len=16384 -artifact_prefix=found/ corpus "${corpora[@]}" \
    >log.txt 2>&1 || status=$?
name=$(basename "$fuzzer")
runs=$(sed -n 's/^stat::number_of_executed_units: *//p' log.txt)
edges=$(grep -a -o 'cov: [0-9]*' log.txt | tail -n 1 | tr -dc 0-9)
all=$(sed -n 's/^INFO: Loaded .*(\([0-9]*\) inline 8-bit counters).*/\1/p' log.txt | head -n 1)
echo "$name: ${runs:-0} runs, ${edges:-0} of ${all:-0} edges" | tee summary.txt
if [ $status -ne 0 ]; then
    tail -n 60 log.txt
    echo "run.sh: $name found a fault; its input is in $PWD/found" >&2
fi
exit $status
