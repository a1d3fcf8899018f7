// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Surface correction, and bonds that change with time.

#include <deal.II/base/mpi.h>

#include <perideal/base/user_error.h>
#include <perideal/operators/bond_operator.h>
#include <perideal/operators/crack_side_factors.h>
#include <perideal/operators/heat_content.h>

#include <algorithm>
#include <sstream>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /**
     * The sum of W xi_a^2 over a family for each direction a, and whether some bond of it is cut.
     */
    template <int dim>
    std::pair<Tensor<1, dim>, bool> moments(
      const DiffusionBonds<dim>                             &families,
      const unsigned int                                     node,
      const std::vector<typename DiffusionBonds<dim>::Bond> &family)
    {
      std::pair<Tensor<1, dim>, bool> result;
      result.second = false;
      for (const auto &bond : family)
        {
          const Tensor<1, dim> xi = families.neighbors().bond_vector(node, bond.neighbor);
          for (unsigned int d = 0; d < dim; ++d)
            result.first[d] += bond.weight * xi[d] * xi[d];
          result.second = result.second || bond.cut;
        }
      return result;
    }


    /**
     * Crack-side scaling (doc/theory.md): the trace of a full interior family is 2 d kappa, what a
     * cut family lacks is made up for.
     */
    template <int dim>
    double crack_scaling(const Tensor<1, dim> &sums, const bool cut, const double kappa_volume)
    {
      double trace = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        trace += 0.5 * sums[d];
      return crack_side_factor(cut, dim * kappa_volume, trace);
    }
  } // namespace


  template <int dim>
  std::vector<unsigned int> BondOperator<dim>::rows_to_correct() const
  {
    std::vector<unsigned int> rows;
    for (unsigned int i = 0; i < bonds.nodes().n_owned(); ++i)
      if (bonds.corrects_every_bond() || bonds.near_crack(i))
        rows.push_back(i);
    return rows;
  }


  template <int dim>
  void BondOperator<dim>::correct_surface(const std::vector<unsigned int> &rows)
  {
    const Nodes<dim>         &nodes     = bonds.nodes();
    const bool                energy    = bonds.corrects_every_bond();
    const CorrectionDirection direction = scene.peridynamics.correction_direction;
    const unsigned int n_directions = energy && direction == CorrectionDirection::both ? dim : 1;
    const unsigned int first =
      direction == CorrectionDirection::both ? 0 : static_cast<unsigned int>(direction);
    if (node_factors.empty())
      {
        node_factors.resize(n_directions);
        for (Vector &factors : node_factors)
          {
            initialize_vector(factors);
            factors = 1.;
          }
      }
    bonds.factors().set({}, 1, true); // what the bonds are without
    std::vector<typename DiffusionBonds<dim>::Bond> family;
    std::string                                     message;
    for (const unsigned int i : rows)
      {
        bonds.bonds_of(i, family);
        const auto [sums, cut]    = moments(bonds, i, family);
        const double kappa_volume = bonds.conductivities().of_node(i) * nodes.volume(i);
        if (!energy)
          node_factors[0].local_element(i) = crack_scaling(sums, cut, kappa_volume);
        for (unsigned int d = 0; d < n_directions && energy; ++d)
          {
            // Tan 2020: (kappa/2)/Z, Z = (1/4) sum W xi_a^2 / V the energy of a unit gradient in
            // direction a.
            node_factors[d].local_element(i) = 2. * kappa_volume / sums[first + d];
            if (!(sums[first + d] > 0.) && message.empty())
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
        node_factors[d].update_ghost_values();
        for (unsigned int i = 0; i < nodes.n_local(); ++i)
          all[i * n_directions + d] = node_factors[d].local_element(i);
        node_factors[d].set_ghost_state(false);
      }
    bonds.factors().set(std::move(all), n_directions, !energy);
  }


  template <int dim>
  double BondOperator<dim>::next_event(const double t) const
  {
    return bonds.cracks().history().next_event(t);
  }


  template <int dim>
  bool BondOperator<dim>::update(const double t)
  {
    const double time = bonds.cracks().history().representative(t);
    if (time == cracks_of || !bonds.cracks().history().changes_ever())
      return false;
    cracks_of        = time;
    const auto boxes = bonds.cracks().set_time(time);
    if (boxes.empty())
      return false;
    const bool                corrected = !node_factors.empty();
    std::vector<unsigned int> rows = bonds.neighbors().nodes_near(boxes, bonds.weights().reach());
    if (corrected)
      {
        correct_surface(rows);
        rows = bonds.neighbors().nodes_near(boxes, 2. * bonds.weights().reach());
      }
    if (constraints->any_slave())
      constraints = std::make_unique<NodeConstraints<dim>>(bonds, scene);
    form->update_rows(rows, bond_diagonal.begin());
    if (!bonds.neighbors().outside().empty() &&
        std::any_of(rows.begin(), rows.end(), [&](const unsigned int i) {
          return reaches_outside(i);
        }))
      outside_sums.known = false;
    std::string message;
    for (std::size_t k = 0; k < rows.size() && message.empty(); ++k)
      message = isolation(rows[k]);
    throw_on_all_if_any(bonds.nodes().communicator(), message);
    for (const auto &[node, h] : convection_diagonal)
      if (std::binary_search(rows.begin(), rows.end(), node))
        bond_diagonal.local_element(node) += h;
    if (corrected || bonds.cracks().history().may_close() || !symmetric())
      {
        // Rates can have grown. Where bonds are only cut, the old bounds still hold.
        double bound = 0.;
        for (const unsigned int i : rows)
          bound = std::max(bound, row_bound(i));
        bounds.set(
          std::max(bounds.safe(), Utilities::MPI::max(bound, bonds.nodes().communicator())));
      }
    constraints->mask(bond_diagonal, 1.);
    recount_bonds = true;
    return true;
  }


  template <int dim>
  bool BondOperator<dim>::depends_on_solution() const
  {
    return scene.material.depends_on_temperature();
  }


  template <int dim>
  bool BondOperator<dim>::capacity_depends_on_solution() const
  {
    return scene.material.storage_depends_on_temperature();
  }


  template <int dim>
  void BondOperator<dim>::heat_between(Vector &y, const Vector &u, const Vector &v) const
  {
    const Nodes<dim> &nodes = bonds.nodes();
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      y.local_element(i) = capacity_depends_on_solution() ?
                             nodes.volume(i) * heat_between_temperatures(scene.material,
                                                                         nodes.position(i),
                                                                         u.local_element(i),
                                                                         v.local_element(i)) :
                             capacity.local_element(i) * (v.local_element(i) - u.local_element(i));
  }


  template <int dim>
  void BondOperator<dim>::update_crack_sides()
  {
    // What a contact conductance lets through depends on the bond's conductivity, and so does
    // crack-side scaling.
    const bool scaled = !node_factors.empty() && !bonds.corrects_every_bond();
    if (scene.cracks.cracks.empty() || !(scaled || scene.cracks.contact_conductance > 0.))
      return;
    if (scaled)
      correct_surface(rows_to_correct());
    std::vector<unsigned int> rows;
    for (unsigned int i = 0; i < bonds.nodes().n_owned(); ++i)
      if (bonds.near_crack(i))
        rows.push_back(i);
    form->update_rows(rows, bond_diagonal.begin());
  }


  template <int dim>
  void BondOperator<dim>::take_material_at(const Vector &u)
  {
    if (!depends_on_solution())
      return;
    if (scene.material.storage_depends_on_temperature())
      find_capacity(&u);
    if (scene.material.conductivity.depends_on_temperature())
      {
        u.update_ghost_values();
        bonds.conductivities().take_at(u);
        u.set_ghost_state(false);
        form->update_conductivities(bond_diagonal.begin());
        outside_sums.known = false;
        update_crack_sides();
        if (constraints->any_slave())
          constraints = std::make_unique<NodeConstraints<dim>>(bonds, scene);
        for (const auto &[node, h] : convection_diagonal)
          bond_diagonal.local_element(node) += h;
      }
    double bound = 0.;
    for (unsigned int i = 0; i < bonds.nodes().n_owned(); ++i)
      bound = std::max(bound, row_bound(i));
    bounds.set(Utilities::MPI::max(bound, bonds.nodes().communicator()));
    constraints->mask(bond_diagonal, 1.);
  }


#define PERIDEAL_INSTANTIATE(dim)                                                                  \
  template std::vector<unsigned int> BondOperator<dim>::rows_to_correct() const;                   \
  template void   BondOperator<dim>::correct_surface(const std::vector<unsigned int> &);           \
  template bool   BondOperator<dim>::depends_on_solution() const;                                  \
  template bool   BondOperator<dim>::capacity_depends_on_solution() const;                         \
  template void   BondOperator<dim>::heat_between(Vector &, const Vector &, const Vector &) const; \
  template void   BondOperator<dim>::update_crack_sides();                                         \
  template void   BondOperator<dim>::take_material_at(const Vector &);                             \
  template double BondOperator<dim>::next_event(const double) const;                               \
  template bool   BondOperator<dim>::update(const double);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
