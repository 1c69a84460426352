#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs programs with a planted cause and compares what `stipple stats` says of them with the table of expectations.
#   check.sh STIPPLE PROGRAM_DIR [--runs N] [--strength S] [--load N] [--keep DIR | --again DIR] [PROGRAM...]
# All programs by default. --strength: how much of the planted cause; --load: so many processes spin meanwhile; --keep:
# the archives, as PROGRAM.N.stipple; --again: judges kept ones.
# A line a run: verdict, program, cause, kind, culprit and region; how much of the time was waited (idle), and the shares
# of the waiting that the first and the second culprit have (first, second). A last line counts; exit status 1 if
# something else was named than what was planted.
set -eu
export LC_ALL=C
here=$(dirname "$(realpath "$0")")
stipple=$1 programs=$2
shift 2
runs=1 strength=1 load=0 keep= again=
while [[ ${1-} == --* ]]; do
  case $1 in
    --runs) runs=$2 ;;
    --strength) strength=$2 ;;
    --load) load=$2 ;;
    --again) again=$(realpath "$2") ;;
    --keep) keep=$(realpath -m "$2") ;;
    *) echo "check.sh: unknown option $1" >&2; exit 2 ;;
  esac
  shift 2
done
wanted=" $* "
work=$(mktemp -d)
spinning=()
trap 'kill "${spinning[@]}" 2>/dev/null || true; rm -rf "$work"' EXIT
for ((i = 0; i < load; ++i)); do
  while :; do :; done &
  spinning+=($!)
done
. "$here/../mpi_environment.sh"
[ -z "$keep" ] || mkdir -p "$keep"

# record PROGRAM RANKS RUN; no ranks: it is no MPI program.
record() {
  local launcher=()
  archive=$work/a.stipple
  [ -z "$keep" ] || archive=$keep/$1.$3.stipple
  if [ -n "$again" ]; then
    archive=$again/$1.$3.stipple
    return 0
  fi
  (($2 == 0)) || launcher=(mpirun --oversubscribe -n "$2")
  "$stipple" run --overwrite -o "$archive" -- "${launcher[@]}" "$programs/$1" "$strength" \
    < /dev/null 2> "$work/messages" || { cat "$work/messages" >&2; return 1; }
}

# one_of VALUE WANTED: `*` is anything, `|` between what is allowed.
one_of() { [[ $2 == '*' || "|$2|" == *"|$1|"* ]]; }

# Shares of all waiting that is charged to the first and to the second culprit.
shares() {
  awk -F, 'NR > 1 { seconds[$3] += $4; sum += $4 }
    END {
      for (c in seconds) {
        if (seconds[c] > first) { second = first; first = seconds[c] } else if (seconds[c] > second) second = seconds[c]
      }
      if (sum == 0) sum = 1
      printf "first %.2f second %.2f", first / sum, second / sum
    }' "$work/waits.csv"
}

# judge PROGRAM CAUSE KIND CULPRIT REGION: the line; fails where another cause was named.
judge() {
  local first cause kind culprit region idle sentence verdict=ok
  "$stipple" stats "$archive" --table waits --format csv > "$work/waits.csv"
  "$stipple" stats "$archive" --table imbalance --format csv > "$work/imbalance.csv"
  first=$(sed -n 2p "$work/waits.csv")
  IFS=, read -r kind _ culprit _ region <<<"$first"
  IFS=, read -r _ idle cause sentence <<<"$(sed -n 2p "$work/imbalance.csv")"
  one_of "$cause" "$2" && one_of "$kind" "$3" && one_of "$culprit" "$4" && one_of "$region" "$5" || verdict=WRONG
  printf '%-5s %-18s cause %s; waits %s %s %s; idle %.3f %s; %s\n' \
    $verdict "$1" "$cause" "${kind:--}" "${culprit:--}" "${region:--}" "$idle" "$(shares)" "$sentence"
  [ $verdict = ok ]
}

named=0 planted=0 left=0 healthy=0
while read -r program ranks cause kind culprit region; do
  [[ $program == \#* || $wanted != "  " && $wanted != *" $program "* ]] && continue
  right=1
  for ((run = 0; run < runs; ++run)); do
    record "$program" "$ranks" $run
    judge "$program" "$cause" "$kind" "$culprit" "$region" || right=0
  done
  if [ "$cause" = none ]; then
    healthy=$((healthy + 1)) left=$((left + right))
  else
    planted=$((planted + 1)) named=$((named + right))
  fi
done < "$here/expected.txt"
echo "$named of $planted named first, $left of $healthy left in peace"
((planted + healthy > 0)) || { echo "check.sh: no such program: $*" >&2; exit 2; }
((named == planted && left == healthy))
