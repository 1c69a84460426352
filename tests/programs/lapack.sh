# SPDX-License-Identifier: MIT
# The reference BLAS of LAPACK (Fortran) and its C interface, with the tests of both: every routine on many shapes, and
# wrong arguments. With clang the C half is clang's, the Fortran half gfortran's: both plugins in one program.
# Left out: LAPACK itself and its tests (more than an hour of compiling).
packages=(lapack)

build() {
  cat >lapack/make.inc <<EOF
SHELL = /bin/sh
CC = $cc
CFLAGS = $flags -w
FC = $fc
FFLAGS = $fflags -frecursive -w
FFLAGS_NOOPT = -O0 -frecursive -w
AR = ar
ARFLAGS = cr
RANLIB = ranlib
BLASLIB = \$(TOPSRCDIR)/librefblas.a
CBLASLIB = \$(TOPSRCDIR)/libcblas.a
EOF
  make -j2 -C lapack/BLAS/SRC
  make -j2 -C lapack/BLAS/TESTING
  make -j2 -C lapack/CBLAS/src
  make -j2 -C lapack/CBLAS/testing
}

# One line per routine and what the tests say of it; their reports go to standard output or to a file.
suite() {
  local precision level
  for precision in s d c z; do
    for level in 1 2 3; do
      (cd lapack/BLAS/TESTING && rm -f ./*.out ./*.SUM && run_blas "$precision" $level ./xblat$level$precision \
        "${precision}blat$level.in" blas)
      (cd lapack/CBLAS/testing && run_blas "$precision" $level "./x${precision}cblat$level" "${precision}in$level" cblas)
    done
  done
}

run_blas() { # PRECISION LEVEL PROGRAM INPUT LABEL
  [ -f "$4" ] || set -- "${@:1:3}" /dev/null "$5"
  "$3" <"$4" >report.out
  echo "$5 ${3#./} status $?"
  cat report.out ./*.SUM 2>/dev/null | grep -E 'PASS|FAIL|TESTS OF|Test of' | sed "s/^ */$5 $1$2 /"
}
