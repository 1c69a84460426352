#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# usage: docs.sh STIPPLE RAYTRACER DOCS
# Every option that --help prints stands in the docs, and no other does.
set -u
stipple=$1 raytracer=$2 docs=$3 bad=0
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
fail() { echo "FAIL: $*"; bad=1; }

# options_of TEXT: the names at the beginning of its option lines, -h and --help aside.
options_of() {
  sed -nE 's/^ +((-[a-zA-Z]|--[a-z-]+)([, ]+--[a-z-]+)*).*/\1/p' <<<"$1" | tr -s ', ' '\n' | grep -vxE -e '-h|--help' | sort -u
}

# compare NAME HELP DOC: both ways; of the docs only words in backticks or in indented lines count, and only of this
# program: `launcher's own` options are written with their program.
compare() {
  local name=$1 help=$2 doc=$3 options written option
  [ -f "$doc" ] || { fail "$name has no $(basename "$doc")"; return; }
  options=$(options_of "$help")
  for option in $options; do
    grep -qE -e "(^|[\`[ |(])$option([]\` =|)]|$)" "$doc" || fail "$name $option is not in $(basename "$doc")"
  done
  written=$(grep -oE -e '(^    .*|`-[^`]*`)' "$doc" | grep -oE -e '(^|[`[ |])--[a-z][a-z-]*' | tr -d '`[| ' | sort -u)
  for option in $written; do
    grep -qxF -e "$option" <<<"$options" || [ "$option" = --help ] || fail "$name does not know $option of $(basename "$doc")"
  done
}

commands=$("$stipple" --help | sed -n '/^Commands/,$s/^  \([a-z]*\) .*/\1/p')
[ "$(wc -w <<<"$commands")" -ge 5 ] || fail "stipple --help names only: $commands"
for command in $commands; do
  compare "stipple $command" "$("$stipple" "$command" --help)" "$docs/stipple-$command.md"
done
for page in "$docs"/stipple-*.md; do
  command=$(basename "$page" .md)
  grep -qxF "${command#stipple-}" <<<"$commands" || fail "$(basename "$page") is of no command"
done
compare raytracer "$("$raytracer" --help)" "$docs/raytracer.md"
[ $bad = 0 ] && echo "docs name the options that there are"
exit $bad
