// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/types.h>

#include <Eigen/Dense>
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "flux_basis.h"

namespace PeriDeal
{
  /**
   * Where a face of a cell lies on the face of the larger one of the two cells beside it, whose
   * coordinates begin at its vertex with the lowest number and go first towards the lower one of
   * the next two.
   */
  struct FacePlace
  {
    /** What the flux through it is, as seen from the cell. */
    enum State
    {
      shared, // with the neighbour
      given,
      open // a value is given, and any flux may pass
    };

    int                                            state = given;
    std::array<dealii::types::global_dof_index, 4> key{}; // vertices of the larger face, ascending
    std::array<int, 2>                             origin{}; // in halves of it
    std::array<int, 4> steps{}; // along each coordinate of the own face: 2 a + c, of both

    /** Part of the larger face. */
    double share(const unsigned int n_coordinates) const;

    template <class Archive>
    void serialize(Archive &archive, const unsigned int)
    {
      archive &state &key &origin &steps;
    }
  };


  /** What a cell adds to the problem of a vertex, for each component of a flux in turn. */
  struct PatchCell
  {
    dealii::types::global_dof_index      vertex = 0;
    unsigned int                         cell   = 0; // active cell index at its owner
    unsigned int                         corner = 0; // of the cell, nearest to the vertex
    unsigned int                         owner  = 0;
    double                               factor = 1.; // of the stiffness of the condensed cell
    Eigen::VectorXd                      means;       // what has to flow out, and moments of it
    std::vector<FacePlace>               faces;
    Eigen::VectorXd                      loads, given; // of the fluxes through faces
    std::shared_ptr<const CondensedCell> condensed;
  };


  /**
   * Fluxes through the faces of the cells around a vertex: those that make sum of factor (o
   * stiffness o/2 - loads o) the smallest, where the fluxes through all faces that are not shared
   * by two of the cells and are not open are given, others are continuous, and out of each cell
   * flows its mean. Of several components, which are those of forces, the moments of each cell
   * about its middle are given, too, in units of its size: of t_i x_j - t_j x_i for i < j. Where
   * there are no such fluxes, as where no face of cells that share faces is open, means and moments
   * are changed as little as makes them possible. Factorizations are kept, and serve all vertices
   * around which all is alike.
   */
  class PatchSolver
  {
  public:
    /** @param n_coordinates of a face; @param k of RT_k */
    PatchSolver(const unsigned int n_coordinates,
                const unsigned int k,
                const unsigned int n_components = 1);

    /** o of each cell; cells are sorted. */
    std::vector<Eigen::VectorXd> solve(std::vector<PatchCell> &cells);

    /** Means and moments of a cell, of which these are the factors of what flows through a face. */
    static Eigen::MatrixXd balances(const CondensedCell &cell,
                                    const unsigned int   component,
                                    const unsigned int   face,
                                    const unsigned int   n_of_face,
                                    const unsigned int   n_components);

  private:
    /** How the flux through a face of a cell follows from an unknown one. */
    struct Part
    {
      unsigned int           cell, face, unknown; // the faces of all components in turn
      double                 sign;
      std::array<int, 6>     place;          // of its coordinates in those of the unknown
      const Eigen::MatrixXd *transformation; // null: the same
    };

    using Key = std::vector<std::int64_t>;
    using LU  = Eigen::PartialPivLU<Eigen::MatrixXd>;

    std::vector<Part>      parts_of(const std::vector<PatchCell> &cells, unsigned int &n_unknown);
    const Eigen::MatrixXd *transformation(const std::array<int, 6> &place);
    Eigen::MatrixXd        matrix(const std::vector<PatchCell> &cells,
                                  const std::vector<double>    &factors,
                                  const std::vector<Part>      &parts,
                                  const unsigned int            n_unknown) const;
    std::shared_ptr<const LU> factorization(const std::vector<PatchCell> &cells,
                                            const std::vector<double>    &factors,
                                            const std::vector<Part>      &parts,
                                            const unsigned int            n_unknown);

    const unsigned int                            n_coordinates, k, n_components, n_of_face;
    const unsigned int                            n_of_faces, n_balances; // of a cell
    std::map<std::array<int, 6>, Eigen::MatrixXd> transformations;
    std::map<Key, std::shared_ptr<const LU>>      known;
    std::size_t                                   n_kept = 0; // numbers in the factorizations
  };
} // namespace PeriDeal
