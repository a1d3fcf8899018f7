// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/place_text.h>
#include <perideal/base/smallest_eigenvalue.h>
#include <perideal/operators/solid/node_laws.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

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
  NodeLaws<dim>::NodeLaws(const Nodes<dim> &nodes, const BodyParameters<dim> &body)
    : weighted(nodes.partitioner())
    , volumetric(!body.elasticity.is_bond_based() && dim > 1)
    , counts_cut(body.material.law.softens())
    , nodes(nodes)
    , body(body)
    , horizon(body.horizon())
  {
    find_laws();
  }


  template <int dim>
  void NodeLaws<dim>::find_laws()
  {
    const PlaneState plane   = body.elasticity.plane;
    double           largest = 0., smallest = 1e300;
    laws.clear();
    for (unsigned int i = 0; i < nodes.n_local(); ++i)
      {
        const Moduli of_node = moduli(i);
        laws.push_back(body.elasticity.is_bond_based() ? bond_law(of_node, dim, plane) :
                                                         state_law(of_node, dim, plane));
        largest  = std::max(largest, laws[i].extension);
        smallest = std::min(smallest, laws[i].extension);
      }
    const auto same = [&](const StateLaw &law) {
      return law.extension == laws[0].extension && law.volumetric == laws[0].volumetric &&
             law.dilatation == laws[0].dilatation;
    };
    if (std::all_of(laws.begin(), laws.end(), same))
      laws.resize(std::min<std::size_t>(laws.size(), 1));
    laws.shrink_to_fit();
    const MPI_Comm all = nodes.communicator();
    several_phases     = Utilities::MPI::max(largest, all) >
                     (1. + 1e-12) * Utilities::MPI::min(smallest, all);
  }


  template <int dim>
  void NodeLaws<dim>::take_temperatures(const Vector &of_nodes)
  {
    changes.resize(nodes.n_local());
    for (unsigned int i = 0; i < nodes.n_local(); ++i)
      changes[i] = of_nodes.local_element(i);
    find_laws();
  }


  template <int dim>
  double NodeLaws<dim>::weight_of(const Families<dim>                               &families,
                                  const unsigned int                                 i,
                                  const std::vector<typename Families<dim>::Member> &family,
                                  std::string                                       &message) const
  {
    SymmetricTensor<2, dim> shape;
    double                  q = 0.;
    for (const auto &bond : family)
      {
        const double weight = bond.kept * bond.weight;
        if (weight == 0. && !counts_cut)
          continue;
        const Tensor<1, dim> xi = families.neighbors().bond_vector(i, bond.neighbor);
        q += (counts_cut ? bond.weight : weight) * xi.norm_square() / nodes.volume(i);
        shape += weight * symmetrize(outer_product(xi, xi));
      }
    if (!message.empty())
      return q;
    if (!(q > 0.) || !(trace(shape) > 0.))
      message =
        "The node at " + place_text(nodes.position(i)) + " is isolated: no bond of it is left. ";
    else if (smallest_eigenvalue(shape) < 1e-9 * trace(shape))
      message = "All bonds of the node at " + place_text(nodes.position(i)) +
                " lie in one line or plane, across which nothing holds it. ";
    if (!message.empty())
      message += advice_on_horizon(horizon, nodes.volume(i), dim);
    return q;
  }


  template <int dim>
  StateLaw NodeLaws<dim>::reference() const
  {
    using Numbers              = std::array<double, 3>;
    const MPI_Comm     all     = nodes.communicator();
    const unsigned int n_owned = nodes.n_owned();
    const auto         law_of  = [&](const unsigned int i) {
      const StateLaw &law = (*this)[i];
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


  PERIDEAL_INSTANTIATE_CLASS(class NodeLaws);
} // namespace PeriDeal
