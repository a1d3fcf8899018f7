// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/analysis/crack_surface.h>
#include <perideal/laws/elasticity.h>
#include <perideal/problems/run_context.h>
#include <perideal/problems/solid_problem.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace PeriDeal
{
  /** Fields of the tensors at the nodes, as the models of an elastic body write them. */
  template <int dim>
  class NodalFields
  {
  public:
    /** @param layout of scalar vectors, one number per node */
    explicit NodalFields(const std::shared_ptr<const dealii::Utilities::MPI::Partitioner> &layout)
      : layout(layout)
    {}

    /** @param value of the owned nodes */
    template <typename Value>
    void add(const std::string &name, const Value &value)
    {
      fields.push_back({name, {}});
      add_component(value);
    }

    /** The displacement. */
    void add_vector(const std::string &name, const Vector &u)
    {
      fields.push_back({name, {}});
      for (unsigned int d = 0; d < dim; ++d)
        add_component([&](const unsigned int i) { return u.local_element(dim * i + d); });
    }

    void add_stress(const std::vector<dealii::SymmetricTensor<2, 3>> &stress)
    {
      add("stress_xx", [&](const unsigned int i) { return stress[i][0][0]; });
      if (dim > 1)
        {
          add("stress_yy", [&](const unsigned int i) { return stress[i][1][1]; });
          add("stress_zz", [&](const unsigned int i) { return stress[i][2][2]; });
          add("stress_xy", [&](const unsigned int i) { return stress[i][0][1]; });
        }
      if (dim > 2)
        {
          add("stress_xz", [&](const unsigned int i) { return stress[i][0][2]; });
          add("stress_yz", [&](const unsigned int i) { return stress[i][1][2]; });
        }
      add("von_mises", [&](const unsigned int i) { return von_mises(stress[i]); });
      add("pressure", [&](const unsigned int i) { return pressure(stress[i]); });
    }

    /** The temperature, where it is computed. */
    void add_temperature(const Vector &change, const Scene<dim> &scene)
    {
      if (change.size() > 0)
        add("temperature", [&](const unsigned int i) {
          return change.local_element(i) + scene.elasticity.reference_temperature;
        });
    }

    void add_strain(const std::vector<dealii::SymmetricTensor<2, dim>> &strain)
    {
      for (unsigned int a = 0; a < dim; ++a)
        for (unsigned int b = a; b < dim; ++b)
          add(std::string("strain_") + "xyz"[a] + "xyz"[b],
              [&](const unsigned int i) { return strain[i][a][b]; });
    }

    std::vector<OutputField> take()
    {
      return std::move(fields);
    }

  private:
    template <typename Value>
    void add_component(const Value &value)
    {
      Vector component(layout);
      for (unsigned int i = 0; i < component.locally_owned_size(); ++i)
        component.local_element(i) = value(i);
      component.update_ghost_values();
      fields.back().components.push_back(std::move(component));
    }

    std::shared_ptr<const dealii::Utilities::MPI::Partitioner> layout;
    std::vector<OutputField>                                   fields;
  };


  /**
   * ux, uy, uz, then the components of the stress and `von_mises`, and a computed `temperature`:
   * the columns of probes.csv and line.csv.
   */
  template <int dim>
  std::vector<std::string> solid_columns(const Scene<dim> &scene);

  /** Append one row of these but the temperature. */
  void append_row(const double                        *displacement,
                  const dealii::SymmetricTensor<2, 3> &stress,
                  const unsigned int                   dim,
                  std::vector<double>                 &rows);

  /** By component, of a body in motion: the last columns of tables of points; else none. */
  template <int dim>
  std::vector<std::vector<double>> velocities_at_points(const Scene<dim>          &scene,
                                                        const PointEvaluator<dim> &reader,
                                                        const Vector              &velocity);

  template <int dim>
  std::unique_ptr<SolidField<dim>> make_element_solid(Model<dim> &model, const Scene<dim> &scene);

  template <int dim>
  std::unique_ptr<SolidField<dim>> make_bond_solid(Model<dim> &model, const Scene<dim> &scene);


  /**
   * The cracks that run through the breaking bonds of a solid: their surface, how far they have got
   * and how fast. All of it follows from the bonds that are broken and since when; nothing has to
   * be archived. Looks at them when asked, and only if more have broken since. All functions are
   * collective.
   */
  template <int dim>
  class CrackGrowth
  {
  public:
    /** Rows of totals.csv and what the summary says of t; none where no bonds may break. */
    void add_totals(const SolidProblem<dim> &solid, const double t, const RunContext &context);

    /** For files. */
    NewCracks surfaces(const SolidProblem<dim> &solid);

  private:
    void look_at(const SolidProblem<dim> &solid);
    void add_tips(const SolidProblem<dim> &solid,
                  const double             t,
                  const RunContext        &context,
                  nlohmann::ordered_json  &summary) const;

    std::unique_ptr<CrackSurface<dim>> surface; // null before anything has broken
    unsigned long long                 n_broken = 0;
    std::vector<CrackFacet<dim>>       facets;
    double                             area = 0., damaged_volume = 0.;
  };


  /** Of the owned nodes, what its heat problem has found less `Reference temperature`. */
  template <int dim>
  Vector computed_temperature_change(const SolidProblem<dim> &solid);


  /**
   * The heat that a body at rest releases when it is compressed and takes up when it expands,
   *
   *     rho c dT/dt = div k grad T + q - T0 d(beta theta)/dt,
   *
   * beta theta that of entropy_of_deformation(), T0 the absolute temperature of the unstressed
   * body: the heat equation of linear thermoelasticity (Biot 1956), with c at constant strain.
   *
   * In each step the body first conducts as it is deformed, then deforms without conduction: node i
   * with the capacity C_i gets C_i dT_i = -T0 dS_i, S_i the integral of beta theta over its volume.
   * That is the adiabatic split, of first order in the step, and no step makes it unstable (Armero
   * and Simo 1992). Equilibria and temperatures are found by turns until they agree. All functions
   * are collective.
   */
  template <int dim>
  class HeatOfDeformation
  {
  public:
    /** The body is in its first equilibrium: what has deformed it before releases nothing. */
    void begin(const SolidProblem<dim> &solid);

    /**
     * The body is in an equilibrium at time t, found with the temperatures of its heat problem: add
     * what it has released on the way, and find both again.
     * @param renew the equilibrium, with temperatures as they are. Throws UserError.
     */
    void add(const SolidProblem<dim> &solid, const double t, const std::function<void()> &renew);

    /**
     * Since the start, of the whole body. What nodes of a given temperature release leaves the
     * body there at once; it counts here, and not in what has entered.
     */
    double released() const
    {
      return set_free;
    }

    void exchange(Archive &archive, const SolidProblem<dim> &solid, const NodeKeys &keys);

  private:
    Vector counted; // S_i of the owned nodes for which heat has been released
    double set_free = 0.;
  };


  /**
   * Tells the heat of a solid, on the same nodes, which of the solid's bonds have broken, if it has
   * any that follows. All functions are collective.
   */
  template <int dim>
  class DamageOfSolid
  {
  public:
    /** What has broken since this was called last. */
    void tell(const SolidProblem<dim> &solid);

    /** The bonds of the solid have been loaded, and the heat. */
    void exchange(Archive &archive, const SolidProblem<dim> &solid);

  private:
    std::size_t n_told   = 0;     // marks of bonds of this process
    bool        was_told = false; // when the run was resumed, of what broke in this step
  };


  /** With correspondence, where bonds break: what new cracks cost. */
  inline std::string note_on_nodal_cracks()
  {
    return "bonds break at the stretches of 'Model = state-based', but a node of 'correspondence' has all of its stress until its bonds in some direction have lost 65 % of their weight: new cracks have cost 1.2 to 1.8 times what they cost there.";
  }

  /** Say once where the first bond of a body broke, and keep it. */
  template <int dim>
  void tell_first_break(const SolidProblem<dim> &run, const double t, const RunContext &context);

  /**
   * That pieces of the body overlap (BodyPieces) at t; said once. Collective. Throws UserError, at
   * rest.
   */
  template <int dim>
  void note_overlap(const SolidProblem<dim> &run, const double t, const RunContext &context);

  /**
   * What is wrong with the equilibrium that has been found at t: pieces of the body that overlap
   * (BodyPieces), a residual that round-off keeps above the tolerance; each is said once.
   * Collective. Throws UserError.
   */
  template <int dim>
  void note_equilibrium(const SolidProblem<dim> &run, const double t, const RunContext &context);

  /**
   * What the user should know at the end of a run: steps that became shorter, an energy balance
   * that does not close, cells turned inside out, bonds torn off beside loads. Collective.
   */
  template <int dim>
  void note_end_of_solid(const SolidProblem<dim> &run, const RunContext &context);
} // namespace PeriDeal
