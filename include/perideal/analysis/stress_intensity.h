// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <perideal/scene/scene.h>

#include <mpi.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * What a scalar field is like around the end of a crack, by least squares of the terms
   *
   *   r^(n/2) cos(n phi/2), r^(n/2) sin(n phi/2),   n = lowest, ..., highest,
   *
   * r, phi the polar coordinates about the end, |phi| = pi on the crack faces, and r^2: the
   * expansion of harmonic fields that may jump across the crack, and of those with a uniform
   * source.
   */
  class HalfPowerFit
  {
  public:
    /** @param scale a length, of which r is a multiple */
    HalfPowerFit(const int lowest, const int highest, const double scale);

    void add(const double r, const double angle, const double value, const double weight);

    /** Of what all processes have added. Collective. */
    void solve(const MPI_Comm communicator);

    /** Of solve(). */
    double value(const double r, const double angle) const;

    /** The derivative ahead of the crack, along phi = 0. */
    double slope_ahead(const double r, const double angle) const;

  private:
    template <typename Visit>
    void for_each_term(const Visit &visit) const;

    std::vector<double> terms_at(const double r, const double angle) const;

    int                 lowest, highest;
    double              scale;
    std::vector<double> matrix, right_side, coefficients;
  };


  /**
   * What holds at the end of a crack in two dimensions, or at a place of its front in three. Units:
   * force per length (J), stress times the square root of length (K).
   */
  struct StressIntensity
  {
    std::string name; // of the end or place, as in `crack 1 end 2`
    double      j      = 0.;
    double      mode_1 = 0., mode_2 = 0.;

    std::optional<double>           mode_3 = std::nullopt; // of fronts, as is the place
    std::optional<dealii::Point<3>> place  = std::nullopt;
  };


  /** A point of the rings about ends of cracks, with what is known there. */
  template <int dim>
  struct RingPoint
  {
    dealii::Point<dim>     place;
    double                 weight = 0.; // the share of the area or volume
    dealii::Tensor<2, dim> gradient;    // [i][j] = du_i/dx_j
    dealii::Tensor<1, dim> force;       // b, per volume

    /** In the plane: alpha dT, times 1 + nu in plane strain; and its gradient. */
    double                 thermal_strain = 0.;
    dealii::Tensor<1, dim> thermal_slope;

    /** On that side of the crack the material lies; empty: at the place itself. */
    std::optional<dealii::Point<dim>> node = std::nullopt;
  };


  /**
   * Domain integrals over a ring about the end of a straight crack, in its frame (x_1 ahead of the
   * crack), with the thermal strain s, the elastic strain e_ij = (u_i,j + u_j,i)/2 - s delta_ij,
   * the stress sigma of e by Hooke's law, W = sigma : e/2 and the body force b:
   *
   *   J   = int (sigma_ij u_i,1 - W delta_1j) q,j + (sigma_ii s,1 - b_i u_i,1) q dA
   *   K_m = E'/2 int (sigma_ij u^m_i,1 + sigma^m_ij u_i,1 - sigma^m_kl e_kl delta_1j) q,j
   *                  + (sigma^m_ii s,1 - b_i u^m_i,1) q dA
   *
   * (J: Rice 1968, domain form of Li, Shih and Needleman 1985, with thermal strain Shih, Moran and
   * Nakamura 1986; K_m: interaction integral, Yau, Wang and Corten 1980)
   * with the near-tip fields u^m of unit intensity in mode m, E' = E in plane stress, E/(1 - nu^2)
   * in plane strain, and q falling from 1 at the inner radius to 0 at the outer one, with two
   * derivatives that do not jump: cells there may be coarse. They hold for one elastic material in
   * the ring without forces on the crack faces.
   *
   * What the slope of s does is as much from every annulus down to the end, where no model has the
   * fields: within some cells, or a horizon, s and the trace of sigma are those of HalfPowerFit
   * there, that of the trace from an annulus around.
   *
   * Give add() all points of this process; result() is collective.
   */
  class CrackEndIntegral
  {
  public:
    /**
     * @param end, along the place of the end and the unit vector ahead of the crack
     * @param inner, outer radii of the ring
     * @param core within which fields are not those of a continuum, nor beside it to twice that
     * @param on_line nodes on the crack lie on this side of it, 1: left of @p along, or -1
     */
    CrackEndIntegral(const std::string          &name,
                     const dealii::Point<2>     &end,
                     const dealii::Tensor<1, 2> &along,
                     const double                inner,
                     const double                outer,
                     const double                core,
                     const Moduli               &moduli,
                     const PlaneState            plane,
                     const int                   on_line = 1);

    /** Whether what lies at most so far from a point counts. */
    bool reaches(const dealii::Point<2> &p, const double radius) const;

    void add(const RingPoint<2> &point);

    /**
     * The strip from the edge of a cell on to the line of the crack, behind its end, where cells
     * are cut: all in it is as on the edge.
     * @param point on the edge, its weight a length; normal: out of the cell
     * @param for_j also for J. Where the cells of the strip are no part of the body it has none
     *              there; the near-tip fields of K_m have tractions on such an edge.
     */
    void add_strip(const RingPoint<2> &point, const dealii::Tensor<1, 2> &normal, const bool for_j);

    /** The sums of all processes. Collective. */
    StressIntensity result(const MPI_Comm communicator);

  private:
    /** In the frame; behind the end no farther than the crack on the side of a node. */
    dealii::Tensor<1, 2> from_end(const RingPoint<2> &point, double &angle) const;

    /** q, and the part of the field that HalfPowerFit has. */
    double weight_at(const double r) const;
    double part_of_fits(const double r) const;

    /**
     * The gradient of a point so near to a crack face, at most @p reach, that no stress crosses its
     * line, to second order in the distance: what bonds or cells beside the crack are stretched by
     * across it is not that of a continuum.
     */
    dealii::Tensor<2, 2> beside_lips(dealii::Tensor<2, 2>        u,
                                     const dealii::Tensor<1, 2> &x,
                                     const double                reach,
                                     const double                thermal_strain) const;

    void add(const RingPoint<2> &point, const bool for_j);

    /** What heat does where HalfPowerFit has the fields: to J and K_m, as in sums. */
    std::array<double, 3> work_of_heat_in_core() const;

    std::string          name;
    dealii::Point<2>     end;
    dealii::Tensor<2, 2> frame; // rows: along the crack, across it
    double               inner, outer, core, shear, lambda, kappa, stiffness;
    int                  on_line;
    HalfPowerFit         strain_of_heat, trace_of_stress;
    double               sums[3] = {0., 0., 0.};
  };


  /**
   * The ends of the cracks of a scene that lie in the body, away from its sides and from other
   * cracks, with rings as wide as these and the crack allow; those without room for a ring of a few
   * cells have none; holes, and regions and points that are held or loaded, stay outside the rings.
   * Empty unless the body is at rest, is no mesh file or image, and has two dimensions and the same
   * moduli everywhere.
   * @param time    of the cracks, whose ends may move (CrackHistory::representative())
   * @param horizon of peridynamics alone: rings begin beyond it, and where the body is bond-based
   *                the moduli are those of its bonds
   */
  std::vector<CrackEndIntegral> crack_end_integrals(const Scene<2> &scene,
                                                    const double    time,
                                                    const double    horizon = 0.);
} // namespace PeriDeal
