// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Families that go on beyond the sides of the body.

#include <deal.II/base/mpi.h>

#include <perideal/base/interleaved.h>
#include <perideal/operators/state_operator.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "state_lattice.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /**
     * A traction acts on the side, where the displacement is 3/2 u_0 - 1/2 u_1 of the cell centres
     * in the two outermost rows: of a whole side or a part of it, each node of the second row bears
     * -1/2 of what its neighbour in the outermost row does. Collective.
     */
    template <int dim>
    void draw_on_to_side(const Families<dim>                   &families,
                         const BoundaryConditions<dim>         &conditions,
                         const std::array<BeyondSide, 2 * dim> &sides,
                         std::vector<TractionShare<dim>>       &tractions)
    {
      const Nodes<dim>   &nodes   = families.nodes();
      const Lattice<dim> &lattice = *nodes.lattice();
      const auto          next =
        [&](const unsigned int node, const types::boundary_id side, const int step) {
          auto site = lattice.index(nodes.position(node));
          site[side / 2] += side % 2 == 0 ? step : -step;
          return families.neighbors().node_at(site);
        };
      std::vector<TractionShare<dim>> second;
      std::array<Vector, dim + 1>     carried; // areas and places of the outermost row
      for (const VectorCondition &condition : conditions.traction)
        {
          const types::boundary_id side = conditions.side_of(condition.id);
          if (side >= 2 * dim || sides[side] != BeyondSide::continued ||
              lattice.n_sites[side / 2] == 1)
            continue;
          for (Vector &values : carried)
            values.reinit(nodes.partitioner());
          for (TractionShare<dim> &share : tractions)
            if (share.side == condition.id &&
                next(share.node, side, 1) != numbers::invalid_unsigned_int)
              {
                carried[dim].local_element(share.node) = share.area;
                for (unsigned int d = 0; d < dim; ++d)
                  carried[d].local_element(share.node) = share.place[d];
                share.area *= 1.5;
              }
          for (Vector &values : carried)
            values.update_ghost_values();
          const int row = side % 2 == 0 ? 1 : lattice.n_sites[side / 2] - 2;
          for (unsigned int i = 0; i < nodes.n_owned(); ++i)
            {
              if (lattice.index(nodes.position(i))[side / 2] != row)
                continue;
              const unsigned int outer = next(i, side, -1);
              if (outer == numbers::invalid_unsigned_int || carried[dim].local_element(outer) == 0.)
                continue;
              Point<dim> place;
              for (unsigned int d = 0; d < dim; ++d)
                place[d] = carried[d].local_element(outer);
              second.push_back({i, condition.id, -0.5 * carried[dim].local_element(outer), place});
            }
        }
      tractions.insert(tractions.end(), second.begin(), second.end());
    }
  } // namespace


  template <int dim>
  void FictitiousBonds<dim>::set_thermal_strains(
    const std::function<double(const unsigned int)> &strain)
  {
    strains.resize(images.size());
    for_each([&](const Bond &bond) {
      // What a temperature linear in space does to a free body is no linear displacement. The bond
      // has no force then if its extension is that of what the image follows from, at r_k from the
      // node: e = sum f_k (s_k M.r_k - r_k^2/2 ds/dM), the mean of both ends for a mirror image.
      const Point<dim>     at  = families.nodes().position(bond.node);
      const Tensor<1, dim> xi  = bond_vector(bond);
      double               own = strain(bond.node), other = 0., mean = 0., half = 0., rest = 1.;
      for (std::size_t k = term_starts[bond.image]; k < term_starts[bond.image + 1]; ++k)
        {
          Tensor<1, dim> r = families.nodes().position(terms[k].node) - at;
          for (unsigned int d = 0; d < dim; ++d)
            r[d] = (terms[k].mirrored >> d) & 1 ? xi[d] : r[d];
          const double f = terms[k].factor / xi.norm_square(), s = strain(terms[k].node);
          other += terms[k].factor * s;
          mean += f * s * (r * xi);
          half += 0.5 * f * r.norm_square();
          rest -= f * (r * xi);
        }
      // A body narrower than a family mirrors and continues along one axis: no such sum.
      mean -= half * (other - own);
      strains[bond.number] = std::abs(rest) > 1e-6 ? 0.5 * (own + other) : mean;
    });
  }


  template <int dim>
  void StateOperator<dim>::complete_families()
  {
    if (completes_mesh(scene))
      {
        const auto goes_on = [&](const types::boundary_id side) {
          return goes_on_beyond(scene, side);
        };
        beyond =
          std::make_unique<FictitiousBonds<dim>>(bonds,
                                                 boundary_images(bonds.nodes(),
                                                                 scene.boundary_conditions.symmetry,
                                                                 goes_on,
                                                                 bonds.weights().reach()));
        beyond->add_weights(weighted);
        return;
      }
    const auto sides = beyond_sides(scene);
    if (!bonds.neighbors().has_unique_sites() ||
        std::all_of(sides.begin(), sides.end(), [](const auto side) {
          return side == BeyondSide::nothing;
        }))
      return;
    beyond = std::make_unique<FictitiousBonds<dim>>(bonds, sides);
    if (bonds.nodes().lattice()->at_centers && scene.boundary_conditions.traction_layer <= 0.)
      draw_on_to_side(bonds, scene.boundary_conditions, sides, tractions);
    beyond->add_weights(weighted);
    // The lattice knows what is complete to the last bit.
    const double complete = complete_weighted();
    for (unsigned int i = 0; i < bonds.nodes().n_owned(); ++i)
      if (std::abs(weighted.local_element(i) - complete) < 1e-12 * complete)
        weighted.local_element(i) = complete;
  }


  template <int dim>
  void StateOperator<dim>::add_images_to_dilatations(const Vector &u, const bool strained) const
  {
    if (!beyond)
      return;
    beyond->find_images(u.begin());
    for (const unsigned int i : beyond->nodes())
      {
        double sum = 0.;
        beyond->for_each_of(i, [&](const auto &bond) {
          sum += strained ? beyond->extension_moment(bond, u.begin()) :
                            bond.moment * beyond->change(bond, u.begin());
        });
        const StateLaw &law = laws[i].law;
        const double    q   = weighted.local_element(i);
        tau.local_element(i) +=
          law.volumetric * law.dilatation * sum / (q * q * bonds.nodes().volume(i));
      }
  }


  template <int dim>
  void StateOperator<dim>::add_strained_image_forces(Vector &y, const Vector &u) const
  {
    if (!beyond)
      return;
    beyond->find_images(u.begin());
    beyond->begin_forces();
    beyond->for_each([&](const auto &bond) {
      const double size = bond.spring * beyond->extension_moment(bond, u.begin()) +
                          (volumetric ? tau.local_element(bond.node) : 0.);
      const Tensor<1, dim> force = size * beyond->direction(bond, u.begin());
      for (unsigned int d = 0; d < dim; ++d)
        y.local_element(dim * bond.node + d) -= force[d];
      beyond->pull(bond, force);
    });
    beyond->pass_on(y);
  }


  template <int dim>
  void StateOperator<dim>::linearize_images(const Vector &u)
  {
    if (!beyond)
      return;
    beyond->find_images(u.begin());
    beyond->for_each([&](const auto &bond) {
      const Tensor<1, dim> direction = beyond->direction(bond, u.begin());
      const double         size      = bond.spring * beyond->extension_moment(bond, u.begin()) +
                          (volumetric ? tau.local_element(bond.node) : 0.);
      const Tensor<1, dim> y = beyond->bond_vector(bond) + beyond->change(bond, u.begin());
      beyond->set_tangent(bond, direction, size * beyond->length(bond) / y.norm());
    });
  }


  template <int dim>
  void StateOperator<dim>::add_geometric_image_forces(Vector &y, const Vector &x) const
  {
    if (!beyond)
      return;
    beyond->begin_forces();
    beyond->for_each([&](const auto &bond) {
      if (!bond.whole)
        return;
      const double   length = beyond->length(bond);
      Tensor<1, dim> force  = beyond->change(bond, x.begin());
      force -= (bond.moment * force) / (length * length) * bond.moment;
      force *= beyond->stiffness_across(bond);
      for (unsigned int d = 0; d < dim; ++d)
        y.local_element(dim * bond.node + d) -= force[d];
      beyond->pull(bond, force);
    });
    beyond->pass_on(y);
  }


  template <int dim>
  double StateOperator<dim>::energy_of_images(const Vector &u) const
  {
    double sum = 0.;
    if (!beyond)
      return sum;
    beyond->find_images(u.begin());
    beyond->for_each([&](const auto &bond) {
      const double product = beyond->extension_moment(bond, u.begin());
      sum += 0.5 * bond.spring * product * product;
    });
    return sum;
  }


  template <int dim>
  void StateOperator<dim>::add_images_to_diagonal(const std::vector<double> &factor)
  {
    if (!beyond)
      return;
    // theta_i is a sum over coefficients of displacements. What images change of these, and what
    // was counted without them:
    Vector                      sum;
    std::vector<Tensor<1, dim>> own(bonds.nodes().n_local()), change(own.size());
    std::vector<unsigned int>   touched;
    std::vector<bool>           is_touched(own.size(), false);
    sum.reinit(unknowns);
    const auto touch = [&](const unsigned int node) {
      if (!is_touched[node])
        touched.push_back(node);
      is_touched[node] = true;
    };
    for (const unsigned int i : beyond->nodes())
      {
        touched.clear();
        beyond->for_each_of(i, [&](const auto &bond) {
          Tensor<1, dim> of_node = bond.moment;
          touch(i);
          change[i] -= bond.moment;
          beyond->for_each_term(bond.image, [&](const auto node, const auto &factors) {
            Tensor<1, dim> p;
            for (unsigned int d = 0; d < dim; ++d)
              p[d] = factors[d] * bond.moment[d];
            if (node == i)
              of_node -= p;
            else
              for (unsigned int d = 0; d < dim; ++d)
                sum.local_element(dim * node + d) += bond.spring * p[d] * p[d];
            touch(node);
            change[node] += p;
          });
          for (unsigned int d = 0; d < dim; ++d)
            sum.local_element(dim * i + d) += bond.spring * of_node[d] * of_node[d];
        });
        own[i] = Tensor<1, dim>();
        for_each_bond(i, [&](const Bond &bond) {
          own[bond.neighbor] = bond.moment;
          own[i] -= bond.moment;
        });
        for (const unsigned int node : touched)
          for (unsigned int d = 0; d < dim; ++d)
            sum.local_element(dim * node + d) +=
              factor[i] * change[node][d] * (change[node][d] + 2. * own[node][d]);
        for (const unsigned int node : touched)
          {
            change[node]     = Tensor<1, dim>();
            is_touched[node] = false;
          }
        for_each_bond(i, [&](const Bond &bond) { own[bond.neighbor] = Tensor<1, dim>(); });
        own[i] = Tensor<1, dim>();
      }
    sum.compress(VectorOperation::add);
    stiffness_diagonal += sum;
  }


  template <int dim>
  Vector StateOperator<dim>::rows_of_images(const bool with_dilatations) const
  {
    Vector rows(bonds.nodes().partitioner());
    if (!beyond)
      return rows;
    beyond->for_each([&](const auto &bond) {
      const double p    = bond.moment.norm();
      double       size = bond.spring * p * (1. + beyond->sum_of_factors(bond.image));
      size += with_dilatations ? source.local_element(bond.node) : 0.;
      rows.local_element(bond.node) += size * p;
      beyond->for_each_term(bond.image, [&](const auto node, const auto &factors) {
        double largest = 0.;
        for (unsigned int d = 0; d < dim; ++d)
          largest = std::max(largest, std::abs(factors[d]));
        rows.local_element(node) += size * largest * p;
        if (full)
          rows.local_element(node) += largest * std::abs(beyond->stiffness_across(bond)) *
                                      (1. + beyond->sum_of_factors(bond.image));
      });
      if (full)
        rows.local_element(bond.node) +=
          std::abs(beyond->stiffness_across(bond)) * (1. + beyond->sum_of_factors(bond.image));
    });
    rows.compress(VectorOperation::add);
    return rows;
  }


  template <int dim>
  void StateOperator<dim>::find_overstretched_images(const double *u)
  {
    breaking_images.clear();
    if (!beyond)
      return;
    beyond->find_images(u);
    beyond->for_each([&](const auto &bond) {
      if (!beyond->may_break(bond))
        return;
      const Tensor<1, dim> xi  = beyond->bond_vector(bond);
      const double         all = full ? beyond->length(bond) * xi.norm() : bond.moment * xi;
      const double         limit =
        all * std::min(critical[bond.node], critical[beyond->origin(bond.image)]);
      const double found = beyond->extension_moment(bond, u);
      if (found > limit)
        breaking_images.push_back({bond.number, found / limit});
    });
  }


  template <int dim>
  unsigned int StateOperator<dim>::break_images(const double t)
  {
    if (!beyond)
      return 0;
    unsigned int           n_ends = 0;
    std::vector<double>    broken;
    std::size_t            next = 0; // both lists are sorted
    std::set<unsigned int> touched;
    beyond->for_each([&](const auto &bond) {
      if (next < breaking_images.size() && breaking_images[next].first == bond.number)
        {
          n_ends += beyond->n_ends(bond);
          beyond->break_bond(bond.number, BondState::broken, t);
          touched.insert(bond.node);
          ++next;
        }
    });
    for (const auto &[k, ratio] : breaking)
      touched.insert(std::upper_bound(starts.begin(), starts.end(), k) - starts.begin() - 1);
    for (const unsigned int i : touched)
      {
        std::vector<unsigned int> lost;
        for (std::size_t k = starts[i]; k < starts[i + 1]; ++k)
          if (!state.is_whole(k))
            lost.push_back(neighbors[k]);
        beyond->break_dependent(i, lost, t);
      }
    return n_ends;
  }


#define PERIDEAL_INSTANTIATE(dim)                                                                  \
  template void FictitiousBonds<dim>::set_thermal_strains(                                         \
    const std::function<double(const unsigned int)> &);                                            \
  template void   StateOperator<dim>::complete_families();                                         \
  template void   StateOperator<dim>::add_images_to_dilatations(const Vector &, const bool) const; \
  template void   StateOperator<dim>::add_strained_image_forces(Vector &, const Vector &) const;   \
  template void   StateOperator<dim>::add_geometric_image_forces(Vector &, const Vector &) const;  \
  template void   StateOperator<dim>::linearize_images(const Vector &);                            \
  template double StateOperator<dim>::energy_of_images(const Vector &) const;                      \
  template void   StateOperator<dim>::add_images_to_diagonal(const std::vector<double> &);         \
  template Vector StateOperator<dim>::rows_of_images(const bool) const;                            \
  template void   StateOperator<dim>::find_overstretched_images(const double *);                   \
  template unsigned int StateOperator<dim>::break_images(const double);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
