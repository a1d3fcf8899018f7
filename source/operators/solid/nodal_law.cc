// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/operators/solid/nodal_law.h>

#include <string>

namespace PeriDeal
{
  NodalLaw::NodalLaw(const Material::Law &law, const Vector &layout)
    : steps(law, {"", MPI_COMM_SELF}) // not of the user
    , histories(steps.n_history(), layout)
  {
    for (Vector &history : histories)
      {
        history = 0.;
        history.update_ghost_values();
      }
  }


  template <typename Act>
  void NodalLaw::for_each(const Vector &u, const Act &act) const
  {
    const auto &layout = *u.get_partitioner();
    of_one.resize(histories.size());
    for (unsigned int i = 0; i < layout.locally_owned_size() + layout.n_ghost_indices(); ++i)
      {
        for (unsigned int k = 0; k < of_one.size(); ++k)
          of_one[k] = histories[k].local_element(i);
        act(i, BondValues{u.local_element(i), 1.}, of_one);
      }
  }


  void NodalLaw::find_change(Vector &change, const Vector &u) const
  {
    for_each(u, [&](const unsigned int i, const BondValues &value, const auto &history) {
      change.local_element(i) = steps->effective(value, history.data()) - value.product;
    });
    change.set_ghost_state(true);
  }


  void NodalLaw::find_part(Vector            &part,
                           const Vector      &u,
                           const unsigned int k,
                           const bool         dissipated) const
  {
    for_each(u, [&](const unsigned int i, const BondValues &value, const auto &history) {
      part.local_element(i) = steps->part(k, dissipated, value, history.data());
    });
    part.set_ghost_state(true);
  }


  void NodalLaw::accept(const Vector &u, const double t)
  {
    for_each(u, [&](const unsigned int i, const BondValues &value, auto &history) {
      steps->accept(value, history.data());
      for (unsigned int k = 0; k < histories.size(); ++k)
        histories[k].local_element(i) = history[k];
    });
    steps.accept(t);
  }


  void NodalLaw::exchange(Archive &archive, const NodeKeys &keys)
  {
    steps.exchange(archive);
    for (unsigned int k = 0; k < histories.size(); ++k)
      {
        histories[k].set_ghost_state(false);
        archive.exchange("history " + std::to_string(k), histories[k], keys);
        histories[k].update_ghost_values();
      }
  }
} // namespace PeriDeal
