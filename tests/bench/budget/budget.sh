# SPDX-License-Identifier: MIT
# tests/bench/run reads this: what a program takes under --clock budget:5, against the same binary with recording
# stopped (--paused). Programs of tests/programs are measured if they have been built there (tests/programs/run NAME).

# An interpreter's daily work: calls, strings, tables, coroutines. Long enough that what is recorded before anything may be
# degraded, 100 000 visits of each function, does not decide.
lua_work='
local function fib(n) if n < 2 then return n end return fib(n - 1) + fib(n - 2) end
local n = 0
for round = 1, 8 do
  local words = {}
  for i = 1, 120000 do words[i] = string.format("%05d", (i * 7919) % 100003) end
  table.sort(words)
  local text = table.concat(words, " ")
  for word in text:gmatch("%d+") do n = n + #word:gsub("0", "zero") end
  local co = coroutine.wrap(function() for i = 1, 300000 do coroutine.yield(i) end end)
  for i = 1, 300000 do n = n + co() end
  n = n + fib(29)
end
print(n)'

# budget_cpu MODE COMMAND...: seconds of CPU time, as `stipple run` does it but for the summary.
budget_cpu() {
  local mode=$1
  shift
  rm -rf "$work/budget.stipple" && mkdir "$work/budget.stipple" || return 1
  local variables=(STIPPLE_ARCHIVE="$work/budget.stipple" STIPPLE_CLOCK=budget:5)
  [ "$mode" = budget ] || variables+=(STIPPLE_PAUSED=1)
  cpu_seconds env "${variables[@]}" LD_PRELOAD="$build/lib/stipple/libstipple.so:$build/lib/stipple/libstipple-mpi.so" "$@"
}

budget_program() { # NAME COMMAND...
  local name=$1 round paused budget
  shift
  : >"$work/budget.rounds"
  for ((round = 0; round < rounds; ++round)); do
    paused=$(budget_cpu paused "$@") && budget=$(budget_cpu budget "$@") || return 1
    echo "$paused $budget" >>"$work/budget.rounds"
  done
  awk -v name="$name" '
    function sort_of(values, n, i, j, x) {
      for (i = 2; i <= n; ++i) { x = values[i]
        for (j = i - 1; j > 0 && values[j] > x; --j) values[j + 1] = values[j]
        values[j + 1] = x } }
    function median(values, n) { sort_of(values, n); return (values[int((n + 1) / 2)] + values[int(n / 2) + 1]) / 2 }
    { paused[NR] = $1; budget[NR] = $2; ratio[NR] = $2 / $1 }
    END { printf "  %s: stopped %.3f s, budget %.3f s; ratio %.3f (%.3f to %.3f; of the least of each %.3f)\n", name,
            median(paused, NR), median(budget, NR), median(ratio, NR), ratio[1], ratio[NR], budget[1] / paused[1]
          printf "%.3f\n", median(ratio, NR) > "/dev/fd/3" }' "$work/budget.rounds" 3>"$work/budget.ratio"
  verdict "$(<"$work/budget.ratio")" 1.05 "$name, CPU time to recording stopped"
}

run_budget() {
  echo "Under --clock budget:5, against the same binary with recording stopped: visits that cost more than the budget are counted only."
  "$build/tests/bench_budget" "$work" | tee "$work/budget" || return 1
  local kernel compiler scene pixels lua=$build/../programs/lua5.4/gcc/traced/lua5.4/src/lua
  for compiler in gcc llvm; do
    verdict "$(row "$work/budget" 5 mix_$compiler)" 5 "mix, $compiler, percent of CPU time"
    for kernel in leaf fib; do
      verdict "$(row "$work/budget" 7 ${kernel}_$compiler)" 0.5 "$kernel, $compiler, ns per event beyond counting"
    done
  done
  for scene in teapot balls; do
    for pixels in 512x512 2048x2048; do
      budget_program "ray tracer, $scene, $pixels" \
        "$build/bin/raytracer" --scene $scene --resolution $pixels --output "$work/picture.png" || return 1
    done
  done
  [ ! -x "$lua" ] || budget_program lua "$lua" -e "$lua_work"
}
