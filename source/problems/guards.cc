// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/base/vectorization.h>

#include <perideal/problems/guards.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>
#include <limits>

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
} // namespace PeriDeal
