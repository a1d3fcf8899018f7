// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/quadrature_lib.h>

#include <perideal/analysis/bond_intensities.h>
#include <perideal/base/instantiate.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

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


  PERIDEAL_INSTANTIATE_FUNCTION_2_3(bond_intensities);
} // namespace PeriDeal
