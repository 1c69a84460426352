#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs an MPI program under the MPI layer and compares what was recorded with a golden text.
#   transcript.sh LIB_DIR TRANSCRIPT RANKS GOLDEN PROGRAM [ARGUMENT...]
# GOLDEN ending in .messages.txt: messages and collectives only; in none.txt: matching only. In the
# environment: DIES=1, the program does not end in order; CLOCK=1, clock readings are checked too;
# UPDATE=1 rewrites GOLDEN.
set -eu
lib_dir=$1 transcript=$2 ranks=$3 golden=$4
shift 4
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/run.stipple"
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
cd "$work"
status=0
mpirun --oversubscribe -n "$ranks" -x STIPPLE_ARCHIVE="$work/run.stipple" -x STIPPLE_CLOCK=exact \
  -x LD_PRELOAD="$lib_dir/libstipple.so:$lib_dir/libstipple-mpi.so" "$@" || status=$?
if [ "${DIES:-0}" = 1 ]; then
  [ "$status" != 0 ]
else
  [ "$status" = 0 ]
  "$transcript" --match run.stipple
fi
if [ "${CLOCK:-0}" = 1 ]; then "$transcript" --clock run.stipple; fi
case $golden in */none.txt) exit 0 ;; esac
option=
case $golden in *.messages.txt) option=--messages ;; esac
"$transcript" $option run.stipple > recorded.txt
if [ "${UPDATE:-0}" = 1 ]; then cp recorded.txt "$golden"; fi
diff -u "$golden" recorded.txt
