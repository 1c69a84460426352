#!/bin/sh
# SPDX-License-Identifier: MIT
# tools_test.sh STIPPLE SOURCE_DIR: what scripts rely on: exit statuses, where output goes, JSON keys, errors that name
# what is known.
set -u
stipple=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0

fail() { echo "FAILED: $*"; failures=$((failures + 1)); }
# expect STATUS NAME COMMAND...: output in out, errors in err.
expect() {
  status=$1; name=$2; shift 2
  "$@" >out 2>err; got=$?
  [ "$got" -eq "$status" ] || { fail "$name: exit $got, not $status"; cat out err; }
}
has() { grep -qe "$2" "$1" || { fail "no '$2' in $1"; cat "$1"; }; }

# Use.
expect 0 help "$stipple" --help; has out "print an archive\|prove an archive"
for command in flags run info check print stats plot view report compact exemplar; do expect 0 "$command --help" "$stipple" $command --help; done
expect 2 "unknown command" "$stipple" nonsense; has err "known: flags run info"
expect 2 "unknown option" "$stipple" info --nonsense x; has err "known: --json"
expect 2 "missing archive" "$stipple" info none.stipple; has err "none.stipple"
expect 2 "unknown clock" "$stipple" run --clock sundial -- true; has err "known: exact, sparse:N.*budget:P"
expect 2 "a budget of nothing" "$stipple" run --clock budget:0 -- true; has err "known: exact"
expect 2 "unknown option" "$stipple" run --samples 100 -- true; has err "known"
expect 2 "no size" "$stipple" run --max-bytes 64Q -- true; has err "max-bytes.*64M, 2G"
expect 2 "too small a ring" "$stipple" run --max-bytes 1000K -- true; has err "max-bytes.*the least is 1M"
expect 2 "no command" "$stipple" run -o x; has err "no command"
expect 2 "no compiler" "$stipple" flags nonsense

# An empty archive is read as far as it goes.
mkdir empty.stipple
expect 0 "info of nothing" "$stipple" info --json empty.stipple; has out '"events":0'
expect 1 "check of nothing" "$stipple" check empty.stipple; has out "no stream"
expect 2 "unknown table" "$stipple" stats empty.stipple --table nonsense; has err "profile states messages volume waits imbalance"
expect 2 "unknown format" "$stipple" stats empty.stipple --table states --format nonsense; has err "text csv json"

# Nothing recorded: said, with the reason, and the status is the command's.
expect 3 "status" "$stipple" run -o none.stipple -- sh -c 'exit 3'; has err "nothing was recorded"
expect 143 "signal" "$stipple" run -o none.stipple -- sh -c 'kill -TERM $$'
expect 127 "no program" "$stipple" run -o none.stipple -- ./none
[ -e none.stipple ] && fail "an empty archive was left behind"

# No place for an archive: the command runs all the same, and one line says so.
touch file
expect 3 "no place" "$stipple" run -o file/x.stipple -- sh -c 'exit 3'; has err "nothing is recorded: file/x.stipple: Not a dir"

# Filters are refused before anything runs.
printf 'SCOREP_REGION_NAMES_BEGIN\n  EXCLUDE *\nOOPS_END\n' >unended
printf '\n\nEXCLUDE main\n' >misplaced
expect 2 "no filter" "$stipple" run -o none.stipple --filter ./none -- touch ran; has err "^./none: cannot be read: No such file"
expect 2 "a folder as filter" "$stipple" run -o none.stipple --filter . -- touch ran; has err "^.: is a directory"
expect 2 "unended filter" "$stipple" run -o none.stipple --filter unended -- touch ran; has err "^unended:4: 'SCOREP_REGION_NAMES_END' is missing"
expect 2 "misplaced rule" "$stipple" run -o none.stipple --filter misplaced -- touch ran; has err "^misplaced:3: 'EXCLUDE' stands outside"
[ -e ran ] && fail "the command ran all the same"
[ -e none.stipple ] && fail "an archive was made all the same"

flags=$("$stipple" flags g++ 2>/dev/null) || { echo "no plugin for g++: the rest is skipped"; exit "$failures"; }
cat >app.cpp <<'END'
#include <unistd.h>
#include <csignal>
#include <cstdio>
__attribute__((noinline)) int Fib(int n) { return n < 2 ? n : Fib(n - 1) + Fib(n - 2); }
int main(int argc, char**) {
  std::printf("%d\n", Fib(10));
  std::fflush(stdout);
  if (argc > 1) kill(getpid(), SIGKILL);
}
END
g++ -O2 $flags app.cpp -o app || fail "compile"
expect 0 "run" "$stipple" run -- ./app
[ "$(cat out)" = 55 ] || fail "standard output is not the program's own"
has err "recorded 180 events"; has err "next: stipple report app.stipple"
expect 2 "existing archive" "$stipple" run -- ./app; has err "overwrite"
expect 0 "overwrite" "$stipple" run --overwrite -- ./app
mkdir precious; touch precious/file
expect 2 "no archive to overwrite" "$stipple" run -o precious --overwrite -- ./app
[ -e precious/file ] || fail "a folder that is no archive was removed"
expect 0 "check" "$stipple" check app.stipple; has out "sound"
expect 0 "info" "$stipple" info --json app.stipple
for key in '"locations":\[{"rank":0,"process":0,"thread":0,"events":180}\]' '"ranks":1' '"lost":0' \
  '"unmatched_messages":0' '"span_s":' '"clock":{'; do has out "$key"; done
sed 's/Fib(10)/Fib(24)/' app.cpp >long.cpp && g++ -O2 $flags long.cpp -o long || fail "compile"
expect 0 "ring" "$stipple" run -o ring.stipple --max-bytes 1M -- ./long; has err "keeps only the last .* events before were overwritten"
expect 0 "check of a ring" "$stipple" check ring.stipple; has out "sound"; has out "keeps only the last"
expect 0 "info of a ring" "$stipple" info --json ring.stipple; has out '"ring":{"kept_from_s":.*"overwritten_events":[1-9]'; has out '"lost":0'
expect 0 "profile of a ring" "$stipple" stats ring.stipple --table profile; has out main; has err "keeps only the last"
[ "$(du -sb ring.stipple | cut -f1)" -le 1150000 ] || fail "the ring is larger than it may be"
expect 0 "profile" "$stipple" stats app.stipple --table profile --format json
has out '"region":"Fib(int)","file":"app.cpp","line":4,"calls":89,"inclusive_s":'
expect 0 "states" "$stipple" stats app.stipple --table states --format json
has out '{"rank":0,"user_s":.*,"system_s":null,"message_s":0.0,"idle_s":0.0}'
expect 0 "messages" "$stipple" stats app.stipple --table messages --format json
has out '{"rows":\["0"\],"columns":\["0"\],"values":\[\[0\]\]}'
expect 2 "--per-rank" "$stipple" stats app.stipple --table messages --per-rank
expect 2 "--ranks" "$stipple" stats app.stipple --table profile --ranks 0-3; has err "ranks 0-0"
expect 0 "canonical" "$stipple" print --canonical app.stipple
[ "$(head -3 out | tr '\n' ';')" = "location 0 0 0;enter main;enter Fib(int);" ] || { fail canonical; head -3 out; }

# As many visits as the formula says, 2 fib(21) - 1, of a program that is written for it.
gcc -O2 $("$stipple" flags gcc) "$2/../apps/recursion.c" -o recursion || fail "compile"
expect 0 "run of 21891 visits" "$stipple" run -- ./recursion 20
expect 0 "profile of 21891 visits" "$stipple" stats recursion.stipple --table profile --format json
has out '"region":"Fib","file":".*/recursion.c","line":9,"calls":21891,'

# After kill -9 every event is there and the unclean end is told.
expect 137 "killed" "$stipple" run -o killed.stipple -- ./app x
expect 1 "check of the killed" "$stipple" check killed.stipple; has out "did not end in order"
expect 0 "canonical of the killed" "$stipple" print --canonical killed.stipple
[ "$(grep -c Fib out)" = 178 ] || fail "events of the killed run are missing"

# What a filter leaves out is said, and so is that it left out nothing.
printf 'SCOREP_REGION_NAMES_BEGIN EXCLUDE Fib(int) SCOREP_REGION_NAMES_END' >fib
printf 'SCOREP_REGION_NAMES_BEGIN EXCLUDE nothing::* SCOREP_REGION_NAMES_END' >nothing
expect 0 "filter" "$stipple" run -o filtered.stipple --filter fib -- ./app
has err "recorded 2 events"; has err "the filter /.*/fib left out 1 of 2 functions"
expect 0 "info of the filtered" "$stipple" info --json filtered.stipple
has out '"filter":{"file":"/.*/fib","functions":2,"filtered":1}'; has out '"paused_s":0.0,"paused_times":0'
expect 0 "idle filter" "$stipple" run --overwrite -o filtered.stipple --filter nothing -- ./app
has err "recorded 180 events"; has err "the filter /.*/nothing excludes none of the 2 functions"

# Paused: nothing is recorded until the signal, which `stipple run` and a shell around the program survive and pass on.
expect 0 "paused" "$stipple" run -o paused.stipple --paused -- ./app
has err "recorded 0 events"; has err "switched off 1 time"
expect 0 "info of the paused" "$stipple" info paused.stipple; has out "^paused  .*, 1 time"
cat >signalled.cpp <<'END'
#include <csignal>
#include <cstdlib>
#include <sched.h>
#include "stipple/user.h"
__attribute__((noinline)) void While(bool on) {
  bool (*recording)();
  STIPPLE_RUNTIME_FUNCTION(stipple_recording, recording);
  while (recording() == on) sched_yield();
}
volatile int sink;
__attribute__((noipa)) int After(int x) { return sink = x; }
int main(int, char** argv) {
  const pid_t tool = std::atoi(argv[1]);
  kill(tool, SIGUSR2);
  While(false);
  After(1);
  kill(tool, SIGUSR2);
  While(true);
  return After(0);
}
END
g++ -O2 $flags -fplugin-arg-stipple-instruction-threshold=1 -I"$2/../../runtime/include" signalled.cpp -o signalled || fail "compile"
expect 0 "signals" sh -c 'exec "$0" run -o signalled.stipple --paused -- ./signalled $$' "$stipple"
expect 0 "canonical of the signalled" "$stipple" print --canonical signalled.stipple
has err "switched off 2 times"
[ "$(grep -c "After(int)" out)" = 2 ] || { fail "not one visit of After"; cat out; }

exit "$failures"
