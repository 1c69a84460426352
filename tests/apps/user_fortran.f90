! SPDX-License-Identifier: MIT
! Manual events in Fortran: regions (one ends as the last thing that a procedure does), a mark,
! counters of each kind, a name made at run time, messages, and nothing while switched off.
module work
  use stipple
  implicit none
  type(stipple_region), save :: inner = stipple_region('inner region', 'work.f90', 12)
contains
  subroutine compute(x)
    integer, intent(in) :: x
    call stipple_region_begin(inner)
    if (x > 100) print *, x
    call stipple_region_end(inner)
  end subroutine
end module

program app
  use stipple
  use work
  use, intrinsic :: iso_fortran_env, only: int64
  implicit none
  type(stipple_region), save :: outer = stipple_region('outer region')
  type(stipple_region), save :: step
  type(stipple_name), save :: phase = stipple_name('phase')
  type(stipple_name), save :: residual = stipple_name('residual', 'N')
  type(stipple_channel), save :: jobs = stipple_channel('jobs')
  integer :: i
  integer(int64) :: since

  call stipple_region_begin(outer)
  call compute(1)
  call stipple_mark(phase)
  call stipple_counter(residual, 0.5d0)
  call stipple_counter(residual, 0.25)
  call stipple_counter(residual, 3)
  call stipple_counter(residual, 4_int64)
  do i = 1, 2
    step = stipple_region('')
    write (step%name, '(a, i0)') 'step ', i
    call stipple_region_begin(step)
    call stipple_region_end(step)
  end do
  call stipple_stop()
  call compute(2)
  call stipple_mark(phase)
  call stipple_start()
  since = stipple_time()
  call stipple_send(jobs, 7, 100)
  call stipple_receive(jobs, 7_int64, 100_int64, since)
  call stipple_send(jobs, 8, 200)
  call stipple_receive(jobs, 8, 200)
  call compute(3)
  call stipple_region_end(outer)
  print *, i
end program
