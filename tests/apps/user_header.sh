#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# usage: user_header.sh INCLUDE
# user.h compiles without a warning by old standards and new ones, needs nothing at link, costs a load and a test where no
# runtime is, and does not keep a library from being unloaded.
set -eu
include=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
fail() { echo "FAILED: $*" >&2; exit 1; }
strict="-Wall -Wextra -Wpedantic -pedantic-errors -Wshadow -Wconversion -Wundef -Werror -I$include"

cat >all.c <<'END'
#include <stipple/user.h>
STIPPLE_REGION(region, "region");
static struct stipple_name name = {"name", "unit", 0};
static struct stipple_channel channel = {"channel", 0};
int All(void);
int All(void) {
  struct stipple_region made_region = stipple_make_region("made", "", 0);
  struct stipple_name made_name = stipple_make_name("made", "");
  struct stipple_channel made_channel = stipple_make_channel("made");
  stipple_region_begin(&region);
  stipple_region_begin(&made_region);
  stipple_mark(&made_name);
  stipple_counter(&name, 1);
  stipple_send(&channel, 1, 2);
  stipple_receive(&made_channel, 1, 2, stipple_time());
  stipple_host();
  stipple_stop_regions("*");
  stipple_start_regions("*");
  stipple_stop();
  stipple_start();
  stipple_region_end(&made_region);
  stipple_region_end(&region);
  return (int)(region.id + name.id + channel.id);
}
void One(void);
void One(void) { stipple_mark(&name); }
void Region(void);
void Region(void) { stipple_region_end(&region); }
int main(void) { return All(); }
END
{
  cat all.c
  cat <<'END'
#if __cplusplus >= 201103L
template <class T> inline T Scoped(T x) { STIPPLE_SCOPE("template"); return x; }
inline int Scoped2() {
  STIPPLE_SCOPE("inline");
  STIPPLE_SCOPE("twice in a block");
  stipple::Scope scope(region);
  stipple::Scope moved(static_cast<stipple::Scope&&>(scope));
  moved.End();
  return 1;
}
int Use();
int Use() { return Scoped(1) + Scoped2(); }
#endif
END
} >all.cpp

# steps FUNCTION OBJECT: instructions of the function when the runtime's address is null.
steps() {
  objdump -d --no-show-raw-insn "$2" | awk -v name="<$1>:" '
    $2 == name { inside = 1; next }
    /^$/ { inside = 0 }
    inside { sub(/^ */, ""); address[++n] = substr($1, 1, length($1) - 1); place[address[n]] = n
             code[n] = $2; target[n] = $3 }
    END { for (i = 1; i <= n && steps < 100; ++i) {
            if (code[i] ~ /^(endbr64|nop|xchg|cs|data16)/) continue
            ++steps
            if (code[i] ~ /^ret/) break
            if (code[i] ~ /^call/) steps = 100
            if (code[i] == "je" || code[i] == "jmp") i = place[target[i]] - 1
          }
          print steps }'
}

tried=0
for compiler in gcc-12 clang-14 clang-19; do
  command -v $compiler >/dev/null || continue
  cxx=${compiler/gcc/g++}; cxx=${cxx/clang/clang++}
  for standard in c89 c99 gnu17; do
    $compiler -std=$standard $strict -fsyntax-only all.c || fail "$compiler -std=$standard"
  done
  $compiler $strict -U__ELF__ -fsyntax-only all.c || fail "$compiler: a machine without ELF"
  $compiler $strict -O2 -c all.c -o all.o || fail "$compiler -O2"
  nm -u all.o | grep -v ' w stipple_' | grep -v _GLOBAL_OFFSET_TABLE_ && fail "$compiler: something must be linked"
  $compiler all.o -o all && ./all || fail "$compiler: without a runtime it does something"
  for function in One Region; do  # load, test, jump, return
    [ "$(steps $function all.o)" -le 4 ] || { objdump -d all.o; fail "$compiler: $function costs more than a load and a test"; }
  done
  tried=$((tried + 1))
  command -v $cxx >/dev/null || continue
  for standard in c++98 c++11 c++20; do
    $cxx -std=$standard $strict -fno-exceptions -fno-rtti -fsyntax-only all.cpp || fail "$cxx -std=$standard"
  done
  $cxx -std=c++11 $strict -O0 -fPIC -shared all.cpp -o all.so || fail "$cxx -O0"
  readelf -sW all.so | grep UNIQUE && fail "$cxx: a library with scopes cannot be unloaded"
done
[ $tried -gt 0 ] || fail "no compiler"
echo "user.h serves $tried compilers"
