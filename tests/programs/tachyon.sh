# SPDX-License-Identifier: MIT
# A ray tracer (C, MPI; the scene is divided by lines of the picture). It has no tests but a folder of scenes: each is
# rendered on 3 ranks, and the outcome is the checksum of the picture. Left out: scenes that repeat what the listed ones do,
# take minutes (dna, gridtest, sc98ao) or lack a file.
packages=(tachyon)

scenes="2balls balls clipplanes fisheye lattice polycyl teapot trypsin4pti"

build() {
  make -C tachyon/unix linux-mpi CC=mpicc MISCFLAGS="$flags -w"
}

suite() {
  local scene
  cd tachyon/scenes || return
  for scene in $scenes; do
    rm -f picture.ppm
    mpirun --oversubscribe -n 3 ../compile/linux-mpi/tachyon "$scene.dat" -res 160 120 -format PPM -o picture.ppm \
      </dev/null >&2
    echo "$scene status $?, picture $(cksum <picture.ppm)"
  done
}
