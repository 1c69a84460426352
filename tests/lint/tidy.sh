#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# usage: tidy.sh BUILD_DIR SOURCE_DIR [PATTERN]
# clang-tidy finds nothing in the sources that the build compiles (those that match PATTERN). Exit 77: no clang-tidy here.
set -eu
build=$1 source=$2 pattern=${3:-.}
tidy=$(command -v clang-tidy-14 || command -v clang-tidy) || exit 77
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# Neither plugins, which must fit the compiler, nor the options and warnings that only GCC knows.
sed -E 's/ -f(pass-)?plugin[^ "]*//g; s/ -Rpass=[a-z]+//g; s/ -Wno-(maybe-uninitialized|restrict)//g' \
  "$build/compile_commands.json" >"$work/compile_commands.json"
# GCC's own headers are no clang's; the bare ray tracer is the same sources again.
sed -nE 's/^ *"file": "(.*)",?$/\1/p' "$work/compile_commands.json" | sort -u | grep "^$source/" |
  grep -vE "^$build/|^$source/plugin/gcc/|\.S$|\.f(90)?$" | grep -E "$pattern" >"$work/files"
echo "$(wc -l <"$work/files") files"
xargs -d '\n' -P "$(nproc)" -n 1 "$tidy" -p "$work" --quiet --warnings-as-errors='*' <"$work/files" 2>"$work/err" ||
  { grep -vE '^[0-9]+ warnings? (generated|treated)' "$work/err"; exit 1; }
