# SPDX-License-Identifier: MIT
# A JSON library (C++ templates; wrong input is reported by exceptions, hundreds in these tests) with three of its own
# tests, each assertion one outcome. Left out: its other seventy test files, for the time they take to compile.
packages=(nlohmann-json3)

units="json_pointer allocator merge_patch"

build() {
  local unit
  cd nlohmann-json3/tests || return
  for unit in $units; do
    echo "-o test_$unit src/unit-$unit.cpp"
  done | xargs -P3 -L1 $cxx $flags -w -std=c++17 -DJSON_TEST_KEEP_MACROS -DDOCTEST_CONFIG_IMPLEMENT_WITH_MAIN \
    -DDOCTEST_CONFIG_SUPER_FAST_ASSERTS -I ../include -I thirdparty/doctest
}

suite() {
  local unit
  cd nlohmann-json3/tests || return
  for unit in $units; do
    "./test_$unit" -s --no-path-filenames=1 | grep -E '(SUCCESS|ERROR|FATAL|WARNING):|^\[doctest\] (test cases|assertions)'
    echo "$unit status ${PIPESTATUS[0]}"
  done
}
