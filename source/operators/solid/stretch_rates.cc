// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/base/interleaved.h>
#include <perideal/operators/solid/stretch_rates.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  StretchRates<dim>::StretchRates(const Nodes<dim>    &nodes,
                                  const BondEnds<dim> &ends,
                                  const Expression    &factor,
                                  const bool           is_full)
    : ends(ends)
    , of_rate(factor)
    , is_full(is_full)
  {
    for (State *const state : {&now, &before})
      {
        state->displacement.reinit(interleaved(*nodes.partitioner(), dim));
        if (ends.images)
          state->images.resize(dim * ends.images->size());
      }
  }


  template <int dim>
  void StretchRates<dim>::find_images(State &state) const
  {
    ends.find(state.displacement.begin());
    for (unsigned int k = 0; k < state.images.size() / dim; ++k)
      std::copy_n(ends.images->value(k), dim, state.images.begin() + dim * k);
  }


  template <int dim>
  void StretchRates<dim>::take(const Vector &u, const double t)
  {
    if (t > now.time)
      {
        std::swap(before, now);
        now.time = t;
      }
    now.displacement.set_ghost_state(false);
    std::copy(u.begin(), u.begin() + u.locally_owned_size(), now.displacement.begin());
    now.displacement.update_ghost_values();
    find_images(now);
    if (!begun) // no step has led to it that is known
      before.displacement = now.displacement;
    begun = true;
  }


  template <int dim>
  double StretchRates<dim>::stretch(const State       &state,
                                    const unsigned int i,
                                    const unsigned int j) const
  {
    const Tensor<1, dim> xi  = ends.vector(i, j);
    const double *const  own = state.displacement.begin() + dim * i;
    const double *const  far = ends.is_fictitious(j) ? state.images.data() + dim * ends.image(j) :
                                                       state.displacement.begin() + dim * j;
    Tensor<1, dim>       change;
    for (unsigned int d = 0; d < dim; ++d)
      change[d] = far[d] - own[d];
    return is_full ? (xi + change).norm() / xi.norm() - 1. : (xi * change) / xi.norm_square();
  }


  template <int dim>
  double StretchRates<dim>::factor(const unsigned int i, const unsigned int j) const
  {
    if (!(now.time > before.time))
      return 1.;
    const double change = stretch(now, i, j) - stretch(before, i, j),
                 rate   = std::max(0., change / (now.time - before.time)),
                 found  = of_rate.value(Point<1>(rate));
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
    archive.exchange("rates have begun", begun);
    for (const auto &[name, state] :
         {std::make_pair(std::string("before"), &before), std::make_pair(std::string("now"), &now)})
      {
        archive.exchange("time of rates, " + name, state->time);
        state->displacement.set_ghost_state(false);
        archive.exchange("displacement of rates, " + name, state->displacement, keys);
        state->displacement.update_ghost_values();
        find_images(*state);
      }
  }


  PERIDEAL_INSTANTIATE_CLASS(class StretchRates);
} // namespace PeriDeal
