# SPDX-License-Identifier: MIT
# Part of tests/bench/run: the ray tracer against POV-Ray and Tachyon, as Debian packages them.

# CPU seconds of tracing, without reading and bounding the scene.
pov_seconds() { # SCENE SIZE
  "$build/tests/bench_pov" "$1" "$2" >"$work/scene.pov" || return 1
  povray +I"$work/scene.pov" +O"$work/pov.png" +W512 +H512 -D -A +WT1 +Q9 File_Gamma=1 >"$work/pov.log" 2>&1 ||
    { tail -5 "$work/pov.log" >&2; return 1; }
  grep -a -A1 'Trace Time' "$work/pov.log" | sed -nE 's/.*with ([0-9.]+) CPU-seconds.*/\1/p'
}

own_seconds() { # SCENE SIZE
  spd_draw "$work/own.json" "$1" "$2" --output "$work/own.png" && figure "$work/own.json" render_cpu_s
}

# The bar of a scene; Tachyon has no cones, which tree needs.
tachyon_limit() {
  case $1 in balls | teapot) echo 0.5 ;; rings) echo 0.55 ;; esac
}

run_renderers() {
  local scene name peer round own peers=() limit times=$((rounds < 5 ? rounds : 5))
  echo "Other ray tracers, one thread, 512x512, depth 5, the same objects, lights, frame and surfaces, $times rounds in turn: CPU"
  echo "seconds of tracing (own: 513x513 corner rays; theirs: pixel centres; Tachyon cuts rays that add less than 1/512)."
  if command -v povray >/dev/null; then peers+=(pov); else echo "  POV-Ray: not here; as root: apt-get install povray"; fi
  if [ -x "$build/tests/bench_tachyon" ]; then peers+=(tachyon); else
    echo "  Tachyon: not here; as root: apt-get install libtachyon-mt-0-dev, then cmake $build and build again"
  fi
  for scene in "${spd_scenes[@]}"; do
    name=${scene% *}
    for peer in "${peers[@]}"; do
      limit=0.6
      [ $peer = pov ] || limit=$(tachyon_limit $name)
      [ -n "$limit" ] || continue
      for ((round = 0; round < times; ++round)); do
        own=$(own_seconds $scene) || return 1
        if [ $peer = pov ]; then echo "$own $(pov_seconds $scene)"; else echo "$own $("$build/tests/bench_tachyon" $scene 512)"; fi
      done | awk 'NF != 2 { exit 1 } { print $1, $2, $1 / $2 }' >"$work/peer.rounds" || { echo "$peer does not run" >&2; return 1; }
      set -- $(spread "$work/peer.rounds" 1) $(spread "$work/peer.rounds" 2) $(spread "$work/peer.rounds" 3)
      echo "  $scene: own $1 s ($2 to $3), $peer $4 s ($5 to $6)"
      verdict "$7" "$limit" "$scene, own to $peer ($8 to $9)"
    done
  done
}
