// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// The material along a bond.

#include <deal.II/base/mpi.h>

#include <perideal/base/user_error.h>
#include <perideal/bonds/families.h>
#include <perideal/laws/interface.h>
#include <perideal/scene/lists.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  void Families<dim>::find_conductivities(const Scene<dim> &scene)
  {
    uniform              = scene.material.uniform_conductivity();
    const unsigned int n = uniform ? 1 : own_nodes->n_local();
    std::string        message;
    conductivities.resize(n);
    for (unsigned int i = 0; i < n && message.empty(); ++i)
      {
        const Point<dim> p = own_nodes->n_local() > 0 ? own_nodes->position(i) : Point<dim>();
        conductivities[i] =
          material.conductivity.value(p, scene.initial_and_source.initial_value.value(p));
        if (!(conductivities[i] > 0.))
          message = "'Conductivity' in section 'Material' is " + std::to_string(conductivities[i]) +
                    " at a node; it must be positive everywhere in the body.";
      }
    throw_on_all_if_any(own_nodes->communicator(), message);
  }


  template <int dim>
  void Families<dim>::take_conductivities_at(const Vector &u)
  {
    if (!material.conductivity.depends_on_temperature())
      return;
    std::string message;
    for (unsigned int i = 0; i < own_nodes->n_local(); ++i)
      {
        const double T    = u.local_element(i);
        conductivities[i] = material.conductivity.value(own_nodes->position(i), T);
        if (!(conductivities[i] > 0.) && message.empty())
          message = "'Conductivity' in section 'Material' is " + number_text(conductivities[i]) +
                    " at T = " + number_text(T) +
                    "; it must be positive at every temperature that the run reaches.";
      }
    throw_on_all_if_any(own_nodes->communicator(), message);
  }


  template <int dim>
  double Families<dim>::conductivity(const unsigned int node) const
  {
    if (uniform)
      return conductivities[0];
    return conductivities[node < own_nodes->n_local() ?
                            node :
                            outside[node - own_nodes->n_local()].mirror];
  }


  template <int dim>
  double Families<dim>::bond_conductivity(const unsigned int node,
                                          const unsigned int neighbor) const
  {
    if (uniform)
      return conductivities[0];
    const double a = conductivity(node), b = conductivity(neighbor);
    if (material.interface_rule != InterfaceRule::harmonic)
      return interface_conductivity(material.interface_rule, a, b);
    // From the end that comes first in space, so that both ends of a bond see the same value to the
    // last bit.
    Point<dim> start = position(node), end = position(neighbor);
    for (unsigned int d = 0; d < dim; ++d)
      if (start[d] != end[d])
        {
          if (end[d] < start[d])
            std::swap(start, end);
          break;
        }
    const bool real = neighbor < own_nodes->n_local();
    return harmonic_conductivity([&](const double s) {
      Point<dim> p = start + s * (end - start);
      // Beyond a side the material is the mirror image of the body's.
      for (unsigned int d = 0; d < dim && !real; ++d)
        if (p[d] < own_nodes->lattice()->lower[d])
          p[d] = 2. * own_nodes->lattice()->lower[d] - p[d];
        else if (p[d] > own_nodes->lattice()->upper[d])
          p[d] = 2. * own_nodes->lattice()->upper[d] - p[d];
      return material.conductivity.value(p);
    });
  }


#define PERIDEAL_INSTANTIATE(dim)                                         \
  template void   Families<dim>::find_conductivities(const Scene<dim> &); \
  template void   Families<dim>::take_conductivities_at(const Vector &);  \
  template double Families<dim>::conductivity(const unsigned int) const;  \
  template double Families<dim>::bond_conductivity(const unsigned int, const unsigned int) const;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
