// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/base/worst_trip.h>
#include <perideal/bonds/bond_conductivities.h>
#include <perideal/laws/interface.h>
#include <perideal/scene/not_positive.h>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  BondConductivities<dim>::BondConductivities(const Neighbors<dim> &neighbors,
                                              const Material       &material,
                                              const Expression     &initial_value,
                                              SidePoints            side_points)
    : neighbors(neighbors)
    , material(material)
    , all_alike(material.uniform_conductivity())
    , moved(std::move(side_points))
  {
    const Nodes<dim>  &nodes = neighbors.nodes();
    const unsigned int n     = all_alike ? 1 : nodes.n_local();
    std::string        message;
    values.resize(n);
    for (unsigned int i = 0; i < n && message.empty(); ++i)
      {
        const Point<dim> p = nodes.n_local() > 0 ? nodes.position(i) : Point<dim>();
        values[i]          = at(i, initial_value.value(p));
        if (!(values[i] > 0.))
          message = "'Conductivity' in section 'Material' is " + std::to_string(values[i]) +
                    " at a node; it must be positive everywhere in the body.";
      }
    throw_on_all_if_any(nodes.communicator(), message);
  }


  template <int dim>
  double BondConductivities<dim>::at(const unsigned int node, const double T) const
  {
    const Nodes<dim> &nodes = neighbors.nodes();
    const auto        found = moved.find(node);
    return material.conductivity.value(found != moved.end() ? found->second :
                                       nodes.n_local() > 0  ? nodes.position(node) :
                                                              Point<dim>(),
                                       T);
  }


  template <int dim>
  void BondConductivities<dim>::take_at(const Vector &u)
  {
    if (!depend_on_temperature())
      return;
    const Nodes<dim> &nodes = neighbors.nodes();
    Trip              worst;
    for (unsigned int i = 0; i < nodes.n_local(); ++i)
      {
        const double T = u.local_element(i);
        values[i]      = at(i, T);
        if (!(values[i] > 0.))
          keep_lower(worst, not_positive("'Conductivity'", values[i], T, nodes.position(i)));
      }
    throw_lowest_if_any(nodes.communicator(), worst);
  }


  template <int dim>
  double BondConductivities<dim>::of_node(const unsigned int node) const
  {
    return values[all_alike ? 0 : neighbors.real(node)];
  }


  template <int dim>
  double BondConductivities<dim>::of_bond(const unsigned int node,
                                          const unsigned int neighbor) const
  {
    if (all_alike)
      return values[0];
    const double a = of_node(node), b = of_node(neighbor);
    if (material.interface_rule != InterfaceRule::harmonic)
      return interface_conductivity(material.interface_rule, a, b);
    return harmonic(node, neighbor);
  }


  template <int dim>
  double BondConductivities<dim>::in_series(const unsigned int node,
                                            const unsigned int neighbor,
                                            const double       s) const
  {
    if (all_alike)
      return values[0];
    if (depend_on_temperature())
      return 1. / (s / of_node(node) + (1. - s) / of_node(neighbor));
    return harmonic(node, neighbor);
  }


  template <int dim>
  double BondConductivities<dim>::harmonic(const unsigned int node,
                                           const unsigned int neighbor) const
  {
    // From the end that comes first in space, so that both ends of a bond see the same value to the
    // last bit.
    Point<dim> start = neighbors.position(node), end = neighbors.position(neighbor);
    for (unsigned int d = 0; d < dim; ++d)
      if (start[d] != end[d])
        {
          if (end[d] < start[d])
            std::swap(start, end);
          break;
        }
    const bool  real    = neighbors.is_real(neighbor);
    const auto &lattice = neighbors.nodes().lattice();
    return harmonic_conductivity([&](const double s) {
      Point<dim> p = start + s * (end - start);
      // Beyond a side the material is the mirror image of the body's.
      for (unsigned int d = 0; d < dim && !real; ++d)
        if (p[d] < lattice->lower[d])
          p[d] = 2. * lattice->lower[d] - p[d];
        else if (p[d] > lattice->upper[d])
          p[d] = 2. * lattice->upper[d] - p[d];
      return material.conductivity.value(p);
    });
  }


  template <int dim>
  bool BondConductivities<dim>::depend_on_temperature() const
  {
    return material.conductivity.depends_on_temperature();
  }

  template <int dim>
  std::size_t BondConductivities<dim>::memory_consumption() const
  {
    return values.capacity() * sizeof(double);
  }

  PERIDEAL_INSTANTIATE_CLASS(class BondConductivities);
} // namespace PeriDeal
