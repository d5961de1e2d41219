#!/usr/bin/env bash
# A plan through Slurm on this one machine, from nothing: its daemons with a configuration of their own in a scratch
# folder, the shaders as one array job, the merge as a second that waits for the first, and a comparison with what
# `lacquer gen` makes of the same files. Needs Debian's slurm-wlm and munge, and to be root, as slurmd does.
#
# usage: one_machine.sh LACQUER FILE... [-- FLAG...]     the flags go to `plan` and `gen`, such as --programs 4
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
[[ $# -ge 2 ]] || { sed -n '2,6s/^# //p' "$0" >&2; exit 2; }
lacquer=$(realpath "$1")
shift
files=()
while [[ $# -gt 0 && $1 != -- ]]; do
  files+=("$(realpath "$1")")
  shift
done
[[ $# == 0 ]] || shift
for program in munged slurmctld slurmd sbatch squeue; do
  command -v "$program" >/dev/null || { echo "there is no $program: apt-get install slurm-wlm munge" >&2; exit 77; }
done
[[ $(id -u) == 0 ]] || { echo "slurmd must be root" >&2; exit 77; }

work=$(mktemp -d "${TMPDIR:-/tmp}/lacquer-slurm-XXXXXX")
daemons=()
finish() {
  local one
  for one in "${daemons[@]+"${daemons[@]}"}"; do kill "$one" 2>/dev/null || true; done
  for one in "${daemons[@]+"${daemons[@]}"}"; do wait "$one" 2>/dev/null || true; done
  rm -rf "$work"
}
trap finish EXIT

# Who signs: munge with a key of this run.
mkdir -m 755 "$work"/{munge,state,spool,store}
head -c 128 /dev/urandom >"$work/munge/key"
chmod 400 "$work/munge/key"
munged --foreground --force --key-file="$work/munge/key" --socket="$work/munge/socket" --pid-file="$work/munge/pid" \
  --log-file="$work/munge/log" --seed-file="$work/munge/seed" >"$work/munge/out" 2>&1 &
daemons+=($!)

# Who schedules, and the one worker: it has all cores, and a task takes one.
port=$((20000 + RANDOM % 20000))
host=$(hostname -s)
cat >"$work/slurm.conf" <<CONF
ClusterName=lacquer
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmctldPort=$port
SlurmdPort=$((port + 1))
AuthType=auth/munge
AuthInfo=socket=$work/munge/socket
CredType=cred/munge
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=sched_interval=1,batch_sched_delay=0
ReturnToService=2
MpiDefault=none
SwitchType=switch/none
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP
CONF
export SLURM_CONF="$work/slurm.conf"
slurmctld -D -i >"$work/slurmctld.out" 2>&1 &
daemons+=($!)
slurmd -D >"$work/slurmd.out" 2>&1 &
daemons+=($!)
for ((i = 0; i < 60; ++i)); do
  [[ $(sinfo -h -o %T 2>/dev/null) != idle ]] || break
  sleep 0.5
done
[[ $(sinfo -h -o %T) == idle ]] || { tail -n 20 "$work"/slurm*.log "$work"/*.out "$work/munge/log" >&2; exit 1; }
echo "Slurm $(sinfo -V | cut -d' ' -f2) has $(sinfo -h -o '%D node with %c cores')"

# The plan, and its actions as jobs.
cd "$work/store"
"$lacquer" plan "${files[@]}" -o out --ninja build.ninja --json actions.json -q "$@"
jobs=$(python3 "$here/farm.py" submit actions.json -- --output="$work/job-%A-%a.txt")
echo "$jobs"
last=${jobs##* job }
while squeue -h -j "$last" 2>/dev/null | grep -q .; do sleep 0.5; done
[[ -e out/manifest.json ]] || { echo "no manifest was made:" >&2; cat "$work"/job-*.txt >&2; exit 1; }

# The same bytes.
"$lacquer" gen "${files[@]}" -o local -q "$@"
diff -r local out
echo "the same bytes in $(find out -type f | wc -l) files, made by $(find "$work" -name 'job-*.txt' | wc -l) tasks"
