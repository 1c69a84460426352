#!/bin/sh
# SPDX-License-Identifier: MIT
# past_formats.sh STIPPLE DATA_DIR: archives of every format there was are sound and hold the same events as then.
set -u
failures=0
for archive in "$2"/format-*.stipple; do
  name=$(basename "$archive" .stipple)
  "$1" check "$archive" || failures=$((failures + 1))
  "$1" print --canonical "$archive" | diff - "$2/$name.txt" || failures=$((failures + 1))
done
[ $failures = 0 ]
