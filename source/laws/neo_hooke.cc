// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/laws/linear_stress.h>
#include <perideal/laws/neo_hooke.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** det(1 + 2 E) - 1, in the first two directions or in all. */
    double square_in_plane(const StressLaw::Tensor &E)
    {
      return 2. * (E[0][0] + E[1][1]) + 4. * (E[0][0] * E[1][1] - E[0][1] * E[0][1]);
    }


    double square_in_space(const StressLaw::Tensor &E)
    {
      const double t = trace(E);
      return 2. * t + 2. * (t * t - E * E) + 8. * determinant(E);
    }


    /**
     * The strain out of the plane that leaves no stress there: the one root of what S_33 is, times
     * C_33, which grows with it and is concave.
     */
    double strain_out_of_plane(const StressLaw::Tensor &E, const double bulk, const double shear)
    {
      constexpr unsigned int most     = 50;
      const double           of_plane = square_in_plane(E), in_plane = E[0][0] + E[1][1],
                   ratio = (bulk - 2. / 3. * shear) / (bulk + 4. / 3. * shear);
      double e           = 0.5 * std::expm1(-ratio * std::log1p(of_plane));
      for (unsigned int k = 0; k < most; ++k)
        {
          const double c = 1. + 2. * e, J2 = (1. + of_plane) * c,
                       of_shape = shear * std::pow(J2, -1. / 3.),
                       deviator = 2. / 3. * (2. * e - in_plane),
                       value =
                         of_shape * deviator + 0.5 * bulk * (of_plane + 2. * e * (1. + of_plane)),
                       slope  = of_shape * (4. - 2. * deviator / c) / 3. + bulk * (1. + of_plane),
                       next   = std::max(e - value / slope, 0.5 * (c / 8. - 1.));
          const bool is_there = !(std::abs(next - e) > 1e-10 * std::abs(next));
          e                   = next; // to the square of that
          if (is_there)
            break;
        }
      return e;
    }


    /** The derivative of S by E, X = C^-1. */
    StressLaw::Tangent neo_hooke_stiffness(const StressLaw::Tensor &X,
                                           const double             trace_of_C,
                                           const double             J2,
                                           const double             of_shape,
                                           const double             bulk)
    {
      StressLaw::Tangent result;
      const double       both = 2. / 9. * of_shape * trace_of_C + bulk * J2,
                   mixed      = 0.5 * (2. / 3. * of_shape * trace_of_C - bulk * (J2 - 1.));
      for (unsigned int a = 0; a < 3; ++a)
        for (unsigned int b = a; b < 3; ++b)
          for (unsigned int c = 0; c < 3; ++c)
            for (unsigned int d = c; d < 3; ++d)
              result[a][b][c][d] =
                both * X[a][b] * X[c][d] + mixed * (X[a][c] * X[b][d] + X[a][d] * X[b][c]) -
                2. / 3. * of_shape * ((a == b ? X[c][d] : 0.) + (c == d ? X[a][b] : 0.));
      return result;
    }
  } // namespace


  StressLaw::Response NeoHooke::update(const Trial &trial, double *, Tangent *tangent) const
  {
    const double bulk = trial.parameters[0], shear = trial.parameters[1];
    const bool   plane = kind == StressState::plane_stress;
    Tensor       E     = trial.strain;
    if (plane)
      {
        E[0][2] = E[1][2] = 0.;
        E[2][2]           = strain_out_of_plane(E, bulk, shear);
      }
    Response     result;
    const double j = square_in_space(E), t = trace(E), log_J2 = std::log1p(j),
                 of_shape = shear * std::exp(-log_J2 / 3.);
    const Tensor X        = invert(unit_symmetric_tensor<3>() + 2. * E);
    // C^-1 times what commutes with it.
    result.stress = symmetrize(dealii::Tensor<2, 3>(X) *
                               dealii::Tensor<2, 3>(2. * of_shape * deviator(E) +
                                                    0.5 * bulk * j * unit_symmetric_tensor<3>()));
    result.stored = 0.5 * shear * ((3. + 2. * t) * std::expm1(-log_J2 / 3.) + 2. * t) +
                    0.25 * bulk * (j - log_J2);
    if (plane)
      {
        result.stress[2][2] = 0.;
        result.stretch      = std::sqrt(1. + 2. * E[2][2]);
      }
    if (tangent == nullptr)
      return result;
    *tangent = neo_hooke_stiffness(X, 3. + 2. * t, 1. + j, of_shape, bulk);
    if (plane)
      *tangent = in_plane_stress(*tangent);
    return result;
  }
} // namespace PeriDeal
