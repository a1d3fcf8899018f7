// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>

#include <perideal/analysis/stress_intensity.h>
#include <perideal/analysis/tip_field.h>
#include <perideal/laws/elasticity.h>
#include <perideal/scene/zone.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  HalfPowerFit::HalfPowerFit(const int lowest, const int highest, const double scale)
    : lowest(lowest)
    , highest(highest)
    , scale(scale)
  {
    const std::size_t n = terms_at(scale, 0.).size();
    matrix.assign(n * n, 0.);
    right_side.assign(n, 0.);
    coefficients.assign(n, 0.);
  }


  /** Calls visit(n, whether it is a sine); r^2 comes after these. */
  template <typename Visit>
  void HalfPowerFit::for_each_term(const Visit &visit) const
  {
    for (int n = lowest; n <= highest; ++n)
      {
        visit(n, false);
        if (n != 0)
          visit(n, true);
      }
  }


  std::vector<double> HalfPowerFit::terms_at(const double r, const double angle) const
  {
    const double        x = r / scale;
    std::vector<double> terms;
    for_each_term([&](const int n, const bool sine) {
      terms.push_back(std::pow(x, 0.5 * n) *
                      (sine ? std::sin(0.5 * n * angle) : std::cos(0.5 * n * angle)));
    });
    terms.push_back(x * x);
    return terms;
  }


  void HalfPowerFit::add(const double r,
                         const double angle,
                         const double value,
                         const double weight)
  {
    const std::vector<double> terms = terms_at(r, angle);
    const std::size_t         n     = terms.size();
    for (std::size_t i = 0; i < n; ++i)
      {
        right_side[i] += weight * terms[i] * value;
        for (std::size_t j = 0; j < n; ++j)
          matrix[i * n + j] += weight * terms[i] * terms[j];
      }
  }


  void HalfPowerFit::solve(const MPI_Comm communicator)
  {
    const std::size_t   n = right_side.size();
    std::vector<double> all(n * n), right(n);
    dealii::Utilities::MPI::sum(matrix, communicator, all);
    dealii::Utilities::MPI::sum(right_side, communicator, right);
    const Eigen::MatrixXd square = Eigen::Map<const Eigen::MatrixXd>(all.data(), n, n);
    const Eigen::VectorXd found =
      Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(square).solve(
        Eigen::Map<const Eigen::VectorXd>(right.data(), n));
    coefficients.assign(found.data(), found.data() + n);
  }


  double HalfPowerFit::value(const double r, const double angle) const
  {
    const std::vector<double> terms = terms_at(r, angle);
    double                    sum   = 0.;
    for (std::size_t i = 0; i < terms.size(); ++i)
      sum += coefficients[i] * terms[i];
    return sum;
  }


  double HalfPowerFit::slope_ahead(const double r, const double angle) const
  {
    // d/dx of z^(n/2), real and imaginary part, is n/2 z^(n/2 - 1).
    const double x   = r / scale;
    double       sum = 0.;
    std::size_t  k   = 0;
    for_each_term([&](const int n, const bool sine) {
      const double power = 0.5 * n - 1.;
      sum += coefficients[k++] * 0.5 * n * std::pow(x, power) *
             (sine ? std::sin(power * angle) : std::cos(power * angle));
    });
    return (sum + coefficients[k] * 2. * x * std::cos(angle)) / scale;
  }


  namespace
  {
    const double pi = std::acos(-1.);
  } // namespace


  CrackEndIntegral::CrackEndIntegral(const std::string  &name,
                                     const Point<2>     &end,
                                     const Tensor<1, 2> &along,
                                     const double        inner,
                                     const double        outer,
                                     const double        core,
                                     const Moduli       &moduli,
                                     const PlaneState    plane,
                                     const int           on_line)
    : name(name)
    , end(end)
    , inner(inner)
    , outer(outer)
    , core(core)
    , shear(moduli.shear)
    , lambda(plane_lambda(moduli, plane))
    , on_line(on_line)
    , strain_of_heat(0, 4, core)
    , trace_of_stress(-1, 2, core)
  {
    frame[0]        = along;
    frame[1][0]     = -along[1];
    frame[1][1]     = along[0];
    const double nu = moduli.poisson();
    kappa           = plane == PlaneState::stress ? (3. - nu) / (1. + nu) : 3. - 4. * nu;
    stiffness = plane == PlaneState::stress ? moduli.young() : moduli.young() / (1. - nu * nu);
  }


  double CrackEndIntegral::weight_at(const double r) const
  {
    return smooth_step((r - inner) / (outer - inner));
  }


  double CrackEndIntegral::part_of_fits(const double r) const
  {
    return smooth_step((r - core) / core);
  }


  bool CrackEndIntegral::reaches(const Point<2> &p, const double radius) const
  {
    return p.distance(end) < outer + radius;
  }


  Tensor<1, 2> CrackEndIntegral::from_end(const RingPoint<2> &point, double &angle) const
  {
    Tensor<1, 2> x = frame * (point.place - end);
    angle          = std::atan2(x[1], x[0]);
    if (!point.node || x[0] >= 0.)
      return x;
    // What a node beside the crack stands for may go on beyond the line.
    constexpr double slack = 1e-9;
    const double     apart = frame[1] * (*point.node - end);
    const double     side  = std::abs(apart) > slack * outer ? apart : on_line;
    if (side * x[1] < 0.)
      {
        x[1]  = 0.;
        angle = std::copysign(pi, side);
      }
    return x;
  }


  void CrackEndIntegral::add(const RingPoint<2> &point)
  {
    add(point, true);
  }


  void CrackEndIntegral::add_strip(const RingPoint<2> &point,
                                   const Tensor<1, 2> &normal,
                                   const bool          for_j)
  {
    const Tensor<1, 2> x = frame * (point.place - end);
    if (x[0] >= 0.)
      return;
    const Tensor<1, 2> to_crack = -x[1] * frame[1];
    RingPoint<2>       strip    = point;
    strip.weight *= normal * to_crack;
    strip.node = point.place;
    strip.place += 0.5 * to_crack;
    add(strip, for_j);
  }


  Tensor<2, 2> CrackEndIntegral::beside_lips(Tensor<2, 2>        u,
                                             const Tensor<1, 2> &x,
                                             const double        reach,
                                             const double        thermal_strain) const
  {
    constexpr double flat = 0.5;
    if (x[0] >= 0. || std::abs(x[1]) >= std::min(reach, -flat * x[0]))
      return u;
    const double ratio = lambda / (lambda + 2. * shear); // in the plane
    u[1][1]            = thermal_strain - ratio * (u[0][0] - thermal_strain);
    u[0][1]            = -u[1][0];
    return u;
  }


  void CrackEndIntegral::add(const RingPoint<2> &point, const bool for_j)
  {
    double             angle;
    const Tensor<1, 2> x = from_end(point, angle);
    const double       r = x.norm();
    if (r >= outer || r == 0.)
      return;
    const Tensor<2, 2> u = beside_lips(frame * point.gradient * transpose(frame),
                                       x,
                                       point.node ? core : 0.,
                                       point.thermal_strain);
    const auto ahead     = [](const Tensor<2, 2> &t) { return Tensor<1, 2>({t[0][0], t[1][0]}); };
    const SymmetricTensor<2, 2> elastic =
      symmetrize(u) - point.thermal_strain * unit_symmetric_tensor<2>();
    const SymmetricTensor<2, 2> sigma =
      lambda * trace(elastic) * unit_symmetric_tensor<2>() + 2. * shear * elastic;
    if (r > 0.5 * core && r < 2. * core)
      strain_of_heat.add(r, angle, point.thermal_strain, point.weight);
    if (r > core && r < 2. * core)
      trace_of_stress.add(r, angle, trace(sigma), point.weight);
    const Tensor<1, 2> b     = frame * point.force;
    const double       warms = (1. - part_of_fits(r)) * (frame[0] * point.thermal_slope);
    if (b.norm_square() > 0. || warms != 0.)
      {
        // Both do work on the fields that move with the end, wherever q is not 0.
        const double part = point.weight * weight_at(r);
        if (for_j)
          sums[0] += part * (trace(sigma) * warms - b * ahead(u));
        for (unsigned int mode = 0; mode < 2; ++mode)
          sums[1 + mode] += part * (trace(near_stress(mode, r, angle)) * warms -
                                    b * near_slope(mode, r, angle, kappa, shear));
      }
    if (r <= inner)
      return;
    const double       s     = (r - inner) / (outer - inner);
    const Tensor<1, 2> slope = (-30. * s * s * (1. - s) * (1. - s) / ((outer - inner) * r)) * x;
    if (for_j)
      sums[0] += point.weight * (ahead(u) * (sigma * slope) - 0.5 * (sigma * elastic) * slope[0]);
    for (unsigned int mode = 0; mode < 2; ++mode)
      {
        const SymmetricTensor<2, 2> other = near_stress(mode, r, angle);
        sums[1 + mode] +=
          point.weight * (near_slope(mode, r, angle, kappa, shear) * (sigma * slope) +
                          ahead(u) * (other * slope) - (other * elastic) * slope[0]);
      }
  }


  std::array<double, 3> CrackEndIntegral::work_of_heat_in_core() const
  {
    constexpr unsigned int n_rays = 64; // the integrand has the period 2 pi
    const double           edge   = std::min(2. * core, outer);
    const QGauss<1>        radii(32);
    std::array<double, 3>  work{};
    for (unsigned int k = 0; k < radii.size(); ++k)
      for (unsigned int l = 0; l < n_rays; ++l)
        {
          const double r     = edge * radii.point(k)[0];
          const double angle = pi * ((2. * l + 1.) / n_rays - 1.);
          const double part  = radii.weight(k) * edge * r * (2. * pi / n_rays) * weight_at(r) *
                              part_of_fits(r) * strain_of_heat.slope_ahead(r, angle);
          work[0] += part * trace_of_stress.value(r, angle);
          for (unsigned int mode = 0; mode < 2; ++mode)
            work[1 + mode] += part * trace(near_stress(mode, r, angle));
        }
    return work;
  }


  StressIntensity CrackEndIntegral::result(const MPI_Comm communicator)
  {
    strain_of_heat.solve(communicator);
    trace_of_stress.solve(communicator);
    const std::array<double, 3> of_core = work_of_heat_in_core();
    double                      total[3];
    for (unsigned int k = 0; k < 3; ++k)
      total[k] = Utilities::MPI::sum(sums[k], communicator) + of_core[k];
    return {name, total[0], 0.5 * stiffness * total[1], 0.5 * stiffness * total[2]};
  }


  namespace
  {
    /** An end of a crack at a time, and the last corner on the way to it. */
    std::pair<Point<2>, Point<2>> last_stretch(const Cracks<2>   &cracks,
                                               const unsigned int crack,
                                               const unsigned int end,
                                               const double       time)
    {
      std::pair<Point<2>, Point<2>> stretch(cracks.cracks[crack][end],
                                            cracks.cracks[crack][1 - end]);
      for (const CrackTip<2> &tip : cracks.tips)
        if (tip.crack == crack && tip.corner == end)
          {
            const Tensor<1, 2> first = stretch.first - stretch.second;
            stretch.first            = tip.at(time);
            for (const auto &[turn, corner] : tip.path)
              {
                const Tensor<1, 2> on       = stretch.first - corner;
                const bool         straight = std::abs(cross_product_2d(first) * on) <
                                      1e-9 * first.norm() * on.norm();
                // Where the way begins straight on, the crack does not turn.
                if (turn < time && on.norm() > 0. && !(straight && corner == tip.path[0].second))
                  stretch.second = corner;
              }
          }
      return stretch;
    }
  } // namespace


  namespace
  {
    /** Those that a body of bonds has: its Poisson ratio is its own (bond_law()). */
    Moduli moduli_of_bonds(const Moduli &given, const PlaneState plane)
    {
      return moduli_from(Modulus::shear,
                         0.5 * (plane_lambda(given, plane) + given.shear),
                         Modulus::poisson,
                         bond_based_poisson(2, plane));
    }
  } // namespace


  std::vector<CrackEndIntegral> crack_end_integrals(const Scene<2> &scene,
                                                    const double    time,
                                                    const double    horizon)
  {
    std::vector<CrackEndIntegral> list;
    const auto                   &cracks   = scene.cracks.cracks;
    const Material               &material = scene.material;
    const double size     = 2. * scene.domain.spacing().norm(); // of cells: a ring has to hold some
    const bool   is_plate = scene.domain.shape == Shape::box ||
                          scene.domain.shape == Shape::plate_with_hole;
    if (!scene.elasticity.is_static() || !is_plate || !material.uniform_moduli())
      return list;
    const std::vector<CrackPiece<2>> pieces = scene.cracks.pieces(time);
    for (unsigned int k = 0; k < cracks.size(); ++k)
      for (unsigned int e = 0; e < 2; ++e)
        {
          const auto [end, corner]  = last_stretch(scene.cracks, k, e, time);
          const Tensor<1, 2> along  = end - corner;
          const double       length = along.norm();
          double             room   = 0.5 * length;
          for (unsigned int d = 0; d < 2; ++d)
            room = std::min({room,
                             end[d] - scene.domain.extra.body_lower[d],
                             scene.domain.extra.body_upper[d] - end[d]});
          room = std::min({room, scene.domain.holes.distance(end), distance_to_parts(scene, end)});
          for (const CrackPiece<2> &piece : pieces)
            if (piece.crack != k)
              room = std::min(room, distance_to_piece(piece.corners, end));
          const double inner = std::max(0.45 * room, horizon), outer = 0.9 * room;
          if (outer - inner < size)
            continue;
          const bool   of_bonds = horizon > 0. && scene.elasticity.is_bond_based();
          const Moduli moduli   = material.moduli(end);
          list.emplace_back("crack " + std::to_string(k + 1) + " end " + std::to_string(e + 1),
                            end,
                            along / length,
                            inner,
                            outer,
                            std::max(size, horizon),
                            of_bonds ? moduli_of_bonds(moduli, scene.elasticity.plane) : moduli,
                            scene.elasticity.plane,
                            e == 1 ? 1 : -1);
        }
    return list;
  }
} // namespace PeriDeal
