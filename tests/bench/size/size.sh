# SPDX-License-Identifier: MIT
# Part of tests/bench/run: what the plugin adds to a C++ file of many templates, in bytes and in time of the compiler,
# and whether what it leaves out matters.

# The command of one compiler; nlohmann-json and fmt stand in a folder of the program's own, so that nothing of them is
# left out as a system header.
size_command() { # gcc|llvm plain|default|all
  local plugin
  if [ "$1" = gcc ]; then
    plugin=$build/lib/stipple/gcc-12/stipple.so
    command=(g++-12)
    [ "$2" = plain ] || command+=(-fplugin="$plugin")
    [ "$2" != all ] || command+=(-fplugin-arg-stipple-instruction-threshold=1)
  else
    plugin=$build/lib/stipple/llvm-14/stipple.so
    command=(clang++-14)
    [ "$2" = plain ] || command+=(-fplugin="$plugin" -fpass-plugin="$plugin")
    [ "$2" != all ] || command+=(-mllvm -stipple-instruction-threshold=1)
  fi
  command+=(-std=c++20 -O2 -I"$work/headers")
}

# Bytes of .text and of all that `size` calls text, of what the plugin brings besides, of a program.
size_line() {
  size -A "$1" | awk -v label="$2" '
    $1 ~ /^\.text/ { code += $2 }
    $1 == "stipple_desc" { descriptors += $2 }
    $1 ~ /^\.(eh_frame|gcc_except_table)/ { tables += $2 }
    END { printf "  %-14s code %d, exception tables %d, descriptors %d", label, code, tables, descriptors }'
  size "$1" | awk 'NR == 2 { printf ", text %d\n", $1 }'
}

text_of() { size "$1" | awk 'NR == 2 { print $1 }'; }

# Exclusive seconds and region names of a program run under the runtime, a line each.
size_profile() { # PROGRAM LINES
  rm -rf "$work/size.stipple" && mkdir "$work/size.stipple" || return 1
  STIPPLE_ARCHIVE="$work/size.stipple" STIPPLE_CLOCK=exact LD_PRELOAD="$build/lib/stipple/libstipple.so" "$1" 300 >"$work/out" || return 1
  "$build/bin/stipple" stats "$work/size.stipple" --table profile --format json | sed 's/},{/}\n{/g' |
    sed -nE 's/.*"region":"(.*)","file":"(.*)","line":([0-9]+),.*"exclusive_s":([-0-9.e]+).*/\4 \1 \3/p' >"$2"
  [ -s "$2" ]
}

# Ratios of alternating compilations, in user seconds.
size_compile_time() { # COMPILER ROUNDS
  local round kind TIMEFORMAT=%U
  : >"$work/compile.$1"
  for ((round = 0; round < $2; ++round)); do
    for kind in plain default; do
      size_command "$1" $kind
      { time "${command[@]}" -c "$source" -o "$work/size.o" 2>"$work/errors"; } 2>>"$work/compile.$1" || return 1
    done
  done
  paste - - <"$work/compile.$1" | awk '{ print $2 / $1, $1, $2 }' | sort -g |
    awk '{ ratio[NR] = $1; plain += $2; traced += $3 }
      END { printf "%.3f %.3f %.3f %.2f %.2f\n", (ratio[int((NR + 1) / 2)] + ratio[int(NR / 2) + 1]) / 2, ratio[1], ratio[NR], plain / NR, traced / NR }'
}

run_size() {
  local source compiler kind time covered text_ratio
  source=${BASH_SOURCE[0]%/*}/orders.cpp
  for compiler in g++-12 clang++-14; do
    command -v $compiler >/dev/null || { echo "size: no $compiler" >&2; return 1; }
  done
  mkdir -p "$work/headers" && cp -r /usr/include/nlohmann /usr/include/fmt "$work/headers" || return 1
  echo "orders.cpp (nlohmann-json and fmt as its own headers), -O2, default position and options; bytes of the linked program."
  for compiler in gcc llvm; do
    for kind in plain default all; do
      size_command $compiler $kind
      "${command[@]}" "$source" -lfmt -o "$work/$compiler.$kind" || return 1
      size_line "$work/$compiler.$kind" "$compiler $kind"
    done
    text_ratio=$(awk -v a="$(text_of "$work/$compiler.default")" -v b="$(text_of "$work/$compiler.plain")" 'BEGIN { printf "%.3f", a / b }')
    verdict "$text_ratio" 1.5 "text, $compiler, to plain"
    size_profile "$work/$compiler.all" "$work/all.profile" && size_profile "$work/$compiler.default" "$work/default.profile" || return 1
    covered=$(awk '{ seconds = $1; sub(/^[^ ]+ /, "") } NR == FNR { kept[$0]; next } { sum += seconds } $0 in kept { inside += seconds }
      END { printf "%.2f", 100 * inside / sum }' "$work/default.profile" "$work/all.profile")
    verdict "$covered" 95 "exclusive time of a threshold-1 run in regions kept by default, %, $compiler" at-least
  done
  for compiler in gcc llvm; do
    time=$(size_compile_time $compiler "${BENCH_COMPILATIONS:-7}") || { cat "$work/errors" >&2; return 1; }
    set -- $time
    echo "  compile time, $compiler: user $4 s plain, $5 s with the plugin (means); ratio round by round $1 ($2 to $3)"
    verdict "$1" 1.05 "compile time, $compiler, to plain"
  done
}
