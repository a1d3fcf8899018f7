/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Copyright (C) 2026 the PeriDeal authors */

/*
 * The built-in law `hyperelastic` (NeoHooke) in the deformed body: with b = J^(-2/3) F F^T, G and K,
 *
 *   sigma = G/J dev b + K/2 (J - 1/J) 1.
 *
 * PROPS: K, G.
 */

#include "arguments.h"

static const int ends[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

UMAT
{
  const double  bulk = props[0], shear = props[1];
  const double *F = dfgrd1; /* by columns */
  const double  J = F[0] * (F[4] * F[8] - F[5] * F[7]) - F[3] * (F[1] * F[8] - F[2] * F[7]) +
                   F[6] * (F[1] * F[5] - F[2] * F[4]);
  const double size = pow(J, -2. / 3.);
  double       b[3][3], trace = 0.;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      {
        b[i][j] = 0.;
        for (int k = 0; k < 3; ++k)
          b[i][j] += size * F[i + 3 * k] * F[j + 3 * k];
      }
  for (int i = 0; i < 3; ++i)
    trace += b[i][i];
  for (int p = 0; p < *ntens; ++p)
    {
      const int i = ends[p][0], j = ends[p][1];
      stress[p] = shear / J * (b[i][j] - (i == j ? trace / 3. : 0.)) +
                  (i == j ? 0.5 * bulk * (J - 1. / J) : 0.);
      for (int q = 0; q < *ntens; ++q)
        {
          const int k = ends[q][0], l = ends[q][1];
          ddsdde[p + *ntens * q] = shear / J *
                                     (0.5 * ((i == k) * b[j][l] + b[i][k] * (j == l) +
                                             (i == l) * b[j][k] + b[i][l] * (j == k)) -
                                      2. / 3. * ((i == j) * b[k][l] + b[i][j] * (k == l)) +
                                      2. / 9. * trace * (i == j) * (k == l)) +
                                   bulk * J * (i == j) * (k == l);
        }
    }
  *sse = (0.5 * shear * (trace - 3.) + 0.5 * bulk * (0.5 * (J * J - 1.) - log(J))) / J;
}
