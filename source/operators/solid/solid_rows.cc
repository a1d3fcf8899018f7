// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Which bonds are stored, and which the lattice knows.

#include <perideal/base/make_room.h>
#include <perideal/base/place_text.h>
#include <perideal/base/smallest_eigenvalue.h>
#include <perideal/base/user_error.h>
#include <perideal/operators/lattice/bond_form.h>
#include <perideal/operators/solid/solid_rows.h>
#include <perideal/operators/solid/surface_factors.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "../lattice/state_lattice.h"
#include "change_along.h"

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


    template <int dim>
    bool may_leave_out_bonds(const Families<dim> &families, const BodyParameters<dim> &body)
    {
      const std::string reason = families.neighbors().has_unique_sites() ?
                                   StateLattice<dim>::obstacle(body) :
                                   "the nodes are not on a lattice with one node per site";
      // Bonds of bars take little, and differences of displacements round less than convolutions.
      return takes_lattice_form(body.peridynamics.form, reason, dim > 1);
    }
  } // namespace


  template <int dim>
  SolidRows<dim>::SolidRows(const Families<dim>       &families,
                            NodeLaws<dim>             &laws,
                            const BodyParameters<dim> &body)
    : families(families)
    , laws(laws)
    , horizon(body.horizon())
  {
    const Nodes<dim> &nodes     = families.nodes();
    const bool        leave_out = may_leave_out_bonds(families, body);
    const double      q         = leave_out ? complete_weighted() : 0.;
    Family            family;
    std::string       message;
    std::vector<bool> changing;
    row_of.assign(nodes.n_owned(), no_row);
    if (!leave_out && families.neighbors().has_unique_sites())
      {
        // More than enough, in one go: what is not written to takes no memory.
        const std::size_t n = families.weights().members().size() * nodes.n_owned();
        neighbors.reserve(n);
        moments.reserve(n);
        springs.reserve(n);
      }
    if (leave_out)
      {
        lattice_bonds = unit_bonds(families);
        packs         = lattice_bonds.size() < BondCode::gone;
        changing      = find_changing(body);
      }
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        const bool complete = leave_out && has_complete_family(i);
        bool       stored   = !leave_out;
        if (complete && !families.near_crack(i) && !changing[i])
          n_whole += 0.5 * static_cast<double>(lattice_bonds.size()); // at each end
        else
          {
            families.members_of(i, family);
            stored = stored || changing[i] ||
                     std::any_of(family.begin(), family.end(), [](const auto &bond) {
                       return bond.kept < 1. || bond.weight == 0.;
                     });
            n_whole += 0.5 * static_cast<double>(
                               std::count_if(family.begin(), family.end(), [](const auto &bond) {
                                 return bond.kept * bond.weight != 0.;
                               }));
            laws.weighted.local_element(i) = weight_of(i, family, message);
          }
        if (stored)
          add_row(i, family);
        else if (complete)
          laws.weighted.local_element(i) = q; // to the last bit
      }
    if (!leave_out)
      row_of.clear(); // all rows, in the order of their nodes
    throw_on_all_if_any(nodes.communicator(), message);
  }


  template <int dim>
  SolidRows<dim>::~SolidRows() = default;


  template <int dim>
  std::vector<bool> SolidRows<dim>::find_changing(const BodyParameters<dim> &body) const
  {
    constexpr unsigned int   n_spans = 64; // boxes around parts of a crooked way take in less
    const CrackHistory<dim> &history = families.cracks().history();
    std::vector<bool>        changing(families.nodes().n_owned(), false);
    if (!history.changes_ever())
      return changing;
    // q of a node whose bonds are cut changes the springs of its neighbours.
    const double distance = 2. * families.weights().reach();
    const double end      = body.cracks.end_time;
    for (unsigned int k = 0; k < n_spans; ++k)
      for (const unsigned int i : families.neighbors().nodes_near(
             history.changes(end * k / n_spans, end * (k + 1) / n_spans),
             distance))
        changing[i] = true;
    return changing;
  }


  template <int dim>
  bool SolidRows<dim>::has_complete_family(const unsigned int i) const
  {
    const Nodes<dim> &nodes  = families.nodes();
    const double      volume = nodes.lattice()->cell_volume();
    if (nodes.volume(i) != volume)
      return false;
    const auto site = nodes.lattice()->index(nodes.position(i));
    for (const FamilyMember<dim> &member : families.weights().members())
      {
        const unsigned int j = families.neighbors().node_at(site + member.offset);
        if (j == numbers::invalid_unsigned_int || nodes.volume(j) != volume)
          return false;
      }
    return true;
  }


  template <int dim>
  double SolidRows<dim>::complete_weighted() const
  {
    double q = 0.;
    for (const FamilyMember<dim> &member : families.weights().members())
      q += families.nodes().lattice()->cell_volume() * member.weight * member.r * member.r;
    return q;
  }


  template <int dim>
  void SolidRows<dim>::add_row(const unsigned int i, const Family &family)
  {
    if (packs)
      pack_row(i, family);
    else
      for (const auto &bond : family)
        {
          const double weight = bond.kept * bond.weight;
          if (weight == 0.)
            continue;
          AssertIndexRange(bond.neighbor, families.nodes().n_local()); // no fictitious nodes
          const Tensor<1, dim> xi = families.neighbors().bond_vector(i, bond.neighbor);
          neighbors.push_back(bond.neighbor);
          moments.push_back(weight * xi);
          springs.push_back(weight * xi.norm_square());
        }
    row_of[i] = static_cast<std::uint32_t>(stored_nodes.size());
    stored_nodes.push_back(i);
    starts.push_back(neighbors.size());
  }


  template <int dim>
  void SolidRows<dim>::pack_row(const unsigned int i, const Family &family)
  {
    make_room(neighbors, family.size());
    make_room(codes, family.size());
    const auto site = families.nodes().lattice()->index(families.nodes().position(i));
    auto       bond = family.begin();
    for (unsigned int m = 0; m < lattice_bonds.size() && bond != family.end(); ++m)
      if (families.neighbors().node_at(site + lattice_bonds[m].offset) == bond->neighbor)
        {
          if (bond->kept * bond->weight != 0.)
            {
              if (bond->kept < 1.)
                parts.emplace_back(neighbors.size(), bond->kept);
              neighbors.push_back(bond->neighbor);
              codes.push_back(
                static_cast<BondCode::Code>(m | (bond->kept < 1. ? BondCode::in_part : 0)));
            }
          ++bond;
        }
    Assert(bond == family.end(), ExcInternalError());
  }


  template <int dim>
  template <typename Visit>
  void SolidRows<dim>::for_each_packed(const unsigned int i, const Visit &visit) const
  {
    for (std::size_t k = begin_of(i); k < end_of(i); ++k)
      if (codes[k] != BondCode::gone)
        visit(k, neighbors[k], lattice_bonds[BondCode::number(codes[k])]);
  }


  template <int dim>
  void SolidRows<dim>::store_row(const unsigned int i)
  {
    Assert(is_on_lattice(i), ExcInternalError());
    Family family;
    families.members_of(i, family);
    add_row(i, family);
    for (std::size_t k = begin_of(i); !packs && k < end_of(i); ++k)
      springs[k] = (laws.stiffness(i) + laws.stiffness(neighbors[k])) / springs[k]; // W x^2
  }


  template <int dim>
  BondState::Numbering SolidRows<dim>::numbering(const bool stores)
  {
    return {[this](const std::size_t number) -> std::size_t { return node_of(number); },
            [this, stores](const std::size_t node) {
              if (stores && is_on_lattice(node))
                store_row(node);
              return begin_of(node);
            },
            [this]() { return n_stored(); }};
  }


  template <int dim>
  double SolidRows<dim>::weight_of(const unsigned int i,
                                   const Family      &family,
                                   std::string       &message) const
  {
    const Nodes<dim>       &nodes = families.nodes();
    SymmetricTensor<2, dim> shape;
    double                  q = 0.;
    for (const auto &bond : family)
      if (const double weight = bond.kept * bond.weight; weight != 0.)
        {
          const Tensor<1, dim> xi = families.neighbors().bond_vector(i, bond.neighbor);
          q += weight * xi.norm_square() / nodes.volume(i);
          shape += weight * symmetrize(outer_product(xi, xi));
        }
    if (!message.empty())
      return q;
    if (!(q > 0.))
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
  double SolidRows<dim>::weight_left(const unsigned int i, std::string &message) const
  {
    Family family;
    families.members_of(i, family);
    return weight_of(i, family, message);
  }


  template <int dim>
  void SolidRows<dim>::renew_springs(const unsigned int i, const BondState &state)
  {
    if (packs) // they follow from q
      return;
    Family family;
    families.members_of(i, family);
    std::size_t k = begin_of(i);
    for (const auto &bond : family)
      if (k < end_of(i) && neighbors[k] == bond.neighbor && bond.weight != 0.)
        {
          const double square =
            bond.weight * families.neighbors().bond_vector(i, bond.neighbor).norm_square();
          if (state.is_whole(k))
            springs[k] = (laws.stiffness(i) + laws.stiffness(neighbors[k])) / square;
          ++k;
        }
  }


  template <int dim>
  void SolidRows<dim>::correct_surface(const BodyParameters<dim> &body)
  {
    // Springs still are W x^2.
    const SurfaceFactors factors =
      surface_factors(families, body.peridynamics, {starts, neighbors, springs});
    std::string message;
    for (unsigned int i = 0; i < families.nodes().n_owned(); ++i)
      if (message.empty() && laws.volumetric &&
          laws[i].extension + laws[i].volumetric * laws[i].dilatation * factors.ratio[i] <= 0.)
        message =
          "'Surface correction' in section 'Peridynamics': with this Poisson ratio the energy of the node at " +
          place_text(families.nodes().position(i)) +
          " would not be positive. Use 'moments' or 'none'.";
    throw_on_all_if_any(families.nodes().communicator(), message);
    for (std::size_t k = 0; k < neighbors.size(); ++k)
      {
        moments[k] *= factors.dilatation[k];
        springs[k] *= factors.dilatation[k] * factors.dilatation[k] / factors.extension[k];
      }
    laws.weighted = factors.q;
    n_uncorrected = factors.n_left;
    moments_gap   = factors.gap;
    laws.weighted.update_ghost_values();
  }


  template <int dim>
  void SolidRows<dim>::find_springs(const BodyParameters<dim> &body)
  {
    if (body.peridynamics.corrects_elastic_bonds())
      correct_surface(body);
    for (const unsigned int i : stored_nodes)
      for (std::size_t k = begin_of(i); !packs && k < end_of(i); ++k)
        springs[k] = (laws.stiffness(i) + laws.stiffness(neighbors[k])) / springs[k]; // W x^2
    if (!lattice_bonds.empty())
      make_lattice();
  }


  template <int dim>
  void SolidRows<dim>::make_lattice()
  {
    const StateLaw      law = laws.reference();
    const double        q   = complete_weighted();
    LatticeCoefficients coefficients;
    coefficients.stiffness  = law.extension / q;
    coefficients.dilatation = laws.volumetric ? law.volumetric * law.dilatation / (q * q) : 0.;
    for (unsigned int i = 0; i < families.nodes().n_local(); ++i)
      {
        const double own = laws.weighted.local_element(i);
        coefficients.excesses.push_back(0.5 * (laws.stiffness(i) / coefficients.stiffness - 1.));
        if (laws.volumetric && i < families.nodes().n_owned())
          coefficients.dilatations.push_back(laws[i].volumetric * laws[i].dilatation / (own * own));
      }
    std::vector<bool> computed;
    for (const std::uint32_t row : row_of)
      computed.push_back(row == no_row);
    lattice = std::make_unique<StateLattice<dim>>(families, coefficients, computed);
  }


  template <int dim>
  bool SolidRows<dim>::is_regular(const unsigned int i) const
  {
    return lattice && is_on_lattice(i) && lattice->is_regular(i);
  }


  template <int dim>
  void SolidRows<dim>::find_tensions(double *tau, const double *u) const
  {
    if (lattice)
      lattice->dilatation_forces(tau, u);
    for (const unsigned int i : stored_nodes)
      {
        double sum = 0.;
        if (packs)
          for_each_packed(i,
                          [&](const std::size_t k, const unsigned int j, const LatticeBond &bond) {
                            sum += volumes_of(i, k) * change_along(bond.moment, u, i, j);
                          });
        else
          for (std::size_t k = begin_of(i); k < end_of(i); ++k)
            sum += change_along(moments[k], u, i, neighbors[k]);
        tau[i] = laws.tension(i, sum);
      }
  }


  template <int dim>
  void SolidRows<dim>::find_forces(double *y, const double *u, const double *tau) const
  {
    if (lattice)
      lattice->forces(y, u, tau);
    const auto tension = [tau](const unsigned int i, const unsigned int j) {
      return tau != nullptr ? tau[i] + tau[j] : 0.;
    };
    for (const unsigned int i : stored_nodes)
      {
        Tensor<1, dim> force;
        if (packs) // of spring and W x e volumes drop out
          for_each_packed(i,
                          [&, own = laws.stiffness(i)](const std::size_t  k,
                                                       const unsigned int j,
                                                       const LatticeBond &bond) {
                            const double stiffness = (own + laws.stiffness(j)) / bond.weight;
                            const double size =
                              stiffness * change_along(bond.moment, u, i, j) + tension(i, j);
                            force += (size * volumes_of(i, k)) * bond.moment;
                          });
        else
          for (std::size_t k = begin_of(i); k < end_of(i); ++k)
            {
              const unsigned int    j = neighbors[k];
              const Tensor<1, dim> &p = moments[k];
              force += (springs[k] * change_along(p, u, i, j) + tension(i, j)) * p;
            }
        for (unsigned int d = 0; d < dim; ++d)
          y[static_cast<std::size_t>(dim) * i + d] = -force[d];
      }
  }


  template <int dim>
  bool SolidRows<dim>::may_exceed(const unsigned int i, const double *u, const double stretch) const
  {
    if (!packs || !(stretch > 0.))
      return true;
    const double limit = (1. - 1e-9) * stretch;
    bool         any   = false;
    for_each_packed(i, [&](const std::size_t, const unsigned int j, const LatticeBond &bond) {
      any = any || change_along(bond.moment, u, i, j) > limit * bond.weight;
    });
    return any;
  }


  template <int dim>
  void SolidRows<dim>::release(const std::size_t number)
  {
    if (packs)
      codes[number] = BondCode::gone;
    else
      {
        springs[number] = 0.;
        moments[number] = Tensor<1, dim>();
      }
    n_whole -= 0.5;
  }


  template <int dim>
  std::size_t SolidRows<dim>::memory_consumption() const
  {
    return moments.size() * sizeof(moments[0]) + springs.size() * sizeof(double) +
           codes.capacity() * sizeof(BondCode::Code) + parts.capacity() * sizeof(parts[0]) +
           starts.capacity() * sizeof(std::size_t) +
           (packs ? neighbors.capacity() : neighbors.size()) * sizeof(unsigned int) +
           (stored_nodes.capacity() + row_of.capacity()) * sizeof(unsigned int) +
           (lattice ? lattice->memory_consumption() : 0);
  }


  template class SolidRows<1>;
  template class SolidRows<2>;
  template class SolidRows<3>;
} // namespace PeriDeal
