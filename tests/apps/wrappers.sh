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
# The account of two files that share a header: each function once, however they are linked; never loaded.
cat >both.h <<'END_OF_SOURCE'
__attribute__((noinline)) inline int Shared(int n) { int s = 0; for (int i = 0; i < n; ++i) asm("" : "+r"(s)); return s; }
__attribute__((noinline)) inline int Tiny(int n) { asm volatile(""); return n; }
END_OF_SOURCE
printf '#include "both.h"\n__attribute__((noinline)) int First(int n) { return Shared(n) + Tiny(n); }\n' >first.cpp
printf '#include "both.h"\nint First(int n);\nint main(int c, char**) { return First(c) + Shared(c) + Tiny(c) > 0 ? 0 : 1; }\n' >second.cpp
for compiler in g++-12 clang++-14; do
  command -v $compiler >/dev/null || continue
  for flags in -O2 -O0 "-O2 -flto" "-O2 -ffunction-sections -Wl,--gc-sections -s" "-O2 -shared -fPIC" "-O2 --stipple-instrument=source -flto"; do
    STIPPLE_CXX=$compiler "$bin/stipple-c++" $flags first.cpp second.cpp -o both || fail "$compiler $flags"
    "$bin/stipple" flags --explain both >out || fail "$compiler $flags: --explain"
    case $compiler$flags in
      g++*"-O2 -flto") expected='of [34] functions are instrumented; 1 left out: 1 trivial' ;;  # which inlines First
      *) expected='^3 of 4 functions are instrumented; 1 left out: 1 trivial$' ;;
    esac
    grep -q "$expected" out || { cat out; fail "$compiler $flags: headline"; }
    grep -qE '^  trivial  Tiny\(int\)  (\./)?both.h:2$' out || { cat out; fail "$compiler $flags: row of Tiny"; }
    readelf -SW both | grep 'stipple_left_out' | grep -q ' 0000000000000000 .* MS ' || fail "$compiler $flags: it is loaded"
  done
done
"$bin/stipple" flags --explain /bin/sh 2>errors && fail "a program without account is explained"
grep -q 'does not say what was instrumented' errors || { cat errors; fail "no clear message"; }
echo "stipple flags --explain knows what was left out"

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
