#!/bin/bash
# SPDX-License-Identifier: MIT
# by_address.sh STIPPLE CC CXX: programs of -finstrument-functions whose modules come, go and change. Property: every
# function is shown under the name that it had when it ran, or, where that cannot be known, as module+0xoffset and said so.
set -u
stipple=$1 cc=$2 cxx=$3 failures=0
library_directory=$(dirname "$(dirname "$stipple")")/lib/stipple
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
fail() { echo "FAILED: $*"; failures=$((failures + 1)); }
record() { "$stipple" run --overwrite -o a.stipple -- "$@" >out 2>err || fail "$* fails: $(cat err)"; }
# events WORDS...: the events, in order, without the heading
events() {
  local found
  found=$("$stipple" print --canonical a.stipple 2>/dev/null | grep -v ^location | tr '\n' ';')
  [ "$found" = "$1" ] || fail "events are $found, not $1"
}

# Two libraries, one after the other, at one address.
for name in first second; do
  echo "int $name(int x) { return x + 1; }" >$name.c
  $cc -O1 -fPIC -shared -finstrument-functions $name.c -o $name.so || fail "compile"
done
cat >reload.c <<'END'
#include <dlfcn.h>
int main(int argc, char** argv) {
  for (int round = 0; round < 2; ++round)
    for (int i = 1; i < argc; i += 2) {
      void* library = dlopen(argv[i], RTLD_NOW);
      int (*function)(int) = (int (*)(int))dlsym(library, argv[i + 1]);
      if (function(1) != 2) return 1;
      dlclose(library);
    }
  return 0;
}
END
$cc -O1 reload.c -o reload || fail "compile"
record ./reload ./first.so first ./second.so second
once="enter first;leave first;enter second;leave second;"
events "$once$once"
"$stipple" check a.stipple | grep "no names" && fail "a name is missing"

# A static program, one at a fixed address, one without build-id.
cat >main.c <<'END'
static __attribute__((noinline)) int inner(int x) { return x + 1; }
int main(int argc, char** argv) { return inner(argc) - argc - 1; }
END
for flags in "-no-pie" "-Wl,--build-id=none" \
  "-static -Wl,-u,stipple_register,-u,__cyg_profile_func_enter -L$library_directory -lstipple"; do
  # shellcheck disable=SC2086
  $cc -O1 -finstrument-functions main.c -o main $flags || fail "compile $flags"
  record ./main
  events "enter main;enter inner;leave inner;leave main;"
done

# Source lines, where there is debug information.
$cc -O1 -g -finstrument-functions main.c -o main
record ./main
"$stipple" stats --table profile --format csv a.stipple 2>/dev/null | grep -q "^inner,.*main.c,1," || fail "no line of inner"

# Built anew with other code, stripped, gone: never a wrong name.
for change in "$cc -O0 -finstrument-functions main.c -DCHANGED=1 -o main" "rm main"; do
  $change
  "$stipple" print --canonical a.stipple >out 2>err
  grep -q "^enter main+0x" out || fail "a name after '$change': $(cat out)"
  [ "$(grep -c "main: 2 functions have no names" err)" = 1 ] || fail "not said after '$change': $(cat err)"
done

# clang forgets the exit of a function that an exception leaves; its callers' times and calls are right all the same.
cat >throw.cpp <<'END'
__attribute__((noinline)) void Thrower(int x) { if (x > 0) throw x; }
__attribute__((noinline)) void Caller(int x) { try { Thrower(x); } catch (int) {} }
int main(int argc, char**) { for (int i = 0; i < 5; ++i) Caller(argc); }
END
$cxx -O1 -finstrument-functions throw.cpp -o throw || fail "compile"
record ./throw
"$stipple" stats --table profile --format csv a.stipple 2>/dev/null >out
for row in "Caller(int),.*,0,5," "Thrower(int),.*,0,5," "main,.*,0,1,"; do
  grep -q "^\"*${row}" out || fail "no row $row: $(cat out)"
done

# A filter does not apply, and that is said.
printf 'SCOREP_REGION_NAMES_BEGIN EXCLUDE Caller* SCOREP_REGION_NAMES_END' >filter
"$stipple" run --overwrite -o a.stipple --filter filter -- ./throw 2>err
grep -q "was not applied" err || fail "filter: $(cat err)"

exit "$failures"
