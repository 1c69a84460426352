#!/bin/sh
# SPDX-License-Identifier: MIT
# Simulated runs: the same hash every time, the picture of a real run, archives that every command reads, clear errors.
# usage: simulate.sh STIPPLE RAYTRACER
stipple=$1
raytracer=$2
tests=$(dirname "$(realpath "$0")")/../..
. "$tests/own_folder.sh"
fail() { echo "FAIL: $*"; exit 1; }
scene="--scene teapot --scene-size 3 --resolution 64x64 --samples 1"

# usage: simulate NAME MACHINE NODES [OPTIONS...] -- RAYTRACER'S OPTIONS: its JSON in NAME.json, its picture in NAME.png
simulate() {
  name=$1 machine=$2 nodes=$3
  shift 3
  own=
  while [ "$1" != -- ]; do own="$own $1"; shift; done
  shift
  "$stipple" simulate --machine "$machine" --nodes "$nodes" $own -o "$name.stipple" --json \
    -- raytracer $scene "$@" --output "$name.png" > "$name.json" 2> "$name.err" || { cat "$name.err"; fail "$name does not run"; }
}
same() { cmp -s "$1.json" "$2.json" || { cat "$1.json" "$2.json"; fail "$1 and $2 differ"; }; }
differs() { ! cmp -s "$1.json" "$2.json" || fail "$1 and $2 are the same"; }
figure() { sed -nE "s/.*\"$2\":\"?([^,\"}]*).*/\1/p" "$1.json"; }

"$raytracer" $scene --output real.png > real.txt

# On demand, on eight nodes and a host: the same time and hash again and again, also under load.
simulate first ipsc2 8 -- --partition bundles --bundle 64
simulate second ipsc2 8 -- --partition bundles --bundle 64
(while :; do :; done) & load=$!
simulate third ipsc2 8 -- --partition bundles --bundle 64
kill $load
same first second
same first third
test "$(figure first messages)" = 144 || fail "$(figure first messages) messages: two for each of 64 bundles and of 8 nodes"
test "$(figure first hash | wc -c)" = 65 || fail "hash '$(figure first hash)'"

# Every partition and machine: one picture. The iPSC's host collects always.
simulate tiled ipsc2 8 -- --partition tiled
simulate five ipsc860 5 -- --partition scattered
simulate alone ipsc2 1 -- --partition bundles
simulate modern modern 8 -- --partition scattered
simulate served modern 8 -- --partition bundles --bundle 64
# Ranks of a simulated cluster share no memory: what each found travels.
simulate guided modern 4 -- --partition guided
for name in first tiled five alone modern served guided; do
  cmp real.png $name.png || fail "$name has another picture"
  "$stipple" check $name.stipple > check.txt || { cat check.txt; fail "$name.stipple is not sound"; }
done
"$stipple" stats tiled.stipple --table messages | grep -q host || fail "tiled on an iPSC has no host"
! "$stipple" stats modern.stipple --table messages | grep -q host || fail "scattered on a cluster has a host"

# Parameters act.
simulate slow_host ipsc2 8 --host-overhead 0.05 -- --partition bundles --bundle 64
simulate twice ipsc2 8 --work-scale 2 -- --partition bundles --bundle 64
simulate watched ipsc2 8 --event-cost 0.0001 -- --partition bundles --bundle 64
for name in slow_host twice watched; do
  differs first $name
  awk -v less="$(figure first simulated_s)" -v more="$(figure $name simulated_s)" 'BEGIN { exit !(more > less) }' \
    || fail "$name is not slower"
done

# What the machine tells of itself.
"$stipple" info first.stipple | grep -q 'virtual time' || fail "no virtual time"
"$stipple" stats first.stipple --table states --format csv > states.csv
awk -F, 'NR > 1 && ($3 == "" || $3 <= 0 || $4 < 0 || $5 < 0) { bad = 1 } END { exit bad || NR != 10 }' states.csv \
  || { cat states.csv; fail "states"; }
"$stipple" stats first.stipple --table syscalls | grep -q 'start send' || fail "no system call for a start-up"
"$stipple" print first.stipple --ranks 0 > events.txt
test "$(grep -c 'transmission of .* bytes to' events.txt)" -ge 9 || fail "no transmissions"
grep -q 'blocked' events.txt || fail "no switch for a wait"
"$stipple" report first.stipple -o first.html > report.txt
grep -q raytracer first.html

# Messages between neighbours take what can be computed by hand: 135 us to start (375 above 100 bytes), 1 us for the hop, their
# bytes and 16 of the simulator's at 2.8 MB/s if nothing shares the channel, 135 us to be taken. Those of a collective are
# started one after the other like any other: node 0 sends to the host, then to node 1.
simulate neighbours ipsc2 2 -- --objects partitioned
"$stipple" stats neighbours.stipple --table transmissions --format csv > transmissions.csv
awk -F, '
  function us(from, to) { return (to - from) * 1e6 }
  function near(a, b) { return a - b < 0.003 && b - a < 0.003 }
  NR == 1 || $1 > 1 { next }
  $3 == "" && $1 == 0 { if ($2 == 1 && to_host != "" && near(us(to_host, $7), 135)) ++collective
                        to_host = $2 == 2 ? $7 : "" }
  $3 == "" || $2 > 1 { next }
  { long = $4 > 100; ++messages[long]
    if (!near(us($6, $7), long ? 375 : 135) || us($8, $9) < 134.997 || us($7, $8) < 0.997 + $5 / 2.8 || $5 != $4 + 16) wrong = 1
    if (near(us($7, $8), 1 + ($4 + 16) / 2.8)) ++alone[long]
    if (near(us($8, $9), 135)) ++awaited }
  END { exit wrong || !collective || !messages[0] || !messages[1] || !alone[0] || !alone[1] || !awaited }' transmissions.csv \
  || { head -40 transmissions.csv; fail "a message does not take what it should"; }
"$stipple" stats neighbours.stipple --table load --format csv |
  awk -F, 'NR > 1 { if ($NF < 0) exit 1; sum += $NF } END { exit !(sum > 0) }' || fail "no load of the network"

# Errors name what is wrong and what is known.
refuses() { # WORDS OPTIONS...
  words=$1
  shift
  status=0
  "$stipple" simulate -o none.stipple --overwrite "$@" > out.txt 2> err.txt || status=$?
  test $status = 2 || fail "status $status for $*"
  grep -q -e "$words" err.txt || { cat err.txt; fail "no '$words' for $*"; }
}
refuses 'known are' --machine cray --nodes 8 -- raytracer
refuses 'from 1 to 128' --machine ipsc2 --nodes 129 -- raytracer
refuses 'not built for simulated' --machine ipsc2 --nodes 8 -- ls
test ! -e none.stipple || fail "an archive of what was refused"
# A node has 16 MiB: what takes more is divided among nodes, or refused with the number.
scene="--scene teapot --scene-size 26 --resolution 24x24 --samples 1"
"$raytracer" $scene --output large.png > large.txt
refuses '43732 objects take up to 18\.. MB .* 16\.8 MB are allowed' --machine ipsc2 --nodes 4 -- raytracer $scene --objects replicated
for objects in auto partitioned coupled; do
  simulate large_$objects ipsc2 4 -- --objects $objects --stats large_stats.json
  cmp large.png large_$objects.png || fail "divided among small nodes ($objects) it is another picture"
  grep -q '"copies"' large_stats.json || fail "a scene of 18 MB was not divided among nodes of 16 ($objects)"
done
refuses 'divided among 1 ranks, 1 leaf each, .* 16\.8 MB are allowed' --machine ipsc2 --nodes 1 -- raytracer $scene
refuses 'counts no tests' --machine ipsc2 --nodes 2 -- raytracer --kernel embree
echo "simulated runs are what they were"
