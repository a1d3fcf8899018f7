// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/partitioner.h>

#include <perideal/operators/solid/displacement_conditions.h>
#include <perideal/operators/solid/solid_contact.h>
#include <perideal/scene/crack_history.h>

#include <functional>
#include <memory>

namespace PeriDeal
{
  /**
   * What all models of solids have alike: unknowns, displacements that are prescribed, masses,
   * loads that are kept while they do not change, thermal strains alpha dT (in plane strain
   * (1 + nu) alpha dT) from the formula of the scene or from temperatures at nodes, and cracks that
   * grow.
   */
  template <int dim>
  class SolidOperator : public ElasticOperator
  {
  public:
    /** Throws UserError for a body that no model can deform. Not collective. */
    static void require(const BodyParameters<dim> &body);

    void initialize_vector(Vector &vector) const override
    {
      vector.reinit(unknowns);
    }

    void          surrogate(dealii::TrilinosWrappers::SparseMatrix &matrix) const final;
    const Vector &surrogate_diagonal() const final
    {
      return latest.diagonal.size() > 0 ? latest.diagonal : stiffness_diagonal;
    }

    void apply(Vector &y, const Vector &x) const override;
    void residual(Vector &r, const Vector &u, const double t) const override;
    void unbalanced(Vector &r, const Vector &u, const double t) const override;
    void mechanical_loads(Vector &loads, const double t) const override;
    void distribute(Vector &u, const double t) const override
    {
      conditions->distribute(u, t, this->stepping.load_factor);
    }

    void distribute_homogeneous(Vector &x) const override
    {
      conditions->mask(x);
    }

    void clear_constrained(Vector &y) const override
    {
      conditions->mask(y);
    }

    const Vector &lumped_capacity() const override
    {
      return mass;
    }

    const Vector &diagonal() const override
    {
      return stiffness_diagonal;
    }

    bool depends_on_time() const override
    {
      return loads_vary || this->stepping.scales_loads || conditions->depends_on_time();
    }

    double next_event(const double t) const override
    {
      return history.next_event(t);
    }

    bool grow_cracks(const Vector &u, const double t) override;
    bool update_contact(const Vector &u) override;

    /** The representative time of the cracks as they are in K (CrackHistory). Not collective. */
    double crack_time() const
    {
      return cracks_of;
    }

    void exchange(Archive &archive, const NodeKeys &keys) override;

    std::vector<Vector> near_null_space() const override;
    std::string         place_of(const unsigned int local_index) const override;
    unsigned int        n_components() const override
    {
      return dim;
    }

    void fill_noise(Vector &vector) const override;

    /** Place of a node of this process, by local number. */
    virtual const dealii::Point<dim> &position(const unsigned int node) const = 0;

  protected:
    using Layout = std::shared_ptr<const dealii::Utilities::MPI::Partitioner>;

    /** @param of_nodes the layout; if null, set_layout() has to be called by constructors. */
    explicit SolidOperator(const BodyParameters<dim> &body, const Layout &of_nodes = nullptr);

    /** Sets the layouts and allocates all vectors, to zero. Collective. */
    void set_layout(const Layout &of_nodes);

    /**
     * Let the nodes join the zone that do so with a change, and cut nothing yet; the diagonal is
     * left for apply_change(). Returns whether K has changed. Collective. Throws UserError.
     */
    virtual bool join_zone(const ChangeSet<dim> & /*change*/)
    {
      return false;
    }

    /**
     * Mend what a change names, after join_zone(). Collective. Throws UserError.
     * @param loaded bonds have been marked already, by what was loaded
     */
    virtual void apply_change(const ChangeSet<dim> &change, const bool loaded) = 0;

    /** y = -F(u) at time t, without loads and contact. */
    virtual void find_forces(Vector &y, const Vector &u, const double /*t*/) const
    {
      this->multiply(y, u);
    }

    /** Let parts of the body touch each other, with the current thermal strains. Collective. */
    void set_contact(std::unique_ptr<SolidContact> new_contact);

    /** Cracks or bonds that break may part the body. Not collective. */
    bool may_part() const
    {
      return !body.cracks.cracks.empty() || this->may_release_energy();
    }

    /** Thermal strains have changed. */
    void set_contact_strains();

    /** Energy that contact has released by being found. */
    virtual void take_released(const double /*energy*/) {}

    /** What surrogate() gives, of the body as it is now. Collective. */
    virtual void assemble_surrogate(dealii::TrilinosWrappers::SparseMatrix &matrix) const = 0;

    /** surrogate() is made for the body as it is now. Not collective. */
    virtual void surrogate_made() const {}

    /**
     * Exchange the state of the bonds. Collective.
     *
     * @param at_surrogate to be called once when a body is loaded whose bonds have changed since
     *                     surrogate_made(), when they have only changed as far as then
     */
    virtual void exchange_bonds(Archive & /*archive*/,
                                const NodeKeys & /*keys*/,
                                const std::function<void()> & /*at_surrogate*/)
    {}

    /** Thermal ones included. */
    virtual void find_loads(Vector &loads, const double t) const = 0;

    /** To be called when thermal loads have changed. */
    void keep_constant_loads()
    {
      if (!loads_vary)
        find_loads(constant_loads, 0.);
    }

    /** Positive on unknowns that are not free; ghosts up to date. */
    Vector held_unknowns() const;

    double thermal_strain_at(const unsigned int node) const;

    /** Thermal strains may be other than zero. Not collective. */
    bool is_warm() const;

    const BodyParameters<dim>                   &body;
    const CrackHistory<dim>                      history;
    double                                       cracks_of; // representative time of those in K
    Layout                                       nodes, unknowns;
    std::unique_ptr<DisplacementConditions<dim>> conditions;
    const bool                                   loads_vary;
    Vector                                       mass, stiffness_diagonal, thermal_loads;

  private:
    /**
     * What the latest preconditioner was made for. Where a body is loaded that has changed since,
     * the next one is made for the same, so that the solver's digits are the same.
     */
    struct Surrogate
    {
      bool   is_made = false, contact_is_loaded = false;
      double cracks_of = 0.;
      std::shared_ptr<dealii::TrilinosWrappers::SparseMatrix> matrix; // of a loaded body
      Vector                                                  diagonal;
    };

    /** Adds springs across faces that touch, which are as stiff as the body. Collective. */
    void add_contact(dealii::TrilinosWrappers::SparseMatrix &matrix) const;

    /** @param u at which energy is released; null: by a body that is loaded, which has told it. */
    void take(const ChangeSet<dim> &change, const Vector *u);
    void take_loaded(const double time);

    Vector            constant_loads;
    mutable Surrogate latest;

  protected:
    mutable Vector                scratch;
    std::unique_ptr<SolidContact> contact; // never null
  };
} // namespace PeriDeal
