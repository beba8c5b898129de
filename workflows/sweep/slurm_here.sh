#!/usr/bin/env bash
# Starts a Slurm of its own on this machine, runs a command there, and stops that Slurm afterwards:
#
#     slurm_here.sh CPUS COMMAND ARGUMENT...
#
# For tests: one node, no accounting, no limits of memory. Its keys, logs and state are in a
# temporary folder. Exit code 77, with a message, if the packages slurm-wlm and munge are missing.
set -eu -o pipefail
cpus=$1
shift
PATH=$PATH:/usr/sbin:/sbin
for program in munged slurmctld slurmd srun sinfo; do
  command -v $program > /dev/null ||
    { echo "slurm_here.sh: there is no $program; skipped. apt-get install slurm-wlm munge" >&2; exit 77; }
done
[ "$(id -u)" -eq 0 ] || { echo "slurm_here.sh: slurmd has to be started by root; skipped" >&2; exit 77; }

work=$(mktemp -d /tmp/slurm-here.XXXXXX)
# munged requires that others can pass through its folders but not write into them.
chmod 755 "$work"
daemons=()
stop() {
  local pid
  for pid in ${daemons[@]+"${daemons[@]}"}; do kill "$pid" 2> /dev/null || true; done
  for pid in ${daemons[@]+"${daemons[@]}"}; do wait "$pid" 2> /dev/null || true; done
  rm -rf "$work"
}
trap stop EXIT
trap 'exit 130' INT TERM HUP

# port: prints a free port.
port() { /usr/bin/python3 -c 'import socket; s = socket.socket(); s.bind(("", 0)); print(s.getsockname()[1])'; }

host=$(hostname -s)
mkdir "$work/munge" "$work/state" "$work/spool"
chmod 700 "$work/munge"
dd if=/dev/urandom of="$work/munge/key" bs=1024 count=1 status=none
chmod 400 "$work/munge/key"
cat > "$work/slurm.conf" <<END
ClusterName=here
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$(port)
SlurmdPort=$(port)
AuthInfo=socket=$work/munge.socket
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
ProctrackType=proctrack/linuxproc
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
KillWait=5
InactiveLimit=10
SchedulerParameters=sched_min_interval=10000,batch_sched_delay=0
SlurmctldParameters=enable_configless
SlurmdTimeout=120
NodeName=$host NodeAddr=127.0.0.1 CPUs=$cpus State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP OverSubscribe=NO
END
export SLURM_CONF=$work/slurm.conf

# start PROGRAM ARGUMENT...
start() {
  "$@" > "$work/$1.log" 2>&1 &
  daemons+=($!)
}

# give_up WHAT: prints the logs and ends.
give_up() {
  echo "slurm_here.sh: $1" >&2
  tail -n 20 "$work"/*.log >&2
  exit 1
}

start munged --foreground --force --key-file="$work/munge/key" --socket="$work/munge.socket" \
  --pid-file="$work/munge/pid" --log-file="$work/munged-file.log" --seed-file="$work/munge/seed"
timeout 10 bash -c 'until [ -S "$0" ]; do sleep 0.1; done' "$work/munge.socket" || give_up 'munged did not start'
start slurmctld -D -f "$SLURM_CONF"
start slurmd -D -N "$host" -f "$SLURM_CONF"
timeout 30 bash -c 'until [ "$(sinfo --noheader --format=%t 2> /dev/null)" = idle ]; do sleep 0.1; done' ||
  give_up 'the node did not get ready'
"$@"
