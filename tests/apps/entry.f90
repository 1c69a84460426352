! SPDX-License-Identifier: MIT
! A function with a second entry, procedures inside a procedure, recursion.
module figures
  implicit none
contains
  function area(width) result(value)
    real :: area_of_square, width, height, value
    value = width * 2.0
    call note(value)
    return
    entry square(height) result(area_of_square)
    area_of_square = height * height
    call note(area_of_square)
  end function

  subroutine note(value)
    real, intent(in) :: value
    print '(f6.2)', value
  end subroutine

  recursive function depth(n) result(value)
    integer, intent(in) :: n
    integer :: value
    value = 1
    if (n > 0) value = 1 + inner(n)
  contains
    integer function inner(m)
      integer, intent(in) :: m
      inner = depth(m - 1)
    end function
  end function
end module

program main
  use figures
  implicit none
  real :: sum
  sum = area(1.5)
  sum = sum + square(1.5)
  print '(f6.2, i3)', sum, depth(2)
end program
