# SPDX-License-Identifier: MIT
# Part of tests/bench/run: adaptive sampling against uniform sampling in the same time.

# Lines "scene setting cpu error ratio": the error of an adaptive picture over that of a uniform one of the same CPU time,
# between two measured ones in logarithms.
adaptive_to_uniform() { # CSV
  awk -F, '
    /^#/ || $1 == "panel" { next }
    $2 == "stratified" { n = ++count[$1]; cpu[$1, n] = $4; error[$1, n] = $5; next }
    $2 ~ /^adaptive/ { scene[++m] = $1; label[m] = $2 " " $3; at[m] = $4; own[m] = $5 }
    END {
      for (i = 1; i <= m; ++i) {
        s = scene[i]
        for (k = 1; k < count[s] - 1 && cpu[s, k + 1] < at[i]; ++k);
        share = log(at[i] / cpu[s, k]) / log(cpu[s, k + 1] / cpu[s, k])
        uniform = exp(log(error[s, k]) + share * log(error[s, k + 1] / error[s, k]))
        printf "%s,%s,%.3f,%.6f,%.3f\n", s, label[i], at[i], own[i], own[i] / uniform
      } }' "$1"
}

run_sampling() {
  echo "Adaptive sampling: its error over that of uniform sampling in the same CPU time; the truth has 1024 rays a pixel."
  "$build/bin/raytracer-charts" sampling -o "$work/charts" | sed 's/^/  /' || return 1
  adaptive_to_uniform "$work/charts/sampling.csv" >"$work/adaptive"
  if [ ! -s "$work/adaptive" ]; then echo "  nothing adaptive in the chart"; return; fi
  while IFS=, read -r scene label cpu error ratio; do
    echo "  $scene, $label: $cpu s, error $error"
    verdict "$ratio" 1.0 "$scene, $label, error to that of uniform sampling"
  done <"$work/adaptive"
}
