#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs a program whose last rank is on a machine of its own, as far as a program can tell: it sees
# another boot id, and the launcher does not say how many ranks are here. Exit 77: not allowed here.
#   other_node.sh STIPPLE PROGRAM
set -eu
if [ "${1:-}" = rank ]; then
  unset OMPI_COMM_WORLD_LOCAL_SIZE
  if [ "$OMPI_COMM_WORLD_RANK" = 2 ]; then
    exec unshare --mount sh -c 'mount --bind boot_id /proc/sys/kernel/random/boot_id && exec "$1"' sh "$2"
  fi
  exec "$2"
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
here=$(realpath "$0")
cd "$work"
echo 11111111-2222-3333-4444-555555555555 > boot_id
unshare --mount mount --bind boot_id /proc/sys/kernel/random/boot_id 2> unshare.txt || exit 77
. "$(dirname "$here")/../../mpi_environment.sh"
"$1" run -o run.stipple --clock exact -- mpirun --oversubscribe -n 3 "$here" rank "$2"
"$1" info run.stipple | tee info.txt
grep -q ' 0 unmatched' info.txt
grep -q '2 computers, synchronised to [0-9.]* [^ ]*s' info.txt
