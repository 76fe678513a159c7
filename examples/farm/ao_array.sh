#!/bin/sh
# SPDX-License-Identifier: MIT
#
# A shot on a farm with Slurm: each task of an array computes one slice of the frames.
#
#     sbatch --array=1-20 --cpus-per-task=4 ao_array.sh IN FIRST LAST OUT [OPTIONS]
#     sbatch --array=1-20 ao_array.sh "shot.####.exr" 1 240 "ao.####.exr" --lens 35
#
# The results have the same bits as those of one run over all frames: frame FIRST, which
# every task looks at, decides the radius and how normals and depth are read. A task that
# is requeued, or an array that is submitted again, makes only what is missing.
#
#SBATCH --job-name=crevice-ao
#SBATCH --requeue
set -eu

if [ $# -lt 4 ]; then
    echo "usage: sbatch --array=1-TASKS $0 IN FIRST LAST OUT [OPTIONS]" >&2
    exit 2
fi
input=$1
first=$2
last=$3
output=$4
shift 4

# Frames are dealt out in turn, because neighbours take the same time.
tasks=${SLURM_ARRAY_TASK_COUNT:-1}
slice=$((first + ${SLURM_ARRAY_TASK_ID:-1} - ${SLURM_ARRAY_TASK_MIN:-1}))
if [ "$slice" -gt "$last" ]; then
    echo "more tasks than frames: nothing to do"
    exit 0
fi

# A radius that is given needs no frame to choose it.
radius="--radius-frame $first"
for option in "$@"; do
    case $option in
    --radius | --radius=*) radius= ;;
    esac
done

# shellcheck disable=SC2086
exec "${CREVICE:-crevice}" ao "$input" --frames "$slice-${last}x$tasks" -o "$output" \
    --skip-existing $radius --threads "${SLURM_CPUS_PER_TASK:-1}" "$@"
