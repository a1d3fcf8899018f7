// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/quadrature_lib.h>

#include <perideal/analysis/bond_intensities.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    RingPoint point_beside(const FamilyFit<2> &fit,
                           const Point<2>     &node,
                           const Tensor<1, 2> &away,
                           const bool          warm)
    {
      RingPoint point;
      point.place = node + away;
      for (unsigned int d = 0; d < 2; ++d)
        point.gradient[d] = fit.slope(d, away);
      if (warm)
        {
          point.thermal_strain = fit.value(2, away);
          point.thermal_slope  = fit.slope(2, away);
        }
      return point;
    }
  } // namespace


  std::vector<StressIntensity> bond_intensities(const Scene<2>             &scene,
                                                const Families<2>          &families,
                                                const FamilyFit<2>::Values &values,
                                                const bool                  warm,
                                                const double                t,
                                                const double                crack_time)
  {
    std::vector<StressIntensity>  list;
    std::vector<CrackEndIntegral> ends = crack_end_integrals(scene, crack_time, scene.horizon());
    if (ends.empty())
      return list;
    const Nodes<2>    &nodes = families.nodes();
    const Tensor<1, 2> edges = scene.domain.spacing();
    const QGauss<2>    rule(3);
    const auto        &given = scene.initial_and_source.body_force;
    FamilyFit<2>       fit(families);
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        const Point<2> &p = nodes.position(i);
        if (std::none_of(ends.begin(), ends.end(), [&](const CrackEndIntegral &end) {
              return end.reaches(p, 0.5 * edges.norm());
            }))
          continue;
        const Point<2> side = nodes.crack_point(i);
        fit.fit(i, warm ? 3 : 2, values);
        for (unsigned int q = 0; q < rule.size(); ++q)
          {
            Tensor<1, 2> away;
            for (unsigned int d = 0; d < 2; ++d)
              away[d] = (rule.point(q)[d] - 0.5) * edges[d];
            RingPoint point = point_beside(fit, p, away, warm);
            // Of two nodes on faces of a crack each has its own side.
            if (p.distance(side) > 0. && families.cracks().separate(side, point.place))
              continue;
            point.node   = side;
            point.weight = rule.weight(q) * edges[0] * edges[1];
            for (unsigned int d = 0; d < 2 && !given.empty(); ++d)
              point.force[d] = given[d].value(point.place, t);
            for (CrackEndIntegral &end : ends)
              end.add(point);
          }
      }
    for (CrackEndIntegral &end : ends)
      list.push_back(end.result(nodes.communicator()));
    return list;
  }
} // namespace PeriDeal
