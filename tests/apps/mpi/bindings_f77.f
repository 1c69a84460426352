! SPDX-License-Identifier: MIT
! mpif.h: a message with an ignored status, requests completed by Waitall, a collective.
      program bindings
      implicit none
      include 'mpif.h'
      integer rank, ierror, data(4), requests(2)
      call mpi_init(ierror)
      call mpi_comm_rank(MPI_COMM_WORLD, rank, ierror)
      data = rank
      if (rank == 0) then
        call mpi_send(data, 3, MPI_INTEGER, 1, 7,
     &                MPI_COMM_WORLD, ierror)
      else
        call mpi_recv(data, 4, MPI_INTEGER, MPI_ANY_SOURCE, MPI_ANY_TAG,
     &                MPI_COMM_WORLD, MPI_STATUS_IGNORE, ierror)
      end if
      call mpi_irecv(data(1), 1, MPI_DOUBLE_PRECISION, 1 - rank, 8,
     &               MPI_COMM_WORLD, requests(1), ierror)
      call mpi_isend(data(3), 1, MPI_DOUBLE_PRECISION, 1 - rank, 8,
     &               MPI_COMM_WORLD, requests(2), ierror)
      call mpi_waitall(2, requests, MPI_STATUSES_IGNORE, ierror)
      call mpi_allreduce(MPI_IN_PLACE, data, 1, MPI_INTEGER, MPI_SUM,
     &                   MPI_COMM_WORLD, ierror)
      call mpi_finalize(ierror)
      end program
