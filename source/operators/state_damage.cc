// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Bonds that break.

#include <deal.II/base/mpi.h>

#include <perideal/base/user_error.h>
#include <perideal/operators/state_operator.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /**
     * What a plane through the full family of a lattice cuts, mean over its normals along the axes
     * n; lengths.
     */
    struct CrossingSums
    {
      double bonds = 0.; // sum over half the family of omega f V xi_n x^2, over q
      // h_n times the sum over the layers of nodes on one side of (sum over what crosses of
      // omega f V x^2, over q)^2
      double dilatations = 0.;
    };

    template <int dim>
    CrossingSums crossing_sums(const Families<dim> &bonds)
    {
      const Tensor<1, dim> &spacing = bonds.nodes().lattice()->spacing;
      double                q       = 0.;
      for (const FamilyMember<dim> &member : bonds.weights().members())
        q += member.weight * member.r * member.r;
      CrossingSums sums;
      for (unsigned int d = 0; d < dim; ++d)
        {
          std::vector<double> shares; // of the layers
          for (const FamilyMember<dim> &member : bonds.weights().members())
            {
              const double share = member.weight * member.r * member.r / q;
              const int    n     = std::max(0, member.offset[d]);
              sums.bonds += n * spacing[d] * share / dim;
              shares.resize(std::max<std::size_t>(shares.size(), n), 0.);
              for (int layer = 0; layer < n; ++layer)
                shares[layer] += share;
            }
          for (const double share : shares)
            sums.dilatations += spacing[d] * share * share / dim;
        }
      return sums;
    }


    /**
     * The same for a node's own family, where there is no lattice. Half of what lies on both sides
     * of the node counts for each side, so that families that end at the surface have no smaller
     * sums than others.
     */
    template <int dim>
    CrossingSums own_crossing_sums(const Families<dim>                         &bonds,
                                   const unsigned int                           node,
                                   std::vector<typename Families<dim>::Member> &family)
    {
      bonds.members_of(node, family);
      std::vector<std::pair<double, double>> crossing(family.size()); // distance, share
      CrossingSums                           sums;
      double                                 q = 0.;
      for (const auto &bond : family)
        q += bond.weight * bonds.neighbors().bond_vector(node, bond.neighbor).norm_square();
      for (unsigned int d = 0; d < dim; ++d)
        {
          for (std::size_t k = 0; k < family.size(); ++k)
            {
              const Tensor<1, dim> xi = bonds.neighbors().bond_vector(node, family[k].neighbor);
              crossing[k] = {std::abs(xi[d]), 0.5 * family[k].weight * xi.norm_square() / q};
            }
          std::sort(crossing.begin(), crossing.end());
          // What reaches farther than a plane, as the plane moves away from the node.
          double beyond = 0.5, last = 0.;
          for (const auto &[distance, share] : crossing)
            {
              sums.bonds += distance * share / dim;
              sums.dilatations += (distance - last) * beyond * beyond / dim;
              beyond -= share;
              last = distance;
            }
        }
      return sums;
    }
  } // namespace


  template <int dim>
  void StateOperator<dim>::find_critical_stretches()
  {
    const Material &material = scene.material;
    if (!material.fracture_energy && !material.critical_stretch)
      return;
    const Nodes<dim>  &nodes      = bonds.nodes();
    const bool         converts   = !material.critical_stretch;
    const CrossingSums of_lattice = converts && nodes.lattice() ? crossing_sums(bonds) :
                                                                  CrossingSums();
    std::vector<typename Families<dim>::Member> family;
    std::string                                 message;
    Vector                                      stretches(nodes.partitioner());
    breaks = true;
    state.resize(neighbors.size());
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        const Point<dim> &p   = nodes.position(i);
        const StateLaw   &law = laws[i].law;
        double           &s   = stretches.local_element(i);
        if (converts)
          {
            const CrossingSums sums = nodes.lattice() ? of_lattice :
                                                        own_crossing_sums(bonds, i, family);
            s                       = std::sqrt(material.fracture_energy->value(p) /
                          (law.extension * sums.bonds +
                           (volumetric ? law.volumetric * law.dilatation * sums.dilatations : 0.)));
          }
        else
          s = material.critical_stretch->value(p);
        if (message.empty() && !(s > 0.))
          {
            std::ostringstream where;
            where << "'" << (converts ? "Fracture energy" : "Critical stretch")
                  << "' in section 'Material' is not positive at (" << p << ").";
            message = where.str();
          }
      }
    throw_on_all_if_any(nodes.communicator(), message);
    stretches.update_ghost_values();
    critical.assign(stretches.begin(), stretches.begin() + nodes.n_local());
  }


  template <int dim>
  const std::vector<double> &StateOperator<dim>::critical_stretches() const
  {
    return critical;
  }


  template <int dim>
  bool StateOperator<dim>::brittle() const
  {
    return breaks;
  }


  template <int dim>
  void StateOperator<dim>::find_overstretched(const Vector &u, const double share)
  {
    const Nodes<dim> &nodes = bonds.nodes();
    double            most  = 0.;
    u.update_ghost_values();
    breaking.clear();
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      for (std::size_t k = starts[i]; k < starts[i + 1]; ++k)
        {
          if (!state.is_whole(k))
            continue;
          // W x e and W x^2; the same digits at both ends of a bond.
          const unsigned int   j     = neighbors[k];
          const Tensor<1, dim> xi    = bonds.neighbors().bond_vector(i, j);
          const double         all   = full ? lengths[k] * xi.norm() : moments[k] * xi;
          const double         limit = all * std::min(critical[i], critical[j]);
          const double         found = extension_moment(u.begin(), i, stored_bond(k));
          if (found <= limit)
            continue;
          breaking.push_back({k, found / limit});
          most = std::max(most, found / limit);
        }
    find_overstretched_images(u.begin());
    u.set_ghost_state(false);
    if (share <= 0.)
      return;
    for (const auto &[number, ratio] : breaking_images)
      most = std::max(most, ratio);
    const double at_least = share * Utilities::MPI::max(most, nodes.communicator());
    for (auto *const list : {&breaking, &breaking_images})
      list->erase(std::remove_if(list->begin(),
                                 list->end(),
                                 [&](const auto &bond) { return bond.second < at_least; }),
                  list->end());
  }


  template <int dim>
  unsigned long long StateOperator<dim>::break_bonds(const Vector &u,
                                                     const double  t,
                                                     const double  share)
  {
    if (!breaks)
      return 0;
    find_overstretched(u, share);
    const MPI_Comm     all    = bonds.nodes().communicator();
    unsigned long long n_ends = breaking.size() + breaking_images.size();
    if (Utilities::MPI::sum(n_ends, all) == 0)
      return 0;
    keep_places();
    const double before = energy(u);
    for (const auto &[k, ratio] : breaking)
      {
        state.mark(k, BondState::broken, t);
        springs[k] = 0.;
        moments[k] = Tensor<1, dim>();
        if (full)
          lengths[k] = across[k] = 0.;
      }
    n_ends = Utilities::MPI::sum(breaking.size() + break_images(t), all);
    released += before - energy(u);
    n_bonds -= 0.5 * breaking.size();
    n_broken += n_ends / 2;
    find_diagonal();
    if (any_thermal)
      find_thermal_loads();
    return n_ends / 2;
  }


  template <int dim>
  double StateOperator<dim>::released_energy() const
  {
    return released;
  }


  template <int dim>
  unsigned long long StateOperator<dim>::n_broken_bonds() const
  {
    return n_broken;
  }


  template <int dim>
  std::vector<double> StateOperator<dim>::damage() const
  {
    const Nodes<dim>                           &nodes = bonds.nodes();
    std::vector<typename Families<dim>::Member> family;
    std::vector<std::pair<unsigned int, int>>   crossed;
    std::vector<double>                         result(nodes.n_owned());
    for (const unsigned int i : stored_nodes) // others have no bond cut
      {
        // Bonds are stored in the order of the family, those that cracks cut left out.
        bonds.members_of(i, family);
        double      all = 0., left = 0.;
        std::size_t k = starts[i];
        for (const auto &bond : family)
          {
            const double volume = nodes.volume(bond.neighbor);
            if (bond.cut || bond.weight == 0.)
              {
                bonds.cracks().crossed_cracks(i, bond.neighbor, crossed);
                if (!crossed.empty() || bonds.is_parted(i, bond.neighbor))
                  all += volume;
                continue;
              }
            all += volume;
            left += state.is_whole(k) ? volume : 0.;
            ++k;
          }
        if (beyond)
          beyond->for_each_of(i, [&](const auto &bond) {
            if (!beyond->may_break(bond))
              return;
            all += beyond->volume(bond.image);
            left += bond.whole ? beyond->volume(bond.image) : 0.;
          });
        result[i] = all > 0. ? 1. - left / all : 0.;
      }
    return result;
  }


#define PERIDEAL_INSTANTIATE(dim)                                                                    \
  template const std::vector<double> &StateOperator<dim>::critical_stretches() const;                \
  template void                       StateOperator<dim>::find_critical_stretches();                 \
  template void                StateOperator<dim>::find_overstretched(const Vector &, const double); \
  template bool                StateOperator<dim>::brittle() const;                                  \
  template unsigned long long  StateOperator<dim>::break_bonds(const Vector &,                       \
                                                              const double,                         \
                                                              const double);                        \
  template double              StateOperator<dim>::released_energy() const;                          \
  template unsigned long long  StateOperator<dim>::n_broken_bonds() const;                           \
  template std::vector<double> StateOperator<dim>::damage() const;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
