# SPDX-License-Identifier: MIT
# Part of tests/bench/run: what a context switch and a system call cost more when they are recorded, alternating runs.

# One number of bench_system, not recorded (the runtime is not there) or recorded.
system_ns() { # WHAT plain|VARIABLE=VALUE
  local libraries=$build/lib/stipple
  if [ "$2" = plain ]; then "$build/tests/bench_system" "$1"; return; fi
  rm -rf "$work/system.stipple" && mkdir "$work/system.stipple" || return 1
  env STIPPLE_ARCHIVE="$work/system.stipple" STIPPLE_CLOCK=exact "$2" \
    LD_PRELOAD="$libraries/libstipple.so:$libraries/libstipple-system.so" "$build/tests/bench_system" "$1"
}

median_of() { sort -n | awk '{ v[NR] = $1 } END { print NR % 2 ? v[(NR + 1) / 2] : (v[NR / 2] + v[NR / 2 + 1]) / 2 }'; }

run_system() {
  echo "CPU time of close(-1) through libc; of a context switch between two threads that yield, two records each (out, in); $rounds rounds in turn."
  local round what option plain recorded
  for what in calls switches; do
    option=STIPPLE_SYSCALLS=io
    [ $what = switches ] && option=STIPPLE_SWITCHES=1
    : >"$work/plain" && : >"$work/recorded" && : >"$work/ring"
    for ((round = 0; round < rounds; ++round)); do
      system_ns $what plain >>"$work/plain" && system_ns $what $option >>"$work/recorded" || return 1
      [ $what = calls ] || system_ns ring plain >>"$work/ring" || return 1
    done
    plain=$(median_of <"$work/plain") recorded=$(median_of <"$work/recorded")
    printf '  %s: %s ns, recorded %s ns\n' $what "$plain" "$recorded"
    if [ $what = calls ]; then
      verdict "$(awk "BEGIN { printf \"%.1f\", $recorded - $plain }")" 50 "system call, ns added"
    else
      printf '  switches noted by the kernel in a ring that nobody reads, the floor: %s ns\n' "$(median_of <"$work/ring")"
      verdict "$(awk "BEGIN { printf \"%.1f\", ($recorded - $plain) / 2 }")" 300 "context switch, ns added per record"
    fi
  done
}
