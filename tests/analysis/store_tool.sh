#!/bin/bash
# SPDX-License-Identifier: MIT
# store_tool.sh STIPPLE BENCH_STORE: every table in every form is the same, byte for byte, without an index, when it is made, from it,
# and by several processes together.
set -u
stipple=$1 bench=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
unset OMPI_COMM_WORLD_RANK OMPI_COMM_WORLD_SIZE PMI_RANK PMI_SIZE
failures=0
fail() { echo "FAILED: $*" >&2; failures=$((failures + 1)); }

archive=$work/a.stipple
index=$archive/analysis.index
"$bench" write "$archive" 4e5 4 500 || exit 1
touch -d '1 hour ago' "$archive"/*.stream
tables=$("$stipple" stats "$archive" --table ? 2>&1 | sed 's/.*known: *//')
[ "$(wc -w <<<"$tables")" -ge 12 ] || fail "which tables are there? $tables"

# All tables in all forms, of the whole run and of a part; ARCHIVE OUTPUT [BEFORE EACH...]
all_tables() {
  local table format
  for table in $tables; do
    for format in text csv json; do
      "${@:3}"
      echo "== $table $format"
      "$stipple" stats "$1" --table "$table" --format $format 2>&1
    done
    echo "== $table of a part"
    "$stipple" stats "$1" --table "$table" --from 0.002 --to 0.005 --ranks 1-2 --format csv 2>&1
  done >"$2"
}
no_index() { rm -f "$index"; }
all_tables "$archive" "$work/anew" no_index
[ -e "$index" ] || fail "no index was made"
all_tables "$archive" "$work/again" :
cmp "$work/anew" "$work/again" || fail "tables from the index differ"
"$stipple" info "$archive" >"$work/info"
no_index
"$stipple" info "$archive" | cmp - "$work/info" || fail "info differs"

# A damaged index is as good as none.
head -c 5000 "$index" >"$work/cut" && cp "$work/cut" "$index"
"$stipple" stats "$archive" --table states --format csv >"$work/out" || fail "damaged index"
no_index
"$stipple" stats "$archive" --table states --format csv | cmp - "$work/out" || fail "damaged index: tables differ"

# Several processes, as a launcher starts them.
together() { # RANK SIZE STAMP TABLE
  env OMPI_COMM_WORLD_RANK="$1" OMPI_COMM_WORLD_SIZE="$2" PMIX_NAMESPACE="$3" \
    "$stipple" stats "$archive" --table "$4" --format csv
}
for table in $tables; do
  no_index
  echo "half a part" >"$index.0123456789abcdef.1.part"
  for rank in 1 2 3 4; do
    together $rank 5 run "$table" >"$work/other.$rank" 2>&1 &
    others[rank]=$!
  done
  together 0 5 run "$table" >"$work/together" 2>/dev/null || fail "together: $table"
  for rank in 1 2 3 4; do
    wait "${others[rank]}" || fail "process $rank failed: $table"
    [ -s "$work/other.$rank" ] && fail "process $rank printed: $table"
  done
  no_index
  "$stipple" stats "$archive" --table "$table" --format csv 2>/dev/null | cmp - "$work/together" || fail "together: $table differs"
done
rm -f "$index.0123456789abcdef.1.part"
[ "$(find "$archive" -name '*.part*' | wc -l)" = 0 ] || fail "parts were left"

# One that died is named, and what it left earlier is not believed.
no_index
together 1 2 first states >/dev/null || fail "process 1 alone"
STIPPLE_WAIT_S=1 together 0 2 second states >/dev/null 2>"$work/error"
[ $? = 2 ] || fail "a missing process is no error"
grep -q "process 1 of 2" "$work/error" || fail "which process is missing? $(<"$work/error")"
rm -f "$archive"/*.part

# Compacted, it is another archive with the same tables.
"$stipple" stats "$archive" --table states --format csv >"$work/before"
"$stipple" compact "$archive" >/dev/null || fail "compact"
"$stipple" stats "$archive" --table states --format csv | cmp - "$work/before" || fail "compacted"
sleep 0.1
"$stipple" stats "$archive" --table states --format csv | cmp - "$work/before" || fail "compacted, again"
"$stipple" check "$archive" >/dev/null || fail "check"
[ $failures = 0 ]
