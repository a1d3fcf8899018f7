// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "growth_trace.h"

#include <deal.II/base/mpi.h>

#include <perideal/analysis/tip_field.h>
#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/output/tables.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <sstream>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    std::string text_of(const Attempt &attempt, const std::string &entry)
    {
      for (const auto &[name, text] : attempt.settings)
        if (name == entry)
          return text;
      return "";
    }


    /** The same of cells between lines. */
    double diagonal_between_lines(const Attempt &attempt)
    {
      const double halves = std::stod(text_of(attempt, "Domain/Refinements"));
      double       square = 0.;
      for (const std::string &piece : split_list(text_of(attempt, "Domain/Cell lines"), ';'))
        {
          double last = 0., edge = std::numeric_limits<double>::max();
          bool   any = false;
          for (const std::string &place : split_list(piece, ','))
            {
              const double at = std::stod(place);
              edge            = any ? std::min(edge, at - last) : edge;
              last            = at;
              any             = true;
            }
          square += std::pow(edge / std::exp2(halves), 2);
        }
      return std::sqrt(square);
    }


    /** The diagonal of the smallest cells. */
    double diagonal_of(const Attempt &attempt, const CrackedBox &box)
    {
      if (text_of(attempt, "Domain/Cells").empty())
        return diagonal_between_lines(attempt);
      std::istringstream cells(text_of(attempt, "Domain/Cells"));
      double             square = 0.;
      for (unsigned int d = 0; d < box.dim(); ++d)
        {
          double n = 1.;
          cells >> n;
          cells.ignore(1, ',');
          square += std::pow((box.upper[d] - box.lower[d]) / n, 2);
        }
      return std::sqrt(square);
    }


    /** Whether an end has stress intensities. */
    bool is_seen(const GriffithState &state, const std::string &name)
    {
      return std::any_of(state.ends.begin(), state.ends.end(), [&](const GriffithEnd &end) {
        return end.name == name;
      });
    }


    bool is_open(const GrowingCracks &cracks, const GrowingCracks::End &end)
    {
      return std::any_of(cracks.ends().begin(),
                         cracks.ends().end(),
                         [&](const GrowingCracks::End &one) {
                           return one.line == end.line && one.is_last == end.is_last;
                         });
    }


    /** Ends that have grown, and the largest angle by which one turned. */
    struct Grown
    {
      std::vector<GrowingCracks::End> ends;
      double                          turned = 0.;
    };


    /** Those that grow first, or hardly later, go on. */
    Grown grow_first(GrowingCracks &cracks, const GriffithState &state, const double step)
    {
      constexpr double                      together = 1.02;
      const double                          first    = state.load();
      const std::vector<GrowingCracks::End> ends     = cracks.ends();
      // Names change as cracks get longer.
      std::vector<std::pair<GrowingCracks::End, double>> growing;
      for (const GrowingCracks::End &end : ends)
        for (const GriffithEnd &one : state.ends)
          if (one.name == cracks.name(end) && one.load() <= together * first)
            growing.emplace_back(end, one.kink().angle);
      Grown grown;
      for (const auto &[end, angle] : growing)
        {
          cracks.grow(end, angle, step);
          grown.ends.push_back(end);
          grown.turned = std::max(grown.turned, std::abs(angle));
        }
      return grown;
    }


    /** What is left of the way to a side or another crack is less than a ring there needs. */
    void end_near_sides(GrowingCracks                         &cracks,
                        const std::vector<GrowingCracks::End> &ends,
                        const double                           step)
    {
      constexpr double near = 0.5;
      for (const GrowingCracks::End &end : ends)
        if (is_open(cracks, end) && cracks.way_ahead(end) < near * step)
          cracks.let_through(end);
    }
  } // namespace


  std::size_t GrowthTrace::strongest() const
  {
    std::size_t best = 0;
    for (std::size_t k = 1; k < states.size(); ++k)
      if (states[k].bears > states[best].bears)
        best = k;
    return best;
  }


  double GrowthTrace::between_states() const
  {
    const std::size_t best = strongest();
    if (states.size() < 3)
      return 0.;
    // The parabola through three states around it, with their distances along the crack.
    const std::size_t  middle = std::clamp<std::size_t>(best, 1, states.size() - 2);
    const TracedState &a = states[middle - 1], &b = states[middle], &c = states[middle + 1];
    const auto         bearing = [](const TracedState &one) { return one.state.strength(); };
    const double       before  = b.cracks.grown() - a.cracks.grown(),
                 after         = c.cracks.grown() - b.cracks.grown();
    if (!(before > 0.) || !(after > 0.))
      return 0.;
    const double down = (bearing(a) - bearing(b)) / before, up = (bearing(c) - bearing(b)) / after,
                 bend = (down + up) / (before + after), slope = up - bend * after;
    const double top = bend < 0. ? -0.5 * slope / bend : 0.;
    if (bend >= 0. || top <= -before || top >= after)
      return 0.;
    const double highest = bearing(b) + slope * top + bend * top * top;
    return std::max(0., highest / states[best].bears - 1.);
  }


  template <int dim>
  CrackTracer<dim>::CrackTracer(const Scene<dim>         &scene,
                                const SceneText          &text,
                                const MPI_Comm            communicator,
                                const MeasuredError<dim> &measure)
    : scene(scene)
    , text(text)
    , communicator(communicator)
    , measure(measure)
  {}


  template <int dim>
  std::vector<Setting> CrackTracer<dim>::settings(const GrowingCracks &cracks,
                                                  const double         end_time) const
  {
    return {{"Cracks/Segments", cracks.segments()},
            {"Material/Fracture energy", ""},
            {"Elasticity/Breaking", "auto"},
            {"Elasticity/Contact", "auto"},
            {"Elasticity/Solver", "linear"},
            {"Coupling/Zone share", "0.5"},
            {"Time/End time", full_precision(end_time)},
            {"Time/Time step", full_precision(end_time)},
            {"Output/Write at", ""},
            {"Output/Write every", ""}};
  }


  template <int dim>
  std::shared_ptr<Scene<dim>> CrackTracer<dim>::body_with(const GrowingCracks &cracks,
                                                          const double         end_time) const
  {
    std::vector<Setting> all = settings(cracks, end_time);
    // Else cracks near faces of `Cells` would be laid on them.
    all.emplace_back("Cracks/Mesh", "removed");
    all.emplace_back("Cracks/Nodes on cracks", "left");
    return scene_variant(scene, all);
  }


  template <int dim>
  double CrackTracer<dim>::fineness_for(const GrowingCracks &cracks,
                                        const Attempts<dim> &attempts) const
  {
    // A ring has this share of the room, and needs two cells (crack_end_integrals()).
    constexpr double ring = 0.45, more = 1.1, most = 50.;
    // Less of the longest edge beside sides and places that are held is not worth such cells; the
    // stretch of a step is, or ends would be passed by.
    constexpr double narrow  = 0.01;
    const CrackedBox box     = cracked_box(scene);
    double           longest = 0., narrowest = std::numeric_limits<double>::max();
    for (unsigned int d = 0; d < dim; ++d)
      longest = std::max(longest, box.upper[d] - box.lower[d]);
    for (const GrowingCracks::End &end : cracks.ends())
      narrowest = std::min(
        narrowest,
        std::max(room(cracks, end), std::min(narrow * longest, 0.5 * cracks.last_stretch(end))));
    double fineness = attempts.coarsest();
    while (2. * diagonal_of(attempts.at(fineness), box) > ring * narrowest &&
           fineness < most * attempts.coarsest())
      fineness *= more;
    return fineness;
  }


  template <int dim>
  double CrackTracer<dim>::room(const GrowingCracks &cracks, const GrowingCracks::End &end) const
  {
    double nearest = cracks.room(end);
    if constexpr (dim == 2)
      nearest = std::min(nearest, distance_to_parts(scene, cracks.place(end)));
    return nearest;
  }


  template <int dim>
  TracedState CrackTracer<dim>::state_of(const GrowingCracks &cracks,
                                         const double         time,
                                         const double         fineness) const
  {
    constexpr unsigned int  n_tries = 3;
    constexpr double        finer   = 1.5;
    const auto              variant = body_with(cracks, time);
    const BodyOfChoice<dim> body(*variant, communicator);
    const Search<dim>       search(body, text, communicator, measure, LimitOfAttempts::classical);
    TracedState             one{cracks, {}, {}};
    one.fineness = fineness * fineness_for(cracks, search.attempts());
    for (unsigned int k = 0;; ++k, one.fineness *= finer)
      {
        one.attempt            = search.attempts().at(one.fineness);
        const Tried<dim> tried = search.solve(one.attempt);
        one.state =
          griffith_state(scene, tried.scene->cracks, tried.simulation->found()["models"]["auto"]);
        const auto &ends = cracks.ends();
        if (k + 1 == n_tries ||
            std::all_of(ends.begin(), ends.end(), [&](const GrowingCracks::End &end) {
              return is_seen(one.state, cracks.name(end));
            }))
          return one;
      }
  }


  template <int dim>
  void CrackTracer<dim>::refuse_loads(const TracedState &state) const
  {
    constexpr double slack = 1e-4, pressed = 0.05;
    const auto       refuse = [&](const bool fault, const std::string &what) {
      scene.accuracy.refuse(fault,
                            "Measure",
                            "is '" + scene.accuracy.measure_text() + "', but " + what);
    };
    refuse(!(state.state.force > 0.), "no side that is held or loaded bears a force.");
    refuse(state.state.ends.empty(),
           "no crack has stress intensities: they need the same moduli everywhere, and room around "
           "the ends of cracks for some cells.");
    for (const GriffithEnd &end : state.state.ends)
      refuse(end.mode_1 < -pressed * std::abs(end.mode_2) && end.mode_1 < -pressed * end.toughness,
             end.name +
               " is pressed together by the loads (K_I < 0), where faces that touch matter. "
               "Give 'Horizon' in section 'Peridynamics' as a length.");
    for (const GrowingCracks::End &end : state.cracks.ends())
      refuse(!is_seen(state.state, state.cracks.name(end)),
             "there is no room around " + state.cracks.name(end) +
               " for a ring of some cells, by which its stress intensities are found.");
    const GriffithState half  = state_of(state.cracks, 0.5 * scene.time.end_time, 1.).state;
    double              apart = std::abs(2. * half.force / state.state.force - 1.);
    for (std::size_t k = 0; k < half.ends.size() && k < state.state.ends.size(); ++k)
      apart = std::max(apart,
                       std::abs(2. * half.ends[k].mode_1 - state.state.ends[k].mode_1) /
                         std::hypot(state.state.ends[k].mode_1, state.state.ends[k].mode_2));
    refuse(
      apart > slack,
      "loads are not in proportion to t. Give displacements, tractions and forces as numbers, or formulas of "
      "x and y, times t.");
  }


  template <int dim>
  TracedState CrackTracer<dim>::first_state(const GrowingCracks &cracks,
                                            const TraceControl  &control) const
  {
    if (control.first)
      return *control.first;
    TracedState now = next_state(cracks, control);
    refuse_loads(now);
    return now;
  }


  template <int dim>
  TracedState CrackTracer<dim>::next_state(const GrowingCracks &cracks,
                                           const TraceControl  &control) const
  {
    try
      {
        return state_of(cracks, scene.time.end_time, control.fineness);
      }
    catch (const UserError &error)
      {
        scene.accuracy.refuse(
          true,
          "Measure",
          "is '" + scene.accuracy.measure_text() +
            "', but the body cannot be computed with the cracks '" + cracks.segments() + "' (" +
            error.message() +
            "). A larger 'Tolerance' needs fewer steps of them, points of 'Parts' in section 'Boundary conditions' should lie away from their way, and "
            "with 'Horizon' in section 'Peridynamics' as a length bonds break in place of it.");
        throw;
      }
  }


  template <int dim>
  bool CrackTracer<dim>::pass_unseen(const TracedState &now,
                                     const Ends        &growing,
                                     const double       step,
                                     GrowingCracks     &cracks,
                                     unsigned int      &n_passed) const
  {
    constexpr double       near = 1.5; // steps
    constexpr unsigned int most = 4;
    bool                   any  = false;
    const Ends             open = cracks.ends();
    // Where nothing is known of any end all go on, as they did.
    const bool none = std::none_of(open.begin(), open.end(), [&](const GrowingCracks::End &end) {
      return is_seen(now.state, cracks.name(end));
    });
    for (const GrowingCracks::End &end : none ? open : growing)
      {
        if (!is_open(cracks, end) || is_seen(now.state, cracks.name(end)))
          continue;
        any = true;
        if (cracks.way_ahead(end) < near * step)
          cracks.let_through(end);
        else
          {
            const dealii::Point<2> at = cracks.place(end);
            scene.accuracy.refuse(
              ++n_passed > most,
              "Measure",
              "is '" + scene.accuracy.measure_text() + "', but at (" + number_text(at[0]) + ", " +
                number_text(at[1]) +
                ") there is no room around the end of a crack for a ring of some cells, by which its stress intensities are "
                "found. Move points and regions of 'Parts' in section 'Boundary conditions' away from its way, or give "
                "'Horizon' in section 'Peridynamics' as a length.");
            cracks.grow(end, 0., step);
          }
      }
    if (!any)
      n_passed = 0;
    return any;
  }


  template <int dim>
  void CrackTracer<dim>::rest_before(TracedState       &&now,
                                     const TraceControl &control,
                                     const double        reached,
                                     const double        best,
                                     GrowthTrace        &trace) const
  {
    const TracedState &last = trace.states.back();
    trace.ends_early        = !control.to_end && last.state.force <= best;
    if (!trace.ends_early)
      {
        const double share =
          (1. - last.state.load()) / (std::min(now.state.load(), 2.) - last.state.load());
        GrowingCracks cracks = last.cracks;
        grow_first(cracks, last.state, share * control.step);
        now       = next_state(cracks, control);
        now.bears = std::min(1., std::max(reached, now.state.load())) * now.state.force;
      }
    trace.states.push_back(std::move(now));
  }


  template <int dim>
  GrowthTrace CrackTracer<dim>::follow(const GrowingCracks &from, const TraceControl &control) const
  {
    using Clock                    = std::chrono::steady_clock;
    constexpr double       fallen  = 0.5; // of the loads that they bore: they run through
    constexpr unsigned int most    = 400;
    const auto             start   = Clock::now();
    const auto             seconds = [&] {
      return Utilities::MPI::max(std::chrono::duration<double>(Clock::now() - start).count(),
                                 communicator);
    };
    GrowthTrace trace;
    trace.step            = control.step;
    GrowingCracks cracks  = from;
    double        reached = 0., best = 0.; // share of the loads, largest force
    Ends          growing;
    unsigned int  n_passed = 0;
    const auto    is_over  = [&] { return cracks.ends().empty() || cracks.part_the_body(); };
    while (trace.states.size() < most && (trace.states.empty() || !is_over()))
      {
        const double before = seconds();
        TracedState  now    = trace.states.empty() ? first_state(cracks, control) :
                                                     next_state(cracks, control);
        if (pass_unseen(now, growing, control.step, cracks, n_passed))
          continue;
        const double load = now.state.load();
        if (load > 1. && !trace.states.empty() && trace.states.back().state.load() < 1. &&
            std::all_of(growing.begin(), growing.end(), [&](const GrowingCracks::End &end) {
              return is_open(cracks, end);
            }))
          {
            trace.rests = true;
            rest_before(std::move(now), control, reached, best, trace);
            cracks = trace.states.back().cracks;
            break;
          }
        now.bears = load >= reached ? now.state.strength() : 0.;
        reached   = std::max(reached, load);
        best      = std::max(best, now.bears);
        trace.states.push_back(std::move(now));
        const TracedState &last = trace.states.back();
        trace.ends_early =
          !control.to_end && reached < 1. &&
          ((trace.states.size() > 2 && last.state.force <= best) || load < fallen * reached);
        trace.rests = reached >= 1.;
        if (trace.rests || trace.ends_early)
          break;
        trace.is_stopped = control.may_go_on && !control.may_go_on(seconds() - before);
        if (trace.is_stopped)
          break;
        const Grown grown = grow_first(cracks, last.state, control.step);
        end_near_sides(cracks, grown.ends, control.step);
        growing      = grown.ends;
        trace.turned = std::max(trace.turned, grown.turned);
      }
    trace.paths   = cracks.paths();
    trace.grown   = cracks.grown();
    trace.seconds = seconds();
    return trace;
  }


  PERIDEAL_INSTANTIATE_CLASS(class CrackTracer);
} // namespace PeriDeal
