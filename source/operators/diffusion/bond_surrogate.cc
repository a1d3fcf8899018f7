// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <perideal/laws/interface.h>
#include <perideal/operators/diffusion/bond_operator.h>

#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /**
     * Conductance of a bond between nearest neighbours as a 5 or 7 point scheme has it; zero for
     * longer bonds and cut ones. The same from both ends, so that the matrix is symmetric.
     */
    template <int dim>
    double neighbor_conductance(const DiffusionBonds<dim>                &bonds,
                                const InterfaceRule                       rule,
                                const unsigned int                        node,
                                const typename DiffusionBonds<dim>::Bond &bond)
    {
      const Nodes<dim> &nodes = bonds.nodes();
      if (bond.intact == 0.)
        return 0.;
      const Tensor<1, dim> xi     = bonds.neighbors().bond_vector(node, bond.neighbor);
      const unsigned int   real   = bonds.neighbors().real(bond.neighbor);
      const double         volume = std::sqrt(nodes.volume(node) * nodes.volume(real));
      const double         kept   = bond.weight / bond.intact;
      const double         kappa  = interface_conductivity(rule,
                                                  bonds.conductivities().of_node(node),
                                                  bonds.conductivities().of_node(real));
      if (nodes.lattice())
        {
          unsigned int n_steps = 0;
          for (unsigned int d = 0; d < dim; ++d)
            n_steps += std::abs(std::lround(xi[d] / nodes.lattice()->spacing[d]));
          return n_steps == 1 ? kept * kappa * volume / xi.norm_square() : 0.;
        }
      const double size =
        std::pow(std::max(nodes.volume(node), nodes.volume(bond.neighbor)), 1. / dim);
      return xi.norm() <= 1.5 * size ? 0.5 * kept * kappa * volume / xi.norm_square() : 0.;
    }
  } // namespace


  template <int dim>
  void BondOperator<dim>::surrogate(TrilinosWrappers::SparseMatrix &matrix) const
  {
    const Nodes<dim> &nodes = bonds.nodes();
    const IndexSet   &owned = nodes.dof_handler().locally_owned_dofs();

    // Which columns are free has to be known of ghosts too.
    Vector free_nodes;
    this->initialize_vector(free_nodes);
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      free_nodes.local_element(i) = constraints.kind(i) == NodeConstraints<dim>::free ? 1. : 0.;
    free_nodes.update_ghost_values();

    std::vector<typename DiffusionBonds<dim>::Bond> family;
    std::vector<unsigned int>                       starts{0};
    std::vector<double>                             of_outside(nodes.n_owned(), 0.);
    std::vector<std::pair<unsigned int, double>>    entries;
    std::vector<types::global_dof_index>            columns;
    std::vector<double>                             values;
    TrilinosWrappers::SparsityPattern               pattern(owned,
                                              nodes.communicator(),
                                              nodes.lattice() ? 2 * dim + 1 : 12);
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        columns.assign(1, nodes.partitioner()->local_to_global(i));
        if (free_nodes.local_element(i) > 0.)
          {
            bonds.nearest_bonds_of(i, family);
            for (const auto &bond : family)
              if (const double c =
                    neighbor_conductance(bonds, body.material.interface_rule, i, bond);
                  c > 0.)
                {
                  if (bond.neighbor >= nodes.n_local())
                    {
                      // A fictitious node holds its neighbours as far as it does not follow its
                      // mirror.
                      of_outside[i] +=
                        (1. - bonds.neighbors().outside()[bond.neighbor - nodes.n_local()].sign) *
                        c;
                      continue;
                    }
                  entries.emplace_back(bond.neighbor, c);
                  columns.push_back(nodes.partitioner()->local_to_global(bond.neighbor));
                }
          }
        pattern.add_entries(columns[0], columns.begin(), columns.end());
        starts.push_back(static_cast<unsigned int>(entries.size()));
      }
    pattern.compress();
    matrix.reinit(pattern);
    std::vector<double> coefficients(nodes.n_owned(), 0.);
    for (const auto &load : loads.with_coefficient())
      if (free_nodes.local_element(load.node) > 0.)
        coefficients[load.node] += load.coefficient;
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        double diag = coefficients[i] + of_outside[i];
        columns.assign(1, nodes.partitioner()->local_to_global(i));
        values.assign(1, 0.);
        for (unsigned int k = starts[i]; k < starts[i + 1]; ++k)
          {
            const auto [j, c] = entries[k];
            diag += c;
            columns.push_back(nodes.partitioner()->local_to_global(j));
            values.push_back(free_nodes.local_element(j) > 0. ? -c : 0.);
          }
        // A node without near neighbours keeps its own diagonal, so that the matrix stays regular.
        values[0] = diag > 0. ? diag : stiffness_diagonal.local_element(i);
        matrix.set(columns[0], columns.size(), columns.data(), values.data());
      }
    matrix.compress(VectorOperation::insert);
  }

  template void BondOperator<1>::surrogate(TrilinosWrappers::SparseMatrix &) const;
  template void BondOperator<2>::surrogate(TrilinosWrappers::SparseMatrix &) const;
  template void BondOperator<3>::surrogate(TrilinosWrappers::SparseMatrix &) const;
} // namespace PeriDeal
