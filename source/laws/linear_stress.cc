// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/laws/elasticity.h>
#include <perideal/laws/linear_stress.h>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    using Strain                     = StressLaw::Tensor;
    constexpr unsigned int n_entries = Strain::n_independent_components;
  } // namespace


  StressLaw::Response LinearStress::update(const Trial &trial, double *, Tangent *tangent) const
  {
    Response      result;
    const double *c = trial.parameters;
    for (unsigned int a = 0; a < n_entries; ++a)
      for (unsigned int b = a; b < n_entries; ++b, ++c)
        {
          // Entries beside the diagonal stand for two.
          result.stress.access_raw_entry(a) +=
            (b < 3 ? 1. : 2.) * *c * trial.strain.access_raw_entry(b);
          if (b > a)
            result.stress.access_raw_entry(b) +=
              (a < 3 ? 1. : 2.) * *c * trial.strain.access_raw_entry(a);
        }
    result.stored = 0.5 * (result.stress * trial.strain);
    if (tangent == nullptr)
      return result;
    c = trial.parameters;
    for (unsigned int a = 0; a < n_entries; ++a)
      for (unsigned int b = a; b < n_entries; ++b, ++c)
        {
          const auto row    = Strain::unrolled_to_component_indices(a),
                     column = Strain::unrolled_to_component_indices(b);
          (*tangent)[row[0]][row[1]][column[0]][column[1]] = *c;
          (*tangent)[column[0]][column[1]][row[0]][row[1]] = *c;
        }
    return result;
  }


  std::vector<double> LinearStress::parameters(const Tangent &stiffness)
  {
    std::vector<double> list;
    for (unsigned int a = 0; a < n_entries; ++a)
      for (unsigned int b = a; b < n_entries; ++b)
        {
          const auto row    = Strain::unrolled_to_component_indices(a),
                     column = Strain::unrolled_to_component_indices(b);
          list.push_back(stiffness[row[0]][row[1]][column[0]][column[1]]);
        }
    return list;
  }


  StressLaw::Tangent isotropic_stiffness(const Moduli &moduli, const StressState kind)
  {
    StressLaw::Tangent C;
    const bool         plane  = kind == StressState::plane_stress;
    const double       lambda = plane ? plane_lambda(moduli, PlaneState::stress) : moduli.lambda();
    const unsigned int n      = plane ? 2 : 3;
    for (unsigned int a = 0; a < n; ++a)
      for (unsigned int b = 0; b < n; ++b)
        {
          C[a][a][b][b] = lambda + (a == b ? 2. * moduli.shear : 0.);
          if (a < b)
            C[a][b][a][b] = moduli.shear;
        }
    return C;
  }


  StressLaw::Tangent in_plane_stress(const StressLaw::Tangent &stiffness)
  {
    StressLaw::Tangent result;
    for (unsigned int a = 0; a < 2; ++a)
      for (unsigned int b = a; b < 2; ++b)
        for (unsigned int c = 0; c < 2; ++c)
          for (unsigned int d = c; d < 2; ++d)
            result[a][b][c][d] = stiffness[a][b][c][d] - stiffness[a][b][2][2] *
                                                           stiffness[2][2][c][d] /
                                                           stiffness[2][2][2][2];
    return result;
  }
} // namespace PeriDeal
