// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/base/interleaved.h>
#include <perideal/base/smallest_eigenvalue.h>
#include <perideal/laws/nodal_stiffness.h>
#include <perideal/operators/coupling/breakable_zone.h>
#include <perideal/operators/solid/nodal_bonds.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  NodalBonds<dim>::NodalBonds(Coupling<dim> &coupling, const BodyParameters<dim> &body)
    : FamilyBonds<dim>(coupling, body, nullptr)
    , numbers(interleaved(*this->families.nodes().partitioner(), dim * dim + 1))
  {
    const Nodes<dim> &nodes = this->families.nodes();
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        const Moduli moduli = body.moduli(nodes.position(i));
        Node         node;
        node.lambda = dim == 1 ? 0. : lambda_of(moduli, dim, body.elasticity.plane);
        node.shear  = moduli.shear;
        node.volume = nodes.volume(i);
        nodes_of_zone.push_back(node);
      }
  }


  template <int dim>
  void NodalBonds<dim>::set_rows(const std::vector<unsigned int> &of_nodes,
                                 const CrackSideFactors          &factors)
  {
    FamilyBonds<dim>::set_rows(of_nodes, factors);
    for (const unsigned int i : of_nodes)
      {
        // b/q of the ordinary solid is c, which tells q, too.
        const double stiffness = this->coefficients.stiffness.local_element(i);
        Node        &node      = nodes_of_zone[i];
        node.share             = stiffness > 0. ? this->zone.weight_of(i) : 0.;
        node.stabilizer        = stiffness > 0. ? stiffness / node.share : 0.;
        node.weight = stiffness > 0. ? stabilizer<dim>(node.shear, node.stabilizer) * node.volume :
                                       0.;
      }
  }


  template <int dim>
  Tensor<1, dim> NodalBonds<dim>::change(const double      *u,
                                         const unsigned int i,
                                         const unsigned int j)
  {
    Tensor<1, dim> difference;
    for (unsigned int d = 0; u != nullptr && d < dim; ++d)
      difference[d] = u[dim * j + d] - u[dim * i + d];
    return difference;
  }


  template <int dim>
  typename NodalBonds<dim>::State NodalBonds<dim>::state_of(const unsigned int i,
                                                            const double      *u,
                                                            const double      *thermal) const
  {
    const Node             &node = nodes_of_zone[i];
    State                   state;
    SymmetricTensor<2, dim> shape;
    Tensor<2, dim>          changes;
    bool                    lost = false;
    if (node.share == 0.)
      return state;
    this->for_each(i, [&](const Bond &bond, const Tensor<1, dim> &xi) {
      shape += bond.strength * symmetrize(outer_product(xi, xi));
      changes += bond.strength * outer_product(change(u, i, bond.neighbor), xi);
      lost = lost || bond.strength == 0.;
    });
    if (lost && !bonds_hold(shape, node.weight))
      return state;
    state.inverse    = invert(shape);
    state.stabilizer = node.stabilizer;
    state.slopes     = changes * Tensor<2, dim>(state.inverse);
    state.strain     = symmetrize(state.slopes);
    for (unsigned int d = 0; thermal != nullptr && d < dim; ++d)
      state.strain[d][d] -= thermal[i];
    state.stress = node.lambda * trace(state.strain) * unit_symmetric_tensor<dim>() +
                   2. * node.shear * state.strain;
    return state;
  }


  template <int dim>
  void NodalBonds<dim>::add_forces_of(const std::vector<unsigned int> &of_nodes,
                                      const double                     multiple,
                                      Vector                          &y,
                                      const double                    *u,
                                      const double                    *thermal,
                                      const bool) const
  {
    constexpr unsigned int n = dim * dim + 1;
    for (const unsigned int i : this->nodes())
      {
        const Node          &node  = nodes_of_zone[i];
        const State          state = state_of(i, u, thermal);
        const double         c     = node.share * state.stabilizer;
        const Tensor<2, dim> pull =
          node.share * node.volume *
            (Tensor<2, dim>(state.stress) * Tensor<2, dim>(state.inverse)) -
          c * state.slopes;
        for (unsigned int a = 0; a < dim; ++a)
          for (unsigned int b = 0; b < dim; ++b)
            numbers.local_element(n * i + dim * a + b) = pull[a][b];
        numbers.local_element(n * i + n - 1) = c;
      }
    numbers.update_ghost_values();
    for (const unsigned int i : of_nodes)
      {
        Tensor<1, dim> sum;
        this->for_each(i, [&](const Bond &bond, const Tensor<1, dim> &xi) {
          const double *const own  = numbers.begin() + n * i,
                              *far = numbers.begin() + n * bond.neighbor;
          const Tensor<1, dim> du  = change(u, i, bond.neighbor);
          for (unsigned int a = 0; a < dim; ++a)
            {
              double force = (own[n - 1] + far[n - 1]) * du[a];
              for (unsigned int b = 0; b < dim; ++b)
                force += (own[dim * a + b] + far[dim * a + b]) * xi[b];
              sum[a] += bond.strength * force;
            }
        });
        for (unsigned int d = 0; d < dim; ++d)
          y.local_element(dim * i + d) -= multiple * sum[d];
      }
  }


  template <int dim>
  double NodalBonds<dim>::energy(const double                    *u,
                                 const std::vector<unsigned int> &of_nodes,
                                 const double                    *thermal,
                                 const bool) const
  {
    double sum = 0.;
    for (const unsigned int i : of_nodes)
      {
        const Node &node = nodes_of_zone[i];
        if (node.share == 0.)
          continue;
        const State state   = state_of(i, u, thermal);
        double      squares = 0.;
        this->for_each(i, [&](const Bond &bond, const Tensor<1, dim> &xi) {
          squares +=
            bond.strength * (change(u, i, bond.neighbor) - state.slopes * xi).norm_square();
        });
        sum += 0.5 * node.share *
               (node.volume * (state.stress * state.strain) + state.stabilizer * squares);
      }
    return sum;
  }


  /** As NodeShapes::row_sums(). */
  template <int dim>
  void NodalBonds<dim>::add_row_sums(std::vector<double> &sums) const
  {
    Vector kappas(this->families.nodes().partitioner());
    for (const unsigned int i : this->nodes())
      {
        const Node  &node    = nodes_of_zone[i];
        const State  state   = state_of(i, nullptr, nullptr);
        const double modulus = 2. * node.shear + std::max(0., dim * node.lambda);
        kappas.local_element(i) =
          node.share *
          std::max(state.stabilizer, modulus * node.volume * -smallest_eigenvalue(-state.inverse));
      }
    kappas.update_ghost_values();
    for (const unsigned int i : this->nodes())
      {
        double sum = 0.;
        this->for_each(i, [&](const Bond &bond, const auto &) {
          sum +=
            2. * bond.strength * (kappas.local_element(i) + kappas.local_element(bond.neighbor));
        });
        for (unsigned int d = 0; d < dim; ++d)
          sums[dim * i + d] += sum;
      }
  }


  PERIDEAL_INSTANTIATE_CLASS(class NodalBonds);
} // namespace PeriDeal
