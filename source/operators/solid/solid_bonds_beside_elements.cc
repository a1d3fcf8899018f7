// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/partitioner.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <perideal/base/instantiate.h>
#include <perideal/operators/coupling/nodal_family.h>
#include <perideal/operators/coupling/state_coupling.h>
#include <perideal/operators/solid/solid_bonds_beside_elements.h>
#include <perideal/operators/solid/zone_breaking.h>
#include <perideal/scene/rules.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  void SolidBondsBesideElements<dim>::require(const BodyParameters<dim> &body)
  {
    body.coupling.refuse(
      body.coupling.is_adaptive(),
      "Zone",
      "'adaptive' is for diffusion; with 'Physics = elasticity' use 'cracks: 1' or a formula.");
    body.elasticity.refuse(
      body.elasticity.has_full_kinematics(),
      "Kinematics",
      "'full' is not for 'Models = coupled', whose coefficients are those of the undeformed body.");
    ZoneBreaking<dim>::require(body);
    if (!body.coupling.exchanges())
      refuse_coupled_families(body);
    body.peridynamics.refuse(
      body.peridynamics.completes_families() && body.coupling.exchanges(),
      "Surface correction",
      "'fictitious nodes' is not for 'Scheme = exchange', whose bonds need no correction. Use 'none', or 'splice' or 'blending'.");
    refuse_coupling(body);
  }


  template <int dim>
  SolidBondsBesideElements<dim>::SolidBondsBesideElements(std::unique_ptr<Coupling<dim>> coupling,
                                                          const BodyParameters<dim>     &body)
    : coupled(std::move(coupling))
  {
    if (has_nodal_law(body))
      own_nodal = std::make_unique<NodalZone<dim>>(*coupled, body);
  }


  template <int dim>
  Tensor<2, dim> SolidBondsBesideElements<dim>::block_of(const unsigned int node,
                                                         const Bond        &bond) const
  {
    const Tensor<1, dim> xi = coupled->families().neighbors().bond_vector(node, bond.neighbor);
    return outer_product(xi, xi);
  }


  template <int dim>
  void SolidBondsBesideElements<dim>::unknowns_of(
    const Family                         &family,
    std::vector<types::global_dof_index> &indices) const
  {
    indices.clear();
    for (const unsigned int j : family.nodes)
      for (unsigned int d = 0; d < dim; ++d)
        indices.push_back(dim * nodes().partitioner()->local_to_global(j) + d);
  }


  template <int dim>
  void SolidBondsBesideElements<dim>::add_pattern(TrilinosWrappers::SparsityPattern &pattern,
                                                  const bool                         ever) const
  {
    const Utilities::MPI::Partitioner   &layout = *nodes().partitioner();
    std::vector<unsigned int>            neighbors;
    std::vector<Bond>                    bonds;
    std::vector<types::global_dof_index> columns;
    for (unsigned int i = 0; i < layout.locally_owned_size(); ++i)
      {
        if (ever)
          coupled->possible_neighbors_of(i, neighbors);
        else
          {
            coupled->bonds_of(i, bonds);
            neighbors.clear();
            for (const Bond &bond : bonds)
              neighbors.push_back(bond.neighbor);
          }
        if (neighbors.empty())
          continue;
        columns.clear();
        for (const unsigned int j : neighbors)
          for (unsigned int d = 0; d < dim; ++d)
            columns.push_back(dim * layout.local_to_global(j) + d);
        for (unsigned int d = 0; d < dim; ++d)
          columns.push_back(dim * layout.local_to_global(i) + d);
        for (unsigned int d = 0; d < dim; ++d)
          pattern.add_entries(dim * layout.local_to_global(i) + d, columns.begin(), columns.end());
      }
    const NodeFamilies<dim> *const families = coupled->node_families();
    for (unsigned int i = 0; i < layout.locally_owned_size() && families != nullptr && !own_nodal;
         ++i)
      families->visit_nodes_of_family(i, [&](const Family &family) {
        unknowns_of(family, columns);
        for (unsigned int a = 0; a < columns.size(); ++a)
          if (family.has_row[a / dim])
            pattern.add_entries(columns[a], columns.begin(), columns.end());
      });
  }


  template <int dim>
  double SolidBondsBesideElements<dim>::add_bonds(TrilinosWrappers::SparseMatrix &matrix,
                                                  const CrackSideFactors         *factors,
                                                  const unsigned int              node,
                                                  const double                    multiple,
                                                  Rows                           &rows) const
  {
    const Utilities::MPI::Partitioner &layout = *nodes().partitioner();
    coupled->bonds_of(node, rows.bonds);
    if (rows.bonds.empty())
      return 0.;
    const auto own = layout.local_to_global(node);
    double     n   = 0.;
    rows.columns.clear();
    for (unsigned int c = 0; c < dim; ++c)
      {
        rows.columns.push_back(dim * own + c);
        rows.values[c].assign(dim, 0.);
      }
    for (const Bond &bond : rows.bonds)
      {
        if (bond.weight == 0. && factors != nullptr)
          continue;
        n += 0.5 * multiple;
        const double factor =
          multiple *
          (factors == nullptr ? bond.intact : bond.weight * factors->of_bond(node, bond.neighbor));
        const Tensor<2, dim> block = block_of(node, bond);
        for (unsigned int e = 0; e < dim; ++e)
          rows.columns.push_back(dim * layout.local_to_global(bond.neighbor) + e);
        for (unsigned int c = 0; c < dim; ++c)
          for (unsigned int e = 0; e < dim; ++e)
            {
              rows.values[c].push_back(-factor * block[c][e]);
              rows.values[c][e] += factor * block[c][e];
            }
      }
    for (unsigned int c = 0; c < dim; ++c)
      matrix.add(dim * own + c, rows.columns.size(), rows.columns.data(), rows.values[c].data());
    return n;
  }


  template <int dim>
  double SolidBondsBesideElements<dim>::add_family(TrilinosWrappers::SparseMatrix &matrix,
                                                   const bool                      intact,
                                                   const unsigned int              node,
                                                   const double                    multiple,
                                                   Rows                           &rows) const
  {
    double n = 0.;
    if (coupled->node_families() == nullptr || own_nodal)
      return n;
    coupled->node_families()->visit_family(node, intact, {}, [&](const Family &family) {
      unknowns_of(family, rows.columns);
      n += multiple * family.n_bonds;
      rows.values[0].resize(rows.columns.size());
      for (unsigned int a = 0; a < rows.columns.size(); ++a)
        if (family.has_row[a / dim])
          {
            for (unsigned int b = 0; b < rows.columns.size(); ++b)
              rows.values[0][b] = multiple * family.stiffness(a, b);
            matrix.add(rows.columns[a],
                       static_cast<types::global_dof_index>(rows.columns.size()),
                       rows.columns.data(),
                       rows.values[0].data());
          }
    });
    return n;
  }


  template <int dim>
  double SolidBondsBesideElements<dim>::add_to(TrilinosWrappers::SparseMatrix &matrix,
                                               const CrackSideFactors         *factors) const
  {
    Rows   rows;
    double n = 0.;
    for (unsigned int i = 0; i < nodes().n_owned(); ++i)
      n += add_bonds(matrix, factors, i, 1., rows);
    for (unsigned int i = 0; i < nodes().n_owned(); ++i)
      n += add_family(matrix, factors == nullptr, i, 1., rows);
    return n;
  }


  template <int dim>
  double SolidBondsBesideElements<dim>::add_to(TrilinosWrappers::SparseMatrix  &matrix,
                                               const CrackSideFactors          &factors,
                                               const std::vector<unsigned int> &of_nodes,
                                               const double                     multiple) const
  {
    Rows   rows;
    double n = 0.;
    for (const unsigned int i : of_nodes)
      {
        n += add_bonds(matrix, &factors, i, multiple, rows);
        n += add_family(matrix, false, i, multiple, rows);
      }
    return n;
  }


  template <int dim>
  double SolidBondsBesideElements<dim>::add_thermal(Vector                 &loads,
                                                    const CrackSideFactors &factors,
                                                    const ThermalStrain    &strain) const
  {
    std::vector<Bond>                    bonds;
    std::vector<types::global_dof_index> indices;
    double                               energy = 0.;
    for (unsigned int i = 0; i < nodes().n_owned(); ++i)
      {
        coupled->bonds_of(i, bonds);
        for (const Bond &bond : bonds)
          {
            if (bond.weight == 0.)
              continue;
            const Tensor<1, dim> xi   = nodes().position(bond.neighbor) - nodes().position(i);
            const double         mean = 0.5 * (strain(i) + strain(bond.neighbor));
            const Tensor<1, dim> force =
              (factors.of_bond(i, bond.neighbor) * mean * bond.weight * xi.norm_square()) * xi;
            for (unsigned int d = 0; d < dim; ++d)
              loads.local_element(dim * i + d) -= force[d];
            energy += 0.25 * mean * (force * xi); // each bond is seen from both of its ends
          }
      }
    const NodeFamilies<dim> *const families = coupled->node_families();
    for (unsigned int i = 0; i < nodes().n_owned() && families != nullptr; ++i)
      families->visit_family(i, false, strain, [&](const Family &family) {
        unknowns_of(family, indices);
        for (unsigned int a = 0; a < indices.size(); ++a)
          loads(indices[a]) += family.thermal(a);
        energy += family.thermal_energy;
      });
    return energy;
  }


  template <int dim>
  void SolidBondsBesideElements<dim>::add_to(CrackSideFactors::Sums &sums) const
  {
    std::vector<Bond> bonds;
    for (unsigned int i = 0; i < nodes().n_owned(); ++i)
      {
        coupled->bonds_of(i, bonds);
        for (const Bond &bond : bonds)
          {
            const double square =
              (nodes().position(bond.neighbor) - nodes().position(i)).norm_square();
            sums.trace.local_element(i) += 0.5 * bond.weight * square * square;
            if (bond.cut)
              sums.marked.local_element(i) = 1.;
          }
      }
  }


  template <int dim>
  double SolidBondsBesideElements<dim>::contact_family(const unsigned int            node,
                                                       std::vector<FacingBond<dim>> &list) const
  {
    list.clear();
    if (!coupled->symmetric())
      return 0.;
    std::vector<Bond> bonds;
    coupled->bonds_of(node, bonds);
    if (std::none_of(bonds.begin(), bonds.end(), [&](const Bond &bond) {
          return bond.weight == 0. && bond.intact != 0.;
        }))
      return 0.;
    for (const Bond &bond : bonds)
      {
        const Tensor<1, dim> xi = nodes().position(bond.neighbor) - nodes().position(node);
        list.push_back(
          {bond.neighbor, xi, 0.5 * bond.intact * xi.norm_square(), bond.weight == 0.});
      }
    return 1.;
  }


  template <int dim>
  std::unique_ptr<CrackContact<dim>> SolidBondsBesideElements<dim>::make_contact(
    const typename CrackContact<dim>::Layout &layout) const
  {
    return std::make_unique<CrackContact<dim>>(
      [this](const unsigned int node, std::vector<FacingBond<dim>> &bonds) {
        return contact_family(node, bonds);
      },
      nodes(),
      layout);
  }


  PERIDEAL_INSTANTIATE_CLASS(class SolidBondsBesideElements);
} // namespace PeriDeal
