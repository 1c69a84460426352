#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Records an MPI program, proves the archive sound and compares it with a golden text.
#   record.sh STIPPLE CONSISTENCY RANKS GOLDEN PROGRAM [ARGUMENT...]
# GOLDEN ending in .messages.txt: messages and collectives only; in none.txt: no text. In the
# environment: DIES=1, the program does not end in order; CLOCK=1, clock readings are checked too;
# UPDATE=1 rewrites GOLDEN.
set -eu
stipple=$1 consistency=$2 ranks=$3 golden=$4
shift 4
tests=$(dirname "$(realpath "$0")")/../..
. "$tests/own_folder.sh"
status=0
# As `stipple run` does it, but the archive stays as it is written: CONSISTENCY reads it without our reader.
mkdir run.stipple
libraries=$(dirname "$(dirname "$stipple")")/lib/stipple
STIPPLE_ARCHIVE=$work/run.stipple STIPPLE_CLOCK=exact ASAN_OPTIONS=verify_asan_link_order=0:${ASAN_OPTIONS:-} \
  LD_PRELOAD=$libraries/libstipple.so:$libraries/libstipple-mpi.so${LD_PRELOAD:+:$LD_PRELOAD} \
  mpirun --oversubscribe -n "$ranks" "$@" || status=$?
if [ "${DIES:-0}" = 1 ]; then
  [ "$status" != 0 ]
else
  [ "$status" = 0 ]
  "$stipple" check run.stipple
  "$consistency" run.stipple
fi
if [ "${CLOCK:-0}" = 1 ]; then "$consistency" --clock run.stipple; fi
case $golden in */none.txt) exit 0 ;; esac
"$stipple" compact run.stipple || [ "${DIES:-0}" = 1 ]
"$stipple" print --canonical run.stipple > recorded.txt
case $golden in *.messages.txt) sed -i -E '/^(enter|leave) /d' recorded.txt ;; esac
if [ "${UPDATE:-0}" = 1 ]; then cp recorded.txt "$golden"; fi
diff -u "$golden" recorded.txt
