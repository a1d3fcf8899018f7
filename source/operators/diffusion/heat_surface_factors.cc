// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/operators/diffusion/heat_surface_factors.h>
#include <perideal/operators/parts/crack_side_factors.h>

#include <sstream>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  std::vector<unsigned int> HeatSurfaceFactors<dim>::nodes() const
  {
    std::vector<unsigned int> result;
    for (unsigned int i = 0; i < bonds.nodes().n_owned(); ++i)
      if (bonds.corrects_every_bond() || bonds.near_crack(i))
        result.push_back(i);
    return result;
  }


  template <int dim>
  void HeatSurfaceFactors<dim>::find(const std::vector<unsigned int> &of_nodes)
  {
    const Nodes<dim>         &nodes        = bonds.nodes();
    const bool                energy       = bonds.corrects_every_bond();
    const CorrectionDirection direction    = parameters.correction_direction;
    const bool                both         = direction == CorrectionDirection::both;
    const unsigned int        n_directions = energy && both ? dim : 1;
    const unsigned int        first        = both ? 0 : static_cast<unsigned int>(direction);
    if (factors.empty())
      {
        factors.resize(n_directions);
        for (Vector &of_direction : factors)
          {
            of_direction.reinit(nodes.partitioner());
            of_direction = 1.;
          }
      }
    bonds.factors().set({}, 1, true); // what the bonds are without
    std::vector<typename DiffusionBonds<dim>::Bond> family;
    std::string                                     message;
    for (const unsigned int i : of_nodes)
      {
        Tensor<1, dim> moments;
        CrossingShare  crossing;
        bool           cut = false;
        bonds.bonds_of(i, family);
        for (const auto &bond : family)
          {
            const Tensor<1, dim> xi = bonds.neighbors().bond_vector(i, bond.neighbor);
            for (unsigned int d = 0; d < dim; ++d)
              moments[d] += bond.weight * xi[d] * xi[d];
            if (!bond.cut)
              continue;
            cut = true;
            crossing.kept += 0.5 * bond.weight * xi.norm_square();
            crossing.whole += 0.5 * bond.intact * xi.norm_square();
          }
        const double kappa_volume = bonds.conductivities().of_node(i) * nodes.volume(i);
        double       trace        = 0.;
        for (unsigned int d = 0; d < dim; ++d)
          trace += 0.5 * moments[d];
        if (!energy)
          factors[0].local_element(i) = crack_side_factor(cut, dim * kappa_volume, trace, crossing);
        for (unsigned int d = 0; d < n_directions && energy; ++d)
          {
            factors[d].local_element(i) = 2. * kappa_volume / moments[first + d];
            if (!(moments[first + d] > 0.) && message.empty())
              {
                std::ostringstream text;
                text
                  << "'Surface correction = energy' in section 'Peridynamics' compares energies of a unit gradient, but the node at ("
                  << nodes.position(i) << ") has no bond left that reaches out in "
                  << "xyz"[first + d]
                  << ". Choose 'none' or a larger 'Horizon ratio', or move the cracks of section 'Cracks' apart.";
                message = text.str();
              }
          }
      }
    throw_on_all_if_any(nodes.communicator(), message);
    std::vector<double> all(nodes.n_local() * n_directions);
    for (unsigned int d = 0; d < n_directions; ++d)
      {
        factors[d].update_ghost_values();
        for (unsigned int i = 0; i < nodes.n_local(); ++i)
          all[i * n_directions + d] = factors[d].local_element(i);
        factors[d].set_ghost_state(false);
      }
    bonds.factors().set(std::move(all), n_directions, !energy);
  }


  PERIDEAL_INSTANTIATE_CLASS(class HeatSurfaceFactors);
} // namespace PeriDeal
