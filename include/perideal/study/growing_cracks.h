// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/point.h>

#include <perideal/study/cracked_box.h>

#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * Cracks in a rectangle, lines of straight stretches, that grow at their ends in the body: what
   * `Segments` in section `Cracks` says, and how that goes on.
   */
  class GrowingCracks
  {
  public:
    using Path = std::vector<dealii::Point<2>>;

    /** Angles in radians that are no turn. */
    static constexpr double straight = 1e-3;

    /** An end that has not come to a side or to another crack yet. */
    struct End
    {
      std::size_t line    = 0;
      bool        is_last = true; // of the two of the line
    };

    /** @param box in two dimensions, each of its cracks with two corners */
    explicit GrowingCracks(const CrackedBox &box);

    const std::vector<End> &ends() const
    {
      return open;
    }

    const dealii::Point<2> &place(const End &end) const;

    /** As results have it: `crack 3 end 2` in the numbering of segments(). */
    std::string name(const End &end) const;

    /** As the entry `Segments` has them. */
    std::string segments() const;

    /** By how much all have grown. */
    double grown() const;

    /** Behind the end, since the last turn. */
    double last_stretch(const End &end) const;

    /** Straight on to the next side or other crack. */
    double way_ahead(const End &end) const;

    /** Around the end: half of the last stretch, or less to a side or another crack. */
    double room(const End &end) const;

    /**
     * Let an end go on by a length, turned to the left by an angle; if it comes to a side or to
     * another crack, only so far, and it is no end any more, nor is the other one that it meets.
     */
    void grow(const End &end, const double angle, const double length);

    /** Let an end go straight on to the side or crack ahead. */
    void let_through(const End &end);

    /** What has grown, each from where it was at the beginning; a line for each end that grew. */
    std::vector<Path> paths() const;

    /** Whether a crack, or cracks that have met, run from side to side. */
    bool part_the_body() const;

  private:
    bool on_side(const dealii::Point<2> &p) const; // or beyond

    /** The share of the way from a to b until a side or another crack, 1 if there is none. */
    double free_share(const dealii::Point<2> &a,
                      const dealii::Point<2> &b,
                      const std::size_t       own) const;

    CrackedBox                    box;
    double                        longest = 0.; // edge
    std::vector<Path>             lines;
    std::vector<dealii::Point<2>> first, last; // ends at the beginning
    std::vector<End>              open;
  };


  /** The farthest distance of a point on one of the paths to the nearest on the others. */
  double distance_of_paths(const std::vector<GrowingCracks::Path> &one,
                           const std::vector<GrowingCracks::Path> &other);
} // namespace PeriDeal
