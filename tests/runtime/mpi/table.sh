#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Compares calls.def with mpi.h and with the MPI library: a row for every function, no other rows.
#   table.sh CALLS_DEF LIBRARY COMPILER [FLAG...]
set -eu
calls=$(grep -v '^//' "$1" | tr '\n' ' ') library=$2
shift 2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

rows() {  # names in rows of the macros given
  grep -oE "STIPPLE_($1)\((\w+, *)?\w+ *[,)]" <<< "$calls" |
    sed -E 's/.*[(, ](\w+) *[,)]$/\1/' | sort
}
# CALL, COLLECTIVE and ICOLLECTIVE name a shape or rule first, then the function.
rows 'CALL|COLLECTIVE|ICOLLECTIVE|BY_HAND|SILENT' > declared_rows
rows 'CALL|COLLECTIVE|ICOLLECTIVE|BY_HAND|SILENT|REMOVED' > all_rows
grep -oE 'STIPPLE_REMOVED\(\w+' <<< "$calls" | sed 's/.*(//' >> all_rows
sort -u all_rows -o all_rows

echo '#include <mpi.h>' | "$@" -E -P -x c - | tr '\n' ' ' | grep -oE '\bPMPI_\w+ *\(' |
  sed -E 's/PMPI_(\w+) *\(/\1/' | sort -u > header
nm -D --defined-only "$library" | sed -nE 's/.* [TW] MPI_([A-Z][a-z_]\w*|T_\w+)$/\1/p' | sort -u > exported

echo "mpi.h: $(wc -l < header) functions, calls.def: $(wc -l < declared_rows) rows for them"
[ "$(uniq -d declared_rows)" = "" ] || { echo "rows twice: $(uniq -d declared_rows)"; exit 1; }
diff header declared_rows || { echo "< only in mpi.h, > only in calls.def"; exit 1; }
missing=$(comm -23 exported all_rows)
[ "$missing" = "" ] || { echo "exported by MPI, no row: $missing"; exit 1; }
