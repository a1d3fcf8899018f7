// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/base/interleaved.h>
#include <perideal/operators/solid/stretch_rates.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  StretchRates<dim>::StretchRates(const Nodes<dim> &nodes,
                                  const Expression &factor,
                                  const bool        is_full)
    : of_rate(factor)
    , is_full(is_full)
    , now(interleaved(*nodes.partitioner(), dim))
    , before(now)
  {}


  template <int dim>
  void StretchRates<dim>::take(const Vector &u, const double t)
  {
    if (t > time)
      {
        before.swap(now);
        time_before = time;
        time        = t;
      }
    now.set_ghost_state(false);
    std::copy(u.begin(), u.begin() + u.locally_owned_size(), now.begin());
    now.update_ghost_values();
  }


  template <int dim>
  double StretchRates<dim>::stretch(const Vector         &u,
                                    const unsigned int    i,
                                    const unsigned int    j,
                                    const Tensor<1, dim> &xi) const
  {
    Tensor<1, dim> change;
    for (unsigned int d = 0; d < dim; ++d)
      change[d] = u.local_element(dim * j + d) - u.local_element(dim * i + d);
    return is_full ? (xi + change).norm() / xi.norm() - 1. : (xi * change) / xi.norm_square();
  }


  template <int dim>
  double StretchRates<dim>::factor(const unsigned int    i,
                                   const unsigned int    j,
                                   const Tensor<1, dim> &xi) const
  {
    if (!(time > time_before))
      return 1.;
    const double rate =
      std::max(0., (stretch(now, i, j, xi) - stretch(before, i, j, xi)) / (time - time_before));
    const double found = of_rate.value(Point<1>(rate));
    if (found < 1.)
      report_formula_error(
        "'Rate factor' in section 'Material' is " + number_text(found) + " at a rate of " +
        number_text(rate) +
        ", less than 1: limits are those of slow loads, which rates may raise only.");
    return found;
  }


  template <int dim>
  void StretchRates<dim>::exchange(Archive &archive, const NodeKeys &keys)
  {
    archive.exchange("time of rates", time);
    archive.exchange("time before", time_before);
    for (const auto &[name, vector] : {std::make_pair("displacement of rates", &now),
                                       std::make_pair("displacement before", &before)})
      {
        vector->set_ghost_state(false);
        archive.exchange(name, *vector, keys);
        vector->update_ghost_values();
      }
  }


  PERIDEAL_INSTANTIATE_CLASS(class StretchRates);
} // namespace PeriDeal
