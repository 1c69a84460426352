# SPDX-License-Identifier: MIT
# Part of tests/bench/run: what the ray tracer pays for what a scene does not use, in instructions, which no load of the
# machine changes; and from how many objects on a hierarchy pays.

# Instructions of drawing 32 x 32 pixels, less those of 1 x 1: loading and building are in both.
draw_instructions() { # SCENE SIZE RULES
  local pixels counts=()
  for pixels in 32 1; do
    valgrind --tool=callgrind --callgrind-out-file="$work/callgrind.$3.$pixels" "$build/tests/bench_features" draw "$1" "$2" $pixels "$3" \
      2>"$work/callgrind" || { tail -5 "$work/callgrind" >&2; return 1; }
    counts+=("$(sed -nE 's/.*Collected : ([0-9]+).*/\1/p' "$work/callgrind")")
  done
  echo $((counts[0] - counts[1]))
}

run_features() {
  local scene rules least objects round
  echo "Instructions of drawing opaque scenes: as the program shades them, and with what other scenes need compiled in."
  if ! command -v valgrind >/dev/null; then echo "  valgrind: not here; as root: apt-get install valgrind"; else
    for scene in "balls 3" "teapot 4"; do
      least=$(draw_instructions $scene auto) || return 1
      for rules in transmitting extended; do
        awk -v least="$least" -v more="$(draw_instructions $scene $rules)" -v text="$scene, $rules" 'BEGIN {
          printf "  %s: %d instructions, as it is %d: %+.2f %%\n", text, more, least, (more / least - 1) * 100
          printf "%.4f\n", least / more > "/dev/fd/3" }' 3>"$work/features.ratio"
        verdict "$(<"$work/features.ratio")" 1.0 "$scene, as it is, to $rules"
      done
      verdict "$(grep -c 'Refract' "$work/callgrind.auto.32")" 0 "$scene, as it is, entries of refraction in the profile"
    done
  fi
  echo "A hierarchy against trying every object, rings, 256x256: CPU time, medians of $rounds rounds in turn."
  for objects in 3 10 66; do
    for ((round = 0; round < rounds; ++round)); do "$build/tests/bench_features" hierarchy $objects 256 || return 1; done |
      awk '{ print $1, $2, $1 / $2 }' >"$work/hierarchy" || return 1
    set -- $(spread "$work/hierarchy" 1) $(spread "$work/hierarchy" 2) $(spread "$work/hierarchy" 3)
    echo "  $objects objects: with $1 s ($2 to $3), without $4 s ($5 to $6)"
    verdict "$7" 1.0 "$objects objects, with to without"
  done
}

run_exact() {
  echo "Double against long double, the same program: pixels and rays of 512x512 that differ."
  local scene
  for scene in "${spd_scenes[@]}"; do
    set -- $("$build/tests/bench_features" exact $scene 512)
    [ $# = 2 ] || return 1
    echo "  $scene: $1 pixels, $2 rays"
    verdict "$1" 0 "$scene, pixels that differ"
  done
}
