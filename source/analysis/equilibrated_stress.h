// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "composite_stress.h"
#include "stress_problem.h"

namespace PeriDeal
{
  /** A displacement in a cell: stress and load at the points inside. */
  template <int dim>
  struct SolidCell
  {
    using Matrix = typename HookeAt<dim>::Matrix;

    /** @param u columns: components */
    SolidCell(const UnitCell<dim>      &unit,
              const CellCorners<dim>   &corners,
              const StressProblem<dim> &problem,
              const Eigen::MatrixXd    &u);

    MappedPoints<dim>         at;
    std::vector<HookeAt<dim>> laws;
    std::vector<Matrix>       gradients, stresses;
    Eigen::MatrixXd           force; // columns: components
    double                    least; // eigenvalue of C
  };


  /**
   * Korn's constant of a quadrilateral: |grad v|^2 <= korn |eps(v)|^2 where the mean rotation is 0.
   * It is 2/beta^2 with the constant beta of the divergence (Horgan and Payne 1983), bounded for
   * cells that are star-shaped about a ball by Costabel and Dauge (2015, theorem 2.3).
   */
  double korn_constant(const CellCorners<2> &corners);


  /** What a cell adds to a bound: the square root of its part, of stress and of all. */
  struct StressPart
  {
    double stress = 0., all = 0.;
  };


  /**
   * Stresses in balance with the loads, near that of u_h. Tractions between cells are sums over the
   * vertices that do not hang of tractions on the support of their hat psi: of Raviart-Thomas
   * elements, one for each component, nearest to psi sigma_h, of which each cell's forces are in
   * balance with psi f - sigma_h grad psi, and its moments, too. That can be since psi times a
   * rotation is a displacement of elements from Q2 on. In the cells CompositeStress follows.
   */
  class EquilibratedStress
  {
  public:
    using Cell = typename FluxMesh<2>::Cell;

    /** @param u interleaved, with ghosts. All must outlive this. Collective. */
    EquilibratedStress(FluxMesh<2> &mesh, const StressProblem<2> &problem, const Vector &u);

    /** Of an owned cell. */
    StressPart part(const Cell &cell) const;

    /** Sums over all cells of what is left of the balances of forces and, over size, moments. */
    double imbalance() const
    {
      return left;
    }

    /** Why the bound is none; empty: it is. Of this process. */
    const std::string &fault() const
    {
      return no_bound;
    }

  private:
    VertexShares<2>                        shares(const Cell &cell);
    void                                   add_faces(const Cell           &cell,
                                                     const SolidCell<2>   &in_cell,
                                                     const CellCorners<2> &corners,
                                                     VertexShares<2>      &shares);
    void                                   finish(const VertexPatches<2> &patches);
    std::shared_ptr<const CompositeStress> composite(const CellCorners<2> &corners,
                                                     const double          size,
                                                     const double          ratio) const;

    /** Of an owned cell. */
    struct Sums
    {
      Eigen::VectorXd outward, balance; // what has to leave
      double          of_sides = 0.;    // what tractions that are no polynomials add
    };

    FluxMesh<2>              &mesh;
    const StressProblem<2>   &problem;
    const Vector             &u;
    std::vector<Sums>         sums; // by active cell index
    double                    left = 0.;
    mutable std::string       no_bound;
    const TrianglePolynomials polynomials;

    mutable std::map<std::pair<int, long>, std::shared_ptr<const CompositeStress>> known;
  };
} // namespace PeriDeal
