// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/bond_state.h>
#include <perideal/operators/solid/unit_bonds.h>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /**
   * Bonds that are stored, in rows of owned nodes, each at both ends: W xi, the spring of
   * LinearPeridynamicSolid, a column; packed, a column and which bond of its family it is, from
   * which the others follow. A bond that is gone stays in its row and bears nothing.
   */
  template <int dim>
  struct BondRows
  {
    /** Close the row of a node; what has been added since the last one is in it. */
    void end_row(const unsigned int node)
    {
      nodes.push_back(node);
      starts.push_back(neighbors.size());
    }

    std::size_t size() const
    {
      return neighbors.size();
    }

    bool is_packed() const
    {
      return may_pack && !units.empty() && units.size() < BondCode::gone;
    }

    /** Some nodes have no row, or had none at first: a lattice knows their bonds. */
    bool leaves_out() const
    {
      return !units.empty();
    }

    /** The node in whose row a bond is. */
    unsigned int node_of(const std::size_t k) const
    {
      return nodes[std::upper_bound(starts.begin(), starts.end(), k) - starts.begin() - 1];
    }

    /** A bond that was whole bears nothing any more. @param t since when */
    void mark(const std::size_t k, const BondState::Mark mark, const double t)
    {
      if (state.size() < size())
        state.resize(size());
      state.mark(k, mark, t);
      if (is_packed())
        codes[k] = BondCode::gone;
      else
        {
          springs[k] = 0.;
          moments[k] = dealii::Tensor<1, dim>();
        }
      if (!nonlinear.lengths.empty())
        nonlinear.lengths[k] = nonlinear.across[k] = 0.;
    }

    /** A bond bears this times what it has borne. Rows are not packed. */
    void weaken(const std::size_t k, const double factor)
    {
      moments[k] *= factor;
      springs[k] /= factor;
      if (!nonlinear.lengths.empty())
        {
          nonlinear.lengths[k] *= factor;
          nonlinear.across[k] *= factor;
        }
    }

    /** W x of all bonds of the undeformed body, which full kinematics need. */
    void keep_lengths()
    {
      nonlinear.across.resize(size(), 0.);
      nonlinear.lengths.reserve(size());
      for (const dealii::Tensor<1, dim> &p : moments)
        nonlinear.lengths.push_back(p.norm());
    }

    std::size_t memory_consumption() const
    {
      // What has been reserved and not written to takes no memory.
      return (nodes.capacity() + (is_packed() ? neighbors.capacity() : neighbors.size())) *
               sizeof(unsigned int) +
             starts.capacity() * sizeof(std::size_t) + moments.size() * sizeof(moments[0]) +
             (springs.size() + squares.size() + nonlinear.lengths.capacity() +
              nonlinear.across.capacity() + nonlinear.slopes.capacity() +
              nonlinear.history.capacity()) *
               sizeof(double) +
             codes.capacity() * sizeof(BondCode::Code) + parts.capacity() * sizeof(parts[0]) +
             units.capacity() * sizeof(units[0]) + state.memory_consumption();
    }

    std::vector<unsigned int>           nodes; // one a row
    std::vector<std::size_t>            starts{0};
    std::vector<unsigned int>           neighbors; // BondEnds
    std::vector<dealii::Tensor<1, dim>> moments;   // W xi, of the tangent W x Y/|Y|
    std::vector<double>                 springs;   // at first W x^2
    std::vector<double>                 squares;   // W x^2, if they are asked for later

    /** What forces that are not linear need, or empty. */
    struct
    {
      std::vector<double> lengths, across; // W x; force over length in the tangent
      std::vector<double> slopes, history; // of a BondLaw: in the tangent; its own numbers
    } nonlinear;

    // Where rows are packed, instead of these:
    std::vector<BondCode::Code>                 codes;
    std::vector<UnitBond<dim>>                  units; // also of a lattice with too many of them
    bool                                        may_pack = true;
    std::vector<std::pair<std::size_t, double>> parts; // what cracks leave of bonds, ascending

    BondState state;
  };
} // namespace PeriDeal
