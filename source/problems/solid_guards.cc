// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// What the guards of a run look for in elastic bodies, and what brings it about.

#include <perideal/problems/body_causes.h>
#include <perideal/problems/solid_problem.h>
#include <perideal/scene/lists.h>
#include <perideal/solvers/step_tools.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "guard_causes.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** A part that has broken off and is many times as far from the rest as the body is wide. */
    Trip flown_off(const ElasticOperator &op,
                   const Vector          &u,
                   const unsigned int     dim,
                   const double           size,
                   const PlaceOfNode     &place_of,
                   const double           t)
    {
      // Against supports, or the mean of a body that has none.
      const unsigned int      n    = u.locally_owned_size() / dim;
      const std::vector<bool> held = held_unknowns(op);
      std::vector<double>     sums(4 * dim, 0.); // of all and of held nodes: displacements, numbers
      for (unsigned int i = 0; i < n * dim; ++i)
        for (const unsigned int k : {0u, 2u})
          if (k == 0 || held[i])
            {
              sums[k * dim + i % dim] += u.local_element(i);
              sums[(k + 1) * dim + i % dim] += 1.;
            }
      Utilities::MPI::sum(sums, u.get_mpi_communicator(), sums);
      std::vector<double> rest(dim);
      for (unsigned int d = 0; d < dim; ++d)
        {
          const unsigned int k = sums[3 * dim + d] > 0. ? 2 : 0;
          rest[d]              = sums[k * dim + d] / sums[(k + 1) * dim + d];
        }
      double moved = 0.; // by supports
      for (unsigned int i = 0; i < n * dim; ++i)
        if (held[i])
          moved = std::max(moved, std::abs(u.local_element(i) - rest[i % dim]));
      moved               = Utilities::MPI::max(moved, u.get_mpi_communicator());
      const auto distance = [&](const unsigned int i) {
        double sum = 0.;
        for (unsigned int d = 0; d < dim; ++d)
          sum += std::pow(u.local_element(i / dim * dim + d) - rest[d], 2);
        return std::sqrt(sum);
      };
      const Worst      worst = find_worst(u, dim, place_of, distance);
      Trip             trip;
      constexpr double far = 10.;
      if (!(worst.size > far * (size + moved)))
        return trip;
      trip.monitor = "parts flying off";
      trip.value   = worst.size;
      trip.bound   = far * (size + moved);
      trip.place   = worst.place;
      trip.time    = t;
      trip.found   = "what was at " + text_of_place(worst.place) + " has flown off by " +
                   rounded_text(worst.size) +
                   " against the rest, more than ten times the size of the body (" +
                   rounded_text(trip.bound) + ")";
      trip.cause =
        "The bonds that held it have broken. 'Kinematics = linear' in section 'Elasticity' is for small displacements, and lets what spins grow as it flies: "
        "'Kinematics = full' turns it as it is, or an earlier 'End time' (section 'Time') ends the run before.";
      return trip;
    }
  } // namespace


  template <int dim>
  double SolidProblem<dim>::body_size()
  {
    if (size_of_body > 0.)
      return size_of_body;
    constexpr double far = std::numeric_limits<double>::max();
    double           ends[2 * dim];
    std::fill(ends, ends + 2 * dim, -far);
    for (unsigned int i = 0; i < displacement.locally_owned_size() / dim; ++i)
      for (unsigned int d = 0; d < dim; ++d)
        {
          ends[2 * d]     = std::max(ends[2 * d], this->position(i)[d]);
          ends[2 * d + 1] = std::max(ends[2 * d + 1], -this->position(i)[d]);
        }
    Utilities::MPI::max(ends, this->dofs().get_communicator(), ends);
    double sum = 0.;
    for (unsigned int d = 0; d < dim; ++d)
      sum += std::pow(ends[2 * d] + ends[2 * d + 1], 2);
    return size_of_body = std::sqrt(sum);
  }


  template <int dim>
  unsigned int SolidProblem<dim>::steps_between_looks() const
  {
    return stepper && stepper->name() == "verlet" ? 10 : 1;
  }


  template <int dim>
  Trip SolidProblem<dim>::take_finding()
  {
    return stepper ? stepper->findings().take() : loading ? loading->findings().take() : Trip();
  }


  template <int dim>
  Trip SolidProblem<dim>::watch(const double t)
  {
    const PlaceOfNode place_of = place_of_nodes(*this);
    const Extent      now      = extent_of(displacement);
    if (!now.finite)
      return values_not_finite(displacement, dim, place_of, this->field_name(), t);
    if (!stepper || op().nonlinear() || !op().brittle() || op().n_broken_bonds() == 0)
      return {};
    return now.size() > body_size() ? flown_off(op(), displacement, dim, body_size(), place_of, t) :
                                      Trip();
  }


  template <int dim>
  Trip SolidProblem<dim>::watch_totals(const double t) const
  {
    if (stepper || !op().symmetric())
      return {};
    return balance_broken("the forces on the body at rest do not balance: their sum is " +
                            rounded_text(force_lost),
                          force_lost,
                          "the largest force in it",
                          force_scale,
                          t);
  }


  template <int dim>
  void SolidProblem<dim>::explain(Trip &trip)
  {
    const PlaceOfNode place_of = place_of_nodes(*this);
    if (trip.place.empty() && stepper)
      trip.place = find_worst(velocity, dim, place_of, [&](const unsigned int i) {
                     return std::abs(velocity.local_element(i));
                   }).place;
    if (trip.cause.empty() && trip.monitor == "balance")
      trip.cause = cause_in_balance(scene.solver.tolerance);
    if (trip.cause.empty() && stepper)
      trip.cause = cause_in_motion(*stepper, op(), displacement);
    if (trip.cause.empty())
      trip.cause = cause_in_contrast<dim>(
        this->dofs().get_triangulation(),
        "The Young modulus",
        [&](const Point<dim> &p) { return scene.material.moduli(p).young(); },
        trip.monitor);
    if (trip.cause.empty())
      trip.cause = cause_in_operator(op(), place_of, trip);
  }


#define PERIDEAL_INSTANTIATE(dim)                                            \
  template unsigned int SolidProblem<dim>::steps_between_looks() const;      \
  template Trip         SolidProblem<dim>::take_finding();                   \
  template Trip         SolidProblem<dim>::watch(const double);              \
  template Trip         SolidProblem<dim>::watch_totals(const double) const; \
  template double       SolidProblem<dim>::body_size();                      \
  template void         SolidProblem<dim>::explain(Trip &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
