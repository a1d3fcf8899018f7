// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/point.h>

#include <Eigen/Dense>
#include <array>
#include <vector>

namespace PeriDeal
{
  /** Orthonormal Legendre polynomials on [0, 1] of degrees 0 to n - 1. */
  std::vector<double> legendre_polynomials(const unsigned int n, const double x);

  /** Their products, the first factor fastest, at a point of [0, 1]^dim. */
  Eigen::VectorXd legendre_products(const unsigned int n, const std::vector<double> &point);


  /**
   * Raviart-Thomas elements RT_k on the unit cell: Q_{k+1,k} x Q_{k,k+1}, to be mapped by Piola's
   * transformation sigma = F s/det F. Functions have one component each. First those of the faces
   * (in deal.II's order), whose numbers are the coefficients of the flux outward through the face,
   * per area of the unit face, in Legendre products of its coordinates; then those that no flux
   * leaves the cell by. The divergence of each function on the unit cell is one Legendre product,
   * with the factor 1, so that
   *
   *   (coefficients of the divergence)_m = sum of c_i with divergence[i] = m.
   *
   * With it numbers of inner functions follow from the others: c = A o + B g + Z y, with the fluxes
   * o through faces, the divergence g (but its mean, which the faces determine), and free y.
   */
  template <int dim>
  struct FluxBasis
  {
    explicit FluxBasis(const unsigned int k);

    /** The component that is not 0 of each function, at a point of the unit cell. */
    Eigen::VectorXd values(const dealii::Point<dim> &p) const;

    const unsigned int        k, n_of_face, n_of_faces, n_divergence, n;
    std::vector<unsigned int> direction, divergence;             // of each function
    Eigen::MatrixXd           from_faces, from_divergence, free; // A, B, Z

  private:
    struct Factors
    {
      int                           along; // 0, 1: the two faces; j > 1: the (j - 1)st inner one
      std::array<unsigned int, dim> across;
    };

    std::vector<Factors> factors;
  };


  /**
   * A cell of which all but the fluxes o through its faces is found already: those numbers c with
   * given o and divergence g for which c M c/2 - b c is smallest.
   */
  struct CondensedCell
  {
    /** @param mass M, of the functions of the basis */
    template <int dim>
    CondensedCell(const FluxBasis<dim> &basis, const Eigen::MatrixXd &mass);

    /** o stiffness o/2 - loads(b, g) o is what is left to be made small. */
    Eigen::VectorXd loads(const Eigen::VectorXd &b, const Eigen::VectorXd &g) const
    {
      return by_faces.transpose() * b - mixed * g;
    }

    /** c. */
    Eigen::VectorXd numbers(const Eigen::VectorXd &o,
                            const Eigen::VectorXd &b,
                            const Eigen::VectorXd &g) const
    {
      return by_faces * o + by_divergence * g + by_loads * b;
    }

    int             id = -1; // cells of one id are alike
    Eigen::MatrixXd stiffness, by_faces, by_divergence, by_loads, mixed;

    // From the middle of the corners on, in units of the cell's size (rows: coordinates): Legendre
    // coefficients of places, and factors of the fluxes o in moments.
    Eigen::MatrixXd positions, moments;
  };
} // namespace PeriDeal
