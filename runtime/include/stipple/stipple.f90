! SPDX-License-Identifier: MIT
! Manual events for Fortran: what user.h is for C. Compile this file with your program, or let
! stipple-fc or find_package(stipple) bring it; examples: docs/user.md.
!
! Nothing is linked: the runtime's functions are looked up by name at the first call (dlsym, which is
! in the C library since glibc 2.34; before that add -ldl), so a program runs unchanged without
! stipple; each call is then two loads and tests. A statically linked program records no manual
! events of Fortran. Fortran 2003; any number of threads.
module stipple
  use, intrinsic :: iso_c_binding, only: c_associated, c_char, c_double, c_f_procpointer, c_funptr, &
    c_int, c_int32_t, c_int64_t, c_null_char, c_null_ptr, c_ptr
  use, intrinsic :: iso_fortran_env, only: int32, int64, real32, real64
  implicit none
  private

  ! Handles: variables of static storage (save, or of a module), initialised with a name.
  !   type(stipple_region), save :: solve = stipple_region('solve')
  !   type(stipple_name), save :: residual = stipple_name('residual', '1')    ! with its unit
  !   type(stipple_channel), save :: jobs = stipple_channel('jobs')
  ! In preprocessed source (.F90): stipple_region('solve', __FILE__, __LINE__). The name of a handle
  ! may also be set at run time, before its first use.
  type, public :: stipple_region
    character(len=64) :: name
    character(len=128) :: file = ''
    integer :: line = 0
    integer(c_int32_t), private :: id = 0
  end type
  type, public :: stipple_name
    character(len=64) :: name
    character(len=16) :: unit = ''
    integer(c_int32_t), private :: id = 0
  end type
  type, public :: stipple_channel
    character(len=64) :: name
    integer(c_int32_t), private :: id = 0
  end type

  ! The value that a counter of this process has from now on.
  interface stipple_counter
    module procedure counter_real32, counter_real64, counter_int32, counter_int64
  end interface
  ! call stipple_send(channel, key, bytes), call stipple_receive(channel, key, bytes[, waiting_since])
  interface stipple_send
    module procedure send_int32, send_int64
  end interface
  interface stipple_receive
    module procedure receive_int32, receive_int64
  end interface

  public :: stipple_region_begin, stipple_region_end, stipple_mark, stipple_counter, stipple_time, &
    stipple_send, stipple_receive, stipple_host, stipple_stop, stipple_start, stipple_stop_regions, &
    stipple_start_regions

  ! struct stipple_name, struct stipple_channel of user.h: without a name, the number counts.
  type, bind(c) :: c_name
    type(c_ptr) :: name, unit
    integer(c_int32_t) :: id
  end type
  type, bind(c) :: c_channel
    type(c_ptr) :: name
    integer(c_int32_t) :: id
  end type

  abstract interface
    function define_region_c(name, file, line, kind) bind(c) result(id)
      import :: c_char, c_int32_t
      character(kind=c_char), intent(in) :: name(*), file(*)
      integer(c_int32_t), value :: line, kind
      integer(c_int32_t) :: id
    end function
    function define_name_c(name, unit) bind(c) result(id)
      import :: c_char, c_int32_t
      character(kind=c_char), intent(in) :: name(*), unit(*)
      integer(c_int32_t) :: id
    end function
    function define_channel_c(name) bind(c) result(id)
      import :: c_char, c_int32_t
      character(kind=c_char), intent(in) :: name(*)
      integer(c_int32_t) :: id
    end function
    function event_c(region) bind(c) result(ticks)
      import :: c_int32_t, c_int64_t
      integer(c_int32_t), value :: region
      integer(c_int64_t) :: ticks
    end function
    function ticks_c() bind(c) result(ticks)
      import :: c_int64_t
      integer(c_int64_t) :: ticks
    end function
    subroutine mark_c(name) bind(c)
      import :: c_name
      type(c_name), intent(inout) :: name
    end subroutine
    subroutine counter_c(name, value) bind(c)
      import :: c_double, c_name
      type(c_name), intent(inout) :: name
      real(c_double), value :: value
    end subroutine
    subroutine send_c(channel, key, bytes) bind(c)
      import :: c_channel, c_int64_t
      type(c_channel), intent(inout) :: channel
      integer(c_int64_t), value :: key, bytes
    end subroutine
    subroutine receive_c(channel, key, bytes, waiting_since) bind(c)
      import :: c_channel, c_int64_t
      type(c_channel), intent(inout) :: channel
      integer(c_int64_t), value :: key, bytes, waiting_since
    end subroutine
    subroutine host_c() bind(c)
    end subroutine
    subroutine switch_c(on) bind(c)
      import :: c_int
      integer(c_int), value :: on
    end subroutine
    subroutine switch_regions_c(pattern, on) bind(c)
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: pattern(*)
      integer(c_int), value :: on
    end subroutine
  end interface

  interface
    function dlsym(handle, name) bind(c) result(address)
      import :: c_char, c_funptr, c_ptr
      type(c_ptr), value :: handle
      character(kind=c_char), intent(in) :: name(*)
      type(c_funptr) :: address
    end function
  end interface

  ! The runtime has all of these or none: `found` is set last, and the threads that look at the
  ! same time find the same.
  logical, volatile :: looked = .false., found = .false.
  procedure(define_region_c), pointer :: define_region => null()
  procedure(define_name_c), pointer :: define_name => null()
  procedure(define_channel_c), pointer :: define_channel => null()
  procedure(event_c), pointer :: enter => null(), leave => null()
  procedure(ticks_c), pointer :: ticks_now => null()
  procedure(mark_c), pointer :: record_mark => null()
  procedure(counter_c), pointer :: record_counter => null()
  procedure(send_c), pointer :: record_send => null()
  procedure(receive_c), pointer :: record_receive => null()
  procedure(host_c), pointer :: record_host => null()
  procedure(switch_c), pointer :: switch => null()
  procedure(switch_regions_c), pointer :: switch_regions => null()

contains

  function address_of(name) result(address)
    character(len=*), intent(in) :: name
    type(c_funptr) :: address
    address = dlsym(c_null_ptr, name // c_null_char)  ! RTLD_DEFAULT
  end function

  subroutine look_up()
    if (c_associated(address_of('stipple_record_receive'))) then
      call c_f_procpointer(address_of('stipple_define_region'), define_region)
      call c_f_procpointer(address_of('stipple_define_name'), define_name)
      call c_f_procpointer(address_of('stipple_define_channel'), define_channel)
      call c_f_procpointer(address_of('stipple_enter'), enter)
      call c_f_procpointer(address_of('stipple_leave'), leave)
      call c_f_procpointer(address_of('stipple_ticks'), ticks_now)
      call c_f_procpointer(address_of('stipple_record_mark'), record_mark)
      call c_f_procpointer(address_of('stipple_record_counter'), record_counter)
      call c_f_procpointer(address_of('stipple_record_send'), record_send)
      call c_f_procpointer(address_of('stipple_record_host'), record_host)
      call c_f_procpointer(address_of('stipple_switch'), switch)
      call c_f_procpointer(address_of('stipple_switch_regions'), switch_regions)
      call c_f_procpointer(address_of('stipple_record_receive'), record_receive)
      ! A call that the compiler cannot see into: the pointers are stored before it.
      found = c_associated(address_of('stipple_record_receive'))
    end if
    looked = .true.
  end subroutine

  logical function has_runtime()
    if (.not. looked) call look_up()
    has_runtime = found
  end function

  ! The handles come as `class`: what the caller builds for that on its stack keeps the compiler from
  ! making a jump of a call that ends a procedure, behind the procedure's own end. The volatile ticks
  ! do the same for a call that was inlined.

  ! The region begins or ends on this thread; it ends in the procedure that began it.
  subroutine stipple_region_begin(region)
    class(stipple_region), intent(inout) :: region
    integer(c_int64_t), volatile :: ticks
    if (.not. has_runtime()) return
    if (region%id == 0) region%id = define_region(trim(region%name) // c_null_char, &
      trim(region%file) // c_null_char, int(region%line, c_int32_t), 3_c_int32_t)
    if (region%id /= 0) ticks = enter(region%id)
  end subroutine
  subroutine stipple_region_end(region)
    class(stipple_region), intent(inout) :: region
    integer(c_int64_t), volatile :: ticks
    if (region%id == 0) return
    if (has_runtime()) ticks = leave(region%id)
  end subroutine

  ! The name's number; 0 when nothing is recorded.
  integer(c_int32_t) function id_of(name)
    class(stipple_name), intent(inout) :: name
    if (name%id == 0) name%id = define_name(trim(name%name) // c_null_char, &
      trim(name%unit) // c_null_char)
    id_of = name%id
  end function

  ! Marks a moment: the start of a phase, a decision.
  subroutine stipple_mark(name)
    class(stipple_name), intent(inout) :: name
    type(c_name) :: handle
    if (.not. has_runtime()) return
    handle = c_name(c_null_ptr, c_null_ptr, id_of(name))
    call record_mark(handle)
  end subroutine

  subroutine counter_real64(name, value)
    class(stipple_name), intent(inout) :: name
    real(real64), intent(in) :: value
    type(c_name) :: handle
    if (.not. has_runtime()) return
    handle = c_name(c_null_ptr, c_null_ptr, id_of(name))
    call record_counter(handle, real(value, c_double))
  end subroutine
  subroutine counter_real32(name, value)
    class(stipple_name), intent(inout) :: name
    real(real32), intent(in) :: value
    call counter_real64(name, real(value, real64))
  end subroutine
  subroutine counter_int32(name, value)
    class(stipple_name), intent(inout) :: name
    integer(int32), intent(in) :: value
    call counter_real64(name, real(value, real64))
  end subroutine
  subroutine counter_int64(name, value)
    class(stipple_name), intent(inout) :: name
    integer(int64), intent(in) :: value
    call counter_real64(name, real(value, real64))
  end subroutine

  ! The time, for stipple_receive; 0 without a runtime.
  integer(int64) function stipple_time()
    stipple_time = 0
    if (has_runtime()) stipple_time = ticks_now()
  end function

  function channel_of(channel) result(handle)
    class(stipple_channel), intent(inout) :: channel
    type(c_channel) :: handle
    if (channel%id == 0) channel%id = define_channel(trim(channel%name) // c_null_char)
    handle = c_channel(c_null_ptr, channel%id)
  end function

  ! A message from one thread of this process to another: send just before it is handed over, receive
  ! just after it was taken; see user.h.
  subroutine send_int64(channel, key, bytes)
    class(stipple_channel), intent(inout) :: channel
    integer(int64), intent(in) :: key, bytes
    type(c_channel) :: handle
    if (.not. has_runtime()) return
    handle = channel_of(channel)
    call record_send(handle, key, bytes)
  end subroutine
  subroutine send_int32(channel, key, bytes)
    class(stipple_channel), intent(inout) :: channel
    integer(int32), intent(in) :: key, bytes
    call send_int64(channel, int(key, int64), int(bytes, int64))
  end subroutine
  subroutine receive_int64(channel, key, bytes, waiting_since)
    class(stipple_channel), intent(inout) :: channel
    integer(int64), intent(in) :: key, bytes
    integer(int64), intent(in), optional :: waiting_since
    type(c_channel) :: handle
    integer(c_int64_t) :: since
    if (.not. has_runtime()) return
    handle = channel_of(channel)
    since = 0
    if (present(waiting_since)) since = waiting_since
    call record_receive(handle, key, bytes, since)
  end subroutine
  subroutine receive_int32(channel, key, bytes, waiting_since)
    class(stipple_channel), intent(inout) :: channel
    integer(int32), intent(in) :: key, bytes
    integer(int64), intent(in), optional :: waiting_since
    call receive_int64(channel, int(key, int64), int(bytes, int64), waiting_since)
  end subroutine

  ! This process is the host: it hands out work and is shown apart, last.
  subroutine stipple_host()
    if (has_runtime()) call record_host()
  end subroutine

  ! Switch recording off and on again, in all threads of this process.
  subroutine stipple_stop()
    if (has_runtime()) call switch(0_c_int)
  end subroutine
  subroutine stipple_start()
    if (has_runtime()) call switch(1_c_int)
  end subroutine

  ! The same for the functions whose names match a pattern of a filter file.
  subroutine stipple_stop_regions(pattern)
    character(len=*), intent(in) :: pattern
    if (has_runtime()) call switch_regions(pattern // c_null_char, 0_c_int)
  end subroutine
  subroutine stipple_start_regions(pattern)
    character(len=*), intent(in) :: pattern
    if (has_runtime()) call switch_regions(pattern // c_null_char, 1_c_int)
  end subroutine
end module
