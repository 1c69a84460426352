#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# usage: sampling.sh STIPPLE WORK WAY PLANTED THREADS [WITHOUT_PERF]
# Samples of PLANTED, in which Heavy does three times the work of Light, say so; the thread that waits has none. WAY: what
# must have been used, perf or timer.
set -u
stipple=$1 work=$2 way=$3 planted=$4 threads=$5
shift 5
fail() { echo "FAIL: $*"; exit 1; }
mkdir -p "$work" && cd "$work" || exit 1
archive=$(basename "$planted").stipple
"$stipple" run --sample 1000 --overwrite -o "$archive" -- "$@" "$planted" "$threads" >out || fail "status $?"
[ "$(cat out)" = "done" ] || fail "output: $(cat out)"
"$stipple" check "$archive" || fail "not sound"
"$stipple" info --json "$archive" >info.json
"$stipple" stats "$archive" --table callpaths --format json >paths.json
"$stipple" stats "$archive" --table profile --format json >profile.json
python3 - "$way" "$threads" <<'END' || exit 1
import json, sys
way, threads = sys.argv[1], int(sys.argv[2])
recorded = json.load(open("info.json"))["recorded"]
paths = json.load(open("paths.json"))
profile = {r["region"]: r for r in json.load(open("profile.json"))}

def fail(text):
    sys.exit("FAIL: " + text)

# A machine may deny perf by itself; then the timer is what there is.
if way == "timer" and (recorded["samples by perf"] or not recorded["samples by timer"]):
    fail("not by the timer: %s" % recorded)
if not recorded["samples by perf"] and not recorded.get("samples by timer"):
    fail("by nothing: %s" % recorded)
if not recorded["native stacks"]:
    fail("no native stacks")

of = {tuple(r["path"]): r for r in paths}
for row in paths:
    if row["calls"] is not None or row["messages"] is not None:
        fail("calls of samples: %s" % row)
top = "main" if threads == 0 else "Work"
whole = sum(r["samples"] for r in paths if len(r["path"]) == 1)
reached = sum(r["samples"] for p, r in of.items() if p == (top,))
if whole < 50:
    fail("only %d samples" % whole)
if reached < 0.98 * whole:
    fail("%d of %d samples reach %s" % (reached, whole, top))
work = ("main", "Work") if threads == 0 else ("Work",)
heavy = of[work + ("Heavy", "Spin")]["exclusive_s"]
light = of[work + ("Light", "Spin")]["exclusive_s"]
# 3 to 1, within five standard errors.
share, n = heavy / (heavy + light), of[work]["samples"]
if abs(share - 0.75) > 5 * (0.1875 / n) ** 0.5:
    fail("Heavy has %.3f of %d samples" % (share, n))
if abs(profile["Spin"]["exclusive_s"] - heavy - light) > 1e-6 or profile["Spin"]["calls"] is not None:
    fail("profile: %s" % profile["Spin"])
if any("Wait" in p for p in of):
    fail("a thread that waits was sampled")
print("%d samples, Heavy %.3f" % (whole, share))
END
