# SPDX-License-Identifier: MIT
# A ray tracer (C, MPI; the scene is divided by lines of the picture). It has no tests but a folder of scenes: each is
# rendered on 4 ranks and on 1, and the outcomes are the checksums of the pictures. Left out: scenes that take minutes
# (dna, gridtest, sc98ao, ...) and those that lack a file.
packages=(tachyon)

scenes="2balls 820spheres attenuation balls clipplanes fisheye fog imagedef lattice model2 polycyl room spotlight teapot
  texture transtest trypsin4pti umr"

build() {
  make -C tachyon/unix linux-mpi CC=mpicc MISCFLAGS="$flags -w"
}

suite() {
  local scene ranks
  cd tachyon/scenes || return
  for scene in $scenes; do
    for ranks in 4 1; do
      rm -f picture.ppm
      mpirun --oversubscribe -n $ranks ../compile/linux-mpi/tachyon "$scene.dat" -res 160 120 -format PPM \
        -o picture.ppm </dev/null >&2
      echo "$scene on $ranks: status $?, picture $(cksum <picture.ppm)"
    done
  done
}
