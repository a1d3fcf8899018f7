// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/archive.h>
#include <perideal/bonds/bond_state.h>
#include <perideal/laws/bond_law.h>
#include <perideal/scene/material.h>

#include <mpi.h>

#include <memory>
#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * The law of bonds in the scene (`Law` in section `Material`), or none where it is that of the
   * linear solid, and the step in which it is asked: from the last state that was accepted, whose
   * histories rows of bonds have, to the time of the state that is looked at. Not collective unless
   * stated.
   */
  class LawSteps
  {
  public:
    /** Where the file of a law of the user is. */
    struct Files
    {
      std::string folder;
      MPI_Comm    communicator;
    };

    /** Collective. Throws UserError. */
    LawSteps(const Material::Law &law, const Files &files);

    /** Else bonds are those of the linear solid. */
    bool any() const
    {
      return law != nullptr;
    }

    const BondLaw *operator->() const
    {
      return law.get();
    }

    unsigned int n_history() const
    {
      return any() ? law->n_history() : 0;
    }

    /** States that follow are those at t; there is no step before the first one is accepted. */
    void set_time(const double t) const;

    /** The state at t is accepted. */
    void accept(const double t);

    /** The time of the last accepted state; 0: none. */
    double last() const
    {
      return accepted;
    }

    /** Throws UserError if a law of the user has had a fault on any process. Collective. */
    void throw_faults(const MPI_Comm communicator) const;

    /** Collective. */
    void exchange(Archive &archive);

  private:
    std::unique_ptr<BondLaw> law;
    std::string              file; // of a law of the user
    bool                     begun    = false;
    double                   accepted = 0.;
  };


  /**
   * Exchange n numbers of each bond, row by row of owned nodes, so that any number of processes can
   * take them up. Collective.
   */
  void exchange_history(Archive                    &archive,
                        const BondState::Numbering &numbering,
                        const NodeKeys             &keys,
                        const unsigned int          n,
                        std::vector<double>        &history);
} // namespace PeriDeal
