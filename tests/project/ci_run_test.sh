#!/bin/bash
# What .ci/run counts, in a tree of its own where make and tools/setup are stand-ins that fail where they are told to.
#   ci_run_test.sh RUN
set -euo pipefail
run=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "FAILED: $*"; cat "$work/log"; exit 1; }

mkdir -p "$work/.ci" "$work/tools" "$work/bin"
cp "$run" "$work/.ci/run"
cat >"$work/bin/make" <<'SH'
#!/bin/bash
[[ " $BROKEN " != *" $1 "* ]] || exit 1
# One that has to run beside another waits for it.
[ "$1" != test-farm ] || touch farm
for ((i = 0; i < 100; ++i)); do
  [ "$1" != fuzz ] || [ -e farm ] || sleep 0.1
done
[ "$1" != fuzz ] || [ -e farm ] || exit 1
[[ $1 == *.stamp ]] || echo "100% tests passed, 0 tests failed out of 3"
SH
cat >"$work/tools/setup" <<'SH'
#!/bin/bash
[[ " $BROKEN " != *" $1 "* ]]
SH
chmod +x "$work/bin/make" "$work/tools/setup"

# Runs it with what is broken; its exit code and its last line must be these.
wants() { # BROKEN EXIT LAST-LINE
  local rc=0
  rm -f "$work/farm"
  BROKEN=$1 PATH="$work/bin:$PATH" "$work/.ci/run" >"$work/log" 2>&1 || rc=$?
  [ "$rc" -eq "$2" ] || fail "with '$1' broken it exits with $rc, not $2"
  [ "$(tail -n 1 "$work/log")" = "$3" ] || fail "with '$1' broken its last line is not '$3'"
}

wants "" 0 "27 passed, 0 failed"
# Each goal is shown, and told of in a line, those too that run beside others.
for goal in test validate test-python test-blender test-farm test-neon test-gpu test-asan fuzz; do
  grep -qx "=== make $goal" "$work/log" || fail "it does not show make $goal"
  grep -q "^make $goal: 100% tests passed, 0 tests failed out of 3 (exit 0, " "$work/log" || fail "no line tells of make $goal"
done
wants "test-neon" 1 "24 passed, 1 failed"
# No index for pip: the goal is left out, and said to be.
wants "build/setup-python.stamp" 0 "24 passed, 0 failed"
grep -q "^make test-python: NOT RUN" "$work/log" || fail "it does not say that test-python was not run"
# Debian packages that cannot be installed are no such excuse.
wants "tools/packages-blender.txt" 1 "24 passed, 1 failed"
! grep -q "NOT RUN" "$work/log" || fail "a failing apt is called a failing pip"
grep -q "^make test-blender: stopped, tools/packages-blender.txt" "$work/log" || fail "it does not name the list"
