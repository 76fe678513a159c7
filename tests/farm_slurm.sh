# SPDX-License-Identifier: MIT
# The example for farms on a real Slurm of this machine's own: a controller, a node and
# their authentication, with folders, keys and ports that nobody else uses. Skipped where
# they are missing or do not start.
for program in munged slurmctld slurmd sbatch sinfo scontrol; do
    command -v $program >/dev/null || { echo "no $program; skipped"; exit 77; }
done
. "$(dirname "$0")/tool_lib.sh"
script=$tests/../examples/farm/ao_array.sh

cluster=$(mktemp -d)
chmod 755 "$cluster"
export SLURM_CONF="$cluster/slurm.conf"
stop() {
    scontrol shutdown >/dev/null 2>&1 || true
    for name in slurmd slurmctld munged; do
        if [ -s "$cluster/$name.pid" ]; then
            kill "$(cat "$cluster/$name.pid")" 2>/dev/null || true
        fi
    done
    sleep 1
    rm -rf "$cluster"
}
trap stop EXIT

skip() {
    echo "$1; skipped"
    tail -n 5 "$cluster"/*.log 2>/dev/null || true
    exit 77
}

mkdir "$cluster/state" "$cluster/spool"
(umask 077 && head -c 1024 /dev/urandom >"$cluster/munge.key")
munged --force --key-file="$cluster/munge.key" --socket="$cluster/munge.socket" \
    --pid-file="$cluster/munged.pid" --log-file="$cluster/munged.log" \
    --seed-file="$cluster/munge.seed" >/dev/null 2>&1 || skip "munged does not start"

host=$(hostname -s)
port=$((20000 + $$ % 20000))
cat >"$SLURM_CONF" <<END
ClusterName=crevice
SlurmctldHost=$host(localhost)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket=$cluster/munge.socket
StateSaveLocation=$cluster/state
SlurmdSpoolDir=$cluster/spool
SlurmctldPidFile=$cluster/slurmctld.pid
SlurmdPidFile=$cluster/slurmd.pid
SlurmctldLogFile=$cluster/slurmctld.log
SlurmdLogFile=$cluster/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
JobAcctGatherType=jobacct_gather/none
SchedulerParameters=batch_sched_delay=0
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/none
NodeName=$host NodeAddr=localhost CPUs=$(nproc)
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
END
slurmctld -c >/dev/null 2>&1 || skip "slurmctld does not start"
slurmd >/dev/null 2>&1 || skip "slurmd does not start"
tries=0
until sinfo -h -o %t 2>/dev/null | grep -q idle; do
    tries=$((tries + 1))
    [ $tries -lt 60 ] || skip "no node is idle"
    sleep 0.5
done

for frame in 1 2 3 4 5 6 7; do
    good gbuffer builtin:courtyard --size 48x27 --guard-px 0 --eye "6,2,-$((2 + frame))" \
        --target 0,1,0 -o shot.000$frame.exr
done
good ao "shot.####.exr" --frames 1-7 --append -o "whole.####.exr"

# farm NAME OPTIONS...: three tasks of an array, to their end; $failed of them failed. Their
# lines are in NAME.TASK.txt.
farm() {
    name=$1
    shift
    job=$(CREVICE=$tool sbatch --parsable --array=1-3 --output="$PWD/$name.%a.txt" \
        "$script" "shot.####.exr" 1 7 "$name.####.exr" "$@")
    while [ -n "$(squeue -h -j "$job")" ]; do
        sleep 0.2
    done
    failed=$(scontrol -o show job "$job" | grep -c 'JobState=FAILED' || true)
}
same() {
    for frame in 1 2 3 4 5 6 7; do
        cmp -s whole.000$frame.exr "$1.000$frame.exr" ||
            fail "$1.000$frame.exr has other bits than one run"
    done
}
farm farm --append
[ "$failed" -eq 0 ] || fail "$failed tasks failed: $(cat farm.*.txt)"
same farm

# Submitted again, only what is missing is made.
rm farm.0005.exr
farm farm --append
same farm
[ "$(grep -c 'is there, and made' farm.1.txt)" -eq 3 ] || fail "task 1 made frames again"
grep -q '^wrote farm.0005.exr' farm.2.txt || fail "task 2 did not make the missing frame"

# A task with a bad frame fails, and all other frames are done.
head -c 3000 shot.0004.exr >cut.exr
mv cut.exr shot.0004.exr
farm bad --radius 0.4
[ "$failed" -eq 1 ] || fail "$failed tasks failed, not the one with a bad frame"
[ ! -e bad.0004.exr ] || fail "a result of a bad frame"
for frame in 1 2 3 5 6 7; do
    [ -s bad.000$frame.exr ] || fail "frame $frame beside the bad one"
done
