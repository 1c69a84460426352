# SPDX-License-Identifier: MIT
# Read by ../run: frames of the window on a virtual display, drawn in software.
run_redraw() {
  echo "Frames of a window of 1600x1000 over ${BENCH_REDRAW_EVENTS:-1e8} events of 8 ranks; CPU time of the process, llvmpipe's threads included."
  command -v Xvfb >/dev/null || { echo "  no Xvfb: skipped"; return 0; }
  Xvfb -displayfd 3 -screen 0 1600x1000x24 -nolisten tcp -noreset 3>"$work/display" 2>/dev/null &
  local xvfb=$! status=0 i
  for ((i = 0; i < 300; ++i)); do [ -s "$work/display" ] && break; sleep 0.1; done
  DISPLAY=:$(cat "$work/display") LIBGL_ALWAYS_SOFTWARE=1 "$build/tests/bench_redraw" "${BENCH_REDRAW_EVENTS:-1e8}" "$work" | tee "$work/redraw" || status=1
  kill "$xvfb"
  wait "$xvfb" 2>/dev/null
  [ $status = 0 ] || return 1
  verdict "$(awk '/^worst/ { print $2 }' "$work/redraw")" 16 "ms of CPU per frame at the worst zoom"
}
