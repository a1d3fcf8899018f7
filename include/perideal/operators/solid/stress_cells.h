// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/archive.h>
#include <perideal/base/diverged.h>
#include <perideal/operators/parts/cut_cells.h>
#include <perideal/operators/parts/element_matrix.h>
#include <perideal/operators/solid/deformed_strains.h>
#include <perideal/operators/solid/projected_strains.h>
#include <perideal/operators/solid/stress_laws.h>
#include <perideal/operators/solid/stress_steps.h>

#include <functional>
#include <memory>
#include <vector>

namespace PeriDeal
{
  /**
   * The cells of finite elements Qp of a body with a law of stresses, one at a time: what the law
   * makes of the strains at quadrature points (ProjectedStrains, where deformations are large
   * DeformedStrains), and the states of these, which are those of the last step that was accepted.
   * Ghosts of displacements are up to date. Cells that a crack cuts carry what it leaves of them.
   * Not collective unless stated.
   *
   * The law is asked as StressSteps says, the time of now being that for which forces were found
   * last: all that is collective throws faults, others have to ask throw_faults().
   */
  template <int dim>
  class StressCells
  {
  public:
    using Cell = typename dealii::DoFHandler<dim>::active_cell_iterator;

    /** A quadrature point in the cell that is looked at. */
    struct LawPoint
    {
      double              weight = 0.; // volume, as far as cracks and families leave it
      StressLaw::Response response;
      std::vector<double> state; // next one
      StressLaw::Tangent  tangent;
    };

    /** What counts of a cell beside families; empty: all. */
    using Share = std::function<double(const Cell &)>;

    /** The law of the scene; null: it has none for stresses. Collective. Throws UserError. */
    static std::unique_ptr<StressCells> of_scene(const dealii::DoFHandler<dim> &dofs,
                                                 const BodyParameters<dim>     &body,
                                                 const CutCells<dim>           &cracks,
                                                 const Share                   &share);

    struct Kinematics
    {
      bool projects = false; // the dilatation
      bool is_full  = false; // deformations are large
    };

    /** @param cracks like @p dofs to outlive this */
    StressCells(const dealii::DoFHandler<dim> &dofs,
                PlacedStressLaw<dim>           law,
                const Kinematics              &kinematics,
                const CutCells<dim>           &cracks,
                const StressSteps             &steps = {},
                const Share                   &share = {});

    const StressLaw &law() const
    {
      return *of_points.law;
    }

    /** Deformations are large. */
    bool is_full() const
    {
      return at.deformed != nullptr;
    }

    /** The points of an own cell in the state u, until the next call. */
    const std::vector<LawPoint> &points_of(const Cell &cell, const Vector &u) const;

    /** Cauchy's stress at a point of the cell that was looked at last. */
    StressLaw::Tensor stress_at(const unsigned int q) const
    {
      const StressLaw::Response &response = at.points[q].response;
      return at.deformed ? at.deformed->cauchy(q, response) : response.stress;
    }

    /** Call visit(cell, points) for all own cells. */
    template <typename Visit>
    void for_each(const Vector &u, const Visit &visit) const
    {
      for (const auto &cell : dofs.active_cell_iterators())
        if (cell->is_locally_owned())
          visit(cell, points_of(cell, u));
    }

    /** The tangent of a whole cell before anything has happened, or of what is left of it at u. */
    void find_stiffness(const Cell                 &cell,
                        dealii::FullMatrix<double> &matrix,
                        const Vector               *u = nullptr) const;

    /** Of all tangents since the last add_tangent(), which forgets others. Collective. */
    bool has_symmetric_tangents() const;

    /** Add the tangents of own cells at u. Collective. */
    void add_tangent(ElementMatrix<dim, dim> &matrix,
                     const HangingNodes<dim> &hanging,
                     const Vector            &u) const;

    /**
     * Forces of all cells at time t, zero on hanging nodes; of a law that may fail also where u is
     * zero. Where large deformations have turned a point inside out it throws the Diverged of the
     * worst one (`inversion`). Collective.
     */
    void find_forces(Vector                  &y,
                     const HangingNodes<dim> &hanging,
                     const Vector            &u,
                     const double             t) const;

    /** Stored by all cells. Collective. */
    double energy(const Vector &u) const;

    /** Large deformations: the most of DeformedStrains::stiffening(); else 0. Collective. */
    double largest_stiffening(const Vector &u) const;

    /**
     * Temperatures have become those of the scene's formula and of nodes: what they strain the
     * points by, and parameters that depend on them. The body does not give the strains of which it
     * is asked after that. Throws UserError: a yield stress that is none. Collective.
     *
     * @param changes of nodes, ghosts up to date; empty: those of the formula
     */
    void take_temperatures(const BodyParameters<dim> &body, const Vector &changes);

    /** A state has been accepted. */
    bool has_begun() const
    {
      return begun;
    }

    /** The state u is accepted. Returns what was dissipated on the way to it. Collective. */
    double accept(const Vector &u, const double t);

    /** As StressSteps. Collective. */
    void throw_faults() const
    {
      steps.throw_faults(*of_points.law, dofs.get_communicator());
    }

    /** Collective. */
    void exchange(Archive &archive);

    /** Of states and what goes with them. Not collective. */
    std::size_t memory_consumption() const
    {
      return (all_parameters.capacity() + states.capacity() + warm.strains.capacity() +
              warm.temperatures.capacity() + warm.accepted.capacity()) *
               sizeof(double) +
             first.capacity() * sizeof(first[0]);
    }

  private:
    /** Number of the first point of an own cell. */
    std::size_t first_of(const Cell &cell) const
    {
      return first[cell->active_cell_index()];
    }

    /** @param u null: at zero. @param accepted states of the points of the cell */
    void look_at(const Cell   &cell,
                 const Vector *u,
                 const double *accepted,
                 const bool    with_tangents) const;

    /** Forces on the nodes of the cell that is looked at. */
    void add_forces(std::vector<dealii::Tensor<1, dim>> &forces) const;

    /** Large deformations: whether the point that is looked at is as one may be; else keeps it. */
    bool holds(const unsigned int q) const;

    const dealii::DoFHandler<dim> &dofs;
    const PlacedStressLaw<dim>     of_points;
    const CutCells<dim>           &cracks;
    std::vector<std::size_t>       first; // by active cell index
    const Share                    share;
    std::vector<double>            all_parameters, states;
    bool                           begun = false;

    /** Of the points, by nodal temperatures; empty: the body is cold. */
    struct
    {
      std::vector<double> strains; // alpha dT, as dilatations are projected
      std::vector<double> temperatures, accepted;
    } warm;

    StressSteps  steps;
    mutable Trip inverted; // the point that is turned inside out most

    /** The cell that is looked at. */
    struct Looked
    {
      ProjectedStrains<dim>                        strains;  // of large deformations the points
      std::unique_ptr<DeformedStrains<dim>>        deformed; // null: they are small
      std::vector<dealii::types::global_dof_index> nodes;
      dealii::Vector<double>                       u;
      std::vector<LawPoint>                        points;
      bool                                         unsymmetric; // some tangent so far
    };
    mutable Looked at;
  };
} // namespace PeriDeal
