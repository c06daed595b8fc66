#!/usr/bin/env bash
# A Slurm of one node on loopback, from Debian's packages, that runs a sweep of 20 jobs, loses one, and completes it.
# Run as root where dexrepro[slurm] is installed:  PATH=.venv/bin:$PATH tests/slurm/single_node.sh
# Daemons, keys, logs and results live in one temporary folder; all of it is gone at the end.
set -euo pipefail

if ! command -v slurmctld slurmd munged > /dev/null; then
    apt-get update -q > /dev/null && apt-get install -y -q --no-install-recommends slurm-wlm munge > /dev/null
fi
folder=$(mktemp -d)
node=$(hostname -s)
daemons=()

tear_down() {
    status=$?
    [ $status = 0 ] || tail -n 20 "$folder"/*.log >&2
    scancel --user="$(id -un)" 2> /dev/null || true
    for _ in $(seq 100); do [ -n "$(squeue -h 2> /dev/null)" ] && sleep 0.2 || break; done
    for daemon in $(printf '%s\n' "${daemons[@]}" | tac); do  # munged last: the others sign off with it
        kill "$daemon" 2> /dev/null || true
        for _ in $(seq 50); do kill -0 "$daemon" 2> /dev/null && sleep 0.2 || break; done
        kill -KILL "$daemon" 2> /dev/null || true
    done
    rm -rf "$folder"
    exit $status
}
trap tear_down EXIT

export SLURM_CONF=$folder/slurm.conf
cat > "$SLURM_CONF" << CONF
ClusterName=loopback
SlurmctldHost=$node(127.0.0.1)
SlurmctldPort=16817
SlurmdPort=16818
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
KillWait=1
NodeName=$node NodeAddr=127.0.0.1 CPUs=$(getconf _NPROCESSORS_ONLN) State=UNKNOWN
PartitionName=all Nodes=$node Default=YES State=UP
CONF
echo CgroupPlugin=cgroup/v1 > "$folder/cgroup.conf"  # named so that none is looked for; nothing above uses it

# Slurm's own sacct needs a database; this one tells submitit what the controller remembers.
mkdir "$folder/bin" && export PATH=$folder/bin:$PATH
cat > "$folder/bin/sacct" << 'SACCT'
#!/bin/sh
echo 'JobID|State|NodeList'
scontrol -o show job | sed -nE 's/.*ArrayJobId=(\S+) ArrayTaskId=(\S+) .*JobState=(\S+) .* NodeList=(\S*) .*/\1_\2|\3|\4/p' |
    sed -E 's/_([0-9]+[-,][^|]*)/_[\1]/'
SACCT
chmod +x "$folder/bin/sacct"

start() { "$@" & daemons+=($!); }
mkdir "$folder/state" "$folder/spool" && chmod 755 "$folder"
head -c 1024 /dev/urandom > "$folder/munge.key" && chmod 400 "$folder/munge.key"
start munged --foreground --key-file="$folder/munge.key" --socket="$folder/munge.socket" \
    --pid-file="$folder/munged.pid" --seed-file="$folder/munged.seed" 2> "$folder/munged.log"
for _ in $(seq 50); do [ -S "$folder/munge.socket" ] && break || sleep 0.2; done
start slurmctld -D -f "$SLURM_CONF" 2> "$folder/slurmctld.log"
start slurmd -D -f "$SLURM_CONF" 2> "$folder/slurmd.log"
for _ in $(seq 100); do [ "$(sinfo -h -o %t 2> /dev/null)" = idle ] && break || sleep 0.2; done
sinfo
[ "$(sinfo -h -o %t)" = idle ]

cd "$folder"
sweep=(dexrepro run -m chapter=2 only=movement_estimation 'seed=range(20)' movement_estimation.duration=1.0
    hydra/launcher=submitit_slurm hydra.launcher.partition=all hydra.launcher.cpus_per_task=1 hydra.launcher.timeout_min=10)
results() { ls results/runs/*/run.json 2> /dev/null; }
stamps() { results | xargs -r stat -c '%n %y' | sort; }

echo "\$ ${sweep[*]}"
"${sweep[@]}" 2> killed.log &
parent=$!
for _ in $(seq 240); do [ "$(results | wc -l)" -ge 4 ] && break || sleep 0.5; done
squeue
task() { tr '\0' '\n' < "/proc/$1/environ" | sed -n 's/^SLURM_ARRAY_TASK_ID=//p'; }
until victim=$(pgrep -n -f "^[^ ]*python[^ ]* -u -m submitit.core._submit $folder") &&
    job=$(task "$victim" 2> /dev/null) && [ -n "$job" ] && kill -KILL "$victim" 2> /dev/null; do sleep 0.2; done
echo "killed process $victim, job $job"
wait $parent && status=0 || status=$?
echo "exit status $status: $(tail -n 1 killed.log)"
while [ -n "$(squeue -h)" ]; do sleep 1; done
echo "queue empty: $(results | wc -l) of 20 results"
stamps > before

echo "the same command again:"
"${sweep[@]}"
stamps > after
echo "$(results | wc -l) of 20 results," \
    "written again: $(comm -23 before after | wc -l), new: $(comm -13 before after | wc -l)"
[ "$(results | wc -l)" = 20 ] && [ -z "$(comm -23 before after)" ] && [ -n "$(comm -13 before after)" ]
