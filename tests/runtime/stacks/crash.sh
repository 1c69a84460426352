#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# usage: crash.sh STIPPLE WORK CRASH HOW STATUS [TEXT...]
# CRASH HOW ends with STATUS alone, recorded and sampled; the archive is sound, and what `stipple info` says of it holds
# each TEXT, in this order.
set -u
stipple=$1 work=$2 crash=$3 how=$4 status=$5
shift 5
ulimit -c 0
fail() { echo "FAIL: $how: $*"; exit 1; }
mkdir -p "$work" && cd "$work" || exit 1

"$crash" "$how" >plain 2>/dev/null
[ $? = "$status" ] || fail "not status $status without stipple"

# With few samples, so that the crash is the first event of a program that is not instrumented.
for options in "" "--sample 1"; do
  # shellcheck disable=SC2086
  "$stipple" run --clock exact $options --overwrite -o "$how.stipple" -- "$crash" "$how" >traced 2>said
  got=$?
  [ $got = "$status" ] || fail "status $got with '$options', not $status"
  cmp -s plain traced || fail "another output with '$options'"
  if [ ! -d "$how.stipple" ]; then
    if [ -z "$options" ] && ! readelf -SW "$crash" | grep -q stipple_desc; then continue; fi
    [ $# = 0 ] && continue
    fail "no archive with '$options'"
  fi
  "$stipple" check "$how.stipple" >check || [ $# = 0 ] || fail "not sound: $(cat check)"
  "$stipple" info "$how.stipple" >info 2>&1
  "$stipple" stats "$how.stipple" --table callpaths >/dev/null 2>&1 || fail "no call paths"
  line=0
  for text in "$@"; do
    found=$(tail -n +$((line + 1)) info | grep -nF -m 1 -e "$text" | cut -d: -f1)
    [ -n "$found" ] || fail "with '$options' no '$text' behind line $line of: $(cat info)"
    line=$((line + found))
  done
done
echo "$how: status $status, told"
