// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/mpi.h>

#include <perideal/base/types.h>
#include <perideal/laws/elasticity.h>
#include <perideal/scene/body_parameters.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace PeriDeal
{
  /** alpha dT (in plane strain (1 + nu) alpha dT) of a body at a point. */
  template <int dim>
  double thermal_strain(const BodyParameters<dim> &body,
                        const dealii::Point<dim>  &p,
                        const double               temperature_change)
  {
    return thermal_strain_factor(body.moduli(p, temperature_change), dim, body.elasticity.plane) *
           body.free_expansion(p, temperature_change);
  }


  /** The temperature of the body changes. */
  template <int dim>
  bool is_warm(const BodyParameters<dim> &body)
  {
    return body.elasticity.computes_temperature || !is_zero(body.elasticity.temperature_change);
  }


  /** By how much the temperature of a node has changed: as computed, or by the scene's formula. */
  template <int dim>
  double temperature_change_of(const BodyParameters<dim> &body,
                               const dealii::Point<dim>  &p,
                               const Vector              &computed,
                               const unsigned int         node)
  {
    return computed.size() > 0 ? computed.local_element(node) :
                                 body.elasticity.temperature_change.value(p);
  }


  /** T in formulas of a solid, where the temperature has changed by this (section `Elasticity`). */
  template <int dim>
  double temperature_of(const BodyParameters<dim> &body, const double change)
  {
    return body.elasticity.reference_temperature + change;
  }


  /** The same before any temperature has been computed. */
  template <int dim>
  double temperature_at_start(const BodyParameters<dim> &body, const dealii::Point<dim> &p)
  {
    return temperature_of(body, body.elasticity.temperature_change.value(p));
  }


  /** The thermal strains of nodes, owned and ghosts; those of bonds are the means of both ends. */
  class ThermalStrains
  {
  public:
    /** @param strain of a node by its local number. Collective. */
    template <typename Strain>
    void set(const unsigned int n_nodes, const Strain &strain, const MPI_Comm communicator)
    {
      double largest = 0.;
      lowest         = 0.;
      strains.resize(n_nodes);
      for (unsigned int i = 0; i < n_nodes; ++i)
        {
          strains[i] = strain(i);
          largest    = std::max(largest, std::abs(strains[i]));
          lowest     = std::min(lowest, strains[i]);
        }
      is_any = dealii::Utilities::MPI::max(largest, communicator) > 0.;
      if (!is_any)
        strains = std::vector<double>();
    }

    /** Some node of some process has one. */
    bool any() const
    {
      return is_any;
    }

    /** No node of this process has less; at most 0. */
    double least() const
    {
      return lowest;
    }

    double operator[](const unsigned int node) const
    {
      return is_any ? strains[node] : 0.;
    }

    double of_bond(const unsigned int i, const unsigned int j) const
    {
      return 0.5 * ((*this)[i] + (*this)[j]);
    }

    std::size_t memory_consumption() const
    {
      return strains.size() * sizeof(double);
    }

  private:
    std::vector<double> strains;
    double              lowest = 0.;
    bool                is_any = false;
  };
} // namespace PeriDeal
