#!/bin/bash
# SPDX-License-Identifier: MIT
# What the plugins promise, one check a name:
#   check_plugin.sh CHECK gcc|llvm|llvm16|llvm19 PLUGIN RECORDER APPS_FOLDER WORK_FOLDER
set -u
check=$1 compiler=$2 plugin=$3 recorder=$4 apps=$5 work=$6
rm -rf "$work"
mkdir -p "$work"
cd "$work" || exit 2

major=${compiler#llvm}
major=${major:-14}
[[ $compiler == gcc ]] || command -v "clang++-$major" >/dev/null || exit 77

fail() { echo "FAILED: $*" >&2; exit 1; }

compile() { # SOURCE OUTPUT [OPTION=VALUE...]
  local source=$1 output=$2 flags=() gcc=gcc-12 clang=clang-$major
  shift 2
  [[ $source != *.cpp ]] || gcc=g++-12 clang=clang++-$major
  if [[ $compiler == gcc ]]; then
    flags=(-fplugin="$plugin")
    for option; do flags+=("-fplugin-arg-stipple-$option"); done
    $gcc -O2 ${more-} "${flags[@]}" "$source" -o "$output"
  else
    flags=(-fplugin="$plugin" -fpass-plugin="$plugin" -Wno-unused-command-line-argument)
    for option; do flags+=(-mllvm "-stipple-$option"); done
    $clang -O2 ${more-} "${flags[@]}" "$source" -o "$output"
  fi
}

record() { # MODE COMMAND...: how often each event happened, to file `counts`
  rm -f events
  STIPPLE_RECORDER_FILE=$PWD/events STIPPLE_RECORDER_MODE=$1 LD_PRELOAD=$recorder "${@:2}" ||
    fail "does not run"
  cut -d' ' -f3- events | sort | uniq -c | awk '{ print $2, $3, $1 }' >counts
}

expect() { grep -qxF -e "$1" "$2" || { cat "$2" >&2; fail "no line '$1'"; }; }

# Enter and leave in pairs, innermost first.
balanced() {
  awk '$3 == "enter" { open[++depth] = $4 }
       $3 == "leave" && open[depth--] != $4 { bad = 1 }
       END { exit bad || depth != 0 }' events || fail "unbalanced"
}

case $check in
  counts) # the number of visits is that of the formula, on the fast and on the slow path
    compile "$apps/recursion.c" app instruction-threshold=1
    for mode in "" direct sparse no-clock; do
      record "$mode" ./app 20
      expect "enter Fib 21891" counts
      expect "leave Fib 21891" counts
      balanced
    done
    ;;
  count-only) # the visits are counted, and no event is left over
    compile "$apps/recursion.c" app instruction-threshold=1
    record count ./app 20
    expect "count 21891 Fib" events
    expect "asked 2190 Fib" events
    grep -q enter events && fail "events in spite of STIPPLE_COUNT_ONLY"
    ;;
  toggle) # ids that come and go at any moment leave no enter or leave alone
    compile "$apps/recursion.c" app instruction-threshold=1
    record toggle ./app 27
    balanced
    ;;
  no-call) # an instrumented leaf calls nothing, its slow path included
    compile "$apps/recursion.c" app instruction-threshold=1
    objdump -d --no-show-raw-insn --disassemble=Sink app >leaf
    grep -q rdtsc leaf || fail "Sink has no event"
    grep -qE '\bcall' leaf && fail "Sink calls"
    grep -qE '\bpush|%rsp' leaf && fail "Sink uses the stack"
    ;;
  unwind) # from within the slow path the stack is that of the open visits, with and without frame pointers
    for option in -fomit-frame-pointer -fno-omit-frame-pointer; do
      more="-rdynamic $option" compile "$apps/recursion.c" app instruction-threshold=1
      LD_PRELOAD=${recorder%/*}/libstipple_unwinder.so ./app 10 >output || fail "does not run"
      grep -qE '^chains [1-9][0-9]+ wrong 0$' output || { cat output >&2; fail "wrong stacks"; }
    done
    ;;
  defaults) # short functions without loop and call are left out, listed ones come in or go
    compile "$apps/recursion.c" app
    record "" ./app 20
    expect "enter Fib 21891" counts
    grep -q Sink counts && fail "Sink is instrumented"
    compile "$apps/recursion.c" app include-function-list=Sink exclude-function-list=Fib,other
    record "" ./app 20
    expect "enter Sink 10945" counts
    grep -q Fib counts && fail "Fib is instrumented"
    compile "$apps/recursion.c" app exclude-file-list=recursion
    [[ $(readelf -S app) != *stipple_desc* ]] || fail "the file is instrumented"
    ;;
  attributes) # what the source says of a function; with -fpass-plugin alone clang passes on only what annotate() says
    never='no_instrument_function' always='xray_always_instrument'
    if [[ $compiler == llvm && ! -e ${plugin%/*}/stipple_attributes.so ]]; then
      never="annotate(\"$never\")" always="annotate(\"$always\")"
    fi
    sed "s/^__attribute__((noinline)) void Sink/__attribute__((noinline, $always)) void Sink/
         s/^__attribute__((noinline)) int Fib/__attribute__((noinline, $never)) int Fib/" \
      "$apps/recursion.c" >attributes.c
    more=-Werror=attributes compile attributes.c app || fail "attributes are not known"
    record "" ./app 20
    expect "enter Sink 10945" counts
    grep -q Fib counts && fail "Fib is instrumented"
    for position in after-inlining source; do
      more="-std=c++20 -DNEVER=__attribute__(($never))" \
        compile "$apps/attributes.cpp" app instruction-threshold=1 instrument=$position
      record "" ./app
      expect "enter _Z6Tracedi 1" counts
      grep -E 'Never|main.*EUl' counts && fail "instrumented in spite of the attribute"
    done
    ;;
  tail-calls) # any number in the space of one, as without the plugin, in C++ and among coroutines
    with_stack_arguments=3000000 sums="4500000 9000000 1500008"
    [[ $compiler == gcc ]] || with_stack_arguments=3 sums="4500000 9000000 9"  # clang makes no jump of these
    for way in "-O2 after-inlining" "-O3 after-inlining" "-O2 source"; do
      more="-std=c++20 ${way% *}"
      compile "$apps/tailcalls.cpp" app instruction-threshold=1 instrument="${way#* }"
      [[ $(ulimit -s 8192; ./app 3000000 $with_stack_arguments | head -3 | xargs) == "$sums" ]] ||
        fail "tail calls take stack ($way)"
      compile "$apps/symmetric.cpp" app instruction-threshold=1 instrument="${way#* }"
      [[ $(ulimit -s 8192; ./app 1000000) == "left -1" ]] ||
        fail "symmetric transfer takes stack ($way)"
    done
    ;;
  static) # the runtime is not pulled in by its weak name; -u does it
    more="-static -g" compile "$apps/recursion.c" app instruction-threshold=1
    [[ $(./app 20) == 6765 ]] || fail "static program does not run"
    more="-static-pie -fPIE" compile "$apps/recursion.c" app instruction-threshold=1
    [[ $(./app 20) == 6765 ]] || fail "static-pie program does not run"
    ;;
  unknown-option)
    compile "$apps/nested.c" app threshold=1 2>message && fail "an unknown option is accepted"
    grep -q "stipple: unknown option 'threshold'; known are exclude-function-list, " message ||
      { cat message >&2; fail "no clear message"; }
    ;;
  bad-value)
    compile "$apps/nested.c" app instrument=before 2>message && fail "a bad value is accepted"
    grep -q "stipple: option instrument cannot be 'before'; it takes after-inlining or source" \
      message || { cat message >&2; fail "no clear message"; }
    ;;
  filter) # the last rule that matches decides, and a rule that names a function brings in a trivial one
    printf '%s\n' SCOREP_REGION_NAMES_BEGIN 'EXCLUDE *' 'INCLUDE S?nk # a leaf' SCOREP_REGION_NAMES_END >app.filter
    compile "$apps/recursion.c" app filter-file=app.filter
    record "" ./app 20
    expect "enter Sink 10945" counts
    grep -qE 'Fib|main' counts && fail "functions are instrumented that the filter excludes"
    printf '%s\n' SCOREP_FILE_NAMES_BEGIN 'EXCLUDE */recursion.c' SCOREP_FILE_NAMES_END >file.filter
    compile "$apps/recursion.c" app filter-file=file.filter
    [[ $(readelf -S app) != *stipple_desc* ]] || fail "the file is instrumented"
    ;;
  broken-filter) # one line with the place, no crash, no object
    printf '%s\n' SCOREP_REGION_NAMES_BEGIN '  EXCLUED f' SCOREP_REGION_NAMES_END >app.filter
    compile "$apps/nested.c" app filter-file=app.filter 2>message && fail "a broken filter is accepted"
    [[ $(grep -c "app.filter:2: 'EXCLUED' stands before any INCLUDE or EXCLUDE of its block" message) == 1 ]] ||
      { cat message >&2; fail "no clear message, once"; }
    compile "$apps/nested.c" app filter-file=none.filter 2>message && fail "a missing filter is accepted"
    [[ $(grep -c "stipple: filter-file none.filter: No such file or directory" message) == 1 ]] ||
      { cat message >&2; fail "no clear message, once"; }
    ;;
  note) # said once if nothing of all that was asked for is there; not a warning
    more="-Wall -Werror" compile "$apps/nested.c" app exclude-function-list=none 2>message || fail "the note is an error"
    [[ $(<message) == "stipple: note: nothing in this file matches none" ]] || { cat message >&2; fail "no note"; }
    compile "$apps/recursion.c" app exclude-function-list=none,Sink 2>message
    [[ ! -s message ]] || { cat message >&2; fail "a note though Sink is there"; }
    ;;
  exceptions) # exceptions=off: an exception takes a function away without a leave
    cat >throwing.cpp <<'END'
extern "C" __attribute__((noinline)) void Throw(int x) { if (x > 0) throw x; }
extern "C" __attribute__((noinline)) void Pass(int x) { Throw(x); Throw(x); }
int main() {
  for (int i = 1; i <= 10; ++i) try { Pass(i); } catch (int) {}
  Pass(0);
}
END
    for position in after-inlining source; do
      more="-Wl,--no-as-needed -lstdc++" compile throwing.cpp app instrument=$position instruction-threshold=1
      record "" ./app
      expect "leave Pass 11" counts
      more="-Wl,--no-as-needed -lstdc++" compile throwing.cpp app instrument=$position instruction-threshold=1 exceptions=off
      record "" ./app
      expect "enter Pass 11" counts
      expect "leave Pass 1" counts
    done
    ;;
  wrong-version) # a plugin whose own number says GCC 99; of LLVM's, that of any other version here
    if [[ $compiler == gcc ]]; then
      sed 's/stipple plugin for GCC [0-9]*/stipple plugin for GCC 99/' "$plugin" >stipple.so
      plugin=$PWD/stipple.so
      right="GCC 99[0-9.]*, the compiler is $(gcc-12 -dumpfullversion); use the one in gcc-12/"
    else
      for plugin in "${plugin%/llvm-*}"/llvm-1[!4]/stipple.so; do :; done
      [[ -e $plugin ]] || exit 77
      right="LLVM 1[0-9], the compiler is LLVM 14; use the one in llvm-14/"
    fi
    compile "$apps/nested.c" app 2>message && fail "a plugin for another compiler is accepted"
    [[ $(wc -l <message) == 1 ]] || { cat message >&2; fail "more than one line"; }
    grep -qxE "stipple: this plugin is for $right" message ||
      { cat message >&2; fail "no clear message"; }
    ;;
  *) fail "unknown check $check" ;;
esac
exit 0
