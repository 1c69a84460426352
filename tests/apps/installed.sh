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
for file in bin/stipple bin/raytracer include/stipple/abi.h include/stipple/format.h include/stipple/user.h \
  lib/stipple/libstipple.so lib/stipple/libstipple.a lib/stipple/libstipple-mpi.so lib/stipple/libstipple-views.so \
  lib/cmake/stipple/stippleConfig.cmake share/doc/stipple/stipple-run.md; do
  [ -f "$prefix/$file" ] || fail "$file is not installed"
done
for file in "$prefix"/bin/* "$prefix"/lib/stipple/*.so "$prefix"/lib/stipple/*/*.so; do
  ! readelf -dW "$file" | grep -E 'R(UN)?PATH' | grep -vF '[$ORIGIN]' || fail "$file looks for libraries elsewhere"
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

mkdir project
cat >project/CMakeLists.txt <<'END'
cmake_minimum_required(VERSION 3.25)
project(user LANGUAGES C)
find_package(stipple REQUIRED)
add_executable(user ../app.c)
stipple_instrument(user)
END
CC=$(command -v "${kept%% *}") "$cmake" -S project -B project/build -DCMAKE_PREFIX_PATH="$prefix" >"$work/log" 2>&1 &&
  "$cmake" --build project/build >>"$work/log" 2>&1 || { cat "$work/log"; fail "find_package(stipple)"; }
"$stipple" run -o user.stipple -- project/build/user 2>err || { cat err; fail "run user"; }
"$stipple" print --canonical user.stipple | grep -qx 'enter main' || fail "stipple_instrument() recorded nothing"
echo "find_package(stipple) instruments"
