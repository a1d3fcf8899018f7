// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/operators/solid/relaxing_forces.h>

#include <algorithm>
#include <array>
#include <string>

namespace PeriDeal
{
  namespace
  {
    /** The factors of value(bond, history), which is linear. */
    template <typename Value>
    std::vector<double> factors_of(const unsigned int n_history, const Value &value)
    {
      std::vector<double> factors, history(n_history, 0.);
      factors.push_back(value(BondValues{1., 1.}, history));
      for (unsigned int k = 0; k < n_history; ++k)
        {
          std::fill(history.begin(), history.end(), 0.);
          history[k] = 1.;
          factors.push_back(value(BondValues{0., 1.}, history));
        }
      return factors;
    }


    /** Some unknowns in a row, of which sums stay near. */
    constexpr unsigned int block_size = 512;

    using Block = std::array<double, block_size>;

    /** sum = factors times a state and its histories, n unknowns from the first one. */
    void add_up_block(double                    *sum,
                      const std::vector<double> &factors,
                      const Vector              &state,
                      const std::vector<Vector> &histories,
                      const unsigned int         first,
                      const unsigned int         n)
    {
      const double *const of_state = state.begin() + first;
      const double        factor   = factors[0];
      for (unsigned int i = 0; i < n; ++i)
        sum[i] = factor * of_state[i];
      for (unsigned int k = 0; k < histories.size(); ++k)
        {
          const double *const of_history = histories[k].begin() + first;
          const double        of         = factors[k + 1];
          if (of == 0.)
            continue;
          for (unsigned int i = 0; i < n; ++i)
            sum[i] += of * of_history[i];
        }
    }


    /** visit(first, n) of blocks of owned unknowns. */
    template <typename Visit>
    void for_each_block(const Vector &layout, const Visit &visit)
    {
      const unsigned int all = layout.locally_owned_size();
      for (unsigned int first = 0; first < all; first += block_size)
        visit(first, std::min(block_size, all - first));
    }
  } // namespace


  RelaxingForces::RelaxingForces(const Material::Law &law, const Vector &layout)
    : steps(law, {"", MPI_COMM_SELF}) // not of the user
    , of_displacements(steps.n_history(), layout)
    , of_forces(steps.n_history(), layout)
  {
    for (auto *list : {&of_displacements, &of_forces})
      for (Vector &history : *list)
        history = 0.;
    set_time(0.);
  }


  void RelaxingForces::set_time(const double t) const
  {
    steps.set_time(t);
    const unsigned int n = steps.n_history();
    factors.effective =
      factors_of(n, [&](const BondValues &bond, const std::vector<double> &history) {
        return steps->effective(bond, history.data());
      });
    for (const bool dissipated : {false, true})
      {
        std::vector<Factors> &parts = dissipated ? factors.dissipated : factors.stored;
        parts.resize(steps->n_parts(dissipated));
        for (unsigned int k = 0; k < parts.size(); ++k)
          parts[k] = factors_of(n, [&](const BondValues &bond, const std::vector<double> &history) {
            return steps->part(k, dissipated, bond, history.data());
          });
      }
    factors.accepted.resize(n);
    for (unsigned int k = 0; k < n; ++k)
      factors.accepted[k] = factors_of(n, [&](const BondValues &bond, std::vector<double> history) {
        steps->accept(bond, history.data());
        return history[k];
      });
  }


  void RelaxingForces::add_up(Vector                    &sum,
                              const Factors             &of,
                              const Vector              &state,
                              const std::vector<Vector> &histories)
  {
    Block block;
    for_each_block(sum, [&](const unsigned int first, const unsigned int n) {
      add_up_block(block.data(), of, state, histories, first, n);
      double *const to = sum.begin() + first;
      for (unsigned int i = 0; i < n; ++i)
        to[i] += block[i];
    });
  }


  void RelaxingForces::add_change(Vector &y, const Vector &s) const
  {
    Factors change(factors.effective);
    change[0] -= 1.;
    add_up(y, change, s, of_forces);
  }


  Vector RelaxingForces::with_ghosts(const Factors &of, const Vector &u) const
  {
    Vector sum(u.get_partitioner());
    add_up(sum, of, u, of_displacements);
    sum.update_ghost_values();
    return sum;
  }


  Vector RelaxingForces::effective(const Vector &u) const
  {
    return with_ghosts(factors.effective, u);
  }


  std::vector<Vector> RelaxingForces::stored_parts(const Vector &u) const
  {
    std::vector<Vector> list;
    for (const Factors &part : factors.stored)
      list.push_back(with_ghosts(part, u));
    return list;
  }


  double RelaxingForces::energy(const Vector &u, const Vector &s, const bool dissipated) const
  {
    double sum = 0.;
    Block  of_u, of_s;
    for_each_block(u, [&](const unsigned int first, const unsigned int n) {
      for (const Factors &part : dissipated ? factors.dissipated : factors.stored)
        {
          add_up_block(of_u.data(), part, u, of_displacements, first, n);
          add_up_block(of_s.data(), part, s, of_forces, first, n);
          double of_block = 0.;
          for (unsigned int i = 0; i < n; ++i)
            of_block += of_u[i] * of_s[i];
          sum += 0.5 * of_block;
        }
    });
    return dealii::Utilities::MPI::sum(sum, u.get_mpi_communicator());
  }


  void RelaxingForces::accept(const Vector &u, const Vector &s, const double t)
  {
    set_time(t);
    std::vector<Block> blocks(of_forces.size());
    const auto         take = [&](std::vector<Vector> &histories, const Vector &state) {
      for_each_block(state, [&](const unsigned int first, const unsigned int n) {
        for (unsigned int k = 0; k < blocks.size(); ++k)
          add_up_block(blocks[k].data(), factors.accepted[k], state, histories, first, n);
        for (unsigned int k = 0; k < blocks.size(); ++k)
          std::copy_n(blocks[k].begin(), n, histories[k].begin() + first);
      });
    };
    take(of_displacements, u);
    take(of_forces, s);
    steps.accept(t);
    set_time(t);
  }


  void RelaxingForces::exchange(Archive &archive, const NodeKeys &keys)
  {
    steps.exchange(archive);
    for (unsigned int k = 0; k < of_forces.size(); ++k)
      {
        archive.exchange("history " + std::to_string(k), of_displacements[k], keys);
        archive.exchange("forces of history " + std::to_string(k), of_forces[k], keys);
      }
    if (archive.loads())
      set_time(steps.last());
  }


  std::size_t RelaxingForces::memory_consumption() const
  {
    std::size_t sum = 0;
    for (const auto *list : {&of_displacements, &of_forces})
      for (const Vector &history : *list)
        sum += history.memory_consumption();
    return sum;
  }
} // namespace PeriDeal
