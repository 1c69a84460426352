#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# usage: wrappers.sh BIN
# stipple-cc and its sisters: whatever a build asks of a compiler, they answer as the compiler does, and what they compile
# is instrumented.
set -u
bin=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 2
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
unset STIPPLE_CC STIPPLE_CXX STIPPLE_FC STIPPLE_MPICC STIPPLE_MPICXX
fail() { echo "FAILED: $*" >&2; exit 1; }
instrumented() { readelf -SW "$1" | grep -q stipple_desc || fail "$1 is not instrumented"; }

cat >app.c <<'END_OF_SOURCE'
#include <stdio.h>
int Twice(int x);
int main(int argc, char** argv) { puts(argv[argc - 1]); return Twice(argc) == 4 ? 0 : 3; }
END_OF_SOURCE
cat >twice.S <<'END_OF_SOURCE'
#define RESULT %eax
	.globl	Twice
Twice:
	leal	(%rdi,%rdi), RESULT
	ret
	.section .note.GNU-stack,"",@progbits
END_OF_SOURCE
echo 'int main() { try { throw 1; } catch (int) { return 0; } }' >app.cpp

for compiler in gcc-12 clang-14; do
  command -v $compiler >/dev/null || continue
  export STIPPLE_CC=$compiler
  "$bin/stipple-cc" -O2 -c app.c -o app.o || fail "$compiler -c"
  instrumented app.o
  "$bin/stipple-cc" -c twice.S -o twice.o || fail "$compiler -c twice.S"
  "$bin/stipple-cc" app.o twice.o -o app || fail "$compiler: linking"
  [ "$(./app 'two  words')" = "two  words" ] || fail "$compiler: the program's output"
  "$bin/stipple-cc" -O2 '-DTEXT="a b"' app.c twice.S -o both || fail "$compiler: compiling and linking at once"
  instrumented both
  "$bin/stipple-cc" -E app.c >preprocessed.c && grep -q 'int main' preprocessed.c || fail "$compiler -E"
  "$bin/stipple-cc" -S -O2 app.c -o app.s && grep -q stipple_desc app.s || fail "$compiler -S"
  "$bin/stipple-cc" -O2 --stipple-exclude-function-list=main,none -c app.c -o without.o || fail "$compiler: an option"
  "$bin/stipple" flags --explain without.o >out || fail "$compiler: --explain"
  grep -qx '0 of 1 functions are instrumented; 1 left out: 1 named by exclude-function-list' out || { cat out; fail "headline"; }
  grep -qx '  named by exclude-function-list  main  app.c:3' out || { cat out; fail "$compiler: row of main"; }
  grep -qx '  exclude-function-list  none' out || { cat out; fail "$compiler: rule without effect"; }
  "$bin/stipple-cc" -O2 -static app.c twice.S -o static || fail "$compiler -static"
  nm static | grep -q ' T stipple_register' || fail "$compiler: no runtime in a static program"
  for question in --version -v "" -dumpversion; do
    $compiler $question >expected 2>expected_errors; status=$?
    "$bin/stipple-cc" $question >out 2>errors
    [ $? = $status ] || fail "$compiler $question: exit status"
    cmp -s expected out || fail "$compiler $question: output"
  done
  "$bin/stipple-cc" -c none.c 2>errors && fail "$compiler: an error is lost"
  echo "stipple-cc stands for $compiler"
done
STIPPLE_CC="$bin/stipple-cc" "$bin/stipple-cc" -c app.c 2>errors && fail "a wrapper calls itself"
grep -q 'would call itself' errors || { cat errors; fail "no clear message"; }
STIPPLE_CC=no-such-compiler "$bin/stipple-cc" -c app.c 2>errors && fail "a compiler that is none is used"
grep -q "'no-such-compiler --version' cannot be run: no compiler?" errors || { cat errors; fail "no clear message"; }

STIPPLE_CXX=g++-12 "$bin/stipple-c++" -O2 -flto app.cpp -o lto || fail "-flto"
instrumented lto
if command -v gfortran-12 >/dev/null; then
  printf 'program main\n  print *, "x"\nend program\n' >app.f90
  STIPPLE_FC=gfortran-12 "$bin/stipple-fc" app.f90 -o fortran || fail "Fortran"
  instrumented fortran
fi
printf '#include <mpi.h>\nint main(int c, char** v) { MPI_Init(&c, &v); return MPI_Finalize(); }\n' >mpi.c
"$bin/stipple-mpicc" mpi.c -o mpi || fail "mpicc"
instrumented mpi
if command -v clang-14 >/dev/null && mpicc --version >/dev/null && OMPI_CC=clang-14 mpicc --version | grep -q clang; then
  OMPI_CC=clang-14 "$bin/stipple-mpicc" mpi.c -o mpi_clang || fail "mpicc with clang"
  instrumented mpi_clang
fi
cp mpi.c mpi.cpp
"$bin/stipple-mpicxx" mpi.cpp -o mpixx || fail "mpicxx"
instrumented mpixx
echo "stipple-c++, stipple-fc, stipple-mpicc and stipple-mpicxx instrument"
