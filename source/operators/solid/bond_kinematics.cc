// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/operators/solid/bond_kinematics.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** The thermal strain of a bond to a fictitious node. */
    template <int dim>
    double strain_beyond(const Nodes<dim>     &nodes,
                         const BondEnds<dim>  &ends,
                         const ThermalStrains &thermal,
                         const unsigned int    i,
                         const unsigned int    j)
    {
      // What a temperature linear in space does to a free body is no linear displacement. The bond
      // has no force then if its extension is that of what the image follows from, at r_k from the
      // node: e = sum f_k (s_k M.r_k - r_k^2/2 ds/dM), the mean of both ends for a mirror image.
      const Point<dim>     at  = nodes.position(i);
      const Tensor<1, dim> xi  = ends.vector(i, j);
      double               own = thermal[i], other = 0., mean = 0., half = 0., rest = 1.;
      ends.images->for_each_term(ends.image(j), [&](const auto &term) {
        Tensor<1, dim> r = nodes.position(term.node) - at;
        for (unsigned int d = 0; d < dim; ++d)
          r[d] = (term.mirrored >> d) & 1 ? xi[d] : r[d];
        const double f = term.factor / xi.norm_square(), s = thermal[term.node];
        other += term.factor * s;
        mean += f * s * (r * xi);
        half += 0.5 * f * r.norm_square();
        rest -= f * (r * xi);
      });
      // A body narrower than a family mirrors and continues along one axis: no such sum.
      mean -= half * (other - own);
      return std::abs(rest) > 1e-6 ? 0.5 * (own + other) : mean;
    }
  } // namespace


  template <int dim>
  BondKinematics<dim>::BondKinematics(const Families<dim>  &families,
                                      const BondEnds<dim>  &ends,
                                      BondTable<dim>       &bonds,
                                      const ThermalStrains &thermal,
                                      const bool            full)
    : families(families)
    , ends(ends)
    , bonds(bonds)
    , thermal(thermal)
    , full(full)
  {}


  template <int dim>
  void BondKinematics<dim>::take_positions()
  {
    if (!full)
      return;
    nodes.resize(families.nodes().n_local());
    for (unsigned int i = 0; i < nodes.size(); ++i)
      for (unsigned int d = 0; d < dim; ++d)
        nodes[i].numbers[d] = families.nodes().position(i)[d];
  }


  template <int dim>
  void BondKinematics<dim>::take_thermal_strains()
  {
    seen = false;
    strains_beyond.resize(thermal.any() ? bonds.beyond.size() : 0);
    if (thermal.any())
      visit_beyond([&](const unsigned int i, const Bond &bond) {
        strains_beyond[bonds.place(bond.number)] =
          strain_beyond(families.nodes(), ends, thermal, i, bond.neighbor);
      });
  }


  template <int dim>
  DeformedRows BondKinematics<dim>::rows_at(const double *u, const Vector *tau) const
  {
    using Node = DeformedRows::Node;
    seen       = false;
    for (unsigned int i = 0; i < nodes.size(); ++i)
      {
        double *const to = nodes[i].numbers;
        for (unsigned int d = 0; d < dim; ++d)
          to[Node::displacement + d] = u[dim * i + d];
        to[Node::strain] = thermal[i];
        if (tau != nullptr)
          to[Node::tau] = tau->local_element(i);
      }

    DeformedRows all;
    all.starts    = bonds.body.starts.data();
    all.end       = bonds.body.nodes.size();
    all.neighbors = bonds.body.neighbors.data();
    all.springs   = bonds.body.springs.data();
    all.nodes     = nodes.data();
    all.lengths   = bonds.body.lengths.data();
    all.strained  = thermal.any();
    return all;
  }


  template <int dim>
  void BondKinematics<dim>::watch(std::vector<double> of_nodes)
  {
    Assert(full, ExcInternalError());
    limits = std::move(of_nodes);
    exceeds.resize(limits.size());
    seen = false;
  }


  template <int dim>
  const unsigned char *BondKinematics<dim>::exceeding(const double *u) const
  {
    if (!seen)
      return nullptr;
    for (unsigned int i = 0; i < nodes.size(); ++i)
      for (unsigned int d = 0; d < dim; ++d)
        if (nodes[i].numbers[DeformedRows::Node::displacement + d] != u[dim * i + d])
          return nullptr;
    return exceeds.data();
  }


  template <int dim>
  double BondKinematics<dim>::strained_extension_moment(const double      *u,
                                                        const unsigned int i,
                                                        const Bond        &bond) const
  {
    const Tensor<1, dim> xi     = ends.vector(i, bond.neighbor);
    const Tensor<1, dim> eta    = ends.change(u, i, bond.neighbor);
    double               strain = thermal.of_bond(i, ends.origin(bond.neighbor));
    if (ends.is_fictitious(bond.neighbor))
      strain = strains_beyond.empty() ? 0. : strains_beyond[bonds.place(bond.number)];
    if (!full)
      return bond.moment * eta - strain * (bond.moment * xi);
    // |Y| - |xi| without the difference of two nearly equal numbers
    const double x = xi.norm();
    return length(bond) * ((2. * xi + eta) * eta / ((xi + eta).norm() + x) - strain * x);
  }


  template <int dim>
  void BondKinematics<dim>::find_tensions(double              *tau,
                                          const double        *u,
                                          const NodeLaws<dim> &laws) const
  {
    ends.find(u);
    const auto product_at = [&](const unsigned int i) {
      return [this, u, i](const Bond &bond) { return extension_moment(u, i, bond); };
    };
    if (!full)
      {
        for (unsigned int i = 0; i < families.nodes().n_owned(); ++i)
          tau[i] = laws.tension(i, sum_over_bonds(bonds, i, product_at(i)));
        return;
      }
    sum_extensions<dim>(rows_at(u, nullptr), tau, nullptr);
    visit_beyond(
      [&](const unsigned int i, const Bond &bond) { tau[i] += extension_moment(u, i, bond); });
    for (unsigned int i = 0; i < families.nodes().n_owned(); ++i)
      tau[i] = laws.tension(i, tau[i]);
  }


  template <int dim>
  void BondKinematics<dim>::subtract(Vector               &y,
                                     const unsigned int    i,
                                     const unsigned int    j,
                                     const Tensor<1, dim> &force) const
  {
    for (unsigned int d = 0; d < dim; ++d)
      y.local_element(dim * i + d) -= force[d];
    if (ends.is_fictitious(j))
      ends.images->pull(ends.image(j), force);
  }


  template <int dim>
  Tensor<1, dim> BondKinematics<dim>::direction(const double      *u,
                                                const unsigned int i,
                                                const Bond        &bond) const
  {
    if (!full)
      return bond.moment;
    const Tensor<1, dim> along = ends.vector(i, bond.neighbor) + ends.change(u, i, bond.neighbor);
    return length(bond) / along.norm() * along;
  }


  template <int dim>
  double BondKinematics<dim>::force(const double      *u,
                                    const unsigned int i,
                                    const Bond        &bond,
                                    const Vector      &tau) const
  {
    const unsigned int j = bond.neighbor;
    return LinearPeridynamicSolid::force(bond.spring,
                                         extension_moment(u, i, bond),
                                         tau.local_element(i) +
                                           (ends.is_fictitious(j) ? 0. : tau.local_element(j)));
  }


  template <int dim>
  Tensor<1, dim> BondKinematics<dim>::force_on(const unsigned int i,
                                               const double      *u,
                                               const Vector      &tau) const
  {
    Tensor<1, dim> sum;
    bonds.for_each_in_body(i, [&](const Bond &bond) {
      sum += force(u, i, bond, tau) * direction(u, i, bond);
    });
    return sum;
  }


  template <int dim>
  void BondKinematics<dim>::find_forces(Vector &y, const double *u, const Vector &tau) const
  {
    if (full)
      {
        sum_forces<dim>(rows_at(u, &tau),
                        limits.empty() ? nullptr : limits.data(),
                        y.begin(),
                        exceeds.data());
        seen = !limits.empty();
      }
    else
      for (unsigned int i = 0; i < families.nodes().n_owned(); ++i)
        {
          const Tensor<1, dim> sum = force_on(i, u, tau);
          for (unsigned int d = 0; d < dim; ++d)
            y.local_element(dim * i + d) = -sum[d];
        }
    if (!ends.images)
      return;
    ends.find(u);
    ends.images->begin_forces();
    visit_beyond([&](const unsigned int i, const Bond &bond) {
      subtract(y, i, bond.neighbor, force(u, i, bond, tau) * direction(u, i, bond));
    });
    ends.images->pass_on(y);
  }


  template <int dim>
  void BondKinematics<dim>::find_forces_of(const std::vector<unsigned int> &of_nodes,
                                           double                          *y,
                                           const double                    *u,
                                           const Vector                    &tau) const
  {
    DeformedRows rows_of_nodes = rows_at(u, &tau);
    for (const unsigned int i : of_nodes)
      {
        rows_of_nodes.begin = i;
        rows_of_nodes.end   = i + 1;
        sum_forces<dim>(rows_of_nodes, nullptr, y, nullptr);
      }
  }


  template <int dim>
  double BondKinematics<dim>::energy_of_extensions(const double *u) const
  {
    double     sum      = 0.;
    const auto add_bond = [&](const unsigned int i, const Bond &bond) {
      sum += (ends.is_fictitious(bond.neighbor) ? 1. : 0.5) *
             LinearPeridynamicSolid::bond_energy(bond.spring, extension_moment(u, i, bond));
    };
    ends.find(u);
    visit_beyond(add_bond);
    const unsigned int n_owned = families.nodes().n_owned();
    if (full)
      {
        std::vector<double> sums(n_owned), squares(n_owned);
        sum_extensions<dim>(rows_at(u, nullptr), sums.data(), squares.data());
        for (const double square : squares)
          sum += 0.25 * square;
        return sum;
      }
    for (unsigned int i = 0; i < n_owned; ++i)
      bonds.for_each_in_body(i, [&](const Bond &bond) { add_bond(i, bond); });
    return sum;
  }


  template <int dim>
  void BondKinematics<dim>::linearize(const double *u, const Vector &tau)
  {
    ends.find(u);
    const auto renew = [&](BondRows<dim> &rows, const unsigned int i, const Bond &bond) {
      const std::size_t    k = bonds.place(bond.number);
      const Tensor<1, dim> y = ends.vector(i, bond.neighbor) + ends.change(u, i, bond.neighbor);
      rows.across[k]         = force(u, i, bond, tau) * length(bond) / y.norm();
      rows.moments[k]        = direction(u, i, bond);
    };
    for (unsigned int i = 0; i < families.nodes().n_owned(); ++i)
      bonds.for_each_stored(i, [&](const Bond &bond) { renew(bonds.body, i, bond); });
    visit_beyond([&](const unsigned int i, const Bond &bond) { renew(bonds.beyond, i, bond); });
  }


  template <int dim>
  void BondKinematics<dim>::add_geometric_forces(Vector &y, const double *x) const
  {
    if (ends.images)
      ends.images->begin_forces();
    for (unsigned int i = 0; i < families.nodes().n_owned(); ++i)
      bonds.for_each(i, [&](const Bond &bond) {
        if (!bonds.is_whole(bond.number))
          return;
        Tensor<1, dim>        change = ends.change(x, i, bond.neighbor);
        const Tensor<1, dim> &p      = bond.moment;
        change -= (p * change) / (length(bond) * length(bond)) * p;
        subtract(y, i, bond.neighbor, stiffness_across(bond) * change);
      });
    if (ends.images)
      ends.images->pass_on(y);
  }


  template <int dim>
  double BondKinematics<dim>::largest_stretch(const double *u) const
  {
    return Utilities::MPI::max(largest_of_stretches<dim>(rows_at(u, nullptr)),
                               families.nodes().communicator());
  }


  template <int dim>
  std::size_t BondKinematics<dim>::memory_consumption() const
  {
    return (strains_beyond.capacity() + limits.capacity()) * sizeof(double) +
           nodes.capacity() * sizeof(nodes[0]) + exceeds.capacity();
  }


  PERIDEAL_INSTANTIATE_CLASS(class BondKinematics);
} // namespace PeriDeal
