// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "solid_notes.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <perideal/scene/lists.h>
#include <perideal/solvers/static_solver.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "body_pieces.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** `side 'top'`, or `sides 'bottom' (3,340) and 'top' (3,340)`. */
    std::string list_of_sides(const std::map<std::string, unsigned long long> &n_bonds)
    {
      if (n_bonds.size() == 1)
        return "side '" + n_bonds.begin()->first + "'";
      std::string text = "sides ";
      std::size_t left = n_bonds.size();
      for (const auto &[side, n] : n_bonds)
        {
          text += "'" + side + "' (" + readable_count(n) + ")";
          --left;
          text += left == 0 ? "" : left == 1 ? " and " : ", ";
        }
      return text;
    }


    template <int dim>
    void note_torn_sides(const SolidProblem<dim> &run, const RunContext &context)
    {
      const auto &torn = run.op().break_places().beside_loads;
      if (torn.empty())
        return;
      unsigned long long n = 0;
      for (const auto &[side, n_bonds] : torn)
        n += n_bonds;
      context.record.extremes[run.name()]["broken beside loads"] = torn;
      const std::string layer    = "'Traction layer' in section 'Boundary conditions'",
                        tear_off = "They act on the outermost nodes, and tear them off: ";
      const bool  of_file        = !run.scene.domain.has_lattice();
      const auto &parts          = run.scene.boundary_conditions.parts;
      const bool  on_spot        = std::any_of(parts.begin(), parts.end(), [&](const Part &part) {
        return part.kind != Part::of_side && torn.count(part.name) > 0;
      });
      std::string remedy         = tear_off;
      if (on_spot)
        remedy += "spread them over a larger region, or a part of a side";
      else if (of_file)
        remedy += "move the side by 'Displacement' in their place";
      else if (run.scene.boundary_conditions.traction_layer > 0.)
        remedy = layer + " is too thin for them: make it deeper";
      else
        remedy += "spread them by " + layer + ", over a horizon or more";
      if (!on_spot && !of_file &&
          run.scene.peridynamics.surface_correction == SurfaceCorrection::none)
        remedy +=
          ", or let families go on beyond the sides by 'Surface correction = auto' in section 'Peridynamics'";
      context.record.notes.push_back(
        run.name() + ": " + readable_count(n) + (n == 1 ? " bond" : " bonds") +
        " broke beside the loaded " + list_of_sides(torn) +
        " before any did elsewhere. The tractions are more than what they act on bears. " + remedy +
        ". Tractions that come suddenly may be too much all the same.");
    }


    template <int dim>
    void note_steps(const SolidProblem<dim> &run, const RunContext &context)
    {
      const double first    = StepLimit::share * run.stable_step,
                   shortest = run.stepper->shortest_step();
      if (run.scene.time.time_step < 0. && run.stepper->name() == "verlet" && shortest < first)
        context.record.notes.push_back(
          run.name() + ": the automatic time step followed the body's deformation, from " +
          number_text(first) + " down to " + number_text(shortest) + ".");
    }


    template <int dim>
    void note_energy(const SolidProblem<dim> &run, const RunContext &context)
    {
      constexpr double tolerable = 0.01,
                       few       = 0.01; // where few bonds have broken it is not they that tell
      const auto note            = [&](const auto &energy, const double lost) {
        const double imbalance = energy.imbalance();
        const bool   of_bonds  = run.op().brittle() && lost > few * energy.exchanged;
        const double whole     = of_bonds ? lost : energy.exchanged;
        if (std::abs(imbalance) <= tolerable * whole)
          return;
        context.record.notes.push_back(
          run.name() + ": the energy balance does not close. What " +
          (imbalance < 0. ? "is missing" : "has come from nowhere") + " at the end, " +
          rounded_text(std::abs(imbalance)) + ", is " +
          rounded_text(100. * std::abs(imbalance) / whole) + " % of " +
          (of_bonds ? "what broken bonds have dissipated" :
                                 "what start and loads have brought in") +
          (run.stepper ?
                        ". A smaller 'Time step' in section 'Time' makes it less: half the step a quarter, where it is not the breaking of bonds that makes it." :
                        ". Smaller steps of the loading ('Time step' in section 'Time') make it less."));
      };
      if (run.stepper)
        {
          const MotionEnergy energy = run.stepper->energy(run.displacement, run.velocity);
          note(energy, energy.released);
        }
      else
        {
          const LoadingEnergy energy = run.loading->energy(run.displacement);
          note(energy, energy.dissipated);
        }
    }


    template <int dim>
    void note_inversion(const SolidProblem<dim> &run, const RunContext &context)
    {
      if (run.op().nonlinear()) // such runs have ended
        return;
      const Inversion found = run.op().inverted(run.displacement);
      if (found.n_nodes > 0)
        context.record.notes.push_back(
          run.name() + ": the displacements turn cells inside out at " +
          std::to_string(found.n_nodes) + " nodes, worst at " + found.place +
          ". They are far beyond the small displacements that 'Kinematics = linear' in section 'Elasticity' is for: read them as those of a "
          "load of 1, in proportion to the load, or make the load smaller.");
    }


    /**
     * What has turned by large angles without being stretched, as fragments do: small strains do
     * not see that it grows.
     */
    template <int dim>
    void note_turning(const SolidProblem<dim> &run, const RunContext &context)
    {
      constexpr double   much = 0.1, little = 0.01; // of a radian, of the body
      const auto        &dofs = run.dofs();
      const unsigned int n    = dofs.get_fe().n_dofs_per_cell();
      if (dim == 1 || !run.stepper || run.op().nonlinear() ||
          dofs.get_fe().n_dofs_per_vertex() == 0)
        return;
      FEValues<dim> values(dofs.get_fe(), QMidpoint<dim>(), update_gradients | update_JxW_values);
      std::vector<types::global_dof_index> indices(n);
      double                               turned = 0., whole = 0., largest = 0.;
      run.displacement.update_ghost_values();
      for (const auto &cell : dofs.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            values.reinit(cell);
            cell->get_dof_indices(indices);
            Tensor<2, dim> gradient;
            for (unsigned int i = 0; i < n; ++i)
              for (unsigned int d = 0; d < dim; ++d)
                gradient[d] += run.displacement(dim * indices[i] + d) * values.shape_grad(i, 0);
            const Tensor<2, dim> strain = 0.5 * (gradient + transpose(gradient));
            const double         angle  = (gradient - strain).norm() / std::sqrt(2.);
            whole += values.JxW(0);
            if (angle < much || strain.norm() > 0.5 * angle)
              continue;
            turned += values.JxW(0);
            largest = std::max(largest, angle);
          }
      run.displacement.set_ghost_state(false);
      const auto communicator = dofs.get_communicator();
      turned = Utilities::MPI::sum(turned, communicator) / Utilities::MPI::sum(whole, communicator);
      largest = Utilities::MPI::max(largest, communicator);
      if (turned < little)
        return;
      context.record.notes.push_back(
        run.name() + ": " + rounded_text(100. * turned) + " % of the body has turned by up to " +
        rounded_text(largest) +
        " (in radians). 'Kinematics = linear' in section 'Elasticity' is for small angles, and lets what turns so far grow by " +
        rounded_text(100. * (std::sqrt(1. + largest * largest) - 1.)) +
        " %. 'Kinematics = full', for peridynamics, turns it as it is.");
    }
    /** Cracks that have come to the end of their zone. */
    template <int dim>
    void note_end_of_zone(const SolidProblem<dim> &run, const RunContext &context)
    {
      const auto [n, place] = run.op().stretched_outside(run.displacement);
      if (n == 0)
        return;
      context.record.notes.push_back(
        run.name() + ": " + readable_count(n) +
        " cells are stretched beyond the critical stretch, the worst at " + place +
        (run.scene.coupling.exchanges() ?
           ", and have no bonds that could break: what breaks ends there. " :
           ", where elements still hold together what bonds would part: what breaks ends there. ") +
        (!run.scene.coupling.follows_stretches() ?
           "'Zone = follow' in section 'Coupling' goes with it." :
         run.scene.coupling.exchanges() ?
           "Keep cells of lattice size there: 'Fine where' or a smaller 'Coarsening' in section 'Domain'." :
           "A smaller 'Zone share' in section 'Coupling' lets the zone grow before that, and a smaller 'Time step' in section 'Time' more often."));
    }


    /** A note that begins so is there. */
    bool is_told(const std::string &start, const RunContext &context)
    {
      const std::vector<std::string> &notes = context.record.notes;
      return std::any_of(notes.begin(), notes.end(), [&](const std::string &note) {
        return note.compare(0, start.size(), start) == 0;
      });
    }


    /** A note, unless one begins so or there is nothing to say. */
    void tell(const std::string &start, const std::string &rest, const RunContext &context)
    {
      if (!rest.empty() && !is_told(start, context))
        context.record.notes.push_back(start + rest);
    }


    /** A negative K_I is that of faces that are pressed together. */
    template <int dim>
    void note_pressed_faces(const SolidProblem<dim> &run, const RunContext &context)
    {
      constexpr double some = 0.02; // of both intensities
      const auto      &kept = context.record.balances;
      if (!kept.contains(run.name()) || !kept[run.name()].contains("stress intensity"))
        return;
      for (const auto &[end, value] : kept[run.name()]["stress intensity"].items())
        {
          const double first = value["I"], second = value["II"];
          if (first > -some * std::hypot(first, second) || first == 0.)
            continue;
          const bool could = run.name() == to_string(ModelKind::peridynamics) ||
                             (run.name() == to_string(ModelKind::coupled) &&
                              run.scene.coupling.exchanges() && !run.scene.cracks.on_faces()),
                     knows = could && run.scene.elasticity.contact;
          context.record.notes.push_back(
            run.name() + ": K_I at " + end + " is negative: the faces of the crack " +
            (knows ?
               "press on each other there. It is found as if they bore nothing, and is none of an open crack; K_II is that of faces that slide." :
             could ?
               "pass through each other, since contact is off ('Contact = false' in section 'Elasticity', or 'Kinematics = full' there but in motion with 'Stepper = verlet')." :
               "pass through each other, since nothing is between them here. In 'peridynamics', and in 'coupled' with 'Scheme = exchange' where 'Mesh' in section 'Cracks' is not 'faces', they press on each other ('Contact' in section 'Elasticity')."));
          return;
        }
    }
  } // namespace


  template <int dim>
  void tell_first_break(const SolidProblem<dim> &run, const double t, const RunContext &context)
  {
    const BreakPlaces &places = run.op().break_places();
    auto              &kept   = context.record.extremes[run.name()];
    if (places.first.empty() || kept.contains("first broken bond"))
      return;
    kept["first broken bond"]  = places.first;
    kept["first broken bonds"] = t;
    std::ostringstream line;
    line.precision(4);
    line << "  " << run.name() << ": the first bond broke at (";
    for (unsigned int d = 0; d < dim; ++d)
      line << (d > 0 ? ", " : "") << places.first[d];
    line << ")" << (run.stepper ? ", by t = " : " at t = ") << t;
    if (!places.beside_loads.empty())
      line << ", beside the loaded " << list_of_sides(places.beside_loads);
    context.progress.line(line.str());
  }


  template <int dim>
  void note_overlap(const SolidProblem<dim> &run, const double t, const RunContext &context)
  {
    if (run.scene.domain.has_lattice() && !run.scene.domain.has_voids())
      return;
    const std::string start =
      run.name() + ": pieces of the body overlap" + (run.stepper ? "" : " in the equilibrium");
    if (!is_told(start, context))
      tell(start, BodyPieces<dim>(run).overlap(t, start), context);
  }


  template <int dim>
  void note_equilibrium(const SolidProblem<dim> &run, const double t, const RunContext &context)
  {
    if (const double residual = take_accepted_residual(); residual > 0.)
      tell(
        run.name() + ": the residual of an equilibrium fell no further than to ",
        rounded_text(residual) +
          " of that of the loads, above 'Tolerance' = " + number_text(run.scene.solver.tolerance) +
          " in section 'Solver', and was accepted: round-off of the forces between nodes allows no less, since they move far more than they stretch what is between them. "
          "A larger 'Tolerance' takes fewer iterations; fewer cells, or a body that is held so that it moves less as a whole, leave less of it.",
        context);
    note_overlap(run, t, context);
  }


  template <int dim>
  void note_end(const SolidProblem<dim> &run, const RunContext &context)
  {
    if (run.stepper)
      note_steps(run, context);
    // What warming does to the strain energy is not followed.
    if (run.stepper || (!run.scene.time.steady && !run.scene.warms_slowly()))
      note_energy(run, context);
    note_inversion(run, context);
    note_turning(run, context);
    note_torn_sides(run, context);
    note_end_of_zone(run, context);
    note_pressed_faces(run, context);
  }


#define PERIDEAL_INSTANTIATE(dim)                                                              \
  template void note_overlap(const SolidProblem<dim> &, const double, const RunContext &);     \
  template void note_equilibrium(const SolidProblem<dim> &, const double, const RunContext &); \
  template void tell_first_break(const SolidProblem<dim> &, const double, const RunContext &); \
  template void note_end(const SolidProblem<dim> &, const RunContext &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
