// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/user_error.h>
#include <perideal/operators/coupling/exchange_laws.h>
#include <perideal/operators/solid/pair_bonds.h>

#include <algorithm>
#include <cmath>

#include "change_along.h"
#include "stretch_fault.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  PairBonds<dim>::PairBonds(const Coupling<dim> &coupling, const LatticeBonds<dim> &bonds)
    : ZoneBonds<dim>(bonds.families)
    , coupling(coupling)
    , of_lattice(bonds)
  {}


  template <int dim>
  std::vector<double> PairBonds<dim>::critical_stretches(const BodyParameters<dim> &body) const
  {
    const Nodes<dim>        &nodes     = this->families.nodes();
    const Material          &material  = body.material;
    const double             of_square = ElasticBonds<dim>::energy_per_square(of_lattice);
    const CellStiffness<dim> law       = ElasticBonds<dim>::stiffness(body);
    std::string              message;
    Vector                   stretches(nodes.partitioner());
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        const Point<dim> &p = nodes.position(i);
        double           &s = stretches.local_element(i);
        s                   = material.critical_stretch ?
                                material.critical_stretch->value(p) :
                                std::sqrt(material.fracture_energy->value(p) / (law.at_first(p) * of_square));
        if (message.empty() && !(s > 0.))
          message = stretch_fault(material.critical_stretch.has_value(), p);
      }
    throw_on_all_if_any(nodes.communicator(), message);
    stretches.update_ghost_values();
    return {stretches.begin(), stretches.begin() + nodes.n_local()};
  }


  template <int dim>
  void PairBonds<dim>::set_rows(const std::vector<unsigned int> &of_nodes,
                                const CrackSideFactors          &factors)
  {
    std::vector<typename Coupling<dim>::Bond> list;
    for (const unsigned int i : of_nodes)
      {
        coupling.bonds_of(i, list);
        for (auto &bond : list)
          bond.weight *= factors.of_bond(i, bond.neighbor);
        this->set_row(i, list);
      }
    this->finish_rows();
  }


  template <int dim>
  std::vector<unsigned int> PairBonds<dim>::rows_at(const std::vector<unsigned int> &ends) const
  {
    std::vector<unsigned int> owned;
    for (const unsigned int i : ends)
      if (i < this->families.nodes().n_owned())
        owned.push_back(i);
    std::sort(owned.begin(), owned.end());
    owned.erase(std::unique(owned.begin(), owned.end()), owned.end());
    return owned;
  }


  template <int dim>
  void PairBonds<dim>::add_forces_of(const std::vector<unsigned int> &of_nodes,
                                     const double                     multiple,
                                     Vector                          &y,
                                     const Vector                    &u) const
  {
    const double *const all = u.begin();
    for (const unsigned int i : of_nodes)
      {
        Tensor<1, dim> sum;
        this->for_each(i, [&](const Bond &bond, const Tensor<1, dim> &xi) {
          sum += bond.strength * change_along<dim>(xi, all, i, bond.neighbor) * xi;
        });
        for (unsigned int d = 0; d < dim; ++d)
          y.local_element(dim * i + d) -= multiple * sum[d];
      }
  }


  template <int dim>
  Tensor<1, dim> PairBonds<dim>::diagonal_of(const unsigned int node) const
  {
    Tensor<1, dim> sum;
    this->for_each(node, [&](const Bond &bond, const Tensor<1, dim> &xi) {
      for (unsigned int d = 0; d < dim; ++d)
        sum[d] += bond.strength * xi[d] * xi[d];
    });
    return sum;
  }


  template <int dim>
  void PairBonds<dim>::add_row_sums(std::vector<double> &sums) const
  {
    for (const unsigned int i : this->nodes())
      this->for_each(i, [&](const Bond &bond, const Tensor<1, dim> &xi) {
        double length = 0.;
        for (unsigned int d = 0; d < dim; ++d)
          length += std::abs(xi[d]);
        for (unsigned int d = 0; d < dim; ++d)
          sums[dim * i + d] += 2. * bond.strength * std::abs(xi[d]) * length;
      });
  }


  template <int dim>
  double PairBonds<dim>::energy(const Vector                    &u,
                                const std::vector<unsigned int> &of_nodes,
                                const std::vector<double>       &thermal) const
  {
    double sum = 0.;
    for (const unsigned int i : of_nodes)
      this->for_each(i, [&](const Bond &bond, const Tensor<1, dim> &xi) {
        double change = change_along<dim>(xi, u.begin(), i, bond.neighbor);
        if (!thermal.empty())
          change -= 0.5 * (thermal[i] + thermal[bond.neighbor]) * xi.norm_square();
        sum += 0.25 * bond.strength * change * change;
      });
    return sum;
  }


  template <int dim>
  double PairBonds<dim>::add_thermal(Vector                          &loads,
                                     const std::vector<unsigned int> &of_nodes,
                                     const std::vector<double>       &thermal,
                                     const double                     multiple) const
  {
    double held = 0.;
    for (const unsigned int i : of_nodes)
      this->for_each(i, [&](const Bond &bond, const Tensor<1, dim> &xi) {
        const double mean = 0.5 * (thermal[i] + thermal[bond.neighbor]), square = xi.norm_square();
        for (unsigned int d = 0; d < dim; ++d)
          loads.local_element(dim * i + d) -= multiple * bond.strength * mean * square * xi[d];
        held += 0.25 * multiple * bond.strength * std::pow(mean * square, 2);
      });
    return held;
  }


  template class PairBonds<1>;
  template class PairBonds<2>;
  template class PairBonds<3>;
} // namespace PeriDeal
