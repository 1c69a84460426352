# SPDX-License-Identifier: MIT
# A ray tracer (C, MPI). It has no tests but a folder of scenes: each is rendered on 4 ranks, and the outcome is the
# checksum of the picture.
packages=(tachyon)

build() {
  make -C tachyon/unix linux-mpi CC="mpicc" MISCFLAGS="$flags -w"
}

suite() {
  local scene tachyon=$PWD/tachyon/compile/linux-mpi/tachyon
  cd tachyon/scenes || return
  for scene in *.dat; do
    rm -f picture.ppm
    mpirun --oversubscribe -n 4 "$tachyon" "$scene" -res 160 120 -format PPM -o picture.ppm >&2 </dev/null
    echo "$scene status $?, picture $(cksum <picture.ppm)"
  done
}
