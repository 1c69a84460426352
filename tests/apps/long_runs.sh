#!/bin/bash
# SPDX-License-Identifier: MIT
# What only a long run shows, with tables instead of a golden text:
#   a recursion a million frames deep is recorded, read and left at once by longjmp;
#   a library that comes and goes a thousand times keeps its ids, and the archive grows by events only;
#   threads that are silent for nine minutes keep their time;
#   a debugger that stops in the slow path shows the program's frames.
#
#   long_runs.sh deep|dlopen|silence|debugger STIPPLE WORK SOURCES COMPILER FLAGS...
set -u
what=$1 stipple=$2 work=$3 sources=$4
shift 4
fail() { echo "FAILED: $*" >&2; exit 1; }
calls() { # FUNCTION: of the profile
  "$stipple" stats "$work/app.stipple" --table profile --format csv |
    awk -F, -v name="$1" '$1 == name || $1 == "\"" name "\"" { print $(NF - 6) }'
}
rm -rf "$work"
mkdir -p "$work"

case $what in
deep)
  "$@" -pthread "$sources/deep.c" -o "$work/app" || fail "does not compile"
  "$stipple" run --clock exact -o "$work/app.stipple" -- "$work/app" || fail "exit status $?"
  "$stipple" check "$work/app.stipple" || fail "not sound"
  [[ $(calls Down) == 2000002 ]] || fail "calls of Down: $(calls Down)"
  "$stipple" print --canonical "$work/app.stipple" | awk '{ ++count[$1 " " $2] } END {
    exit !(count["enter Down"] == 2000002 && count["leave Down"] == 1000001 && count["unwound Down"] == 1000001) }' ||
    fail "enters, leaves and frames unwound do not sum up"
  ;;
dlopen)
  "$@" -fPIC -shared "$sources/dlopen_library.cpp" -o "$work/library.so" || fail "library does not compile"
  "$@" "$sources/dlopen.cpp" -o "$work/app" || fail "does not compile"
  "$stipple" run --clock exact -o "$work/app.stipple" -- "$work/app" "$work/library.so" 1000 >"$work/out" || fail "exit status $?"
  "$stipple" check "$work/app.stipple" || fail "not sound"
  [[ $(calls InLibrary) == 1000 ]] || fail "calls of InLibrary: $(calls InLibrary)"
  # 6000 events and their chunks; three definitions more each time would be 200 KB.
  bytes=$(stat -c %s "$work"/app.stipple/*.stream)
  ((bytes < 160 * 1024)) || fail "$bytes bytes"
  ;;
silence)
  "$@" -pthread "$sources/silent.c" -o "$work/app" || fail "does not compile"
  "$stipple" run --clock exact -o "$work/app.stipple" -- "$work/app" || fail "exit status $?"
  "$stipple" check "$work/app.stipple" || fail "not sound"
  for function in RestSeldom RestAfterBurst; do
    "$stipple" stats "$work/app.stipple" --table profile --format csv |
      awk -F, -v name=$function '$1 == name && $(NF - 5) > 529 { ++good } END { exit good != 1 }' ||
      fail "$function did not take 530 s"
  done
  ;;
debugger)
  command -v gdb >/dev/null || { echo "SKIPPED: no gdb"; exit 77; }
  "$@" -g "$sources/nested.c" -o "$work/app" || fail "does not compile"
  library=$("$stipple" run -o "$work/app.stipple" -- printenv LD_PRELOAD 2>/dev/null)
  mkdir -p "$work/app.stipple"
  gdb -nx -batch -iex "set debuginfod enabled off" -ex "set breakpoint pending on" -ex "set environment LD_PRELOAD $library" \
    -ex "set environment STIPPLE_ARCHIVE $work/app.stipple" -ex "set startup-with-shell off" \
    -ex "break stipple_slow_event" -ex run -ex bt -ex "info symbol \$rip" "$work/app" >"$work/gdb" 2>&1
  grep -q "not permitted\|not allowed\|Cannot trace" "$work/gdb" && { echo "SKIPPED: may not trace"; exit 77; }
  grep -q "^#0 .*stipple_slow_event" "$work/gdb" || { cat "$work/gdb"; fail "did not stop in the slow path"; }
  grep -q "^#[0-9]* .*main (" "$work/gdb" || { cat "$work/gdb"; fail "main is not in the backtrace"; }
  ;;
*) fail "unknown: $what" ;;
esac
