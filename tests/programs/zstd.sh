# SPDX-License-Identifier: MIT
# A compressor (C, threads, assembly) with parts of its tests, each one outcome: the fuzzers of blocks and of streams with
# fixed seeds, the tests of its thread pool, and those of the command line. Left out: the numbered unit tests with which the
# fuzzers start and the slow tests of the command line, which compress hundreds of megabytes. Two tests of the command line
# fail: they want zlib, which this build leaves out.
packages=(libzstd)

build() {
  make -j2 -C libzstd/tests fuzzer zstreamtest poolTests datagen CC="$cc" CFLAGS="$flags -w" DEBUGLEVEL=0
  make -j2 -C libzstd/programs zstd CC="$cc" CFLAGS="$flags -w" HAVE_ZLIB=0 HAVE_LZMA=0 HAVE_LZ4=0
}

# Tests of the command line that take less than half a second each, and threads.
command_lines="basic/help basic/version basic/output_dir cltools/zstdgrep cltools/zstdless compression/basic
  compression/compress-literals compression/format compression/golden compression/gzip-compat
  compression/long-distance-matcher compression/multi-threaded compression/multiple-files compression/row-match-finder
  compression/stream-size decompression/golden dict-builder/no-inputs file-stat/compress-file-to-file
  file-stat/compress-stdin-to-stdout file-stat/decompress-file-to-file zstd-symlinks/zstdcat"

suite() {
  local seed
  cd libzstd/tests || return
  for seed in 1 2 3 4 5; do
    fuzzed ./fuzzer -t1 -i10 -s$seed
    fuzzed ./zstreamtest -t1 -i3 -s$seed
    fuzzed ./zstreamtest --newapi -t1 -i3 -s$seed
  done
  ./poolTests 2>&1 | grep -E 'PASS|FAIL|SUCCESS'
  echo "poolTests status ${PIPESTATUS[0]}"
  cd cli-tests || return
  # shellcheck disable=SC2046  # one word for each test
  python3 run.py --zstd ../../programs/zstd --datagen ../datagen --zstdgrep ../../programs/zstdgrep \
    --zstdless ../../programs/zstdless $(printf '%s.sh ' $command_lines) | grep -E '^(PASS|FAIL)'
}

fuzzed() { # PROGRAM ARGUMENT...
  "$@" 2>&1 | tr '\r' '\n' | grep -E 'completed|rror'
  echo "${*:1} status ${PIPESTATUS[0]}"
}
