/* SPDX-License-Identifier: MIT */
/* A host deals out bundles to the nodes, one whenever a node asks; the host is the last rank. */
#ifndef STIPPLE_TESTS_CAUSES_DEAL_H
#define STIPPLE_TESTS_CAUSES_DEAL_H

#include "ranks.h"
#include "stipple/user.h"

REGION void KeepAccount(double ms) {
  if (ms > 0) Sleep(ms);
}
REGION void Trace(double ms) { Sleep(ms); }

REGION void Host(int bundles, double account_ms) {
  stipple_host();
  for (int next = 0; next < bundles + ranks - 1; ++next) {
    const int node = Receive(MPI_ANY_SOURCE);
    const int bundle = next < bundles ? next : -1;
    if (bundle >= 0) KeepAccount(account_ms);
    MPI_Send(&bundle, 1, MPI_INT, node, 1, MPI_COMM_WORLD);
  }
}

/* Tracing a bundle takes bundle_ms, the last one last_ms. */
REGION void Node(int bundles, double bundle_ms, double last_ms) {
  for (int bundle = 0; bundle >= 0;) {
    Send(ranks - 1);
    MPI_Recv(&bundle, 1, MPI_INT, ranks - 1, 1, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    if (bundle >= 0) Trace(bundle == bundles - 1 ? last_ms : bundle_ms);
  }
}

#endif
