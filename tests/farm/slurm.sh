#!/bin/bash
# The script of `dreampm farm --to slurm` on a cluster of one machine, which is this one, made here and ended again: the film
# must be that of `dreampm make`, also where a task was stopped. Debian's slurm-wlm and munge; as root.
#   tests/farm/slurm.sh DREAMPM
set -euo pipefail
dreampm=$(realpath "$1")
work=$(mktemp -d)
passed=0
start=$SECONDS

end() {
  local rc=$?
  for name in slurmd slurmctld munged; do
    [ ! -s "$work/$name.pid" ] || kill "$(cat "$work/$name.pid")" 2>/dev/null || true
  done
  [ $rc -eq 0 ] || tail -n 20 "$work"/*.log
  wait
  rm -rf "$work"
}
trap end EXIT
fail() {
  echo "FAILED: $*"
  exit 1
}
pass() {
  echo "ok: $*"
  passed=$((passed + 1))
}

# Munge with a key and a socket of its own, then the controller and the machine.
host=$(hostname -s)
mkdir -p "$work"/{state,spool,munge}
chmod 755 "$work"
chmod 700 "$work/munge"
head -c 1024 /dev/urandom >"$work/munge/key"
chmod 600 "$work/munge/key"
munged --foreground --force --key-file="$work/munge/key" --socket="$work/munge.socket" --pid-file="$work/munged.pid" \
  --log-file="$work/munge/log" --seed-file="$work/munge/seed" >"$work/munged.log" 2>&1 &
port=$((20000 + RANDOM % 20000))
cat >"$work/slurm.conf" <<CONF
ClusterName=farm
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$work/munge.socket
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=sched_interval=1,bf_interval=1,defer
ReturnToService=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=film Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
export SLURM_CONF=$work/slurm.conf
until [ -S "$work/munge.socket" ]; do sleep 0.05; done
slurmctld -D >>"$work/slurmctld.out" 2>&1 &
slurmd -D >>"$work/slurmd.out" 2>&1 &
for _ in $(seq 200); do
  [ "$(sinfo -h -o %T 2>/dev/null)" != idle ] || break
  sleep 0.1
done
[ "$(sinfo -h -o %T)" = idle ] || fail "the cluster does not start"

cd "$work"
cat >dam.yaml <<'YAML'
dreampm: 1
name: dam
space: {min: [0, 0, 0], max: [0.6, 0.4, 0.3], spacing: 0.03, walls: {ceiling: {type: open}}}
time: {fps: 24, frames: 6, cfl: 0.5}
materials: {water: {type: newtonian, max_compression: 0.05}}
bodies: {column: {material: water, shape: {box: {min: [0, 0, 0], max: [0.24, 0.3, 0.3]}}}}
output: {folder: out/dam}
render: {size: [256, 144], samples: 16, noise: 0.1}
YAML
"$dreampm" make dam.yaml --out whole 2>/dev/null >whole.txt

# Until the queue is empty.
wait_for_all() {
  for _ in $(seq 1200); do
    [ -n "$(squeue -h -o %i)" ] || return 0
    sleep 0.1
  done
  squeue
  fail "tasks still wait after two minutes"
}

"$dreampm" farm dam.yaml --to slurm --chunk 2 2>/dev/null
bash out/dam/slurm.sh --partition=film --cpus-per-task=1
wait_for_all
cmp out/dam/dam.mp4 whole/dam.mp4 || fail "another film than make's"
cmp out/dam/contact-sheet.png whole/contact-sheet.png || fail "another contact sheet than make's"
pass "simulation, an array of three chunks and the film give make's film"
[ "$(ls out/dam/farm/log/dam-frames-*.log | wc -l)" -eq 3 ] || fail "three tasks of frames have three logs"

bash out/dam/slurm.sh --partition=film
wait_for_all
[ "$(grep -l 'nothing to do' out/dam/farm/log/*.log | wc -l)" -eq 5 ] || fail "tasks make again what is up to date"
pass "submitted again, all five tasks have nothing to do"

# A chunk that is cancelled while it draws: what depends on it leaves the queue, and the script goes on.
"$dreampm" farm dam.yaml --to slurm --chunk 3 --out cut 2>/dev/null
bash cut/slurm.sh
until [ -e cut/render/render_000001.png ]; do sleep 0.02; done
scancel --batch --signal=TERM --name=dam-frames
wait_for_all
[ ! -e cut/dam.mp4 ] || fail "there is a film although a chunk was stopped"
grep -q 'type the same command again to go on' cut/farm/log/dam-frames-*.log || fail "the stopped chunk does not say so"
bash cut/slurm.sh
wait_for_all
grep -q 'going on' cut/farm/log/dam-frames-*.log || fail "the chunk does not go on"
cmp cut/dam.mp4 whole/dam.mp4 || fail "another film after a stop"
pass "a chunk that was stopped goes on, and the film is the same"

"$dreampm" wedge dam.yaml space.spacing=0.06,0.05 --set time.frames=3 --set render.size=[64,36] --to slurm --chunk 2 --out wedge 2>/dev/null
bash wedge/slurm.sh
wait_for_all
[ "$(grep -c ',complete,3,' wedge/wedge.csv)" -eq 2 ] || fail "the table of the wedge: $(cat wedge/wedge.csv)"
pass "a wedge ends with its table"

echo "$passed passed in $((SECONDS - start)).0s"
