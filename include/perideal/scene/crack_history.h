// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/bounding_box.h>

#include <perideal/scene/change_set.h>
#include <perideal/scene/cracks.h>

#include <optional>
#include <vector>

namespace PeriDeal
{
  /**
   * When the cracks of a scene change: a list of events, between which cracks and their
   * transmission are taken as constant.
   *
   * Between two events no tip advances more than the growth step s, and the cracks are those of the
   * middle of that span: a bond is cut at most s/(2 v) too early or too late, v the tip's speed,
   * which makes an error of second order in s where the solution is smooth in time. With steps of
   * fixed size events lie at whole numbers of steps, so that they divide none. A transmission that
   * changes with time is taken at the middle too, with events so close that it changes by at most
   * 0.02 between them, jumps excepted.
   *
   * The same on all processes; nothing here is collective.
   */
  template <int dim>
  class CrackHistory
  {
  public:
    /**
     * @param step      the growth step, a length; the entry of section `Cracks` if that is given
     * @param time_step of a stepper with fixed steps, else negative
     *
     * Throws UserError: tips faster than one growth step in one time step, more than a million
     * events, a transmission outside 0 to 1.
     */
    CrackHistory(const Cracks<dim> &cracks,
                 const double       step,
                 const double       end_time,
                 const double       time_step);

    /** First event after time t, infinity if there is none. */
    double next_event(const double t) const;

    /**
     * The time whose cracks hold at t: the middle of the span between events. At an event the span
     * that begins.
     */
    double representative(const double t) const;

    /** The pieces of all cracks, whole history included, at that very time. */
    std::vector<CrackPiece<dim>> pieces(const double t, const bool cut_at_tips = true) const
    {
      return cracks->pieces(t, cut_at_tips);
    }

    double transmission(const double t) const
    {
      return cracks->transmission.value(dealii::Point<dim>(), t);
    }

    /**
     * What changes from the cracks of a representative time to those that hold at t; nothing if
     * they are the same.
     */
    std::optional<ChangeSet<dim>> change(const double from, const double t) const;

    /**
     * Boxes around all that changes with the cracks between two times, t_1 < t_2. Empty if nothing
     * does.
     */
    std::vector<dealii::BoundingBox<dim>> changes(const double t_1, const double t_2) const;

    /** Something changes at some time. */
    bool changes_ever() const
    {
      return cracks->change();
    }

    /** Some bond or pair may conduct again after it was cut, so that rates can grow. */
    bool may_close() const
    {
      return !cracks->cracks.empty() && cracks->transmission.depends_on_time();
    }

    const std::vector<double> &events() const
    {
      return times;
    }

    /** The longest path of a tip between two events. */
    double longest_advance() const
    {
      return advance;
    }

  private:
    double begin_of_span(const double t) const; // that holds t: an event, or 0
    void   add_growth_events(const double step, const double time_step);
    void   add_transmission_events();
    void   refine_transmission(const double a, const double b);
    double checked_transmission(const double t) const;

    const Cracks<dim>  *cracks;
    std::vector<double> times; // of events, ascending
    double              end, advance = 0.;
  };
} // namespace PeriDeal
