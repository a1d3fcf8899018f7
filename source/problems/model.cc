// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/bonds/families.h>
#include <perideal/problems/model.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  Model<dim>::Model(const ModelKind kind, const Triangulation<dim> &mesh)
    : kind(kind)
    , mesh(mesh)
    , handler(mesh)
  {}


  template <int dim>
  Model<dim>::~Model() = default;


  template <int dim>
  void Model<dim>::number(const FiniteElement<dim> &element,
                          const Domain<dim>        &domain,
                          const bool                along_lattice)
  {
    if (numbered)
      {
        AssertThrow(handler.get_fe().get_name() == element.get_name(),
                    ExcMessage("The problems of a model have the same nodes."));
        return;
      }
    handler.distribute_dofs(element);
    if (along_lattice && domain.has_lattice())
      number_along_lattice(handler, domain);
    numbered = true;
  }


  template <int dim>
  Nodes<dim> &Model<dim>::nodes(const BodyParameters<dim> &body, const NodalVolume volume)
  {
    for (const auto &[kind_of_volume, set] : node_sets)
      if (kind_of_volume == volume)
        return *set;
    node_sets.emplace_back(volume,
                           std::make_unique<Nodes<dim>>(handler, body.domain, body.cracks, volume));
    prepare(*node_sets.back().second);
    return *node_sets.back().second;
  }


  template <int dim>
  void Model<dim>::share_nodes(const BodyParameters<dim> &body)
  {
    bodies.push_back(&body);
  }


  template <int dim>
  void Model<dim>::prepare(Nodes<dim> &nodes) const
  {
    if (bodies.empty())
      return;
    HaloNeed                     need{0., HaloAround::cells};
    typename Lattice<dim>::Index margin{};
    for (const BodyParameters<dim> *const body : bodies)
      {
        const KernelWeights<dim>           weights = kernel_weights(nodes, *body);
        const typename Lattice<dim>::Index reach   = weights.reach_in_sites();
        need = need.joined({halo_reach(nodes, *body, weights), HaloAround::cells});
        for (unsigned int d = 0; d < dim; ++d)
          margin[d] = std::max(margin[d], reach[d]);
      }
    prepare_search(nodes, need, margin);
  }


  template <int dim>
  void Model<dim>::forget()
  {
    node_sets.clear();
    numbered = false;
  }


  template class Model<1>;
  template class Model<2>;
  template class Model<3>;
} // namespace PeriDeal
