// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/base/vectorization.h>
#include <deal.II/fe/fe.h>
#include <deal.II/fe/mapping_q1.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/problems/guards.h>
#include <perideal/scene/expression.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace PeriDeal
{
  using namespace dealii;

  double Extent::size() const
  {
    return std::max(std::abs(least), std::abs(most));
  }


  namespace
  {
    /** The extent of some of many values, a few at a time. */
    struct ExtentOfSome
    {
      using Lanes = VectorizedArray<double>;

      static constexpr double largest = std::numeric_limits<double>::max();

      void see(const double *values)
      {
        Lanes v;
        v.load(values);
        add(v, v, 0. * v); // which is 0 unless some value is not finite
      }

      void add(const Lanes &l, const Lanes &m, const Lanes &zero)
      {
        least = std::min(least, l);
        most  = std::max(most, m);
        nothing += zero;
      }

      Lanes least = largest, most = -largest, nothing = 0.;
    };
  } // namespace


  Extent extent_of(const Vector &u)
  {
    // Four at once: a minimum waits for the one before it.
    constexpr unsigned int width = ExtentOfSome::Lanes::size(), block = 4 * width;
    const double          *values = u.begin();
    const unsigned int     n = u.locally_owned_size(), n_whole = n / block * block;
    ExtentOfSome           a, b, c, d;
    for (unsigned int i = 0; i < n_whole; i += block)
      {
        a.see(values + i);
        b.see(values + i + width);
        c.see(values + i + 2 * width);
        d.see(values + i + 3 * width);
      }
    for (const ExtentOfSome *const other : {&b, &c, &d})
      a.add(other->least, other->most, other->nothing);

    double least = ExtentOfSome::largest, most = -least, nothing = 0.;
    for (unsigned int k = 0; k < width; ++k)
      {
        least = std::min(least, a.least[k]);
        most  = std::max(most, a.most[k]);
        nothing += a.nothing[k];
      }
    for (unsigned int i = n_whole; i < n; ++i)
      {
        least = std::min(least, values[i]);
        most  = std::max(most, values[i]);
        nothing += 0. * values[i];
      }
    double found[3] = {most, -least, nothing == 0. ? 0. : 1.};
    Utilities::MPI::max(found, u.get_mpi_communicator(), found);
    return {-found[1], found[0], found[2] == 0.};
  }


  std::string text_of_place(const std::vector<double> &place)
  {
    std::string text;
    for (const double x : place)
      text += (text.empty() ? "(" : ", ") + rounded_text(x);
    return text + ")";
  }


  Worst find_worst(const Vector                                    &u,
                   const unsigned int                               n_components,
                   const PlaceOfNode                               &place_of,
                   const std::function<double(const unsigned int)> &size)
  {
    Worst        worst;
    unsigned int where = 0;
    for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
      {
        const double found = size(i);
        const double here  = std::isfinite(found) ? found : std::numeric_limits<double>::infinity();
        if (here > worst.size)
          {
            worst.size = here;
            where      = i;
          }
      }
    const MPI_Comm communicator = u.get_mpi_communicator();
    const double   all          = Utilities::MPI::max(worst.size, communicator);
    if (all == 0.)
      return {};
    const unsigned int n_processes = Utilities::MPI::n_mpi_processes(communicator),
                       rank        = Utilities::MPI::this_mpi_process(communicator);
    const unsigned int first =
      Utilities::MPI::min(worst.size == all ? rank : n_processes, communicator);
    if (first == rank)
      {
        worst.value = u.local_element(where);
        worst.place = place_of(where / n_components);
      }
    worst.size  = all;
    worst.value = Utilities::MPI::broadcast(communicator, worst.value, first);
    worst.place = Utilities::MPI::broadcast(communicator, worst.place, first);
    return worst;
  }


  Trip values_not_finite(const Vector      &u,
                         const unsigned int n_components,
                         const PlaceOfNode &place_of,
                         const std::string &name,
                         const double       t)
  {
    const Worst worst = find_worst(u, n_components, place_of, [&](const unsigned int i) {
      return std::isfinite(u.local_element(i)) ? 0. : std::numeric_limits<double>::infinity();
    });
    Trip        trip;
    trip.monitor = "finite values";
    trip.found =
      "the " + name + " at " + text_of_place(worst.place) + " is no finite number any more";
    trip.value = worst.value;
    trip.place = worst.place;
    trip.time  = t;
    return trip;
  }


  Trip balance_broken(const std::string &what,
                      const double       missing,
                      const std::string &of,
                      const double       whole,
                      const double       t)
  {
    constexpr double share = 0.01;
    Trip             trip;
    if (!(std::abs(missing) > share * whole))
      return trip;
    trip.monitor = "balance";
    trip.value   = std::abs(missing);
    trip.bound   = share * whole;
    trip.time    = t;
    trip.found   = what + ", " + rounded_text(100. * trip.value / whole) + " % of " + of +
                 " and more than " + rounded_text(100. * share) + " %";
    return trip;
  }


  Trip heat_lost(const DiffusionOperator &op,
                 const HeatLedger        &ledger,
                 const std::string       &quantity,
                 const double             t)
  {
    if (!op.symmetric() || op.capacity_depends_on_solution())
      return {};
    const double      missing = ledger.last_found().imbalance();
    const std::string number  = rounded_text(std::abs(missing));
    return balance_broken(
      missing > 0. ?
        number + " of the " + quantity + " that has come in since the start is not in the body" :
        "the body holds " + number + " of " + quantity + " that has not come in since the start",
      missing,
      "the most that has moved",
      ledger.most_moved(),
      t);
  }


  bool GrowthGuard::returns_too_fast(const DiffusionOperator &op,
                                     const Vector            &u,
                                     const double             t,
                                     const PlaceOfNode       &place_of,
                                     Worst                   &worst) const
  {
    constexpr double part = 0.25, far = 0.5; // of the eigenvalue, of the way to the farthest
    Vector           at(u), rate;
    op.initialize_vector(rate);
    op.distribute(at, t);
    op.residual(rate, at, t);
    const Vector &capacity = op.lumped_capacity();
    const double  middle   = 0.5 * (range.least + range.most);
    const double  fast     = part * op.spectrum().sharp;
    worst                  = find_worst(at, 1, place_of, [&](const unsigned int i) {
      const double away    = at.local_element(i) - middle;
      const double returns = -rate.local_element(i) / capacity.local_element(i) / away;
      return rate.local_element(i) != 0. && returns > fast ? std::abs(away) : 0.;
    });
    return worst.size > far * farthest;
  }


  bool GrowthGuard::gets_farther(const double now)
  {
    const bool farther = farthest_before == 0. || now > farthest_before; // 0: not known
    farthest_before    = farthest;
    farthest           = now;
    return farther;
  }


  void GrowthGuard::forget_suspicion()
  {
    n_suspicious    = 0;
    farthest        = 0.;
    farthest_before = 0.;
  }


  bool GrowthGuard::grows_by_steps(const DiffusionOperator &op,
                                   const Vector            &u,
                                   const double             t,
                                   const Extent            &now,
                                   const bool               is_beyond,
                                   const PlaceOfNode       &place_of,
                                   Worst                   &worst)
  {
    constexpr unsigned int enough = 6;
    const double           middle = 0.5 * (range.least + range.most);
    if (!is_beyond && (n_suspicious == 0 || was_within))
      forget_suspicion();
    else
      {
        const bool farther = gets_farther(std::max(now.most - middle, middle - now.least));
        if (is_beyond && farther && returns_too_fast(op, u, t, place_of, worst))
          ++n_suspicious;
        else if (is_beyond)
          {
            forget_suspicion();
            range = {std::min(range.least, now.least), std::max(range.most, now.most), true};
          }
      }
    was_within = !is_beyond;
    return is_beyond && n_suspicious >= enough;
  }


  Trip GrowthGuard::look(const DiffusionOperator &op,
                         const Vector            &u,
                         const double             t,
                         const Extent            *given,
                         const PlaceOfNode       &place_of,
                         const std::string       &name)
  {
    constexpr double least_width = 1e-3; // of the values: differences of others may be noise
    const Extent     now         = extent_of(u);
    if (!now.finite)
      return values_not_finite(u, 1, place_of, name, t);
    if (known && t == last_time) // the same state again
      return {};
    if (!known)
      range = now;
    if (given)
      range = {std::min(range.least, given->least), std::max(range.most, given->most), true};
    known               = true;
    last_time           = t;
    const double width  = std::max(range.width(), least_width * range.size());
    const double beyond = std::max(now.most - range.most, range.least - now.least);
    const double middle = 0.5 * (range.least + range.most);
    Worst        worst;
    if (given ? beyond <= width : !grows_by_steps(op, u, t, now, beyond > width, place_of, worst))
      return {};
    if (given)
      worst = find_worst(u, 1, place_of, [&](const unsigned int i) {
        return std::abs(u.local_element(i) - middle);
      });
    Trip trip;
    trip.monitor = given ? "maximum principle" : "growth";
    trip.value   = worst.value;
    trip.bound   = worst.value > middle ? range.most + width : range.least - width;
    trip.place   = worst.place;
    trip.time    = t;
    trip.found =
      "the " + name + " at " + text_of_place(worst.place) + " is " + rounded_text(worst.value) +
      ", outside of " + rounded_text(range.least) + " to " + rounded_text(range.most) +
      (given ?
         ", between which initial and given values lie and all others have to stay" :
         ", and on its way back as fast as only noise of the mesh is: the steps make it grow, not the loads");
    return trip;
  }


  namespace
  {
    /** How many times the second value the first one is, both values, and the place. */
    using Jump = std::vector<double>;


    /** Of the same ratio the one whose place comes first, so that all processes find the same. */
    bool is_worse(const Jump &a, const Jump &b)
    {
      constexpr double same = 1. + 1e-12;
      if (a.empty() || b.empty())
        return b.empty() && !a.empty();
      if (a[0] > same * b[0] || b[0] > same * a[0])
        return a[0] > b[0];
      return std::vector<double>(a.begin() + 3, a.end()) <
             std::vector<double>(b.begin() + 3, b.end());
    }


    Jump worst_of(const std::vector<Jump> &jumps)
    {
      Jump worst;
      for (const Jump &jump : jumps)
        if (is_worse(jump, worst))
          worst = jump;
      return worst;
    }


    template <int dim>
    Jump largest_jump(const Triangulation<dim>                        &mesh,
                      const std::function<double(const Point<dim> &)> &property)
    {
      Jump worst;
      for (const auto &cell : mesh.active_cell_iterators())
        for (const unsigned int f : cell->face_indices())
          if (cell->is_locally_owned() && !cell->at_boundary(f))
            {
              const double here  = property(cell->center()),
                           there = property(cell->neighbor(f)->center());
              const Point<dim> p = cell->face(f)->center();
              Jump             jump{here / there, here, there}; // each face has two sides
              jump.insert(jump.end(), p.begin_raw(), p.end_raw());
              worst = worst_of({worst, jump});
            }
      return worst;
    }
  } // namespace


  template <int dim>
  std::string cause_in_contrast(const Triangulation<dim>                        &mesh,
                                const std::string                               &entry,
                                const std::function<double(const Point<dim> &)> &property,
                                const std::string                               &monitor)
  {
    const bool   of_balance = monitor == "balance";
    const double much       = of_balance ? 1e9 : 1e5;
    if (!of_balance && monitor != "solver")
      return "";
    Jump worst;
    try
      {
        with_formulas(mesh.get_communicator(), [&] { worst = largest_jump(mesh, property); });
      }
    catch (const UserError &) // no value at some point that nothing else has asked for
      {
        return "";
      }
    worst = worst_of(Utilities::MPI::all_gather(mesh.get_communicator(), worst));
    if (worst.empty() || !(worst[0] > much))
      return "";
    return entry + " in section 'Material' is " + rounded_text(worst[1]) + " in one cell and " +
           rounded_text(worst[2]) + " in the next, at " +
           text_of_place(std::vector<double>(worst.begin() + 3, worst.end())) +
           (of_balance ?
              ": the round-off of the one is no less than all that the other lets through. " :
              ": iterations hardly get across. ") +
           "Beyond a thousand times hardly anything changes but that: choose values that differ less, or leave out what hardly takes part, as a hole or a crack.";
  }


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
  PlaceOfNode place_of_nodes(const DoFHandler<dim> &dofs)
  {
    return [&dofs](const unsigned int node) {
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


  std::string cause_in_step(const Stepper     &stepper,
                            DiffusionOperator &op,
                            const Vector      &u,
                            const Trip        &trip)
  {
    if (trip.monitor == "solver" || !std::isfinite(stable_step(stepper.name(), 1.)) ||
        !extent_of(u).finite)
      return "";
    if (op.depends_on_solution())
      {
        Vector at(u);
        op.distribute(at, trip.time);
        op.take_material_at(at, trip.time);
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


  PERIDEAL_INSTANTIATE_FUNCTION(cause_in_contrast);
  PERIDEAL_INSTANTIATE_FUNCTION(place_of_nodes);
} // namespace PeriDeal
