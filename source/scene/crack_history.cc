// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/scene/crack_history.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** Of the end time: events closer than this are one. */
    constexpr double same_time = 1e-12;

    constexpr std::size_t most_events = 1000000;

    /** Largest change of the transmission between two events. */
    constexpr double transmission_step = 0.02;
  } // namespace


  template <int dim>
  CrackHistory<dim>::CrackHistory(const Cracks<dim> &cracks,
                                  const double       step,
                                  const double       end_time,
                                  const double       time_step)
    : cracks(&cracks)
    , end(end_time)
  {
    if (!cracks.change())
      return;
    add_growth_events(step, time_step);
    if (cracks.transmission.depends_on_time())
      add_transmission_events();
    if (time_step > 0.)
      for (double &t : times)
        t = time_step * std::round(t / time_step);
    std::sort(times.begin(), times.end());
    std::vector<double> apart;
    for (const double t : times)
      if (t > same_time * end && t < (1. - same_time) * end &&
          (apart.empty() || t - apart.back() > same_time * end))
        apart.push_back(t);
    times = apart;
  }


  template <int dim>
  void CrackHistory<dim>::add_growth_events(const double step, const double time_step)
  {
    std::vector<double> turns{0., end}; // when a tip starts, turns or stops
    for (const CrackTip<dim> &tip : cracks->tips)
      for (const auto &[time, point] : tip.path)
        if (time < end)
          turns.push_back(time);
    std::sort(turns.begin(), turns.end());
    for (std::size_t k = 0; k + 1 < turns.size(); ++k)
      {
        const double         from = turns[k], span = turns[k + 1] - from;
        double               fastest = 0.;
        const CrackTip<dim> *leader  = nullptr;
        for (const CrackTip<dim> &tip : cracks->tips)
          if (tip.speed(from) > fastest)
            {
              fastest = tip.speed(from);
              leader  = &tip;
            }
        if (span <= same_time * end)
          continue;
        times.push_back(from);
        if (leader == nullptr)
          continue;
        double n = std::max(1., std::ceil(span * fastest / step * (1. - 1e-10)));
        if (time_step > 0.)
          {
            if (fastest * time_step > 4. * step * (1. + 1e-10))
              cracks->tip_error(
                *leader,
                "advances by " + number_text(fastest * time_step) +
                  " in one 'Time step' of section 'Time', farther than four growth steps of " +
                  number_text(step) +
                  ". Choose a smaller 'Time step', or a larger 'Growth step' in section 'Cracks'.");
            n = span /
                (time_step * std::max(1., std::floor(step / (fastest * time_step) * (1. + 1e-10))));
          }
        if (!(n < most_events))
          cracks->tip_error(*leader,
                            "needs " + number_text(n) + " events with 'Growth step' = " +
                              number_text(step) + "; choose a larger one.");
        advance = std::max(advance, fastest * span / n);
        for (unsigned int j = 1; j < n * (1. - 1e-10); ++j)
          times.push_back(from + span * (j / n));
      }
  }


  template <int dim>
  double CrackHistory<dim>::checked_transmission(const double t) const
  {
    const double found = transmission(t);
    if (found < 0. || found > 1.)
      entry_error(cracks->where("Transmission"),
                  "'" + cracks->transmission.text() + "' is " + number_text(found) +
                    " at t = " + number_text(t) + ", needs a number from 0 to 1.");
    return found;
  }


  template <int dim>
  void CrackHistory<dim>::refine_transmission(const double a, const double b)
  {
    const double middle = 0.5 * (a + b), there = checked_transmission(middle);
    const double change =
      std::max(std::abs(transmission(a) - there), std::abs(transmission(b) - there));
    if (times.size() > most_events)
      entry_error(cracks->where("Transmission"),
                  "'" + cracks->transmission.text() +
                    "' changes so often that it needs more than " + std::to_string(most_events) +
                    " events; give a smoother formula.");
    if (change > 0.)
      times.push_back(b); // what is constant needs no event but its end
    if (change <= 0.5 * transmission_step || b - a < 1e-7 * end)
      return;
    refine_transmission(a, middle);
    refine_transmission(middle, b);
  }


  template <int dim>
  void CrackHistory<dim>::add_transmission_events()
  {
    constexpr unsigned int n_samples = 128;
    for (unsigned int k = 0; k < n_samples; ++k)
      {
        const double a = end * k / n_samples, b = end * (k + 1) / n_samples;
        checked_transmission(b);
        const std::size_t n_before = times.size();
        refine_transmission(a, b);
        if (times.size() > n_before)
          times.push_back(a);
      }
  }


  template <int dim>
  double CrackHistory<dim>::next_event(const double t) const
  {
    const auto next = std::upper_bound(times.begin(), times.end(), t + same_time * end);
    return next == times.end() ? std::numeric_limits<double>::infinity() : *next;
  }


  template <int dim>
  double CrackHistory<dim>::representative(const double t) const
  {
    if (times.empty())
      return cracks->change() ? 0.5 * end : t;
    return 0.5 * (begin_of_span(t) + std::min(next_event(t), end));
  }


  template <int dim>
  double CrackHistory<dim>::begin_of_span(const double t) const
  {
    const auto next = std::upper_bound(times.begin(), times.end(), t + same_time * end);
    return next == times.begin() ? 0. : *(next - 1);
  }


  template <int dim>
  std::optional<ChangeSet<dim>> CrackHistory<dim>::change(const double from, const double t) const
  {
    const double to = representative(t);
    if (to == from || !changes_ever())
      return std::nullopt;
    ChangeSet<dim> found;
    found.from  = from;
    found.to    = to;
    found.since = begin_of_span(t);
    found.cuts  = changes(from, to);
    return found;
  }


  template <int dim>
  std::vector<BoundingBox<dim>> CrackHistory<dim>::changes(const double t_1, const double t_2) const
  {
    std::vector<BoundingBox<dim>> boxes;
    if (transmission(t_1) != transmission(t_2))
      for (const CrackPiece<dim> &piece : pieces(t_2))
        boxes.emplace_back(piece.corners);
    for (const CrackTip<dim> &tip : cracks->tips)
      {
        std::vector<Point<dim>> way{tip.at(t_1)};
        for (const auto &[time, point] : tip.path)
          if (time > t_1 && time < t_2)
            way.push_back(point);
        way.push_back(tip.at(t_2));
        if (std::all_of(way.begin(), way.end(), [&](const auto &p) { return p == way[0]; }))
          continue;
        if (dim == 3) // the polygon between the corner and its neighbours
          for (const double t : {t_1, t_2})
            {
              const auto corners = pieces(t)[tip.crack].corners;
              for (const std::size_t step : {std::size_t(1), corners.size() - 1})
                way.push_back(corners[(tip.corner + step) % corners.size()]);
            }
        boxes.emplace_back(way);
      }
    return boxes;
  }


  PERIDEAL_INSTANTIATE_CLASS(class CrackHistory);
} // namespace PeriDeal
