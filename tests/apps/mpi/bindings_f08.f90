! SPDX-License-Identifier: MIT
! use mpi_f08: the same calls as bindings_f77.f, by the typed bindings.
program bindings
  use mpi_f08
  implicit none
  integer :: rank, data(4)
  type(MPI_Request) :: requests(2)
  call MPI_Init()
  call MPI_Comm_rank(MPI_COMM_WORLD, rank)
  data = rank
  if (rank == 0) then
    call MPI_Send(data, 3, MPI_INTEGER, 1, 7, MPI_COMM_WORLD)
  else
    call MPI_Recv(data, 4, MPI_INTEGER, MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE)
  end if
  call MPI_Irecv(data(1), 1, MPI_DOUBLE_PRECISION, 1 - rank, 8, MPI_COMM_WORLD, requests(1))
  call MPI_Isend(data(3), 1, MPI_DOUBLE_PRECISION, 1 - rank, 8, MPI_COMM_WORLD, requests(2))
  call MPI_Waitall(2, requests, MPI_STATUSES_IGNORE)
  call MPI_Allreduce(MPI_IN_PLACE, data, 1, MPI_INTEGER, MPI_SUM, MPI_COMM_WORLD)
  call MPI_Finalize()
end program
