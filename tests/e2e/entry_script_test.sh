#!/bin/sh
# entry_script_test.sh ROOT WORK - what ./traction says and runs, with stand-ins for apt, cmake, ninja and ctest in PATH that write down
# how they were called. The script under test is the real one, beside a package list of this test's own.
set -eu
root=$1 work=$2
rm -rf "$work"
mkdir -p "$work/bin" "$work/tree/cmake"
cp "$root/traction" "$work/tree/traction"
tree=$work/tree calls=$work/calls

stand_in() { # NAME, body on stdin
    { echo '#!/bin/sh'; echo "echo \"\${0##*/} \$*\" >>$calls"; cat; } >"$work/bin/$1"
    chmod +x "$work/bin/$1"
}
fail() { echo "entry script: $*"; echo '--- it said'; cat "$work/said"; echo '--- it called'; cat "$calls" 2>/dev/null; exit 1; }
expect() { grep -q -- "$2" "$1" || fail "$1 lacks: $2"; }
refuse() { ! grep -q -- "$2" "$1" 2>/dev/null || fail "$1 has: $2"; }
run() { rm -f "$calls"; status=0; PATH="$work/bin:$PATH" sh "$tree/traction" "$@" >"$work/said" 2>&1 || status=$?; }

stand_in dpkg-query </dev/null
stand_in sudo <<'S'
exec "$@"
S
# 1. no package index: apt-get update brings nothing, apt knows no version
stand_in apt-get <<'S'
echo "E: Failed to fetch the index  Could not resolve the mirror"; case $1 in update) exit 0 ;; *) exit 100 ;; esac
S
stand_in apt-cache <<'S'
echo "$2:"; echo "  Candidate: (none)"
S
cat >"$tree/cmake/apt-packages.txt" <<'S'
build  traction-needs-this   command:traction-needs-this  a package that no machine has
build  traction-needs-that   package                      another
test   traction-tests-this   package                      for the tests
S
run demo
[ "$status" -eq 1 ] || fail "without a package index demo ended with $status"
expect "$work/said" 'package index is empty or out of reach: E: Failed to fetch the index'
expect "$work/said" 'apt offers no version of: traction-needs-this traction-needs-that'
expect "$work/said" 'by hand'
refuse "$calls" '^apt-get install'
refuse "$calls" '^cmake'
refuse "$work/said" traction-tests-this

# 2. apt knows them, but the download fails
stand_in apt-cache <<'S'
echo "$2:"; echo "  Candidate: 1.0"
S
stand_in apt-get <<'S'
case $1 in update) exit 0 ;; *) echo "E: Unable to fetch some archives"; exit 100 ;; esac
S
run demo
[ "$status" -eq 1 ] || fail "with a failed download demo ended with $status"
expect "$work/said" 'Unable to fetch some archives'
expect "$work/said" 'apt could not install: traction-needs-this traction-needs-that'

# 3. nothing is missing: a user's build is the command line alone, in one line a step; the second call is silent
: >"$tree/cmake/apt-packages.txt"
stand_in cmake <<S
[ "\$1" = --preset ] && mkdir -p $tree/build/\$2/host_tools/cli && : >$tree/build/\$2/build.ninja
case "\$*" in *WERROR=OFF*) echo 'TRACTION_WERROR:BOOL=OFF' ;; *) echo 'TRACTION_WERROR:BOOL=ON' ;; esac >$tree/build/\$2/CMakeCache.txt
S
stand_in ninja <<S
echo '[0/2] Re-checking globbed directories...' # always, and all that a dry run tells
[ -e $work/built ] && { echo '[1/4] cd build && cmake -P version.cmake'; exit 0; } # the commit is looked at every time

case " \$* " in *' -n '*) exit 0 ;; esac
printf '[1/40] Building one\n'; sleep 2; printf '[20/40] Building twenty\n[40/40] Linking all\n'
: >$work/built
printf '#!/bin/sh\necho the program ran: "\$@"\n' >$tree/build/host/host_tools/cli/traction
chmod +x $tree/build/host/host_tools/cli/traction
S
stand_in ctest </dev/null
stand_in python3 <<'S'
echo 'no venv here'; exit 1
S
run demo --seed 3
[ "$status" -eq 0 ] || fail "demo ended with $status"
expect "$calls" '^cmake --preset host -DBUILD_TESTING=OFF -DTRACTION_WERROR=OFF -DTRACTION_TOGETHER=ON'
expect "$calls" '^ninja -C .*/build/host traction$'
expect "$work/said" '^traction: configuring build/host$'
expect "$work/said" '^traction: building build/host, 40 steps$'
expect "$work/said" '^traction: built build/host in [2-9] s$' # counted from the first line on, not when ninja has ended
expect "$work/said" 'the program ran: demo --seed 3'
refuse "$work/said" 'Building twenty'
refuse "$calls" '^python3' # the demo needs no environment of Python's
run demo --seed 4
[ "$(cat "$work/said")" = 'the program ran: demo --seed 4' ] || fail 'the second call was not silent'
refuse "$calls" '^cmake'

# 4. on a terminal the build counts
if command -v script >/dev/null; then
    rm -f "$work/built" "$calls"
    PATH="$work/bin:$PATH" script -qec "sh $tree/traction demo" /dev/null >"$work/said" 2>&1 </dev/null || fail 'demo on a terminal failed'
    expect "$work/said" 'building 20 of 40 (50 %)'
fi

# 5. a build that fails shows its errors and ends with 1
rm -f "$work/built"
stand_in ninja <<'S'
echo '[1/40] Building one'; echo 'one.cpp:3: error: expected ;'; exit 1
S
run demo
[ "$status" -eq 1 ] || fail "a failed build ended with $status"
expect "$work/said" 'one.cpp:3: error: expected ;'
refuse "$work/said" 'the program ran'

# 6. the tests configure again, with warnings as errors; a build that has them is left alone
stand_in ninja <<'S'
echo 'ninja: no work to do.'
S
run test
expect "$calls" '^cmake --preset host$'
expect "$calls" '^ctest --preset dev$'
command -v cantools >/dev/null || expect "$work/said" 'no cantools .*: built without the CAN bus' # and everything else went on
command -v mavgen.py >/dev/null || expect "$work/said" 'no mavgen.py .*: built without the supervision link'
run test
refuse "$calls" '^cmake'

# 7. where there are cantools, pymavlink, pyulog, jsonschema and mkdocs nothing is asked for
for program in cantools mavgen.py ulog_info jsonschema mkdocs; do stand_in $program </dev/null; done
run test
refuse "$calls" '^python3'
refuse "$work/said" 'built without'

# 8. the emulated board: its own packages (one is known by a file's pattern), the target without tests, and the verb is told where it lies
mkdir -p "$tree/emulate"
echo "echo $work/board" >"$tree/emulate/emulate.sh"
printf '#!/bin/sh\necho "on $TRACTION_BOARD: $*"\n' >"$tree/build/host/host_tools/cli/traction"
rm -rf "$tree/build/korebot"
: >"$work/source-9.tar"
printf 'emulate  traction-source  file:%s/source-*.tar  a kernel\n' "$work" >"$tree/cmake/apt-packages.txt"
run emulate cruise --seed 3
[ "$status" -eq 0 ] || fail "emulate ended with $status"
expect "$calls" '^cmake --preset korebot -DBUILD_TESTING=OFF'
expect "$calls" '^ninja -C .*/build/korebot tractiond board_init'
expect "$work/said" "on $work/board: emulate cruise --seed 3"
refuse "$calls" '^apt-get'
rm "$work/source-9.tar"
run emulate cruise
expect "$calls" '^apt-get install .* traction-source'

# 9. a package: the board's program is built for it, unless it is named; nothing else of flash builds for the board
printf 'cross  traction-cross  command:traction-cross  the compiler\n' >"$tree/cmake/apt-packages.txt"
printf '#!/bin/sh\necho "cli: $*"\n' >"$tree/build/host/host_tools/cli/traction"
run flash --pack p.tar --key k --rover r
expect "$calls" '^apt-get install .* traction-cross'
printf 'cross  traction-cross  command:sh  the compiler\n' >"$tree/cmake/apt-packages.txt"
run flash --pack p.tar --key k --rover r
expect "$calls" '^ninja -C .*/build/korebot tractiond traction_slot'
expect "$work/said" 'cli: flash --pack p.tar --key k --rover r'
run flash --pack p.tar --key k --rover r --program mine
refuse "$calls" 'korebot'
run flash p.tar --host board
refuse "$calls" 'korebot'
echo 'entry script: 9 claims hold'
