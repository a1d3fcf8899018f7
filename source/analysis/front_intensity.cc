// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>

#include <perideal/analysis/front_intensity.h>
#include <perideal/analysis/tip_field.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  FrontPlace::Local FrontPlace::local(const Point<3> &p) const
  {
    const Tensor<1, 3> along = cross_product_3d(ahead, normal), d = p - place;
    Local              x;
    x.x_1  = ahead * d;
    x.x_2  = normal * d;
    x.s    = along * d;
    x.axes = {{ahead, normal, along}};
    if (curvature != 0.)
      {
        // From the axis of the circle, over its radius.
        const double h = 1. + curvature * x.x_1, v = curvature * x.s;
        const double turn = std::atan2(v, h);
        x.axes[0]         = std::cos(turn) * ahead + std::sin(turn) * along;
        x.axes[2]         = std::cos(turn) * along - std::sin(turn) * ahead;
        x.x_1             = (std::hypot(h, v) - 1.) / curvature;
        x.s               = turn / curvature;
      }
    return x;
  }


  double FrontPlace::weight_at(const Local &x, Tensor<1, 3> &slope) const
  {
    const double r = std::hypot(x.x_1, x.x_2), ring = (r - inner) / (outer - inner);
    const double across = smooth_step(ring), on = half > 0. ? std::abs(x.s) / half : 0.;
    const double along = smooth_step(on);
    slope[0] = slope[1] = 0.;
    if (r > inner)
      {
        const double falls = along * slope_of_smooth_step(ring) / ((outer - inner) * r);
        slope[0]           = falls * x.x_1;
        slope[1]           = falls * x.x_2;
      }
    slope[2] = half > 0. ? across * slope_of_smooth_step(on) * std::copysign(1., x.s) /
                             (half * (1. + curvature * x.x_1)) :
                           0.;
    return across * along;
  }


  namespace
  {
    // Of CoreWeight, in cells.
    constexpr double core_gap = 2., core_reach = 5.;


    /** The two factors of m without a and b. */
    std::pair<double, double> parts_of_core_weight(const double t)
    {
      return {1. - smooth_step(t / core_gap), smooth_step(t / core_reach)};
    }
  } // namespace


  CoreWeight::CoreWeight(const double cell)
    : cell(cell)
  {
    if (cell == 0.)
      return;
    const QGauss<1>       rule(8); // exact: 12 degrees on either piece
    SymmetricTensor<2, 2> matrix;
    Tensor<1, 2>          missing;
    const double          ends[] = {0., core_gap, core_reach};
    for (unsigned int piece = 0; piece < 2; ++piece)
      for (unsigned int k = 0; k < rule.size(); ++k)
        {
          const double length       = ends[piece + 1] - ends[piece];
          const double t            = ends[piece] + rule.point(k)[0] * length;
          const double weight       = rule.weight(k) * length;
          const auto [opens, falls] = parts_of_core_weight(t);
          const Tensor<1, 2> powers({1., t});
          matrix += weight * opens * falls * symmetrize(outer_product(powers, powers));
          missing += weight * (1. - opens) * powers;
        }
    const Tensor<1, 2> solution = invert(matrix) * missing;
    factors                     = {{solution[0], solution[1]}};
  }


  double CoreWeight::operator()(const double r) const
  {
    if (r >= core_reach * cell)
      return 1.;
    const double t            = r / cell;
    const auto [opens, falls] = parts_of_core_weight(t);
    return opens * (1. + (factors[0] + factors[1] * t) * falls);
  }


  FrontIntegral::FrontIntegral(const FrontPlace &at,
                               const double      core,
                               const double      cell,
                               const Moduli     &moduli)
    : at(at)
    , core(core)
    , in_core(cell)
    , moduli(moduli)
  {}


  bool FrontIntegral::reaches(const Point<3> &p, const double radius) const
  {
    const FrontPlace::Local x = at.local(p);
    // What the circle turns away is at most as far along it.
    return std::hypot(x.x_1, x.x_2) < at.outer + radius &&
           (at.half == 0. ||
            std::abs(x.s) * (1. - std::abs(at.curvature) * at.outer) < at.half + radius);
  }


  FrontPlace::Local FrontIntegral::from_front(const RingPoint<3> &point, double &angle) const
  {
    FrontPlace::Local x = at.local(point.place);
    angle               = std::atan2(x.x_2, x.x_1);
    if (!point.node || x.x_1 >= 0.)
      return x;
    // What a node beside the crack stands for may go on beyond its plane.
    constexpr double slack = 1e-9;
    const double     apart = at.normal * (*point.node - at.place);
    const double     side  = std::abs(apart) > slack * at.outer ? apart : 1.;
    if (side * x.x_2 < 0.)
      {
        x.x_2 = 0.;
        angle = std::copysign(numbers::PI, side);
      }
    return x;
  }


  FrontIntegral::NearField FrontIntegral::near_field(const unsigned int mode,
                                                     const double       r,
                                                     const double       angle) const
  {
    NearField    field;
    const double nu = moduli.poisson();
    if (mode < 2)
      {
        const SymmetricTensor<2, 2> stress = near_stress(mode, r, angle);
        const Tensor<1, 2>          slope  = near_slope(mode, r, angle, 3. - 4. * nu, moduli.shear);
        for (unsigned int i = 0; i < 2; ++i)
          {
            field.slope[i] = slope[i];
            for (unsigned int j = i; j < 2; ++j)
              field.stress[i][j] = stress[i][j];
          }
        field.stress[2][2] = nu * trace(stress);
        return field;
      }
    // u_3 = 2/mu sqrt(r/(2 pi)) sin(angle/2)
    const double root  = 1. / std::sqrt(2. * numbers::PI * r);
    field.stress[0][2] = -root * std::sin(0.5 * angle);
    field.stress[1][2] = root * std::cos(0.5 * angle);
    field.slope[2]     = field.stress[0][2] / moduli.shear;
    return field;
  }


  Tensor<2, 3> FrontIntegral::beside_lips(Tensor<2, 3>             u,
                                          const FrontPlace::Local &x,
                                          const double             reach,
                                          const double             thermal_strain) const
  {
    constexpr double flat = 0.5;
    if (x.x_1 >= 0. || std::abs(x.x_2) >= std::min(reach, -flat * x.x_1))
      return u;
    const double ratio = moduli.lambda() / (moduli.lambda() + 2. * moduli.shear);
    u[1][1]            = thermal_strain - ratio * (u[0][0] + u[2][2] - 2. * thermal_strain);
    u[0][1]            = -u[1][0];
    u[2][1]            = -u[1][2];
    return u;
  }


  void FrontIntegral::add(const RingPoint<3> &point)
  {
    add(point, true);
  }


  void FrontIntegral::add_strip(const RingPoint<3> &point,
                                const Tensor<1, 3> &normal,
                                const bool          for_j)
  {
    const FrontPlace::Local x = at.local(point.place);
    if (x.x_1 >= 0.)
      return;
    const Tensor<1, 3> to_crack = -x.x_2 * at.normal;
    RingPoint<3>       strip    = point;
    strip.weight *= normal * to_crack;
    strip.node = point.place;
    strip.place += 0.5 * to_crack;
    add(strip, for_j);
  }


  void FrontIntegral::add(const RingPoint<3> &point, const bool for_j)
  {
    double                  angle;
    const FrontPlace::Local x = from_front(point, angle);
    const double            r = std::hypot(x.x_1, x.x_2);
    if (r >= at.outer || r == 0. || (at.half > 0. && std::abs(x.s) >= at.half))
      return;
    Tensor<1, 3> slope, b;
    const double q = at.weight_at(x, slope), c = at.bend(x);
    Tensor<2, 3> frame;
    for (unsigned int i = 0; i < 3; ++i)
      frame[i] = x.axes[i];
    b                                 = frame * point.force;
    const Tensor<2, 3>          u     = beside_lips(frame * point.gradient * transpose(frame),
                                       x,
                                       point.node ? core : 0.,
                                       point.thermal_strain);
    const Tensor<1, 3>          ahead = transpose(u)[0], along = transpose(u)[2];
    const SymmetricTensor<2, 3> elastic =
      symmetrize(u) - point.thermal_strain * unit_symmetric_tensor<3>();
    const SymmetricTensor<2, 3> sigma =
      moduli.lambda() * trace(elastic) * unit_symmetric_tensor<3>() + 2. * moduli.shear * elastic;
    const double heat   = frame[0] * point.thermal_slope;
    const double energy = 0.5 * (sigma * elastic);
    if (for_j)
      {
        const double       m = in_core(r);
        const Tensor<1, 3> slope_of_j({slope[0], slope[1], m * slope[2]});
        sums[0] += point.weight * (ahead * (sigma * slope_of_j) - energy * slope[0] +
                                   q * (m * c * (along * Tensor<2, 3>(sigma)[2] - energy) +
                                        trace(sigma) * heat - b * ahead));
      }
    for (unsigned int mode = 0; mode < 3; ++mode)
      {
        const auto [other, near] = near_field(mode, r, angle);
        const double both        = other * elastic;
        const double bent        = along * Tensor<2, 3>(other)[2] - both + sigma[2][2] * near[0] -
                            sigma[0][2] * near[2] + (other[0][0] - other[2][2]) * ahead[0] +
                            other[0][1] * ahead[1] + 2. * other[0][2] * ahead[2];
        sums[1 + mode] +=
          point.weight * (near * (sigma * slope) + ahead * (other * slope) - both * slope[0] +
                          q * (c * bent + trace(other) * heat - b * near));
      }
  }


  StressIntensity FrontIntegral::result(const MPI_Comm communicator) const
  {
    const double       nu = moduli.poisson(), plane = 0.5 * moduli.young() / (1. - nu * nu);
    const Tensor<1, 3> factors({plane, plane, moduli.shear});
    Tensor<1, 3>       K;
    for (unsigned int m = 0; m < 3; ++m)
      K[m] = factors[m] * Utilities::MPI::sum(sums[1 + m], communicator) / at.share;
    const double j = Utilities::MPI::sum(sums[0], communicator) / at.share;
    return {at.name, j, K[0], K[1], at.is_mirrored ? 0. : K[2], at.place};
  }
} // namespace PeriDeal
