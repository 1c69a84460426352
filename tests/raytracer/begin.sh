# SPDX-License-Identifier: MIT
# What the ray tracer's scripts, called with RAYTRACER MPIEXEC, begin with: sets $raytracer and $mpiexec and goes to an empty
# folder, which is removed at the end.
set -eu
raytracer=$1
mpiexec=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
. "$(dirname "$(realpath "$0")")/../mpi_environment.sh"
cd "$work"
