#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# usage: installed.sh CMAKE BUILD_DIR
# What `./run install` puts down works by itself: nothing in it points back, and a program is compiled, recorded and
# reported with it alone.
set -eu
cmake=$1 build=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
prefix=$work/prefix
fail() { echo "FAILED: $*" >&2; exit 1; }

"$cmake" --install "$build" --prefix "$prefix" >"$work/log" || { cat "$work/log"; fail "install"; }
for file in bin/stipple bin/raytracer include/stipple/abi.h include/stipple/format.h include/stipple/user.h include/stipple/stipple.f90 \
  lib/stipple/libstipple.so lib/stipple/libstipple.a lib/stipple/libstipple-mpi.so lib/stipple/libstipple-system.so lib/stipple/libstipple-views.so \
  lib/cmake/stipple/stippleConfig.cmake lib/pkgconfig/stipple.pc bin/stipple-cc bin/stipple-c++ bin/stipple-fc \
  bin/stipple-mpicc bin/stipple-mpicxx share/doc/stipple/plugin-options.md share/doc/stipple/stipple-run.md; do
  [ -f "$prefix/$file" ] || fail "$file is not installed"
done
for file in "$prefix"/bin/* "$prefix"/lib/stipple/*.so "$prefix"/lib/stipple/*/*.so; do
  ! readelf -dW "$file" 2>/dev/null | grep -E 'R(UN)?PATH' | grep -vF '[$ORIGIN]' || fail "$file looks for libraries elsewhere"
done

cd "$work"
stipple=$prefix/bin/stipple
cat >app.c <<'END'
#include <stipple/user.h>
static struct stipple_name half = {"half way", "", 0};
__attribute__((noinline)) static int Square(int x) { __asm__(""); return x * x; }
int main(void) {
  int sum = 0;
  for (int i = 0; i < 10; ++i) sum += Square(i);
  stipple_mark(&half);
  return sum == 285 ? 0 : 1;
}
END
make_and_run() { # NAME COMPILER FLAGS...
  local name=$1 compiler=$2 flags
  shift 2
  flags=$("$stipple" flags "$compiler")
  case $flags in *"$build"*) fail "flags name the build tree: $flags" ;; esac
  "$compiler" -O2 -I "$prefix/include" $flags app.c "$@" -o "$name"
  "$stipple" run -o "$name.stipple" -- "./$name" 2>err || { cat err; fail "run $name"; }
  "$stipple" check "$name.stipple" >out || { cat out; fail "check $name"; }
  "$stipple" stats "$name.stipple" --table profile --format csv >out
  grep -q '^Square,.*app.c,3,10,' out || { cat out; fail "profile of $name"; }
  "$stipple" print --canonical "$name.stipple" | grep -qx 'mark half way' || fail "no mark in $name"
  echo "$name is recorded by the installed stipple"
}
# Square is small: without the list it would be inlined, or too trivial to record.
tried=0
for plugin in "$prefix"/lib/stipple/*/stipple.so; do
  folder=$(basename "$(dirname "$plugin")")
  case $folder in
    gcc-*) compiler=gcc-${folder#gcc-} always=-fplugin-arg-stipple-instruction-threshold=1 ;;
    llvm-*) compiler=clang-${folder#llvm-} always="-mllvm -stipple-instruction-threshold=1" ;;
  esac
  command -v "$compiler" >/dev/null || continue
  make_and_run "app-$folder" "$compiler" $always
  tried=$((tried + 1))
  [ -n "${kept:-}" ] || kept="$compiler $always"
done
[ $tried -gt 0 ] || fail "no compiler for any plugin"
make_and_run app-static $kept -static $("$stipple" flags --link --static ${kept%% *})
"$stipple" report app-static.stipple -o static.html >out || fail "report"
grep -q '<svg' static.html || fail "the report has no picture"

# As find_package() and pkg-config give it: one project of C, C++ and, with GCC, Fortran.
mkdir project
cat >project/CMakeLists.txt <<'END'
cmake_minimum_required(VERSION 3.25)
project(user LANGUAGES C CXX)
if(FORTRAN)
  enable_language(Fortran)
endif()
find_package(stipple 0.1 REQUIRED)
add_executable(user ../app.c other.cpp)
target_link_libraries(user PRIVATE stipple::instrument)
add_executable(by_function ../app.c other.cpp)
stipple_instrument(by_function)
add_executable(static ../app.c other.cpp)
target_link_libraries(static PRIVATE stipple::instrument stipple::static_runtime)
target_link_options(static PRIVATE -static)
add_executable(lto ../app.c other.cpp)
target_link_libraries(lto PRIVATE stipple::instrument)
set_target_properties(lto PROPERTIES INTERPROCEDURAL_OPTIMIZATION ${LTO})
if(FORTRAN)
  add_executable(fortran main.f90)
  target_link_libraries(fortran PRIVATE stipple::instrument stipple::fortran)
endif()
END
echo 'extern "C" int Other(int x) { return x > 0 ? Other(x - 1) + 1 : 0; }' >project/other.cpp
cat >project/main.f90 <<'END'
program main
  use stipple
  type(stipple_name), save :: half = stipple_name('half way')
  call stipple_mark(half)
  print *, "x"
end program
END
configure() { # C_COMPILER CXX_COMPILER ARGUMENTS...
  local c=$1 cxx=$2
  shift 2
  rm -rf project/build
  CC=$c CXX=$cxx "$cmake" -S project -B project/build -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_BUILD_TYPE=Release "$@"
}
build_project() { # NAME C_COMPILER CXX_COMPILER ARGUMENTS...
  local name=$1 program
  shift
  configure "$@" >"$work/log" 2>&1 && "$cmake" --build project/build >>"$work/log" 2>&1 || { cat "$work/log"; fail "$name"; }
  for program in user by_function static lto; do
    "$stipple" run --overwrite -o user.stipple -- project/build/$program 2>err || { cat err; fail "$name: $program"; }
    "$stipple" print --canonical user.stipple | grep -qx 'enter main' || fail "$name: $program recorded nothing"
  done
  echo "find_package(stipple) instruments with $name"
}
tested=
for plugin in "$prefix"/lib/stipple/*/stipple.so; do
  folder=$(basename "$(dirname "$plugin")")
  case $folder in
    gcc-*) c=gcc-${folder#gcc-} cxx=g++-${folder#gcc-} lto=ON ;;
    llvm-*) c=clang-${folder#llvm-} cxx=clang++-${folder#llvm-} lto=OFF ;;
  esac
  command -v "$c" >/dev/null && command -v "$cxx" >/dev/null || continue
  case " $tested " in *" ${folder%-*} "*) continue ;; esac  # one of each kind: the others differ by their number
  tested="$tested ${folder%-*}"
  if [ "${folder%-*}" = gcc ] && command -v "gfortran-${folder#gcc-}" >/dev/null; then
    FC=gfortran-${folder#gcc-} build_project $folder $c $cxx -DLTO=ON -DFORTRAN=ON
    readelf -SW project/build/fortran | grep -q stipple_desc || fail "Fortran is not instrumented"
    "$stipple" run --overwrite -o user.stipple -- project/build/fortran >out 2>err || { cat err; fail "Fortran"; }
    "$stipple" print --canonical user.stipple | grep -qx 'mark half way' || fail "no mark in Fortran"
    STIPPLE_FC=gfortran-${folder#gcc-} "$prefix/bin/stipple-fc" project/main.f90 -o by_wrapper || fail "stipple-fc"
    "$stipple" run --overwrite -o user.stipple -- ./by_wrapper >out 2>err || { cat err; fail "by stipple-fc"; }
    "$stipple" print --canonical user.stipple | grep -qx 'mark half way' || fail "no mark by stipple-fc"
  else
    build_project $folder $c $cxx -DLTO=$lto
  fi
  mv "$prefix/lib/stipple/$folder" "$work/away"
  configure $c $cxx -DLTO=OFF >"$work/log" 2>&1 && fail "$folder: a compiler without plugin is accepted"
  grep -q "stipple has no plugin for the C compiler" "$work/log" || { cat "$work/log"; fail "no clear message"; }
  mv "$work/away" "$prefix/lib/stipple/$folder"
done

# A wrapper as the project's compiler.
cat >project/CMakeLists.txt <<'END'
cmake_minimum_required(VERSION 3.25)
project(user LANGUAGES C)
add_executable(user ../plain.c)
END
sed '/stipple/d' app.c >plain.c
STIPPLE_CC=${kept%% *} configure "$prefix/bin/stipple-cc" none >"$work/log" 2>&1 &&
  STIPPLE_CC=${kept%% *} "$cmake" --build project/build >>"$work/log" 2>&1 || { cat "$work/log"; fail "CC=stipple-cc cmake"; }
readelf -SW project/build/user | grep -q stipple_desc || fail "CC=stipple-cc instruments nothing"
echo "CC=stipple-cc cmake instruments"

if command -v pkg-config >/dev/null; then
  export PKG_CONFIG_PATH=$prefix/lib/pkgconfig
  folder=$(pkg-config --variable=compilers stipple | cut -d' ' -f1)
  flags=$(pkg-config --variable="${folder/-/_}_flags" stipple)
  plugin=$(sed 's/ .*//; s/-fplugin=//' <<<"$flags")
  [ -f "$plugin" ] || fail "pkg-config names $plugin"
  [ -f "$(pkg-config --variable=fortran_module stipple)" ] || fail "pkg-config --variable=fortran_module"
  [ -f "$(pkg-config --cflags stipple | sed 's/-I//; s/ *$//')/stipple/user.h" ] || fail "pkg-config --cflags"
  pkg-config --static --libs stipple | grep -q -- '-lstipple' || fail "pkg-config --static --libs"
  echo "pkg-config knows $folder"
fi
