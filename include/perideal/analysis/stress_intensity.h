// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <perideal/scene/scene.h>

#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * What holds at the end of a crack in two dimensions. Units: force per length (J), stress times
   * the square root of length (K).
   */
  struct StressIntensity
  {
    std::string name; // of the end, as in `crack 1 end 2`
    double      j      = 0.;
    double      mode_1 = 0., mode_2 = 0.;
  };


  /**
   * Domain integrals over a ring about the end of a straight crack, in its frame (x_1 ahead of the
   * crack):
   *
   *   J   = int (sigma_ij u_i,1 - W delta_1j) q,j dA
   *   K_m = E'/2 int (sigma_ij u^m_i,1 + sigma^m_ij u_i,1 - sigma^m_kl u_k,l delta_1j) q,j dA
   *
   * (J: Rice 1968, domain form of Li, Shih and Needleman 1985; K_m: interaction integral, Yau, Wang
   * and Corten 1980)
   * with the near-tip fields u^m of unit intensity in mode m, E' = E in plane stress, E/(1 - nu^2)
   * in plane strain, and q falling from 1 at the inner radius to 0 at the outer one, with two
   * derivatives that do not jump: cells there may be coarse. They hold for
   * one elastic material in the ring, without thermal strain and forces on the lips; W = sigma :
   * grad u/2.
   *
   * Give add() all quadrature points of this process; result() is collective.
   */
  class CrackEndIntegral
  {
  public:
    /**
     * @param end, along the place of the end and the unit vector ahead of the crack
     * @param inner, outer radii of the ring
     */
    CrackEndIntegral(const std::string          &name,
                     const dealii::Point<2>     &end,
                     const dealii::Tensor<1, 2> &along,
                     const double                inner,
                     const double                outer,
                     const Moduli               &moduli,
                     const PlaneState            plane);

    /** Whether what lies at most so far from a point counts. */
    bool reaches(const dealii::Point<2> &p, const double radius) const;

    /** @param weight the share of the area; gradient[i][j] = du_i/dx_j; force: b, per volume */
    void add(const dealii::Point<2>              &p,
             const double                         weight,
             const dealii::Tensor<2, 2>          &gradient,
             const dealii::SymmetricTensor<2, 2> &stress,
             const dealii::Tensor<1, 2>          &force = dealii::Tensor<1, 2>());

    /** The sums of all processes. Collective. */
    StressIntensity result(const MPI_Comm communicator) const;

  private:
    /** du_i/dx_1 of the near-tip field of unit intensity. */
    dealii::Tensor<1, 2> near_slope(const unsigned int mode,
                                    const double       r,
                                    const double       angle) const;

    /** q. */
    double weight_at(const double r) const;

    std::string          name;
    dealii::Point<2>     end;
    dealii::Tensor<2, 2> frame; // rows: along the crack, across it
    double               inner, outer, shear, kappa, stiffness;
    double               sums[3] = {0., 0., 0.};
  };


  /**
   * The ends of the cracks of a scene that lie in the body, away from its sides and from other
   * cracks, with rings as wide as these and the crack allow; those without room for a ring of a few
   * cells have none; holes, and regions and points that are held or loaded, stay outside the rings.
   * Empty unless the body is at rest, is no mesh file or image, and has two dimensions and one
   * material without thermal strain.
   * @param time of the cracks, whose ends may move (CrackHistory::representative())
   */
  std::vector<CrackEndIntegral> crack_end_integrals(const Scene<2> &scene, const double time);
} // namespace PeriDeal
