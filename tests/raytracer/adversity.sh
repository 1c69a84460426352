#!/bin/sh
# SPDX-License-Identifier: MIT
# Whatever becomes of messages and ranks: one picture, byte for byte, when every call takes a while at random and messages
# of several ranks are taken in any order; and when a rank is killed or runs out of memory all end, with a message, without
# half a picture, and what was recorded can be read.
# usage: adversity.sh RAYTRACER MPIEXEC ADVERSITY HASTY STIPPLE [full]
. "$(dirname "$(realpath "$0")")/begin.sh"
adversity=$3
hasty=$4
stipple=$5
how_much=${6-quick}
fail() { echo "FAIL: $*"; exit 1; }
scene="--scene teapot --scene-size 3 --resolution 32x24"
"$raytracer" $scene --output serial.png > serial.txt

# In front of what may be preloaded already, and for ranks only.
preloaded='LD_PRELOAD=$ADVERSITY${LD_PRELOAD:+:$LD_PRELOAD} exec "$@"'
export ADVERSITY=$adversity

# usage: ranks N COMMAND...
ranks() {
  ranks=$1
  shift
  timeout 200 "$mpiexec" --oversubscribe -n "$ranks" sh -c "$preloaded" sh "$@"
}

# The control: a program that gets away with what it believes of MPI, and with bad luck does not.
timeout 60 "$mpiexec" --oversubscribe -n 2 "$hasty" > hasty.txt 2>&1 || { cat hasty.txt; fail "hasty without bad luck"; }
status=0
ADVERSITY_DELAYS=1 ranks 2 "$hasty" > hasty.txt 2>&1 || status=$?
test $status = 1 && grep -q '^not found by [1-9]' hasty.txt || { cat hasty.txt; fail "bad luck does not show: status $status"; }

# usage: same RANKS SEED OPTIONS...
same() {
  count=$1 seed=$2
  shift 2
  ADVERSITY_DELAYS=$seed ranks "$count" "$raytracer" $scene "$@" --output other.png > other.txt 2> other.err \
    || { cat other.err; fail "$count ranks, seed $seed: $*"; }
  cmp serial.png other.png || fail "picture differs: $count ranks, seed $seed: $*"
  rm other.png
}

# usage: every RANKS SEED: all partitions of rays and objects
every() {
  same "$1" "$2" --partition tiled
  same "$1" "$2" --partition scattered
  same "$1" "$2" --partition bundles --bundle 50
  same "$1" "$2" --partition guided
  same "$1" "$2" --objects partitioned --package 8
  same "$1" "$2" --objects partitioned --partition bundles --bundle 50
  same "$1" "$2" --objects partitioned --partition guided --replicate 0.6
  same "$1" "$2" --objects coupled --partition bundles --bundle 50
  same "$1" "$2" --objects coupled --partition guided
}

# usage: ends STATUS RANK:N:HOW WORDS OPTIONS...
ends() {
  expected=$1 end=$2 words=$3
  shift 3
  status=0
  rm -rf stopped.stipple stopped.png*
  ADVERSITY_END=$end timeout 60 "$stipple" run -o stopped.stipple -- "$mpiexec" --oversubscribe -n 4 sh -c "$preloaded" sh \
    "$raytracer" $scene "$@" --output stopped.png > stopped.txt 2> stopped.err || status=$?
  test $status = "$expected" || { cat stopped.err; fail "status $status: $end, $*"; }
  grep -q -e "$words" stopped.err || { cat stopped.err; fail "no '$words': $end, $*"; }
  test ! -e stopped.png || fail "a picture of a run that stopped: $end, $*"
  "$stipple" info stopped.stipple > info.txt || { cat info.txt; fail "its archive cannot be read: $end, $*"; }
  status=0
  "$stipple" check stopped.stipple > check.txt || status=$?
  test $status = 1 && grep -q 'did not end in order' check.txt || { cat check.txt; fail "its archive is whole: $end, $*"; }
}

# usage: refused RANK SHELL-COMMAND WORDS OPTIONS...: what SHELL-COMMAND does to one rank is said once, and all end
refused() {
  rank=$1 trouble=$2 words=$3
  shift 3
  status=0
  rm -f stopped.png
  timeout 60 "$mpiexec" --oversubscribe -n 4 sh -c "if [ \$OMPI_COMM_WORLD_RANK = $rank ]; then $trouble; fi; exec \"\$@\"" sh \
    "$raytracer" "$@" --output stopped.png > stopped.txt 2> stopped.err || status=$?
  test $status = 2 || { cat stopped.err; fail "status $status: $trouble on rank $rank, $*"; }
  test "$(grep -c "^raytracer: .*$words" stopped.err)" = 1 || { cat stopped.err; fail "not once '$words': $trouble on rank $rank, $*"; }
  test ! -e stopped.png || fail "a picture all the same: $trouble on rank $rank, $*"
}

if [ "$how_much" = full ]; then
  refused 2 'ulimit -v 280000' 'not enough memory' --objects partitioned --scene balls --scene-size 6 --resolution 8x8
  for seed in 1 2 3 4 5; do every 5 $seed; done
  for count in 1 2 3 8 33; do every $count 1; done
  for n in 3 30 100; do
    for rank in 0 1 3; do
      ends 137 $rank:$n:kill 'signal 9' --objects partitioned --package 4
      ends 2 $rank:$n:memory "rank $rank: not enough memory" --objects coupled --package 4
    done
  done
else
  every 5 1
  same 8 2 --objects partitioned --partition bundles --bundle 10 --package 2
fi
ends 137 2:30:kill 'signal 9' --objects partitioned --package 8
ends 137 3:9:kill 'signal 9' --partition bundles --bundle 50
ends 137 1:6:kill 'signal 9' --partition guided
ends 2 1:30:memory 'rank 1: not enough memory' --objects partitioned --package 8
mkdir elsewhere
"$raytracer" $scene --write-scene here.nff > written.txt
refused 2 'cd elsewhere' 'here.nff: cannot be read' --scene here.nff --objects partitioned
refused 0 'cd elsewhere' 'here.nff: cannot be read' --scene here.nff --partition guided
# While the picture is written.
ends 137 0:0:kill 'signal 9' --partition scattered
test -s stopped.png.unfinished || fail "no picture was begun"
echo "one picture whatever happens, and an end"
