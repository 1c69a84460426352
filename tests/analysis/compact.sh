#!/bin/bash
# SPDX-License-Identifier: MIT
# compact.sh STIPPLE SOURCE_DIR: compacting in place and after a run, on real archives: the same text before and after;
# killed at any moment the archive is sound.
set -u
stipple=$1 source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0
fail() { echo "FAILED: $*"; failures=$((failures + 1)); }

flags=$("$stipple" flags gcc 2>/dev/null) || { echo "no plugin for gcc: skipped"; exit 0; }

# record SOURCE STATUS ARGUMENTS...: an archive as the program wrote it, in raw.stipple.
record() {
  local program status=$2
  program=$(basename "$1" .c)
  # The flags are words.
  # shellcheck disable=SC2086
  gcc -O2 $flags -pthread -I"$source/../../runtime/include" "$source/../apps/$1" -o "$program" || { fail "compile $1"; return 1; }
  rm -rf raw.stipple && mkdir raw.stipple
  STIPPLE_ARCHIVE=$work/raw.stipple STIPPLE_CLOCK=exact LD_PRELOAD=$library "./$program" "${@:3}" >out 2>err
  local is=$?
  [ $is = "$status" ] || fail "$1: exit $is, not $status"
}
text() { "$stipple" print "$1" >"$2" 2>"$2.err"; "$stipple" check "$1" >>"$2"; }
bytes() { cat "$1"/*.stream | wc -c; }
library=$(dirname "$(dirname "$stipple")")/lib/stipple/libstipple.so

for row in "recursion.c 0 18" "threads.c 0" "longjmp.c 0" "fork.c 0" "signals.c 0" "ends.c 0"; do
  # shellcheck disable=SC2086
  record $row || continue
  text raw.stipple before
  "$stipple" compact raw.stipple -o compacted.stipple >answer || fail "$row: compact: exit $?"
  grep -q "before, .* after; .* events, .* bytes each" answer || { fail "$row: headline"; cat answer; }
  text compacted.stipple after
  sed -i 's/compacted\.stipple/raw.stipple/' after after.err
  cmp before after || { fail "$row: the text differs"; diff before after | head -5; }
  cmp before.err after.err || fail "$row: what is said differs"
  rm -rf compacted.stipple
done
"$stipple" compact raw.stipple -o raw.stipple >/dev/null 2>err && fail "-o wrote over an archive"
"$stipple" compact none.stipple 2>err; [ $? = 2 ] || fail "compact of nothing"

# Killed at any moment.
record recursion.c 0 20
text raw.stipple before
before=$(bytes raw.stipple)
for round in $(seq 20); do
  rm -rf again.stipple && cp -r raw.stipple again.stipple
  "$stipple" compact again.stipple >/dev/null 2>&1 &
  sleep "0.0$((RANDOM % 4))$((RANDOM % 10))"
  kill -KILL $! 2>/dev/null
  wait $! 2>/dev/null
  text again.stipple after
  sed -i 's/again\.stipple/raw.stipple/' after
  cmp -s before after || { fail "round $round: the text differs"; ls -l again.stipple; }
done
"$stipple" compact again.stipple >answer || fail "compact after kills"
[ "$(ls again.stipple)" = "$(basename again.stipple/*.stream)" ] || fail "something was left behind"
after=$(bytes again.stipple)
[ $((after * 2)) -lt "$before" ] || fail "$before bytes became $after"

# After a run; the status is the command's, and the same events are there.
"$stipple" run --clock exact -o run.stipple -- ./recursion 20 >out 2>err || fail "run: exit $?"
[ $(($(bytes run.stipple) * 2)) -lt "$before" ] || fail "a run was not compacted"
"$stipple" print --canonical run.stipple >after
"$stipple" print --canonical raw.stipple | cmp - after || fail "a run's events differ"
[ "$("$stipple" compact run.stipple | grep -c "compacted already")" = 1 ] || fail "not compacted already"

# Where nothing can be made, or not all of it, the archive stays as it was.
if [ "$(id -u)" != 0 ]; then
  chmod a-w raw.stipple
  "$stipple" compact raw.stipple >answer 2>err; [ $? = 1 ] || fail "read-only: exit"
  grep -q "not compacted: .*Permission denied" err || fail "read-only: not said"
  chmod u+w raw.stipple
else
  (ulimit -f 1; trap '' XFSZ; "$stipple" compact raw.stipple >answer 2>err; [ $? = 1 ]) || fail "no room: exit"
  grep -q "not compacted: .*File too large" err || { fail "no room: not said"; cat err; }
fi
text raw.stipple after
cmp before after || fail "hindered: the text differs"
exit "$failures"
