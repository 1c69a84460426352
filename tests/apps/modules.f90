! SPDX-License-Identifier: MIT
! Module procedures, a contained procedure, the main program.
module shapes
  implicit none
contains
  subroutine show(n)
    integer, intent(in) :: n
    print '(a,i0)', 'show ', n
  end subroutine show
  recursive function factorial(n) result(f)
    integer, intent(in) :: n
    integer :: f
    call show(n)
    if (n <= 1) then
      f = 1
    else
      f = n * factorial(n - 1)
    end if
  end function factorial
end module shapes

program main
  use shapes
  implicit none
  call contained(factorial(3))
contains
  subroutine contained(f)
    integer, intent(in) :: f
    print '(a,i0)', 'result ', f
  end subroutine contained
end program main
