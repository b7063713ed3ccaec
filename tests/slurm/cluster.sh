#!/usr/bin/env bash
# A Slurm on this machine, for tests: a controller and one node, with its own key, ports and folders. Needs root, and Debian's
# `slurm-wlm` and `munge`.
#
#   tests/slurm/cluster.sh COMMAND...
#
# COMMAND runs with SLURM_CONF set to this cluster, which ends with it.
set -euo pipefail
[[ $# -ge 1 ]] || { echo "usage: tests/slurm/cluster.sh COMMAND..." >&2; exit 2; }
[[ $(id -u) = 0 ]] || { echo "tests/slurm/cluster.sh needs root: it starts the daemons of a cluster" >&2; exit 2; }
for program in munged slurmctld slurmd sbatch; do
    command -v "$program" >/dev/null || { echo "\`$program\` is missing: apt-get install slurm-wlm munge" >&2; exit 2; }
done

folder=$(mktemp -d /tmp/slurm.XXXXXX)
host=$(hostname -s)
cores=$(nproc)
end() {
    local status=$?
    kill $(cat "$folder"/*.pid 2>/dev/null) 2>/dev/null || true
    [[ $status = 0 ]] || tail -n 20 "$folder"/*.log >&2
    sleep 0.5
    rm -rf "$folder"
    exit $status
}
trap end EXIT

# munge wants folders that nobody else can write, and daemons a key that all of them know
chmod 755 "$folder"
mkdir -p "$folder"/{munge,state,spool}
dd if=/dev/urandom of="$folder/munge/key" bs=128 count=1 status=none
chmod 700 "$folder/munge"
chmod 400 "$folder/munge/key"
chmod 755 "$folder/munge"
munged --force --key-file="$folder/munge/key" --socket="$folder/munge/socket" --pid-file="$folder/munged.pid" \
    --log-file="$folder/munged.log" --seed-file="$folder/munge/seed"

cat >"$folder/slurm.conf" <<CONF
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
AuthType=auth/munge
AuthInfo=socket=$folder/munge/socket
SlurmUser=root
SlurmctldPort=26817
SlurmdPort=26818
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/linux
JobAcctGatherFrequency=1
JobAcctGatherParams=OverMemoryKill
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
SchedulerParameters=sched_min_interval=100000,batch_sched_delay=0,bf_interval=1
MpiDefault=none
ReturnToService=2
KillWait=2
MinJobAge=60
OverTimeLimit=0
SwitchType=switch/none
NodeName=$host NodeAddr=127.0.0.1 CPUs=$cores RealMemory=6000 State=UNKNOWN
PartitionName=short Nodes=$host Default=YES MaxTime=01:00:00 State=UP
PartitionName=long Nodes=$host MaxTime=7-00:00:00 State=UP
CONF
export SLURM_CONF="$folder/slurm.conf"
slurmctld
slurmd -N "$host"
for _ in $(seq 100); do
    [[ $(sinfo --noheader --format=%T --partition=short 2>/dev/null) = idle ]] && break
    sleep 0.2
done
[[ $(sinfo --noheader --format=%T --partition=short) = idle ]] || { echo "the node does not come up" >&2; exit 1; }
"$@"
