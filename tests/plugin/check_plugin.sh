#!/bin/bash
# SPDX-License-Identifier: MIT
# What the plugins promise, one check a name:
#   check_plugin.sh CHECK gcc|llvm PLUGIN RECORDER APPS_FOLDER WORK_FOLDER
set -u
check=$1 compiler=$2 plugin=$3 recorder=$4 apps=$5 work=$6
rm -rf "$work"
mkdir -p "$work"
cd "$work" || exit 2

fail() { echo "FAILED: $*" >&2; exit 1; }

compile() { # SOURCE OUTPUT [OPTION=VALUE...]
  local source=$1 output=$2 flags=()
  shift 2
  if [[ $compiler == gcc ]]; then
    flags=(-fplugin="$plugin")
    for option; do flags+=("-fplugin-arg-stipple-$option"); done
    gcc-12 -O2 ${more-} "${flags[@]}" "$source" -o "$output"
  else
    flags=(-fplugin="$plugin" -fpass-plugin="$plugin" -Wno-unused-command-line-argument)
    for option; do flags+=(-mllvm "-stipple-$option"); done
    clang-14 -O2 ${more-} "${flags[@]}" "$source" -o "$output"
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
