#!/bin/bash
# SPDX-License-Identifier: MIT
# Builds one app with and without the plugin and holds it to three promises:
#   1. without a runtime the instrumented program prints and returns what the plain one does;
#   2. so it does while it is recorded, and every leave is that of the innermost open enter of its context;
#   3. the events of the functions named in the golden text are that text. Other functions are free.
#
#   run_app.sh [--update] [--status N] [--stipple TOOL | --recorder LIBRARY] --work FOLDER
#              --golden FILE [--library SOURCE]... [--once NAME]... COMPILER FLAGS... SOURCE
#              --plugin PLUGIN_FLAGS... [-- ARGUMENTS...]
# `--update` (or UPDATE_GOLDEN=1) rewrites the golden text; a new one needs its `enter NAME` lines.
# `--library` builds one more source as a shared object; their names are the app's first arguments.
# `--once`: the archive defines the function of this linkage name once, however many objects have it.
set -u

update=${UPDATE_GOLDEN:-} status=0 stipple= recorder= work= golden= libraries=() once=()
while [[ ${1-} == --* ]]; do
  case $1 in
    --update) update=1; shift; continue ;;
    --library) libraries+=("$2") ;;
    --once) once+=("$2") ;;
    --status | --stipple | --recorder | --work | --golden) printf -v "${1#--}" %s "$2" ;;
    *) echo "run_app.sh: unknown option $1" >&2; exit 2 ;;
  esac
  shift 2
done
compile=() plugin=() arguments=()
while (($#)) && [[ $1 != --plugin ]]; do compile+=("$1"); shift; done
shift
while (($#)) && [[ $1 != -- ]]; do plugin+=("$1"); shift; done
(($#)) && shift
arguments=("$@")

fail() { echo "FAILED: $*" >&2; exit 1; }

build() { # FOLDER FLAGS...
  local folder=$1 i
  shift
  mkdir -p "$folder"
  [[ ${compile[0]} == *fortran* ]] && set -- "$@" -J "$folder"  # module files
  "${compile[@]}" "$@" -o "$folder/app" || fail "does not compile"
  for i in "${!libraries[@]}"; do
    "${compile[@]:0:${#compile[@]}-1}" "${libraries[i]}" -shared -fPIC "$@" -o "$folder/library$i.so" ||
      fail "${libraries[i]} does not compile"
  done
}

run() { # FOLDER PREFIX...: stdout to FOLDER/out, exit status checked
  local folder=$1 i
  shift
  local command=("$folder/app")
  for i in "${!libraries[@]}"; do command+=("$folder/library$i.so"); done
  "$@" "${command[@]}" "${arguments[@]}" >"$folder/out" 2>"$folder/err"
  local is=$?
  [[ $is == "$status" ]] || { cat "$folder/err" >&2; fail "exit status $is, not $status ($folder $*)"; }
}

# The recorder's lines, as `stipple print --canonical` would show them.
canonical_of_recorder() {
  c++filt | sed -E 's/__([a-z0-9_]+)_MOD_/\1::/' | awk '{ key = $1 " " $2; sub(/^[0-9]+ [0-9]+ /, "")
                   if (!(key in text)) order[++n] = key
                   text[key] = text[key] $0 "\n" }
                 END { for (i = 1; i <= n; ++i) printf "location 0 %s\n%s", order[i], text[order[i]] }'
}

rm -rf "$work"
build "$work/plain"
build "$work/traced" "${plugin[@]}"
run "$work/plain"
run "$work/traced"
cmp "$work/plain/out" "$work/traced/out" || fail "output differs without a runtime"

if [[ -n $stipple ]]; then
  run "$work/traced" "$stipple" run --clock exact -o "$work/app.stipple" --
  "$stipple" print --canonical "$work/app.stipple" >"$work/events" || fail "stipple print"
  for name in "${once[@]}"; do
    [[ $(cat "$work"/app.stipple/* | grep -aoF "$name" | wc -l) == 1 ]] || fail "$name is not defined once"
  done
else
  run "$work/traced" env STIPPLE_RECORDER_FILE="$work/recorded" \
    STIPPLE_RECORDER_MODE="${STIPPLE_RECORDER_MODE-direct}" LD_PRELOAD="$recorder"
  canonical_of_recorder <"$work/recorded" >"$work/events"
fi
cmp "$work/plain/out" "$work/traced/out" || fail "output differs while recorded"

awk 'NR == FNR { if ($1 == "unclosed") expected[substr($0, 10)] = 1; next }
     /^location/ { delete depth; context = 0 }
     /^context/ { context = $2 }
     /^enter/ { open[context, ++depth[context]] = substr($0, 7) }
     /^unclosed/ && !(substr($0, 10) in expected) { print; bad = 1 }
     /^(leave|unwound|unclosed)/ {
       name = $0
       sub(/^[a-z]* /, "", name)
       if (depth[context] == 0 || open[context, depth[context]] != name) { print "unmatched: " $0; bad = 1 }
       else --depth[context] }
     END { exit bad }' "$golden" "$work/events" || fail "a leave without its enter"

awk 'NR == FNR { if ($1 == "enter") compared[substr($0, 7)] = 1; next }
     /^location/ { heading = $0; next }
     /^thread end/ { next }  # the last word of a detached thread may come too late
     /^(enter|leave|unwound|unclosed) / { name = $0; sub(/^[a-z]* /, "", name); if (!(name in compared)) next }
     { if (heading != "") print heading; heading = ""; print }' "$golden" "$work/events" \
  >"$work/compared"
if [[ -n $update ]]; then
  cp "$work/compared" "$golden"
  exit 0
fi
diff -u "$golden" "$work/compared" || fail "events differ from $golden"
