// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/output/checkpoint_file.h>
#include <perideal/output/result_folder.h>

#include <functional>
#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * The checkpoints of a run: `checkpoints/N.h5` in its output directory, the newest with the
   * largest N.
   */
  class Checkpoints
  {
  public:
    /**
     * Removes what a run that was killed has left of one. The folder must outlive this object.
     *
     * @param n_kept so many of the newest are kept
     */
    Checkpoints(ResultFolder &folder, const unsigned int n_kept, const MPI_Comm communicator);

    /**
     * Write one; @p save hands the state to the archive. Returns why it could not be written, a
     * sentence; empty if it is whole and on the disk. Those before it stay until then. With the
     * first one the run has results: the folder is committed. Collective.
     */
    std::string write(const CheckpointHeader &header, const std::function<void(Archive &)> &save);

    /** The name of the last one written, relative to the directory; empty if there is none. */
    const std::string &last() const
    {
      return name_of_last;
    }

    /** The run is complete. Not collective. */
    void remove_all();

  private:
    std::vector<unsigned int> numbers() const; // of the run's own, sorted
    std::string               claim_next();

    ResultFolder      &folder;
    const unsigned int n_kept;
    const MPI_Comm     communicator;
    std::string        name_of_last, refusal; // why the last one could not be begun
  };


  /**
   * The newest checkpoint in an output directory that is whole.
   *
   * @param notes one for each newer one that is not, with its name
   *
   * Throws UserError if there is none. Collective.
   */
  std::string newest_checkpoint(const std::string        &directory,
                                const MPI_Comm            communicator,
                                std::vector<std::string> &notes);

  /** The checksum of a file as it is now; empty if it cannot be read. Collective. */
  std::string checksum_of_file(const std::string &file_name, const MPI_Comm communicator);

  /**
   * Throws a UserError that names the first entry that differs, with both values, and those that
   * may, or a file that has changed, unless a run can go on from the checkpoint of another.
   */
  void require_same_run(const CheckpointHeader &saved,
                        const CheckpointHeader &now,
                        const std::string      &name);
} // namespace PeriDeal
