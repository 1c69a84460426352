# SPDX-License-Identifier: MIT
# What the ray tracer's scripts, called with RAYTRACER MPIEXEC, begin with: sets $raytracer and $mpiexec and goes to an empty
# folder, which is removed at the end.
raytracer=$1
mpiexec=$2
tests=$(dirname "$(realpath "$0")")/..
. "$tests/own_folder.sh"
