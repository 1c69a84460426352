# SPDX-License-Identifier: MIT
# An interpreter (C; errors and coroutines by longjmp). Debian's sources have no test suite of Lua itself, so it runs what
# its authors wrote for it: the tests of LPeg (a C library loaded by dlopen), each assertion one outcome, and the test
# programs of Lua 5.1, some of which stop with an error under 5.4: that has to stay as it is, too.
packages=(lua5.4 lua-lpeg lua5.1)

build() {
  make -j2 -C lua5.4/src linux CC="$cc $flags" MYLIBS=
  make -j2 -C lua-lpeg linux CC="$cc $flags" COPT="-O2 -DNDEBUG" LUADIR="$PWD/lua5.4/src"
}

# Each assertion of LPeg's tests: its line and whether it holds, in the order in which they are made.
lpeg_assertions='
local real, write = assert, io.stderr
function assert(ok, ...)
  io.stderr:write("lpeg ", debug.getinfo(2, "l").currentline, ok and " holds\n" or " fails\n")
  return real(ok, ...)
end'

# LPeg's tests. The quick ones leave out a pattern of 65 535 captures: most of the events.
lpeg_tests() {
  [ "$size" = full ] || local large='/large dynamic Cc/,/^end/{/^end/!s/.*//}'
  sed "${large:-}" test.lua
}

suite() {
  local lua=$PWD/lua5.4/src/lua program output status
  (cd lua-lpeg && lpeg_tests | LUA_CPATH='./?.so' LUA_PATH='./?.lua' "$lua" -e "$lpeg_assertions" - 2>&1)
  echo "lpeg status $?"
  for program in lua5.1/test/*.lua; do
    [ "$program" != lua5.1/test/life.lua ] || continue  # 35 million events of the same few functions
    output=$(cd lua5.1/test && "$lua" "${program##*/}" </dev/null 2>&1)
    status=$?
    # These print times or addresses.
    case $program in */fib.lua | */printf.lua | */trace-*) output= ;; esac
    echo "${program##*/} status $status, output $(cksum <<<"$output")"
  done
}
