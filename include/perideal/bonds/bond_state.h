// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/archive.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /** What a bond that softens has been through and bears, of both of its ends alike. */
  struct BondSoftness
  {
    static constexpr unsigned int n = 2; // numbers, the history of a bond

    double reached = 0.; // largest measure over limit, or less than 1
    double lost    = 0.; // of what it bore without damage: 1 - DamageCriterion::integrity()
  };


  /**
   * Which of a list of bonds are whole, and why and since when others are not: their one owner. Two
   * bits a bond, by its number in the list; both ends of a bond have numbers of their own and are
   * marked together. What a bond bears is set to nothing where it is stored, so that sums need not
   * ask; nobody else concludes from a zero that a bond is gone.
   */
  class BondState
  {
  public:
    enum Mark : std::uint8_t
    {
      whole,
      parted,   // by a crack of the scene, from the start or as it grew
      broken,   // stretched too far
      dependent // of a fictitious node: what it follows from is gone
    };

    /**
     * A list of so many bonds, not fewer than before; those that come to it are whole. Bonds beyond
     * its end are whole, and none of them is marked.
     */
    void resize(const std::size_t n);

    std::size_t size() const
    {
      return n_bonds;
    }

    bool is_whole(const std::size_t number) const
    {
      return (*this)[number] == whole;
    }

    bool is_parted(const std::size_t number) const
    {
      return (*this)[number] == parted;
    }

    bool is_broken(const std::size_t number) const
    {
      return (*this)[number] == broken;
    }

    Mark operator[](const std::size_t number) const
    {
      return number < n_bonds ? static_cast<Mark>((marks[number / 4] >> shift(number)) & 3) : whole;
    }

    /** Of a whole bond; it stays so. @param time since when, that of the run */
    void mark(const std::size_t number, const Mark mark, const double time);

    /** Since when a bond is not whole; infinity while it is, 0 if it is parted from the start. */
    double since(const std::size_t number) const;

    /** A mark from an archive, to be set by who knows what follows from it. */
    struct Kept
    {
      std::size_t number;
      Mark        mark;
      double      time;
      bool        is_first; // it is among the marks that were told to be
    };

    /** Where the bonds of a list belong. */
    struct Numbering
    {
      std::function<std::size_t(std::size_t)> node_of;  // by the number of a bond
      std::function<std::size_t(std::size_t)> first_of; // number of a node's first bond
      std::function<std::size_t()>            n_bonds;  // asked for after first_of
    };

    /**
     * Archive the marks of bonds that have been whole at first, and since when, or return those of
     * the archive, in ascending order of numbers. The list has its size then; marks are not set.
     * Collective.
     *
     * @param numbering of the bonds; nodes that are asked for have got a mark
     * @param n_first so many marks were set at first, n_marks() of an earlier time
     */
    std::vector<Kept> exchange(Archive          &archive,
                               const Numbering  &numbering,
                               const NodeKeys   &keys,
                               const std::size_t n_first);

    /** Those at the start apart. */
    std::size_t n_marks() const
    {
      return marked.size();
    }

    /**
     * Numbers and times of what has been marked since there were @p n_known such marks, which
     * becomes what there are now; those at the start apart.
     */
    std::vector<std::pair<std::size_t, double>> marked_since(std::size_t &n_known) const;

    /** Of those marks. */
    std::size_t count(const Mark mark) const;

    std::size_t memory_consumption() const;

  private:
    static unsigned int shift(const std::size_t number)
    {
      return 2 * (number % 4);
    }

    double time_of(const std::size_t k) const; // by the place in the list of those marked

    std::size_t                                 n_bonds = 0;
    std::vector<std::uint8_t>                   marks;  // four to a byte
    std::vector<std::size_t>                    marked; // in the order of marking
    std::vector<std::pair<std::size_t, double>> times;  // from which place in these on
  };
} // namespace PeriDeal
