// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/analysis/stress_intensity.h>

#include <array>
#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * A place on the front of a plane crack in three dimensions and a bent cylinder about the front
   * there: coordinates x_1 ahead of the crack in its plane, x_2 along its normal and s along a
   * circle that touches the front, on which the unit vectors e_1 and e_3 = e_1 x e_2 turn with the
   * front, and
   *
   *   q = S(hypot(x_1, x_2)) H(s),
   *
   * S falling from 1 at the inner radius to 0 at the outer one, H from 1 at the place to 0 at half
   * the length, both without jumps of two derivatives.
   */
  struct FrontPlace
  {
    std::string          name; // as in `crack 1 front 0.25`
    dealii::Point<3>     place;
    dealii::Tensor<1, 3> ahead, normal;  // e_1 at the place, e_2
    double               curvature = 0.; // of the circle; positive: the crack is inside it
    double               inner = 0., outer = 0.;
    double               half  = 0.; // of the length; 0: H = 1, the front from side to side
    double               share = 0.; // int q e_1 . nu ds along the front, nu normal to it
    bool is_mirrored = false;        // on a plane of symmetry: the ring is half of one, K_III is 0

    struct Local
    {
      double                              x_1 = 0., x_2 = 0., s = 0.;
      std::array<dealii::Tensor<1, 3>, 3> axes; // there
    };

    Local local(const dealii::Point<3> &p) const;

    /** q where that is, and its derivatives along the axes there. */
    double weight_at(const Local &x, dealii::Tensor<1, 3> &slope) const;

    /** 1/r of the circle through a place, r its distance from the axis. */
    double bend(const Local &x) const
    {
      return curvature / (1. + curvature * x.x_1);
    }
  };


  /**
   * A factor m(r) of densities that are singular at a front as 1/r is, where the fields within a
   * cell from it are not to be trusted: f(r), the integral of such a density over the circle with
   * the radius r, is nearly linear there, and
   *
   *   m = (1 - S(r/2h)) (1 + (a + b r/h) S(r/5h)),
   *
   * S as in FrontPlace, is 0 at the front, 1 from five cells h on, and integrates f as 1 does:
   * int (m - 1) dr = int (m - 1) r dr = 0.
   */
  class CoreWeight
  {
  public:
    /** @param cell h; 0: m = 1 */
    explicit CoreWeight(const double cell);

    double operator()(const double r) const;

  private:
    double                cell;
    std::array<double, 2> factors{}; // a, b
  };


  /**
   * Domain integrals about a place of a front, with c = bend() and the rest as in CrackEndIntegral:
   *
   *   J share   = int (sigma_ij u_i,1 - W delta_1j) q,j + c (sigma_i3 u_i,3 - W) q
   *                   + (sigma_ii s,1 - b_i u_i,1) q dV,
   *
   * Eshelby's form with the virtual advance q e_1 of the front, exact for curved fronts, too: a
   * mean of J with the weight q e_1 . nu. And K_m by interaction integrals with the near-tip fields
   * of plane strain (m = 1, 2) and antiplane strain (3) on the axes that turn with the front. These
   * are no solutions then, for which there are terms with c (Gosz and Moran 2002):
   *
   *   K_m share = M int (sigma_ij u^m_i,1 + sigma^m_ij u_i,1 - sigma^m_kl e_kl delta_1j) q,j
   *                     + c (sigma^m_i3 u_i,3 - sigma^m_kl e_kl + sigma_33 u^m_1,1
   *                          - sigma_13 u^m_3,1 + (sigma^m_11 - sigma^m_33) u_1,1
   *                          + sigma^m_12 u_2,1 + 2 sigma^m_13 u_3,1) q
   *                     + (sigma^m_ii s,1 - b_i u^m_i,1) q dV,
   *
   * M = E/(2 (1 - nu^2)), for m = 3 the shear modulus. K_II is positive where the side to which the
   * normal points slides ahead, K_III where it slides along e_3.
   *
   * What c and q,3 do to J comes from as far as the front, as much from every annulus: on lattices
   * CoreWeight takes that of the cells next to the front from those around.
   *
   * Give add() all points of this process; result() is collective.
   */
  class FrontIntegral
  {
  public:
    /**
     * @param core beside crack faces so near nothing crosses the plane (CrackEndIntegral)
     * @param cell of CoreWeight
     */
    FrontIntegral(const FrontPlace &at, const double core, const double cell, const Moduli &moduli);

    /** Whether what lies at most so far from a point counts. */
    bool reaches(const dealii::Point<3> &p, const double radius) const;

    void add(const RingPoint<3> &point);

    /** CrackEndIntegral::add_strip(), from a face of a cell to the plane of the crack. */
    void add_strip(const RingPoint<3> &point, const dealii::Tensor<1, 3> &normal, const bool for_j);

    /** The sums of all processes. Collective. */
    StressIntensity result(const MPI_Comm communicator) const;

  private:
    /** The near-tip field of a mode there: stress and du_i/dx_1 on the axes. */
    struct NearField
    {
      dealii::SymmetricTensor<2, 3> stress;
      dealii::Tensor<1, 3>          slope;
    };
    NearField near_field(const unsigned int mode, const double r, const double angle) const;

    /** On the axes there; behind the front no farther than the crack on the side of a node. */
    FrontPlace::Local from_front(const RingPoint<3> &point, double &angle) const;

    /** That no stress crosses the plane near to a crack face. */
    dealii::Tensor<2, 3> beside_lips(dealii::Tensor<2, 3>     u,
                                     const FrontPlace::Local &x,
                                     const double             reach,
                                     const double             thermal_strain) const;

    void add(const RingPoint<3> &point, const bool for_j);

    FrontPlace            at;
    double                core;
    CoreWeight            in_core;
    Moduli                moduli;
    std::array<double, 4> sums{}; // J, K_I, K_II, K_III
  };


  /**
   * Places along the fronts of the cracks of a scene in three dimensions that lie in the body, with
   * room for a ring of a few cells around: `crack 1 front 0.25`, at this part of the way along the
   * corners, where these make a curve (the disc: four; also on planes of symmetry), `crack 1 edge
   * 2`, the middle of the edge from the second corner, else; a straight one from side to side
   * without room along it is taken as a whole. What has none, and when the list is empty:
   * crack_end_integrals() in two dimensions.
   * @param time, horizon as there
   */
  std::vector<FrontIntegral> crack_end_integrals(const Scene<3> &scene,
                                                 const double    time,
                                                 const double    horizon = 0.);
} // namespace PeriDeal
