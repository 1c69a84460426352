# SPDX-License-Identifier: MIT
# Part of tests/bench/run: the same program traced by stipple and by others, one after the other in each round. Each is
# set up for the least time: as many bytes of buffer as take all events, no system or library calls besides.

readonly peer_kinds=(plain-gcc plain-llvm stipple-gcc stipple-llvm sparse-gcc sparse-llvm uftrace xray lttng)  # sparse: stipple, --clock sparse:8

peer_build() { # KIND KERNEL
  local dir=${BASH_SOURCE[0]%/*} source compiler flags=()
  case $2 in leaf) source=$dir/../events/leaf.c ;; mix) source=$dir/../events/mix.cpp ;; esac
  compiler=gcc-12
  case $1 in
    plain-gcc) ;;
    plain-llvm) compiler=clang-14 ;;
    stipple-gcc | sparse-gcc) flags=(-fplugin="$build/lib/stipple/gcc-12/stipple.so" -fplugin-arg-stipple-instruction-threshold=1) ;;
    stipple-llvm | sparse-llvm)
      compiler=clang-14
      flags=(-fplugin="$build/lib/stipple/llvm-14/stipple.so" -fpass-plugin="$build/lib/stipple/llvm-14/stipple.so"
        -mllvm -stipple-instruction-threshold=1)
      ;;
    uftrace) flags=(-pg) ;;
    xray) compiler=clang-14 flags=(-fxray-instrument -fxray-instruction-threshold=1) ;;
    lttng) compiler=clang-14 flags=(-finstrument-functions-after-inlining) ;;
  esac
  if [ "$2" = mix ]; then
    compiler=${compiler/gcc/g++}
    compiler=${compiler/clang/clang++}
  fi
  $compiler -O2 -falign-functions=64 -Wno-unused-command-line-argument "${flags[@]}" -c "$source" -o "$work/peer.o" || return 1
  local link=(-no-pie)
  [ "$1" != xray ] || link=(-fxray-instrument)
  $compiler -O2 "${link[@]}" "$work/peer.o" "$work/peer-main.o" -o "$work/$2.$1" 2>"$work/out" || { cat "$work/out" >&2; return 1; }
}

# What is missing for a kind, or nothing.
peer_missing() {
  case $1 in
    uftrace) command -v uftrace >/dev/null || echo "apt-get install uftrace" ;;
    lttng) { command -v lttng && /sbin/ldconfig -p | grep liblttng-ust-cyg-profile-fast; } >/dev/null || echo "apt-get install lttng-tools liblttng-ust-dev" ;;
    xray) peer_build xray leaf 2>/dev/null || echo "apt-get install libclang-rt-14-dev" ;;
  esac
}

# Bytes of a channel of lttng-ust take all events of a run: 8 sub-buffers of 16 MiB.
lttng_session() { # start|stop
  if [ "$1" = start ]; then
    { lttng create stipple-bench --output="$work/lttng" && lttng enable-channel --userspace --subbuf-size=16M --num-subbuf=8 fast &&
      lttng enable-event --userspace --channel=fast 'lttng_ust_cyg_profile_fast:*' && lttng start; } >"$work/lttng.log" 2>&1
  else
    { lttng stop && lttng list stipple-bench && lttng destroy stipple-bench; } >"$work/lttng.log" 2>&1
  fi || { cat "$work/lttng.log" >&2; return 1; }
}

# Runs a kernel under its tracer; prints ns per call and, of the events that it made, how many are not in the trace.
peer_run() { # KIND KERNEL CALLS
  local program=$work/$2.$1 recorded=$((2 * $3)) clock
  rm -rf "$work/peer.trace" "$work/lttng"
  case $1 in
    plain-*) "$program" "$3" 2>"$work/peer.ns" ;;
    stipple-* | sparse-*)
      [ "${1%-*}" = stipple ] && clock=exact || clock=sparse:8
      mkdir "$work/peer.trace" && STIPPLE_ARCHIVE="$work/peer.trace" STIPPLE_CLOCK=$clock \
        LD_PRELOAD="$build/lib/stipple/libstipple.so" "$program" "$3" 2>"$work/peer.ns" || return 1
      recorded=$(events_of "$work/peer.trace")
      ;;
    uftrace) # 16 bytes an event
      uftrace record --no-pager --no-libcall --no-event -b 64M -d "$work/peer.trace" "$program" "$3" 2>"$work/peer.ns" || return 1
      recorded=$(($(cat "$work"/peer.trace/*.dat | wc -c) / 16))
      ;;
    xray) # 8 bytes an event, and some for the log
      mkdir "$work/peer.trace" && (cd "$work/peer.trace" &&
        XRAY_OPTIONS="patch_premain=true xray_mode=xray-fdr verbosity=0 xray_logfile_base=log." \
          XRAY_FDR_OPTIONS="func_duration_threshold_us=0 buffer_size=1048576 buffer_max=256" "$program" "$3" 2>"$work/peer.ns") || return 1
      recorded=$(($(cat "$work"/peer.trace/log.* | wc -c) / 8))
      ;;
    lttng) # 8 bytes an event and more; a program that does not wait for the daemon is not traced
      lttng_session start && LTTNG_UST_REGISTER_TIMEOUT=20000 LD_PRELOAD=liblttng-ust-cyg-profile-fast.so \
        "$program" "$3" 2>"$work/peer.ns" && lttng_session stop || return 1
      recorded=$(find "$work/lttng" -name 'fast_*' -type f -exec cat {} + | wc -c)
      recorded=$((recorded / 8 < 2 * $3 ? recorded / 8 : 2 * $3))
      recorded=$((recorded - $(sed -nE 's/.*Discarded events: ([0-9]+).*/\1/p' "$work/lttng.log" | head -1)))
      ;;
  esac || return 1
  awk -v events=$((2 * $3)) -v recorded=$recorded '/^ns per call/ { ns = $4 } END {
    if (ns == "") exit 1
    print ns, recorded < events ? events - recorded : 0 }' "$work/peer.ns" || { cat "$work/peer.ns" >&2; return 1; }
}

# Medians of what each adds to the plain program of its compiler, round by round; the lines of the table.
peer_table() { # KERNEL FILE
  awk -v kernel="$1" '
    function median(values, n, i, j, x) {
      for (i = 2; i <= n; ++i) { x = values[i]
        for (j = i - 1; j > 0 && values[j] > x; --j) values[j + 1] = values[j]
        values[j + 1] = x }
      return (values[int((n + 1) / 2)] + values[int(n / 2) + 1]) / 2 }
    { if (!($2 in seen)) { seen[$2]; order[++kinds] = $2 }
      ns[$2, $1] = $3; lost[$2] += $4; rounds = $1 }
    END {
      for (k = 1; k <= kinds; ++k) {
        kind = order[k]
        plain = kind ~ /(gcc|uftrace)$/ ? "plain-gcc" : "plain-llvm"
        for (r = 1; r <= rounds; ++r) { all[r] = ns[kind, r]; added[r] = (ns[kind, r] - ns[plain, r]) / 2 }
        call = median(all, rounds); more = median(added, rounds)
        printf "  %-5s %-13s %9.2f %9.2f  %8.2f..%-8.2f %9d\n", kernel, kind, call, more, added[1], added[rounds], lost[kind] } }' "$2"
}

run_peers() {
  local kinds=() kind kernel round calls=${BENCH_CALLS:-1200000} times=${BENCH_PEER_ROUNDS:-7} missing line best ours
  gcc-12 -O2 -c "${BASH_SOURCE[0]%/*}/main.c" -o "$work/peer-main.o" || return 1
  for kind in "${peer_kinds[@]}"; do
    missing=$(peer_missing $kind)
    if [ -n "$missing" ]; then echo "  $kind: not here; as root: $missing"; else kinds+=($kind); fi
  done
  if [[ " ${kinds[*]} " == *" lttng "* ]]; then
    export LTTNG_HOME=$work/lttng-home
    mkdir -p "$LTTNG_HOME"
    lttng-sessiond --no-kernel >"$work/sessiond.log" 2>&1 &
    sessiond=$!
    for ((round = 0; round < 100; ++round)); do lttng list >/dev/null 2>&1 && break; sleep 0.1; done
  fi
  echo "The same program under each tracer, $calls calls a run and 2 events a call, $times rounds in turn; CPU time of its thread."
  printf '  %-5s %-13s %9s %9s  %18s %9s\n' '' '' 'ns a call' 'per event' 'least..most' 'lost'
  for kernel in leaf mix; do
    : >"$work/peers"
    for kind in "${kinds[@]}"; do peer_build $kind $kernel || return 1; done
    for ((round = 1; round <= times; ++round)); do
      for kind in "${kinds[@]}"; do
        line=$(peer_run $kind $kernel "$calls") || { echo "peers: $kind does not run" >&2; return 1; }
        echo "$round $kind $line" >>"$work/peers"
      done
    done
    peer_table $kernel "$work/peers" | tee "$work/peers.$kernel"
  done
  [ -z "${sessiond-}" ] || { kill "$sessiond"; wait "$sessiond" 2>/dev/null; sessiond=; }
  for kernel in leaf mix; do
    best=$(awk '$2 ~ /^(uftrace|xray|lttng)$/ && (best == "" || $4 < best) { best = $4 } END { print best }' "$work/peers.$kernel")
    [ -n "$best" ] || { echo "  no other tracer is here to compare with"; return 0; }
    for kind in stipple-gcc stipple-llvm; do
      ours=$(awk -v kind=$kind '$2 == kind { print $4 }' "$work/peers.$kernel")
      verdict "$(awk -v a="$best" -v b="$ours" 'BEGIN { printf "%.2f", a / b }')" "$([ $kernel = leaf ] && echo 2.5 || echo 1.5)" \
        "$kernel, added per event, best of the others to $kind" at-least
    done
    best=$(awk '$2 == "uftrace" { print $4 }' "$work/peers.$kernel")
    for kind in sparse-gcc sparse-llvm; do
      ours=$(awk -v kind=$kind '$2 == kind { print $4 }' "$work/peers.$kernel")
      [ -z "$best" ] || verdict "$(awk -v a="$best" -v b="$ours" 'BEGIN { printf "%.2f", a / b }')" "$([ $kernel = leaf ] && echo 8 || echo 4)" \
        "$kernel, added per event, uftrace to $kind:8" at-least
    done
  done
}
