// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/quadrature_lib.h>

#include <perideal/analysis/bond_intensities.h>
#include <perideal/base/instantiate.h>

#include <Eigen/QR>
#include <algorithm>
#include <numeric>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int highest_degree = 3;

    double power(const double x, const unsigned int n)
    {
      double result = 1.;
      for (unsigned int k = 0; k < n; ++k)
        result *= x;
      return result;
    }


    /** How many terms of these have this degree or less. */
    template <int dim>
    unsigned int n_terms_to(const std::vector<std::array<unsigned int, dim>> &terms,
                            const unsigned int                                degree)
    {
      return std::count_if(terms.begin(), terms.end(), [&](const auto &p) {
        return std::accumulate(p.begin(), p.end(), 0u) <= degree;
      });
    }
  } // namespace


  template <int dim>
  FamilyFit<dim>::FamilyFit(const Families<dim> &families)
    : families(families)
  {
    for (unsigned int degree = 1; degree <= highest_degree; ++degree)
      {
        unsigned int n = 1;
        for (unsigned int d = 0; d < dim; ++d)
          n *= degree + 1;
        for (unsigned int k = 0; k < n; ++k)
          {
            Powers       p;
            unsigned int left = k;
            for (unsigned int d = 0; d < dim; ++d, left /= degree + 1)
              p[d] = left % (degree + 1);
            if (std::accumulate(p.begin(), p.end(), 0u) == degree)
              terms.push_back(p);
          }
      }
  }


  template <int dim>
  unsigned int FamilyFit<dim>::degree_of(const unsigned int term) const
  {
    return std::accumulate(terms[term].begin(), terms[term].end(), 0u);
  }


  template <int dim>
  void FamilyFit<dim>::fit(const unsigned int node,
                           const unsigned int n_fields,
                           const Values      &values)
  {
    constexpr double whole = 0.5, // of a bond that an end of a crack cuts in part
      least                = 1e-3;
    families.members_of(node, members);
    members.erase(std::remove_if(members.begin(),
                                 members.end(),
                                 [&](const auto &member) {
                                   return member.kept < whole ||
                                          !families.neighbors().is_real(member.neighbor);
                                 }),
                  members.end());
    own.resize(n_fields);
    for (unsigned int k = 0; k < n_fields; ++k)
      own[k] = values(node, k);
    std::vector<Tensor<1, dim>> bonds;
    scale = 0.;
    for (const auto &member : members)
      {
        bonds.push_back(families.neighbors().bond_vector(node, member.neighbor));
        scale = std::max(scale, bonds.back().norm());
      }
    coefficients.assign(n_fields, std::vector<double>(terms.size(), 0.));
    n_terms = 0;
    for (unsigned int degree = highest_degree; degree > 0; --degree)
      {
        const unsigned int n = n_terms_to<dim>(terms, degree);
        if (n > bonds.size())
          continue;
        Eigen::MatrixXd rows(bonds.size(), n), given(bonds.size(), n_fields);
        for (unsigned int b = 0; b < bonds.size(); ++b)
          {
            const double weight = scale / bonds[b].norm();
            for (unsigned int i = 0; i < n; ++i)
              {
                rows(b, i) = weight;
                for (unsigned int d = 0; d < dim; ++d)
                  rows(b, i) *= power(bonds[b][d] / scale, terms[i][d]);
              }
            for (unsigned int k = 0; k < n_fields; ++k)
              given(b, k) = weight * (values(members[b].neighbor, k) - own[k]);
          }
        Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solver(rows);
        solver.setThreshold(least);
        if (solver.rank() < static_cast<Eigen::Index>(n))
          continue;
        const Eigen::MatrixXd found = solver.solve(given);
        for (unsigned int k = 0; k < n_fields; ++k)
          for (unsigned int i = 0; i < n; ++i)
            coefficients[k][i] = found(i, k);
        n_terms = n;
        return;
      }
  }


  template <int dim>
  double FamilyFit<dim>::value(const unsigned int k, const Tensor<1, dim> &away) const
  {
    double sum = own[k];
    for (unsigned int i = 0; i < n_terms; ++i)
      {
        double term = coefficients[k][i];
        for (unsigned int d = 0; d < dim; ++d)
          term *= power(away[d] / scale, terms[i][d]);
        sum += term;
      }
    return sum;
  }


  template <int dim>
  Tensor<1, dim> FamilyFit<dim>::slope(const unsigned int k, const Tensor<1, dim> &away) const
  {
    Tensor<1, dim> sum;
    for (unsigned int i = 0; i < n_terms; ++i)
      for (unsigned int along = 0; along < dim; ++along)
        {
          if (terms[i][along] == 0)
            continue;
          double term = coefficients[k][i] * terms[i][along] / scale;
          for (unsigned int d = 0; d < dim; ++d)
            term *= power(away[d] / scale, terms[i][d] - (d == along ? 1 : 0));
          sum[along] += term;
        }
    return sum;
  }


  namespace
  {
    template <int dim>
    RingPoint<dim> point_beside(const FamilyFit<dim> &fit,
                                const Point<dim>     &node,
                                const Tensor<1, dim> &away,
                                const bool            warm)
    {
      RingPoint<dim> point;
      point.place = node + away;
      for (unsigned int d = 0; d < dim; ++d)
        point.gradient[d] = fit.slope(d, away);
      if (warm)
        {
          point.thermal_strain = fit.value(dim, away);
          point.thermal_slope  = fit.slope(dim, away);
        }
      return point;
    }
  } // namespace


  template <int dim>
  std::vector<StressIntensity> bond_intensities(const Scene<dim>                      &scene,
                                                const Families<dim>                   &families,
                                                const typename FamilyFit<dim>::Values &values,
                                                const bool                             warm,
                                                const double                           t,
                                                const double                           crack_time)
  {
    std::vector<StressIntensity> list;
    auto                         ends = crack_end_integrals(scene, crack_time, scene.horizon());
    if (ends.empty())
      return list;
    const Nodes<dim>    &nodes = families.nodes();
    const Tensor<1, dim> edges = scene.domain.spacing();
    const QGauss<dim>    rule(dim == 2 ? 3 : 2);
    double               volume = 1.;
    for (unsigned int d = 0; d < dim; ++d)
      volume *= edges[d];
    const auto    &given = scene.initial_and_source.body_force;
    FamilyFit<dim> fit(families);
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        const Point<dim> &p = nodes.position(i);
        if (std::none_of(ends.begin(), ends.end(), [&](const auto &end) {
              return end.reaches(p, 0.5 * edges.norm());
            }))
          continue;
        const Point<dim> side = nodes.crack_point(i);
        fit.fit(i, warm ? dim + 1 : dim, values);
        for (unsigned int q = 0; q < rule.size(); ++q)
          {
            Tensor<1, dim> away;
            for (unsigned int d = 0; d < dim; ++d)
              away[d] = (rule.point(q)[d] - 0.5) * edges[d];
            RingPoint<dim> point = point_beside(fit, p, away, warm);
            // Of two nodes on faces of a crack each has its own side.
            if (p.distance(side) > 0. && families.cracks().separate(side, point.place))
              continue;
            point.node = side;
            // Only where a front goes from side to side rings come to these.
            if (dim == 3 && !scene.domain.contains(point.place))
              continue;
            point.weight = rule.weight(q) * volume;
            for (unsigned int d = 0; d < dim && !given.empty(); ++d)
              point.force[d] = given[d].value(point.place, t);
            for (auto &end : ends)
              end.add(point);
          }
      }
    for (auto &end : ends)
      list.push_back(end.result(nodes.communicator()));
    return list;
  }


  PERIDEAL_INSTANTIATE_CLASS(class FamilyFit);
  PERIDEAL_INSTANTIATE_FUNCTION_2_3(bond_intensities);
} // namespace PeriDeal
