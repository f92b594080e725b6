#!/bin/bash
# The template of `dreampm farm --to openjd`, checked and run by the command openjd of PyPI's openjd-cli: the film must be that
# of `dreampm make`. And the lines of the guide, as they stand.
#   tests/farm/openjd.sh DREAMPM GUIDE       openjd is on the PATH
set -euo pipefail
dreampm=$(realpath "$1")
guide=$(realpath "$2")
work=$(mktemp -d)
passed=0
start=$SECONDS
trap 'rm -rf "$work"' EXIT
fail() {
  echo "FAILED: $*"
  [ ! -e "$work/said" ] || tail -n 30 "$work/said"
  exit 1
}
pass() {
  echo "ok: $*"
  passed=$((passed + 1))
}
quietly() { "$@" >said 2>&1 || fail "$*"; }

cd "$work"
mkdir mine job
printf 'OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n' >mine/wedge.off
cat >dam.yaml <<'YAML'
dreampm: 1
name: dam
space: {min: [0, 0, 0], max: [0.6, 0.4, 0.3], spacing: 0.03, walls: {ceiling: {type: open}}}
time: {fps: 24, frames: 5, cfl: 0.5}
materials: {water: {type: newtonian, max_compression: 0.05}}
bodies: {column: {material: water, shape: {box: {min: [0, 0, 0], max: [0.24, 0.3, 0.3]}}}}
colliders: {ramp: {shape: {mesh: mine/wedge.off, scale: 0.2, center: [0.45, 0.05, 0.15]}}}
output: {folder: out/dam}
render: {size: [64, 36], samples: 4, noise: 0.1}
YAML
quietly "$dreampm" make dam.yaml --out whole

quietly "$dreampm" farm dam.yaml --to openjd --chunk 2
quietly openjd check out/dam/template.yaml
grep -q 'passes validation checks' said || fail "openjd check says another thing"
pass "openjd check: $(cat said)"

# From elsewhere and without the models where they were: they travel along.
mv mine gone
mv out/dam job/moved
quietly openjd run job/moved/template.yaml --step Film --run-dependencies
grep -q 'Chunks run: 5' said || fail "not a task each for simulation and film, and three chunks"
cmp job/moved/dam.mp4 whole/dam.mp4 || fail "another film than make's"
cmp job/moved/contact-sheet.png whole/contact-sheet.png || fail "another contact sheet than make's"
pass "openjd run gives make's film: $(grep 'Chunks run' said)"

quietly openjd run job/moved/template.yaml --step Film --run-dependencies
[ "$(grep -c 'nothing to do' said)" -eq 5 ] || fail "tasks make again what is up to date"
pass "openjd run again: all five tasks have nothing to do"
mv gone mine

quietly "$dreampm" wedge dam.yaml space.spacing=0.06,0.05 time.frames=2,3 --to openjd --chunk 2 --out wedge
quietly openjd check wedge/template.yaml
quietly openjd run wedge/template.yaml --step Table --run-dependencies
[ "$(grep -c ',complete,' wedge/wedge.csv)" -eq 4 ] || fail "the table of the wedge: $(cat wedge/wedge.csv)"
pass "openjd run makes a wedge of runs of two lengths, with its table"

# The guide's scene, coarse, and each of its lines with openjd but pip's.
sed -n '/^# splash.yaml/,/^```/p' "$guide" | sed -e '/^```/d' -e 's/spacing: 0.01,/spacing: 0.04,/' -e 's/seconds: 2}/seconds: 0.09}/' >splash.yaml
echo 'render: {size: [32, 18], samples: 4}' >>splash.yaml
lines=$(sed -n '/^pip install openjd-cli/,/^```/p' "$guide" | sed -e 1d -e '/^```/d')
[ "$(wc -l <<<"$lines")" -eq 3 ] || fail "the guide has other lines: $lines"
while read -r line; do
  PATH=$(dirname "$dreampm"):$PATH quietly bash -c "$line"
done <<<"$lines"
[ -s out/splash/splash.mp4 ] || fail "the guide's lines give no film"
pass "the guide's lines as they stand"

echo "$passed passed in $((SECONDS - start)).0s"
