# SPDX-License-Identifier: MIT
# For tests that start MPI programs, sourced with their own folder in $work: what Open MPI puts down is theirs alone and
# goes with it; ranks that wait let others run, on one core as on many; root may.
export TMPDIR=$work OMPI_MCA_btl_vader_backing_directory=$work OMPI_MCA_mpi_yield_when_idle=1
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
