#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The MPI layer may need libc and the core, and nothing of MPI or of C++; a program without MPI runs
# with it as without.
#   footprint.sh LIB_DIR
set -eu
library=$1/libstipple-mpi.so
needed=$(readelf -d "$library" | sed -nE 's/.*NEEDED.*\[(.*)\]/\1/p' | sort | tr '\n' ' ')
case $needed in
  "libc.so.6 libstipple.so " | "ld-linux-x86-64.so.2 libc.so.6 libstipple.so ") ;;
  *) echo "needs $needed"; exit 1 ;;
esac
foreign=$(nm -D --undefined-only "$library" | grep -E ' (_Z|ompi_|P?MPI_|malloc|free|calloc|__cxa_[^f])' || true)
[ "$foreign" = "" ] || { echo "imports $foreign"; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
STIPPLE_ARCHIVE=$work LD_PRELOAD=$1/libstipple.so:$library /bin/echo inert > "$work.out"
[ "$(cat "$work.out"; rm "$work.out")" = inert ]
[ "$(ls "$work")" = "" ] || { echo "a program without MPI was recorded"; exit 1; }
