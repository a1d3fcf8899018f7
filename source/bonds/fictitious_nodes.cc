// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/bonds/fictitious_nodes.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    Point<dim> clamp_to_body(const Lattice<dim> &lattice, Point<dim> p)
    {
      for (unsigned int d = 0; d < dim; ++d)
        p[d] = std::clamp(p[d], lattice.lower[d], lattice.upper[d]);
      return p;
    }


    /** Site of the mirror image about a side. */
    template <int dim>
    typename Lattice<dim>::Index reflect(const Lattice<dim>          &lattice,
                                         typename Lattice<dim>::Index site,
                                         const unsigned int           side)
    {
      const unsigned int d    = side / 2;
      const int          last = lattice.n_sites[d] - 1, shift = lattice.at_centers ? 1 : 0;
      site[d] = (side % 2 == 0) ? -site[d] - shift : 2 * last + shift - site[d];
      return site;
    }


    /**
     * How many spacings a site lies inside a side; 0 for the side's own row of vertices, 1 for the
     * outermost row of cell centres.
     */
    template <int dim>
    int depth(const Lattice<dim>                 &lattice,
              const typename Lattice<dim>::Index &site,
              const unsigned int                  side)
    {
      const unsigned int d = side / 2;
      return (side % 2 == 0 ? site[d] : lattice.n_sites[d] - 1 - site[d]) +
             (lattice.at_centers ? 1 : 0);
    }


    /** The point of a side that is nearest to a site. */
    template <int dim>
    Point<dim> foot_of(const Lattice<dim>                 &lattice,
                       const typename Lattice<dim>::Index &site,
                       const unsigned int                  side)
    {
      Point<dim> foot = lattice.position(site);
      foot[side / 2]  = side % 2 == 0 ? lattice.lower[side / 2] : lattice.upper[side / 2];
      return clamp_to_body(lattice, foot);
    }


    /** The image of a node or of an earlier fictitious node about one side. */
    template <int dim>
    FictitiousNode<dim> image(const FictitiousNode<dim> &original,
                              const Lattice<dim>        &lattice,
                              const unsigned int         side,
                              const SideCondition       *dirichlet,
                              const bool                 constant)
    {
      FictitiousNode<dim> node = original;
      node.site                = reflect(lattice, original.site, side);
      node.side                = side;
      if (dirichlet == nullptr) // symmetry
        return node;
      const Point<dim> foot = foot_of(lattice, node.site, side);
      node.sign             = constant ? 0. : -original.sign;
      for (auto &term : node.terms)
        term.coefficient *= -1.;
      if (constant)
        node.terms.clear();
      node.terms.push_back({dirichlet, foot, constant ? 1. : 2.});
      return node;
    }
  } // namespace


  template <int dim>
  std::vector<FictitiousNode<dim>> make_fictitious_nodes(const Nodes<dim>              &nodes,
                                                         const BoundaryConditions<dim> &conditions,
                                                         const BoundaryTreatment        treatment,
                                                         const NodalVolume nodal_volume,
                                                         const typename Lattice<dim>::Index &reach)
  {
    std::vector<FictitiousNode<dim>> result;
    const bool                       constant = treatment == BoundaryTreatment::fictitious_constant;
    const bool layers = constant || treatment == BoundaryTreatment::fictitious_mirror;
    if (!layers && conditions.symmetry.empty())
      return result;
    AssertThrow(
      nodes.lattice().has_value(),
      UserError(
        "'Boundary treatment' and 'Symmetry': fictitious layers need the flat sides of a box "
        "(section 'Domain', Shape = box)."));
    const Lattice<dim> &lattice = *nodes.lattice();

    std::vector<FictitiousNode<dim>> all;
    for (unsigned int side = 0; side < 2 * dim; ++side)
      {
        const bool held = layers && std::any_of(conditions.dirichlet.begin(),
                                                conditions.dirichlet.end(),
                                                [&](const SideCondition &condition) {
                                                  return conditions.side_of(condition.id) == side;
                                                });
        const bool symmetric =
          std::find(conditions.symmetry.begin(), conditions.symmetry.end(), side) !=
          conditions.symmetry.end();
        if (!held && !symmetric)
          continue;
        AssertThrow(
          lattice.n_sites[side / 2] > reach[side / 2],
          UserError(
            "'Boundary treatment' and 'Symmetry': the body is narrower than the horizon, so that one mirror image "
            "does not fill a family. Choose a smaller 'Horizon' in section 'Peridynamics'."));
        const auto add_image = [&](const FictitiousNode<dim> &original) {
          const int inside = depth(lattice, original.site, side);
          if (inside < 0 || inside > reach[side / 2] ||
              (inside == 0 && nodal_volume == NodalVolume::full))
            return;
          // Of a side that is held in parts only, nodes lie beyond those parts.
          const SideCondition *const dirichlet =
            symmetric ? nullptr : conditions.value_at(side, foot_of(lattice, original.site, side));
          if (symmetric || dirichlet != nullptr)
            all.push_back(image(original, lattice, side, dirichlet, constant));
        };
        const std::size_t n_before = all.size();
        for (unsigned int i = 0; i < nodes.n_local(); ++i)
          add_image({lattice.index(nodes.position(i)), i, 1., nodes.volume(i), 0, {}});
        for (std::size_t i = 0; i < n_before; ++i)
          {
            const FictitiousNode<dim> original = all[i];
            add_image(original);
          }
      }
    result = std::move(all);
    return result;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(make_fictitious_nodes);
} // namespace PeriDeal
