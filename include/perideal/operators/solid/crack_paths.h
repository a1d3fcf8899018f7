// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/point.h>
#include <deal.II/base/symmetric_tensor.h>

#include <perideal/base/archive.h>

#include <mpi.h>

#include <utility>
#include <vector>

namespace PeriDeal
{
  /**
   * Ways that slow cracks take from the ends of cracks of the scene, in two dimensions: each goes
   * on straight across the largest tension about its tip, a mean over all whole bonds within
   * reach(), and of the bonds near it those alone may break that cross it or what lies ahead. So
   * the stretch of a bond says when it breaks, and a direction that hardly knows of the lattice
   * says where a crack goes.
   *
   * The mean of the stress over a disc about the end of a crack with intensities K_I and K_II is
   * turned by 2 K_II/K_I where that is small, as the largest hoop stress is (Erdogan and Sih 1963);
   * means over about a horizon as a direction of growth: Wells and Sluys (2001).
   *
   * Ways are the same on all processes.
   */
  template <int dim>
  class CrackPaths
  {
  public:
    using Ends = std::pair<dealii::Point<dim>, dealii::Point<dim>>; // of a bond

    /** @param cracks two points each, as they are before anything breaks */
    CrackPaths(const std::vector<std::vector<dealii::Point<dim>>> &cracks, const double horizon);

    /** Bonds whose middle is so near to a tip are to be given to add(). */
    double reach() const;

    /** Where the tips look, of length one; in the order of the cracks, first ends first. */
    std::vector<dealii::Tensor<1, dim>> directions() const;

    /** Some tip within a distance. */
    bool any_tip_near(const dealii::Point<dim> &place, const double distance) const;

    /** Forget what add() was given. */
    void begin();

    /** @param moment force of a whole bond xi times its length, in any unit */
    void add(const dealii::Point<dim>     &middle,
             const dealii::Tensor<1, dim> &xi,
             const double                  moment);

    /** Let each tip look across the largest tension about it. Collective. */
    void turn(const MPI_Comm communicator);

    /** The bond crosses a way or what lies ahead of it, or is near none. */
    bool may_break(const Ends &ends) const;

    /** Ways go on to where the foremost of these bonds, which break now, crosses. Collective. */
    void advance(const std::vector<Ends> &breaking, const MPI_Comm communicator);

    /** Collective. */
    void exchange(Archive &archive);

    std::size_t memory_consumption() const;

  private:
    struct Way
    {
      std::vector<dealii::Point<dim>> points;    // the last one is the tip
      dealii::Tensor<1, dim>          direction; // ahead, of length one
      dealii::SymmetricTensor<2, dim> tension;   // sum about the tip, of this process
    };

    const double     horizon;
    std::vector<Way> ways;
  };
} // namespace PeriDeal
