/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Copyright (C) 2026 the PeriDeal authors */

/*
 * Drucker and Prager's plasticity with a flow that is not associated: with von Mises' stress q and
 * the mean stress p, tension positive, it yields at q + a p = c + H kappa and flows along the
 * gradient of q + b p, so that the tangent is not symmetric. Stresses of the apex are not met.
 *
 * PROPS: E, nu, c, H, a, b. STATEV: kappa.
 */

#include "arguments.h"

UMAT
{
  const double G = 0.5 * props[0] / (1. + props[1]), K = props[0] / 3. / (1. - 2. * props[1]);
  const double c = props[2], H = props[3], a = props[4], b = props[5];
  const int    n = *ntens;
  double       p = 0., q = 0., change = 0.;
  double       s[6], flow[6]; /* flow: the gradient of q */
  for (int k = 0; k < 3; ++k)
    {
      p += stress[k] / 3.;
      change += dstran[k];
    }
  for (int k = 0; k < n; ++k)
    {
      s[k] = k < 3 ? stress[k] - p + 2. * G * (dstran[k] - change / 3.) : stress[k] + G * dstran[k];
      q += (k < 3 ? 1.5 : 3.) * s[k] * s[k];
    }
  p += K * change;
  q                  = sqrt(q);
  const double above = q + a * p - c - H * statev[0], M = 3. * G + a * b * K + H;
  const double grown = above > 0. ? above / M : 0.,
               left  = above > 0. ? 1. - 3. * G * grown / q : 1.;
  for (int k = 0; k < n; ++k)
    {
      flow[k]   = above > 0. ? 1.5 * s[k] / q : 0.;
      stress[k] = left * s[k] + (k < 3 ? p - K * b * grown : 0.);
    }
  for (int k = 0; k < n; ++k)
    for (int l = 0; l < n; ++l)
      {
        const double normal = k < 3 && l < 3;
        double       slope  = normal * (K - 2. / 3. * G * left) + (k != l ? 0. :
                                                                   k < 3  ? 2. :
                                                                            1.) *
                                                             G * left;
        if (above > 0.)
          slope += 4. * G * G * grown / q * flow[k] * flow[l] -
                   (2. * G * flow[k] + K * b * (k < 3)) * (2. * G * flow[l] + K * a * (l < 3)) / M;
        ddsdde[k + n * l] = slope;
      }
  statev[0] += grown;
  *spd += (c + H * statev[0] - (a - b) * (p - K * b * grown)) * grown;
}
