#!/bin/bash
# Which prefix a build folder is configured for, in a tree of its own where cmake, ninja and cpack are stand-ins.
#   makefile_test.sh MAKEFILE
set -euo pipefail
makefile=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "FAILED: $*"; cat "$work/log"; exit 1; }

mkdir -p "$work/tools" "$work/bin"
cp "$makefile" "$work/Makefile"
touch "$work/tools/packages.txt" "$work/tools/packages-package.txt"
for name in tools/setup bin/ninja; do
  printf '#!/bin/bash\n' >"$work/$name"
done
cat >"$work/bin/cmake" <<'SH'
#!/bin/bash
# The folder build remembers its prefix; installing writes what it is for.
prefix=/usr/local
for word; do
  case $word in
    -DCMAKE_INSTALL_PREFIX=*) prefix=${word#*=} ;;
    --install) sed -n 's/^CMAKE_INSTALL_PREFIX:PATH=//p' build/CMakeCache.txt >installed; exit 0 ;;
  esac
done
mkdir -p build
echo "CMAKE_INSTALL_PREFIX:PATH=$prefix" >build/CMakeCache.txt
SH
cat >"$work/bin/cpack" <<'SH'
#!/bin/bash
mkdir -p build/packages
grep -o '/usr.*' build/CMakeCache.txt >>packed
[ -z "$BROKEN" ]
SH
chmod +x "$work/tools/setup" "$work"/bin/*
cd "$work"
unset MAKEFLAGS MAKEOVERRIDES # of a make that runs the tests
export BROKEN="" PATH="$work/bin:$PATH"
made() { make "$@" >log 2>&1; }

made install && [ "$(cat installed)" = /usr/local ] || fail "make install is not for /usr/local"
made install PREFIX=/opt/here && [ "$(cat installed)" = /opt/here ] || fail "PREFIX is not what is configured"
made package || fail "make package"
[ "$(xargs <packed)" = "/usr /usr/local" ] || fail "it packs for $(xargs <packed)"
grep -q '=/opt/here$' build/CMakeCache.txt || fail "make package leaves another prefix: $(cat build/CMakeCache.txt)"
export BROKEN=1
! made package || fail "make package hides that cpack failed"
grep -q '=/opt/here$' build/CMakeCache.txt || fail "a failed make package leaves another prefix: $(cat build/CMakeCache.txt)"
made install && [ "$(cat installed)" = /usr/local ] || fail "make install takes the prefix of an earlier one"
