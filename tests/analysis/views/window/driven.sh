#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# driven.sh STIPPLE WINDOW_ARCHIVE: opens the window on a virtual display and drives it by keys and mouse. What it shows is
# read from its title: the visible span, the cursor, the facts of what was clicked. Waits for titles, never for times.
set -u
stipple=$1 window_archive=$2
for tool in Xvfb xdotool xprop import convert; do
  command -v $tool >/dev/null || { echo "no $tool: skipped"; exit 77; }
done
work=$(mktemp -d) xvfb= view=
cleanup() {
  [ -z "$view" ] || kill "$view" 2>/dev/null
  [ -z "$xvfb" ] || kill "$xvfb" 2>/dev/null
  rm -rf "$work"
}
trap cleanup EXIT
fail() { echo "FAILED: $*"; echo "title: $(title)"; [ -s "$work/err" ] && cat "$work/err"; exit 1; }
title() { [ -n "${id-}" ] && xdotool getwindowname "$id" 2>/dev/null; }

"$window_archive" "$work/a.stipple" 4 20 || exit 1

# Without a display, or with one that is gone: said, and exit 2.
for display in '' ':987'; do
  DISPLAY=$display "$stipple" view "$work/a.stipple" 2>"$work/err"
  [ $? = 2 ] && grep -q 'stipple report' "$work/err" || fail "DISPLAY='$display' is no clear error"
done
unset id

Xvfb -displayfd 3 -screen 0 1440x960x24 -nolisten tcp -noreset 3>"$work/display" 2>/dev/null &
xvfb=$!
for ((i = 0; i < 300; ++i)); do [ -s "$work/display" ] && break; sleep 0.1; done
DISPLAY=:$(cat "$work/display")
export DISPLAY
[ "$DISPLAY" != : ] || { echo "Xvfb does not start: skipped"; exit 77; }
"$stipple" view "$work/a.stipple" 2>"$work/err" &
view=$!

# wait_for REGEX: until the title matches; half a minute is far more than it takes.
wait_for() {
  for ((i = 0; i < 600; ++i)); do
    [[ $(title) =~ $1 ]] && return 0
    kill -0 "$view" 2>/dev/null || fail "the window is gone while waiting for '$1'"
    sleep 0.05
  done
  fail "the title never was '$1'"
}
wait_change() { # FROM
  for ((i = 0; i < 600; ++i)); do
    [ "$(title)" != "$1" ] && return 0
    sleep 0.05
  done
  fail "the title stayed"
}
span() { title | sed -E 's/.* \| ([0-9.]+) s to ([0-9.]+) s \|.*/\1 \2/'; }
near() { awk -v a="$1" -v b="$2" -v e="$3" 'BEGIN { d = a - b; exit !(d < e && -d < e) }' || fail "$4: $1, not $2"; }

for ((i = 0; i < 300; ++i)); do
  kill -0 "$view" 2>/dev/null || fail "it ended at once"
  id=$(xdotool search --name '^stipple view' 2>/dev/null | tail -1)
  [ -n "$id" ] && break
  sleep 0.1
done
wait_for '^stipple view program \| 0\.000000000 s to 0\.200000000 s \| ranks 4 of 4'
whole=$(title)
# A picture is there before anything is asked; of many colours, so not blank.
picture() { import -window "$id" "$work/$1.png" && convert "$work/$1.png" -unique-colors -format %w info:; }
colours=0
for ((i = 0; i < 300 && colours < 30; ++i)); do colours=$(picture first); done
[ "$colours" -ge 30 ] || fail "the window is blank: $colours colours"

left=88 right=1138 run=0.2   # of the axis, in a window of 1440 pixels
at() { awk -v x="$1" -v l=$left -v r=$right -v s="$2" 'BEGIN { split(s, a, " "); print a[1] + (x - l) / (r - l) * (a[2] - a[1]) }'; }

# Rubber band.
xdotool mousemove 300 260 mousedown 1 mousemove 420 260 mousemove 600 262 mouseup 1
wait_change "$whole"
zoomed=$(title)
read -r begin end <<<"$(span)"
near "$begin" "$(at 300 "0 $run")" 0.0004 "the band's begin"
near "$end" "$(at 600 "0 $run")" 0.0004 "the band's end"

# Back and forward.
xdotool key b; wait_for "${whole//|/\\|}\$"
xdotool key f; wait_for "${zoomed//|/\\|}\$"
xdotool key alt+Left; wait_for "${whole//|/\\|}\$"
xdotool key alt+Right; wait_for "${zoomed//|/\\|}\$"

# The wheel keeps what is under the pointer.
before=$(span) now=$(title)
xdotool mousemove 450 260 click 4
wait_change "$now"
near "$(at 450 "$(span)")" "$(at 450 "$before")" 0.0001 "the time under the pointer"
now=$(title)
xdotool click 5
wait_change "$now"

# Moving with the right button: what was under the pointer goes with it.
before=$(span) now=$(title)
xdotool mousemove 500 260 mousedown 3 mousemove 540 260 mousemove 600 260 mouseup 3
wait_change "$now"
for ((i = 0; i < 600; ++i)); do
  awk -v a="$(at 600 "$(span)")" -v b="$(at 500 "$before")" 'BEGIN { d = a - b; exit !(d < 1e-4 && -d < 1e-4) }' && break
  sleep 0.05
done
near "$(at 600 "$(span)")" "$(at 500 "$before")" 0.0001 "the time that was dragged"
now=$(title); xdotool key Left; wait_change "$now"
xdotool key Home; wait_for "${whole//|/\\|}"

# Search: centred, with facts; next and previous.
xdotool key slash type Rare; wait_for 'search: Rare'
xdotool key Return; wait_for 'rank 1, Rare\(\), 0\.05'
read -r begin end <<<"$(span)"
near "$(awk -v a="$begin" -v b="$end" 'BEGIN { print (a + b) / 2 }')" 0.0525 0.002 "the middle of what was found"
xdotool key n; wait_for "no later visit of 'Rare'"
xdotool key Home slash type MPI_Send; xdotool key Return; wait_for 'rank 0, MPI_Send.*message from 0 to 1, tag 0, 1000 bytes'
found=$(title)
xdotool key n; wait_for 'rank [123], MPI_Send.*tag 0'
xdotool key N; wait_for 'rank 0, MPI_Send.*message from 0 to 1, tag 0'

# Down to the single event, and a click on it.
xdotool key z
now=$(title)
xdotool key Escape; wait_change "$now"
# What was found is a send, from 0.00501 to 0.00526 s; its message takes the whole width.
x=$(awk -v l=$left -v r=$right -v s="$(span)" 'BEGIN { split(s, a, " "); printf "%d", l + (0.00513 - a[1]) / (a[2] - a[1]) * (r - l) }')
clicked=
for ((y = 130; y < 300 && ${#clicked} == 0; y += 8)); do
  xdotool mousemove "$x" $y click 1
  # Where nothing is, nothing changes: the next place is tried after a second.
  for ((i = 0; i < 20 && ${#clicked} == 0; ++i)); do
    [[ $(title) =~ "rank 0, MPI_Send" ]] && clicked=$y || sleep 0.05
  done
  [ -n "$clicked" ] || { xdotool key Escape; sleep 0.1; }
done
[[ $(title) =~ "message from 0 to 1, tag 0, 1000 bytes, sent " ]] || fail "a click on MPI_Send tells no message"
[ "$(picture event)" -ge 30 ] || fail "blank"

# A rank's name narrows to it; r brings all back.
xdotool key Home; wait_for "${whole//|/\\|}"
xdotool mousemove 40 $clicked click 1; wait_for 'ranks 1 of 4'
xdotool key r; wait_for 'ranks 4 of 4'

# Playing: the cursor moves on and stops at the end.
xdotool key space; wait_for 'playing at'
now=$(title); wait_change "$now"
xdotool key plus plus plus plus plus
wait_for 'cursor at 0\.200000000 s'
[ "$(picture played)" -ge 30 ] || fail "blank"

# Help, patterns, another size.
xdotool key h; wait_for '\| help'
xdotool key Escape; wait_for 's$|tag'
xdotool key m
grey=1
for ((i = 0; i < 300 && grey; ++i)); do
  picture mono >/dev/null
  [ "$(convert "$work/mono.png" -colorspace HSL -channel G -separate -format '%[fx:maxima < 0.02]' info:)" = 1 ] && grey=0
  [ $grey = 0 ] && break
done
[ $grey = 0 ] || fail "patterns are coloured"
xdotool windowsize "$id" 900 640
for ((i = 0; i < 300; ++i)); do
  picture small >/dev/null
  [ "$(convert "$work/small.png" -format '%wx%h' info:)" = 900x640 ] && break
done
[ "$(picture small)" -ge 20 ] || fail "blank after a change of size"

xdotool mousemove 400 300 key q
wait "$view"; status=$?
view=
[ $status = 0 ] || fail "exit status $status"
[ ! -s "$work/err" ] || fail "it complained"
echo "the window does what its keys say"
