#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# usage: libraries.sh LIB_DIR BIN_DIR
# What the built files may need: the core only libc, nothing in the runtime instrumented, VTK and MPI not in `stipple`.
set -u
lib=$1 bin=$2 bad=0
fail() { echo "FAIL: $*"; bad=1; }
needed() { readelf -dW "$1" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p'; }

for file in "$lib/libstipple.so" "$lib/libstipple-mpi.so" "$lib/libstipple-system.so" "$lib/libstipple-unwind.so" "$bin/stipple" "$bin/raytracer"; do
  [ -f "$file" ] || fail "$file is missing"
done
for library in $(needed "$lib/libstipple.so"); do
  case $library in libc.so.6 | ld-linux-x86-64.so.2) ;; *) fail "libstipple.so needs $library" ;; esac
done
for layer in mpi system; do
  for library in $(needed "$lib/libstipple-$layer.so"); do
    case $library in libstipple.so | libc.so.6 | ld-linux-x86-64.so.2) ;; *) fail "libstipple-$layer.so needs $library" ;; esac
  done
done
for library in $(needed "$lib/libstipple-unwind.so"); do
  case $library in libunwind.so.8 | libc.so.6 | ld-linux-x86-64.so.2) ;; *) fail "libstipple-unwind.so needs $library" ;; esac
done
for file in "$lib/libstipple.so" "$lib/libstipple-mpi.so" "$lib/libstipple-system.so" "$lib/libstipple-unwind.so"; do
  symbols=$(nm -D --undefined-only "$file" | grep -E ' (_Z|__cxa_(throw|begin|end|alloc|guard)|__gxx)' || true)
  [ -z "$symbols" ] || fail "$file uses the C++ runtime: $symbols"
  ! readelf -SW "$file" | grep -q stipple_desc || fail "$file is instrumented"
done
for library in $(needed "$bin/stipple"); do
  case $library in libvtk* | libmpi*) fail "stipple needs $library" ;; esac
done
if [ -f "$lib/libstipple-views.so" ]; then
  for library in $(needed "$lib/libstipple-views.so"); do
    case $library in *OpenGL* | libGL* | libX11* | libvtkRenderingUI*) fail "libstipple-views.so needs $library" ;; esac
  done
fi
readelf -SW "$bin/raytracer" | grep -q stipple_desc || fail "raytracer is not instrumented"
[ $bad = 0 ] && echo "libraries need what they may"
exit $bad
