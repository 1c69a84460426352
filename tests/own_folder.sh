# SPDX-License-Identifier: MIT
# What a test that starts MPI programs begins with, sourced with this file's folder in $tests: goes to an empty folder, $work,
# which is removed at the end.
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
. "$tests/mpi_environment.sh"
cd "$work"
