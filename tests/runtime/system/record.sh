#!/bin/bash
# SPDX-License-Identifier: MIT
# record.sh STIPPLE EVENTS DENY: system events of tests/runtime/system/events.c. A program prints the same recorded or
# not; what must be there whatever the scheduler does is there.
set -u
stipple=$1 events=$2 deny=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "FAILED: $*" >&2; exit 1; }

# record NAME OPTIONS... [-- PREFIX...]: runs a behaviour plainly and recorded, into $work/NAME.stipple.
record() {
  local name=$1 options=() prefix=()
  shift
  while (($#)) && [[ $1 != -- ]]; do options+=("$1"); shift; done
  (($#)) && prefix=("${@:2}")
  "$events" "$name" >"$work/plain" || fail "$name: plain"
  rm -rf "$work/$name.stipple"
  "${prefix[@]}" "$stipple" run --clock exact "${options[@]}" -o "$work/$name.stipple" -- "$events" "$name" \
    >"$work/recorded" 2>"$work/err" || { cat "$work/err" >&2; fail "$name ${options[*]}: exit status $?"; }
  cmp "$work/plain" "$work/recorded" || fail "$name ${options[*]}: prints something else"
  "$stipple" check "$work/$name.stipple" >"$work/check" 2>&1 || { cat "$work/check" >&2; fail "$name: unsound"; }
}
table() { "$stipple" stats "$work/$1.stipple" --table "$2" --format csv 2>/dev/null; }
# column TABLE_TEXT NAME: the values of a column, one a line.
column() { awk -F, -v name="$2" 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == name) c = i; next } { print $c }' <<<"$1"; }
sum() { awk '{ s += $1 } END { printf "%.9f\n", s }'; }
holds() { awk "BEGIN { exit !($1) }" || fail "$2: $1"; }
recorded() { "$stipple" info --json "$work/$1.stipple" 2>/dev/null | grep -q "\"$2\":true"; }

record sleep --switches --syscalls io
if recorded sleep switches; then
  switches=$(table sleep switches)
  holds "$(column "$switches" blocked) >= 3" "three naps block"
  holds "$(column "$switches" blocked_s) >= 0.06" "and take 60 ms"
  holds "$(column "$switches" longest_s) >= 0.02" "20 ms each"
fi
calls=$(table sleep syscalls | grep ^nanosleep)
[[ $(cut -d, -f2 <<<"$calls") == 3 ]] || fail "nanosleep: $calls"
states=$(table sleep states)
span=$("$stipple" info --json "$work/sleep.stipple" | sed -E 's/.*"span_s":([0-9.e-]+).*/\1/')
total=$(for s in user_s system_s message_s idle_s; do column "$states" $s; done | sum)
holds "($total - $span) ^ 2 < 1e-12" "states sum to the span"
holds "$(column "$states" system_s) >= 0.06" "sleeping is the system's time"

record preempted --switches
if recorded preempted switches; then
  switches=$(table preempted switches)
  holds "$(column "$switches" preempted | sum) >= 1" "one of two on a processor is preempted"
  holds "$(column "$switches" preempted_s | sum) > 0" "and waits"
fi

record pipe --syscalls io
calls=$(table pipe syscalls)
[[ $(grep ^read, <<<"$calls" | cut -d, -f2,4,5) == 2,5,1 ]] || fail "reads: $calls"
[[ $(grep ^write, <<<"$calls" | cut -d, -f4) == 5 ]] || fail "writes: $calls"
"$stipple" print "$work/pipe.stipple" >"$work/text"
grep -qE 'read\([0-9]+, 0x[0-9a-f]+, 16\) = 5$' "$work/text" || fail "print shows no read"
grep -qE 'read\(-1, .*\) = -1 EBADF$' "$work/text" || fail "print shows no error"
[[ $(column "$(table pipe states)" system_s) != "" ]] || fail "system is null though calls were recorded"

record interrupted --syscalls io
"$stipple" print "$work/interrupted.stipple" | grep -qE 'read\(.*, 1\) = -1 EINTR$' || fail "EINTR is not recorded"
record cancelled --switches --syscalls io
record forked --switches --syscalls io
[[ $(column "$(table forked switches)" process | sort -u | wc -l) == 2 ]] || fail "the child has no switches of its own"
record threads --switches --syscalls io
[[ $(column "$(table threads switches)" thread | sort -un | wc -l) == 101 ]] || fail "threads without events are missing"
[[ $(table threads syscalls | grep ^nanosleep | cut -d, -f2) == 100 ]] || fail "naps of the threads are missing"

for name in interrupted cancelled forked threads own; do record $name --syscalls all; done
record raw --switches --syscalls all
if recorded raw "all system calls"; then
  [[ $(table raw syscalls | grep ^getppid | cut -d, -f2) == 8 ]] || fail "raw calls: $(table raw syscalls)"
fi

# As nobody, where the programs can be reached: what perf_event_paranoid allows is recorded.
nobody=(setpriv --reuid=65534 --regid=65534 --clear-groups)
if [[ $(id -u) == 0 ]] && "${nobody[@]}" test -x "$stipple" -a -x "$events" 2>/dev/null; then
  chmod 777 "$work"
  record sleep --switches --syscalls all -- "${nobody[@]}"
  if (($(cat /proc/sys/kernel/perf_event_paranoid 2>/dev/null || echo 3) <= 2)) && recorded preempted switches; then
    recorded sleep switches || fail "switches are not recorded as nobody"
  fi
fi

# Refused, and without anything asked for.
record sleep --switches --syscalls io -- "$deny"
recorded sleep switches && fail "switches are recorded without perf_event_open"
"$stipple" info --json "$work/sleep.stipple" 2>/dev/null | grep -q '"what":"switches","errno":1' || fail "no reason given"
switches=$(table sleep switches)
[[ $(column "$switches" blocked_s) == "" ]] || fail "times without switches"
holds "$(column "$switches" blocked) >= 3" "the kernel's own count remains"
record sleep
[[ $(table sleep switches | wc -l) == 1 && $(table sleep syscalls | wc -l) == 1 ]] || fail "tables of nothing"
[[ $(column "$(table sleep states)" system_s) == "" ]] || fail "system is not null"
if "$stipple" run --syscalls some -o "$work/x.stipple" -- true 2>"$work/err"; then fail "--syscalls some"; fi
grep -q "known: none, io, all" "$work/err" || fail "unknown value: $(cat "$work/err")"
echo "system events are what they must be"
