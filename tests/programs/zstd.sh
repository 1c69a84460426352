# SPDX-License-Identifier: MIT
# A compressor (C, threads, assembly). Its unit tests (fuzzer) and streaming tests (zstreamtest) with a fixed seed, each
# numbered test one outcome, then the tests of its thread pool, and files of several levels there and back.
packages=(libzstd)

build() {
  make -j2 -C libzstd/tests fuzzer zstreamtest poolTests datagen CC="$cc" CFLAGS="$flags -w" DEBUGLEVEL=0
  make -j2 -C libzstd/programs zstd CC="$cc" CFLAGS="$flags -w" HAVE_ZLIB=0 HAVE_LZMA=0 HAVE_LZ4=0
}

suite() {
  local level
  cd libzstd/tests || return
  numbered ./fuzzer -v -s5 -i20
  numbered ./zstreamtest -v -s5 -i20
  ./poolTests 2>&1 | grep -E PASS\|FAIL
  echo "poolTests status ${PIPESTATUS[0]}"
  for level in -5 1 3 7 12; do
    ./datagen -g2MB -P60 >data
    ../programs/zstd -q -f -T2 "$([ $level -lt 0 ] && echo --fast=5 || echo -$level)" data -o data.zst
    echo "level $level status $?, $(../programs/zstd -q -dc data.zst | cmp - data && cksum <data.zst)"
  done
}

numbered() { # PROGRAM ARGUMENT...
  "$@" 2>&1 | tr '\r' '\n' | grep -E '^test' | sed "s/^/${1#./} /"
  echo "${1#./} status ${PIPESTATUS[0]}"
}
