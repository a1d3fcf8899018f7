// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/solid/damage_criterion.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /** Another criterion, but for bonds with an end in an unbreakable part of the body. */
  template <int dim>
  class UnbreakableEnds : public DamageCriterion<dim>
  {
  public:
    UnbreakableEnds(const BreakableBonds<dim>              &bonds,
                    std::unique_ptr<DamageCriterion<dim>> &&others)
      : others(std::move(others))
    {
      const Nodes<dim> &nodes = bonds.families.nodes();
      for (unsigned int i = 0; i < nodes.n_local(); ++i)
        holds.push_back(bonds.material.law.breaking.unbreakable->value(nodes.position(i)) > 0.);
      find_least();
    }

    BondMeasure measure(const unsigned int i,
                        const unsigned int j,
                        const double       extension,
                        const double       length) const override
    {
      BondMeasure found = others->measure(i, j, extension, length);
      if (holds[i] || holds[j])
        found.limit = never;
      return found;
    }

    const std::vector<double> &least_stretches() const override
    {
      return least;
    }

    bool take_time(const double t, const std::vector<double> &temperatures) override
    {
      return renewed(others->take_time(t, temperatures));
    }

    NodeQuantity asks_for() const override
    {
      return others->asks_for();
    }

    void take_state(const std::vector<Vector> &values) override
    {
      others->take_state(values);
      find_least();
    }

    bool softens() const override
    {
      return others->softens();
    }

    double integrity(const unsigned int i,
                     const unsigned int j,
                     const double       length,
                     const double       ratio) const override
    {
      return others->integrity(i, j, length, ratio);
    }

    double stored_at_onset() const override
    {
      return others->stored_at_onset();
    }

    /** Also where bonds do not break: those of the material. */
    const std::vector<double> &of_nodes() const override
    {
      return others->of_nodes();
    }

    std::string name_of_limit() const override
    {
      return others->name_of_limit();
    }

    std::size_t memory_consumption() const override
    {
      return others->memory_consumption() + holds.capacity() + least.capacity() * sizeof(double);
    }

    CrackPaths<dim> *paths() const override
    {
      return others->paths();
    }

  private:
    static constexpr double never = std::numeric_limits<double>::infinity();

    bool renewed(const bool changed)
    {
      if (changed)
        find_least();
      return changed;
    }

    void find_least()
    {
      least = others->least_stretches();
      for (unsigned int i = 0; i < least.size(); ++i)
        if (holds[i])
          least[i] = never;
    }

    const std::unique_ptr<DamageCriterion<dim>> others;
    std::vector<unsigned char>                  holds; // of owned nodes and ghosts
    std::vector<double>                         least;
  };
} // namespace PeriDeal
