// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "guard_causes.h"

#include <deal.II/base/mpi.h>
#include <deal.II/fe/fe.h>
#include <deal.II/fe/mapping_q1.h>

#include <perideal/scene/lists.h>

#include <cmath>
#include <limits>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** Both numbers, and how far they are apart. */
    std::string too_long(const double step, const double limit, const std::string &method)
    {
      return "'Time step' in section 'Time' is " + number_text(step) + ", " +
             rounded_text(step / limit, 4) + " times " + number_text(limit) + ", up to which '" +
             method + "' is stable";
    }
  } // namespace


  template <int dim>
  PlaceOfNode place_of_nodes(const Problem<dim> &problem)
  {
    return [&problem](const unsigned int node) {
      const DoFHandler<dim>               &dofs  = problem.dofs();
      const FiniteElement<dim>            &fe    = dofs.get_fe();
      const types::global_dof_index        index = dofs.locally_owned_dofs().nth_index_in_set(node);
      std::vector<types::global_dof_index> indices(fe.n_dofs_per_cell());
      for (const auto &cell : dofs.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            cell->get_dof_indices(indices);
            for (unsigned int i = 0; i < indices.size(); ++i)
              if (indices[i] == index)
                {
                  const Point<dim> p =
                    MappingQ1<dim>().transform_unit_to_real_cell(cell, fe.unit_support_point(i));
                  return std::vector<double>(p.begin_raw(), p.end_raw());
                }
          }
      return std::vector<double>();
    };
  }


  template PlaceOfNode place_of_nodes(const Problem<1> &);
  template PlaceOfNode place_of_nodes(const Problem<2> &);
  template PlaceOfNode place_of_nodes(const Problem<3> &);


  Trip StepGuard::look(const Stepper &stepper, const double end_time, const double t)
  {
    constexpr double         share   = 1e-14;
    constexpr unsigned int   guesses = 1000; // until the first one is short enough
    constexpr unsigned int   enough  = 10;   // looks without growth
    const double             step = stepper.current_step(), bound = share * end_time;
    const StepperCost       &cost = stepper.cost();
    const unsigned long long n    = cost.steps + cost.rejected;
    Trip                     trip;
    if (n == n_last) // the same state again
      return trip;
    const bool goes_on = step <= 0. || step >= bound || step > last_step ||
                         (cost.steps == 0 && cost.rejected < guesses);
    last_step = step;
    n_last    = n;
    n_stuck   = goes_on ? 0 : n_stuck + 1;
    if (n_stuck < enough)
      return trip;
    trip.monitor = "step size";
    trip.value   = step;
    trip.bound   = bound;
    trip.time    = t;
    trip.found   = "the steps of '" + stepper.name() + "' have become as short as " +
                 rounded_text(step) + ", which leads nowhere";
    trip.cause =
      "What is given, a value, a flux or a source, jumps or grows faster than any step can follow. Let it change over some time, or choose 'Stepper = sdirk2' with a 'Time step'.";
    return trip;
  }


  std::string cause_in_step(const Stepper &stepper, Operator &op, const Vector &u, const Trip &trip)
  {
    if (trip.monitor == "solver" || !std::isfinite(stable_step(stepper.name(), 1.)) ||
        !extent_of(u).finite)
      return "";
    if (op.depends_on_solution())
      {
        Vector at(u);
        op.distribute(at, trip.time);
        op.take_material_at(at);
      }
    const double step  = stepper.current_step(),
                 limit = stable_step(stepper.name(), op.spectrum().sharp);
    if (!(step > limit))
      return "";
    return too_long(step, limit, stepper.name()) +
           (op.depends_on_solution() ? " with the material at these values" : "") +
           ". Choose a smaller step, or 'Time step = auto'.";
  }


  std::string cause_in_motion(const MotionStepper &stepper, ElasticOperator &op, const Vector &u)
  {
    if (stepper.name() != "verlet" || !extent_of(u).finite)
      return "";
    op.linearize(u);
    const double step = stepper.current_step(), limit = stable_motion_step(op);
    if (!(step > limit))
      return "";
    return too_long(step, limit, stepper.name()) +
           " for the body as it is now (2/omega of the fastest motion). Choose a smaller step, "
           "'Time step = auto', or 'Stepper = newmark'.";
  }


  std::string cause_in_balance(const double solver_tolerance)
  {
    constexpr double rough = 1e-6;
    if (!(solver_tolerance > rough))
      return "";
    return "'Tolerance' in section 'Solver' is " + number_text(solver_tolerance) +
           ": what is left of the residual, as a share of the start, is lost or comes from nowhere. Choose 1e-8 or less.";
  }


  std::string cause_in_operator(Operator &op, const PlaceOfNode &place_of, const Trip &trip)
  {
    constexpr double hardly   = 1e-6;
    const Vector    &diagonal = op.diagonal();
    Vector           free;
    op.initialize_vector(free);
    free = 1.;
    op.clear_constrained(free);
    const auto inverse = [&](const unsigned int i) {
      return free.local_element(i) == 0. ? 0. : 1. / std::abs(diagonal.local_element(i));
    };
    const auto itself = [&](const unsigned int i) {
      return free.local_element(i) == 0. ? 0. : std::abs(diagonal.local_element(i));
    };
    const unsigned int n        = op.n_components();
    const Worst        smallest = find_worst(diagonal, n, place_of, inverse),
                largest         = find_worst(diagonal, n, place_of, itself);
    const double share          = 1. / (smallest.size * largest.size);
    if (trip.monitor == "solver" && share < hardly)
      return "What holds the node at " + text_of_place(smallest.place) + " to others is " +
             rounded_text(share) + " of what holds that at " + text_of_place(largest.place) +
             ": materials or contacts that differ so much, or a part that hardly anything holds.";
    return "";
  }
} // namespace PeriDeal
