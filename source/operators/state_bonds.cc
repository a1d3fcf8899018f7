// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Which bonds are stored, and which the lattice knows.

#include <deal.II/base/mpi.h>

#include <perideal/base/smallest_eigenvalue.h>
#include <perideal/base/user_error.h>
#include <perideal/operators/bond_form.h>
#include <perideal/operators/state_operator.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "state_lattice.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /**
     * What a node that bonds do not hold needs: a longer horizon, if this one spans few cells of
     * its size, else other cracks.
     */
    std::string advice_on_horizon(const double horizon, const double volume, const unsigned int dim)
    {
      constexpr double few = 2.5, enough = 3.; // cells in a horizon
      const double     size = std::pow(volume, 1. / dim);
      if (horizon >= few * size)
        return "Check the cracks in section 'Cracks': they leave it too few bonds.";
      std::ostringstream text;
      text.precision(3);
      text << "Cells there are as large as " << size
           << ", and 'Horizon' in section 'Peridynamics' is " << horizon << ": take "
           << enough * size << " or more, or smaller cells there.";
      return text.str();
    }
  } // namespace


  template <int dim>
  bool StateOperator<dim>::may_leave_out_bonds() const
  {
    std::string reason;
    if (!bonds.neighbors().has_unique_sites())
      reason = "the nodes are not on a lattice with one node per site";
    else if (full)
      reason = "with 'Kinematics = full' each bond has its own direction";
    else if (scene.material.fracture_energy || scene.material.critical_stretch)
      reason = "bonds may break";
    else if (scene.peridynamics.corrects_elastic_bonds())
      reason = "with 'Surface correction' bonds have factors of their own";
    // Bonds of bars take little, and differences of displacements round less than convolutions.
    return takes_lattice_form(scene.peridynamics.form, reason, dim > 1);
  }


  template <int dim>
  bool StateOperator<dim>::has_complete_family(const unsigned int i) const
  {
    const Nodes<dim> &nodes  = bonds.nodes();
    const double      volume = nodes.lattice()->cell_volume();
    if (nodes.volume(i) != volume)
      return false;
    const auto site = nodes.lattice()->index(nodes.position(i));
    for (const FamilyMember<dim> &member : bonds.weights().members())
      {
        const unsigned int j = bonds.neighbors().node_at(site + member.offset);
        if (j == numbers::invalid_unsigned_int || nodes.volume(j) != volume)
          return false;
      }
    return true;
  }


  template <int dim>
  double StateOperator<dim>::complete_weighted() const
  {
    double q = 0.;
    for (const FamilyMember<dim> &member : bonds.weights().members())
      q += bonds.nodes().lattice()->cell_volume() * member.weight * member.r * member.r;
    return q;
  }


  template <int dim>
  void StateOperator<dim>::find_bonds()
  {
    const Nodes<dim>                           &nodes     = bonds.nodes();
    const bool                                  leave_out = may_leave_out_bonds();
    const double                                q         = leave_out ? complete_weighted() : 0.;
    std::vector<typename Families<dim>::Member> family;
    std::string                                 message;
    if (leave_out)
      {
        on_lattice.assign(nodes.n_owned(), true);
        for (const FamilyMember<dim> &member : bonds.weights().members())
          {
            LatticeBond bond;
            bond.offset = member.offset;
            for (unsigned int d = 0; d < dim; ++d)
              bond.moment[d] = member.weight * (member.offset[d] * nodes.lattice()->spacing[d]);
            bond.weight = member.weight * member.r * member.r;
            lattice_bonds.push_back(bond);
          }
      }
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        const bool complete = leave_out && has_complete_family(i);
        if (complete && !bonds.near_crack(i))
          n_bonds += 0.5 * static_cast<double>(lattice_bonds.size()); // at each end
        else
          {
            bonds.members_of(i, family);
            if (leave_out)
              on_lattice[i] = std::none_of(family.begin(), family.end(), [](const auto &bond) {
                return bond.cut || bond.weight == 0.;
              });
            store_bonds(i, family, message);
          }
        if (complete && on_lattice[i])
          weighted.local_element(i) = q; // to the last bit
        starts.push_back(neighbors.size());
        if (!leave_out || !on_lattice[i])
          stored_nodes.push_back(i);
      }
    throw_on_all_if_any(nodes.communicator(), message);
    complete_families();
    if (scene.elasticity.micromodulus == Micromodulus::constant)
      weighted = complete_weighted();
    weighted.update_ghost_values();
    find_springs();
    if (leave_out)
      make_lattice();
  }


  template <int dim>
  void StateOperator<dim>::store_bonds(const unsigned int                                 i,
                                       const std::vector<typename Families<dim>::Member> &family,
                                       std::string                                       &message)
  {
    const Nodes<dim>       &nodes  = bonds.nodes();
    const bool              stored = on_lattice.empty() || !on_lattice[i];
    SymmetricTensor<2, dim> shape;
    double                  q = 0.;
    for (const auto &bond : family)
      {
        if (bond.cut || bond.weight == 0.)
          continue;
        AssertIndexRange(bond.neighbor, nodes.n_local()); // no fictitious nodes
        const Tensor<1, dim> xi = bonds.neighbors().bond_vector(i, bond.neighbor);
        const double         w  = bond.weight;
        q += w * xi.norm_square() / nodes.volume(i);
        shape += w * symmetrize(outer_product(xi, xi));
        n_bonds += 0.5; // at each end
        if (!stored)
          continue;
        neighbors.push_back(bond.neighbor);
        moments.push_back(w * xi);
        springs.push_back(w * xi.norm_square());
      }
    weighted.local_element(i) = q;
    if (!message.empty())
      return;
    if (!(q > 0.))
      message = "The node at " + place_of(dim * i) + " is isolated: no bond of it is left. " +
                advice_on_horizon(scene.horizon(), nodes.volume(i), dim);
    else if (smallest_eigenvalue(shape) < 1e-9 * trace(shape))
      message = "All bonds of the node at " + place_of(dim * i) +
                " lie in one line or plane, across which nothing holds it. " +
                advice_on_horizon(scene.horizon(), nodes.volume(i), dim);
  }


  template <int dim>
  void StateOperator<dim>::correct_surface()
  {
    // Springs still are W x^2.
    const SurfaceFactors factors =
      surface_factors(bonds, scene.peridynamics, {starts, neighbors, springs});
    std::string message;
    for (unsigned int i = 0; i < bonds.nodes().n_owned(); ++i)
      {
        const StateLaw &law = laws[i].law;
        if (message.empty() && volumetric &&
            law.extension + law.volumetric * law.dilatation * factors.ratio[i] <= 0.)
          message =
            "'Surface correction' in section 'Peridynamics': with this Poisson ratio the energy of the node at " +
            place_of(dim * i) + " would not be positive. Use 'moments' or 'none'.";
      }
    throw_on_all_if_any(bonds.nodes().communicator(), message);
    for (std::size_t k = 0; k < neighbors.size(); ++k)
      {
        moments[k] *= factors.dilatation[k];
        springs[k] *= factors.dilatation[k] * factors.dilatation[k] / factors.extension[k];
      }
    weighted        = factors.q;
    n_not_corrected = factors.n_left;
    moments_gap     = factors.gap;
    weighted.update_ghost_values();
  }


  template <int dim>
  double StateOperator<dim>::gap_of_moments() const
  {
    return moments_gap;
  }


  template <int dim>
  unsigned long long StateOperator<dim>::n_uncorrected_nodes() const
  {
    return n_not_corrected;
  }


  template <int dim>
  void StateOperator<dim>::find_springs()
  {
    if (scene.peridynamics.corrects_elastic_bonds())
      correct_surface();
    for (const unsigned int i : stored_nodes)
      for (std::size_t k = starts[i]; k < starts[i + 1]; ++k)
        {
          const unsigned int j = neighbors[k];
          springs[k]           = (laws[i].law.extension / weighted.local_element(i) +
                        laws[j].law.extension / weighted.local_element(j)) /
                       springs[k]; // W x^2
        }
    if (beyond)
      beyond->find_springs(
        [&](const unsigned int i) { return laws[i].law.extension / weighted.local_element(i); },
        full);
    if (!full)
      return;
    across.resize(neighbors.size(), 0.);
    for (const Tensor<1, dim> &p : moments)
      lengths.push_back(p.norm());
  }


  template <int dim>
  StateLaw StateOperator<dim>::reference_law() const
  {
    // Of several the softest or the stiffest one.
    using Numbers              = std::array<double, 3>;
    const MPI_Comm     all     = bonds.nodes().communicator();
    const unsigned int n_owned = bonds.nodes().n_owned();
    const auto         law_of  = [&](const unsigned int i) {
      const StateLaw &law = laws[i].law;
      return Numbers{{law.extension, law.volumetric, law.dilatation}};
    };
    std::vector<Numbers> extremes; // of this process
    for (unsigned int i = 0; i < n_owned; ++i)
      {
        extremes.resize(2, law_of(i));
        extremes[0] = std::min(extremes[0], law_of(i));
        extremes[1] = std::max(extremes[1], law_of(i));
      }
    std::vector<Numbers> found;
    for (const std::vector<Numbers> &others : Utilities::MPI::all_gather(all, extremes))
      found.insert(found.end(), others.begin(), others.end());
    const auto            limits = std::minmax_element(found.begin(), found.end());
    std::array<double, 2> counts{{0., 0.}};
    for (unsigned int i = 0; i < n_owned; ++i)
      {
        counts[0] += law_of(i) == *limits.first ? 1. : 0.;
        counts[1] += law_of(i) == *limits.second ? 1. : 0.;
      }
    for (double &count : counts)
      count = Utilities::MPI::sum(count, all);
    // s of all others is written as a difference to it, which must not lose digits in the soft
    // ones.
    constexpr double most_contrast = 100.;
    const bool       softest       = counts[0] >= counts[1] ||
                         (*limits.second)[0] > most_contrast * (*limits.first)[0];
    const Numbers &chosen = softest ? *limits.first : *limits.second;
    StateLaw       law;
    law.extension  = chosen[0];
    law.volumetric = chosen[1];
    law.dilatation = chosen[2];
    return law;
  }


  template <int dim>
  void StateOperator<dim>::make_lattice()
  {
    const Nodes<dim>                        &nodes = bonds.nodes();
    const StateLaw                           law   = reference_law();
    const double                             q     = complete_weighted();
    typename StateLattice<dim>::Coefficients coefficients;
    coefficients.stiffness  = law.extension / q;
    coefficients.dilatation = volumetric ? law.volumetric * law.dilatation / (q * q) : 0.;
    for (unsigned int i = 0; i < nodes.n_local(); ++i)
      {
        const double own = weighted.local_element(i);
        coefficients.stiffnesses.push_back(laws[i].law.extension / own);
        if (volumetric && i < nodes.n_owned())
          coefficients.dilatations.push_back(laws[i].law.volumetric * laws[i].law.dilatation /
                                             (own * own));
      }
    lattice = std::make_unique<StateLattice<dim>>(bonds, coefficients, on_lattice);
  }


  template <int dim>
  std::size_t StateOperator<dim>::n_stored_bonds() const
  {
    return neighbors.size();
  }


#define PERIDEAL_INSTANTIATE(dim)                                              \
  template void               StateOperator<dim>::find_bonds();                \
  template std::size_t        StateOperator<dim>::n_stored_bonds() const;      \
  template unsigned long long StateOperator<dim>::n_uncorrected_nodes() const; \
  template double             StateOperator<dim>::gap_of_moments() const;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
