// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/bond_form.h>
#include <perideal/operators/node_constraints.h>
#include <perideal/operators/operator.h>
#include <perideal/operators/spectrum.h>

#include <memory>

namespace PeriDeal
{
  /**
   * Peridynamic diffusion: rho c V_i dT_i/dt = sum_j W_ij (T_j - T_i) + loads (Bobaru 2012 eq 12
   * times the node's volume).
   *
   * Loads are the volume source, the natural flux through the node's share of a side, and
   * convection as a surface source h A (T_inf - T). Vectors have the horizon-wide halo of the
   * nodes.
   */
  template <int dim>
  class BondOperator : public DiffusionOperator
  {
  public:
    /**
     * Collective. Throws UserError, among others for isolated nodes, a storage that is not
     * positive, a form that does not suit.
     */
    BondOperator(Nodes<dim> &nodes, const Scene<dim> &scene);

    void          initialize_vector(Vector &vector) const override;
    void          apply(Vector &y, const Vector &x) const override;
    void          residual(Vector &r, const Vector &u, const double t) const override;
    void          apply_then(Vector &y, const Vector &x, const RowsAction &finish) const override;
    void          residual_then(Vector           &r,
                                const Vector     &u,
                                const double      t,
                                const RowsAction &finish) const override;
    void          distribute(Vector &u, const double t) const override;
    void          distribute_homogeneous(Vector &x) const override;
    void          clear_constrained(Vector &y) const override;
    const Vector &lumped_capacity() const override;
    bool          capacity_is_diagonal() const override;
    void          apply_capacity(Vector &y, const Vector &x) const override;
    const Vector &diagonal() const override;
    Spectrum      spectrum() const override;
    bool          symmetric() const override;
    bool          depends_on_time() const override;
    bool          has_steady_state() const override;
    void          surrogate(dealii::TrilinosWrappers::SparseMatrix &matrix) const override;
    bool          surrogate_is_exact() const override;
    double        next_event(const double t) const override;
    bool          update(const double t) override;
    bool          depends_on_solution() const override;
    bool          capacity_depends_on_solution() const override;
    void          heat_between(Vector &y, const Vector &u, const Vector &v) const override;
    void          take_material_at(const Vector &u) override;
    Balance       balance(const Vector &u, const double t, const bool steady) const override;
    std::string   place_of(const unsigned int local_index) const override;
    OperatorSize  size() const override;

    const DiffusionBonds<dim> &diffusion_bonds() const;

    /** Which form is in use, and why, for the user. */
    const std::string &form_note() const;

    /** Values of the fictitious nodes for given node values (ghosts up to date) at time t. */
    void fictitious_values(const Vector &u, const double t, std::vector<double> &values) const;

  private:
    struct SideLoad
    {
      unsigned int         node;
      double               area;
      const SideCondition *condition;
      dealii::Point<dim>   place; // where the condition's formulas are taken
    };

    void                      choose_form(const OperatorForm wanted);
    void                      find_capacity(const Vector *u);
    void                      find_side_loads();
    void                      find_diagonal();
    std::vector<unsigned int> rows_to_correct() const;
    void                      correct_surface(const std::vector<unsigned int> &rows);
    void                      update_crack_sides();
    std::string               isolation(const unsigned int node) const;
    double                    row_bound(const unsigned int node) const;
    void                      count_bonds(const double n_own) const;
    void                      add_crack_heat(const Vector &u, Balance &balance) const;
    void                      sum_bonds(Vector &y, const Vector &x, const double *outside) const;
    void                      add_fictitious_heat(const Vector &u, Balance &balance) const;
    void add_side_heat(const Vector &u, const double t, Balance &balance) const;
    void add_convection(Vector            &y,
                        const Vector      &x,
                        const unsigned int begin,
                        const unsigned int end) const;
    void clear_held(Vector &y, const unsigned int begin, const unsigned int end) const;
    void add_loads(Vector &r, const double t) const;

    /** Returns the sum of what it adds to free unknowns. */
    double add_loads_now(Vector &r, const double t) const;

    // The parts of entering(), each of this process: what the rows [begin, end) of prescribed nodes
    // say (y = K x without loads there), what is not a load of nodes, and what comes from
    // fictitious nodes with these values.
    double through_prescribed(const Vector      &y,
                              const unsigned int begin,
                              const unsigned int end) const;
    double through_sides(const Vector &x, const double *outside) const;
    double through_slaves(const double t) const;

    /**
     * Sums of the conductances of bonds to fictitious nodes, so that what they bring is a sum over
     * nodes.
     */
    struct OutsideSums
    {
      bool                                         known = false;
      std::vector<double>                          of_outside; // by fictitious node
      std::vector<std::pair<unsigned int, double>> of_nodes;
    };
    void find_outside_sums() const;

    /** A node so near to a side that it may have bonds with fictitious nodes. */
    bool reaches_outside(const unsigned int node) const;

    const Scene<dim>                     &scene;
    Families<dim>                         families;
    DiffusionBonds<dim>                   bonds;
    std::unique_ptr<NodeConstraints<dim>> constraints;
    double                                cracks_of; // representative time of the cracks in K
    std::unique_ptr<BondForm>             form;
    std::string                           note;
    Vector                                capacity, bond_diagonal, constant_loads;
    std::vector<SideLoad>                 fluxes, convections;
    std::vector<std::pair<unsigned int, double>> convection_diagonal; // in the order of nodes
    std::vector<unsigned int>                    held; // owned nodes that are not free, in order
    bool                                         loads_vary = false;
    std::vector<Vector>         node_factors; // of the surface correction, one for each direction
    mutable bool                recount_bonds = false;
    mutable unsigned long long  n_bonds = 0, n_nonzeros = 0;
    double                      free_loads = 0.; // sum of constant_loads
    mutable OutsideSums         outside_sums;
    SpectralBounds              bounds;
    mutable std::vector<double> outside_values, outside_signs_only;
    mutable Vector              scratch;
  };
} // namespace PeriDeal
