// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

/*
 * What Abaqus supplies to a UMAT, exported for shared libraries under the names that Fortran gives
 * them. Lists of a tensor are in the order 11, 22, 33, 12, 13, 23, of which there are NDI and NSHR;
 * matrices are column-major.
 */
extern "C"
{
  /** SINV: a third of the trace, and sqrt(3/2 s:s) of the deviator s. */
  void sinv_(const double *stress, double *sinv1, double *sinv2, const int *ndi, const int *nshr);

  /** SPRINC: principal values PS(3), falling. LSTR = 1: stresses, 2: strains (12 = 2 eps_12). */
  void sprinc_(const double *s, double *ps, const int *lstr, const int *ndi, const int *nshr);

  /** SPRIND: principal values, and in AN(k, :) the direction of the k-th. */
  void sprind_(const double *s,
               double       *ps,
               double       *an,
               const int    *lstr,
               const int    *ndi,
               const int    *nshr);

  /** ROTSIG: R S R^T. */
  void rotsig_(const double *s,
               const double *r,
               double       *sprime,
               const int    *lstr,
               const int    *ndi,
               const int    *nshr);

  /** XIT: end the run, with a message. */
  void xit_();
}
