#!/bin/sh
# SPDX-License-Identifier: MIT
# On a machine that is the same every time: ranks that keep what is not full wait for ever, which is found and said; one
# round of counters, asked of nobody else, ends a run while rays are under way; tiles are the worst partition of a scene in
# one corner; what is refused leaves no archive.
# usage: adversity.sh STIPPLE RAYTRACER BREAKABLE: BREAKABLE/lib/stipple/simulate has a ray tracer that heeds STIPPLE_BREAK
stipple=$1
raytracer=$2
breakable=$3
tests=$(dirname "$(realpath "$0")")/../..
. "$tests/own_folder.sh"
fail() { echo "FAIL: $*"; exit 1; }

# stipple finds the ray tracer by where it is itself.
mkdir -p here/bin here/lib/stipple/simulate
cp "$stipple" here/bin/stipple
ln -s "$(dirname "$(dirname "$stipple")")/lib/stipple/simulate/libstipple-machine.so" "$breakable"/lib/stipple/simulate/raytracer.so \
  here/lib/stipple/simulate/

scene="--scene teapot --scene-size 3 --resolution 32x32 --samples 1"
"$raytracer" $scene --output real.png > real.txt
# usage: simulate STIPPLE MACHINE OPTIONS...: its status in $status; without what $break_off names, if it heeds that
break_off= nodes=8
simulate() {
  program=$1 machine=$2
  shift 2
  status=0
  rm -f other.png
  STIPPLE_BREAK=$break_off timeout 100 "$program" simulate --machine "$machine" --nodes $nodes -o run.stipple --overwrite --json -- raytracer "$@" \
    --output other.png > run.json 2> run.err || status=$?
}
figure() { sed -nE "s/.*\"$1\":\"?([^,\"}]*).*/\1/p" run.json; }

# The same run ends where part-full packages are sent, and where all packages are full; and hangs where they are kept.
for options in '--objects partitioned --partition bundles --bundle 64' '--objects coupled --replicate 0.3 --partition scattered'; do
  simulate "$stipple" ipsc2 $scene $options
  test $status = 0 || { cat run.err; fail "status $status: $options"; }
  cmp real.png other.png || fail "picture differs: $options"
  break_off='part-full packages'
  simulate here/bin/stipple ipsc2 $scene $options
  break_off=
  test $status = 3 || { cat run.err; fail "status $status of a deadlock: $options"; }
  grep -q '^stipple simulate: deadlock at [0-9.]* s of the machine' run.err || { cat run.err; fail "no deadlock said: $options"; }
  for rank in 0 1 2 3 4 5 6 7 8; do
    grep -Eq "^  rank $rank( \(host\))? waits since [0-9.]* s in MPI_(Recv < stipple::raytracer::Mail::Take|Allreduce|Allgather) < stipple::raytracer::" run.err \
      || { cat run.err; fail "nothing of rank $rank: $options"; }
  done
  test ! -e other.png || fail "a picture of a deadlock: $options"
  "$stipple" info run.stipple > info.txt 2> info.err || { cat info.err; fail "its archive cannot be read: $options"; }
done
break_off='part-full packages'
simulate here/bin/stipple ipsc2 $scene --objects partitioned --package 1
break_off=
test $status = 0 || { cat run.err; fail "status $status with packages of one ray"; }
cmp real.png other.png || fail "picture differs with packages of one ray"

# usage: ends_early NODES RESOLUTION PACKAGE: not by itself, but with one round of counters
ends_early() {
  tiny="--scene teapot --scene-size 2 --resolution $2 --samples 1"
  "$raytracer" $tiny --output tiny.png > tiny.txt
  nodes=$1
  simulate "$stipple" ipsc2 $tiny --objects partitioned --package $3
  test $status = 0 || { cat run.err; fail "status $status: $*"; }
  cmp tiny.png other.png || fail "picture differs: $*"
  break_off=agreement
  simulate here/bin/stipple ipsc2 $tiny --objects partitioned --package $3
  break_off= nodes=8
  test $status != 0 && test ! -e other.png && grep -q 'rays came after their end was found\|work is left although' run.err
}
# Which runs a single round gets wrong is a matter of microseconds, the same ones every time: one of these is enough.
ends_early 5 7x7 2 || ends_early 3 10x10 4 || ends_early 6 6x6 4 || ends_early 7 10x10 2 || fail "one round of counters is enough"

# Balls in one corner of the picture: who has that corner has all the work.
awk 'BEGIN {
  print "v from 0 -6 0 at 0 0 0 up 0 0 1 angle 45 hither 0.1 resolution 64 64\nb 0 0.2 0.4\nl 3 -4 5\nl -4 -5 3\nf 0.8 0.6 0.4 0.5 0.5 20 0 1"
  for (x = 0; x < 7; ++x) for (y = 0; y < 4; ++y) for (z = 0; z < 7; ++z) print "s", 1.3 + x / 7, y / 5, 1.3 + z / 7, 0.09
}' > corner.nff
# usage: measure OPTIONS...: the work of the busiest rank over the mean in $busiest, the time in $seconds
measure() {
  simulate "$stipple" modern --scene corner.nff --samples 1 "$@"
  test $status = 0 || { cat run.err; fail "status $status: $*"; }
  busiest=$(sed -n 's/.*work of the busiest tracing rank over the mean: //p' run.err)
  seconds=$(figure simulated_s)
}
more() { awk -v more="$1" -v less="$2" -v times="$3" 'BEGIN { exit !(more > times * less) }'; }
measure --partition tiled
tiled_busiest=$busiest tiled_seconds=$seconds
more $tiled_busiest 1 3 || fail "tiles share the corner: $tiled_busiest"
for partition in scattered bundles guided; do
  measure --partition $partition --bundle 64
  more $tiled_busiest $busiest 2 || fail "$partition: $busiest, tiled only $tiled_busiest"
  # Of so small a picture the counter that guided ranks share takes longer than the rays.
  test $partition = guided || more $tiled_seconds $seconds 1.3 || fail "$partition: $seconds s, tiled only $tiled_seconds"
done

# usage: refuses WORDS OPTIONS...: status 2, and nothing is left
refuses() {
  words=$1
  shift
  simulate "$stipple" ipsc2 "$@"
  test $status = 2 || { cat run.err; fail "status $status: $*"; }
  grep -q -e "$words" run.err || { cat run.err; fail "no '$words': $*"; }
  test ! -e run.stipple || { ls -l run.stipple; fail "an archive of what was refused: $*"; }
}
refuses 'take --partition bundles' --partition guided
refuses 'none.nff: cannot be read' --scene none.nff
refuses 'counts no tests' --kernel embree
echo "found, said, and the worst is the worst"
