// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/data_out_base.h>
#include <deal.II/dofs/dof_handler.h>

#include <perideal/base/archive.h>
#include <perideal/output/result_folder.h>

#include <functional>
#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * A named field for output: one component, or one per coordinate direction. Vectors need
   * up-to-date ghosts.
   */
  struct OutputField
  {
    std::string         name;
    std::vector<Vector> components;
  };


  /**
   * Writes fields of one model at one time: VTU with a PVTU record (single precision; the stress as
   * a tensor, too), and HDF5 (`/nodes`, `/cells`, one table per field, double precision) with, but
   * for 1D, an XDMF description (version 3). Cells are written straight from the dofs (vertex dofs,
   * or cell centres as constants per cell), so that vertices doubled by a crack stay apart and
   * vectors need no finite element system.
   *
   * Rank 0 writes, with what it gets from one process after the other, each file under another name
   * until it is whole. (Open MPI 4 writes in parallel under the protection of a semaphore that is
   * named after the file alone: a stale one, or a second run on the machine, stops it for ever.)
   */
  template <int dim>
  class FieldWriter : public dealii::DataOutInterface<dim>
  {
  public:
    using Choice = std::function<bool(const dealii::Point<dim> &)>;

    /**
     * @param folder where the series goes; @param series its name, for example `finite_elements`
     * @param shows  whether the cell with this centre is written; empty: all are
     */
    FieldWriter(const dealii::DoFHandler<dim> &dofs,
                ResultFolder                  &folder,
                const std::string             &series,
                const Choice                  &shows = {});

    /**
     * Returns the name of the HDF5 file relative to the directory (empty if not asked for). What
     * cannot be written is kept in the folder. Collective.
     */
    std::string write(const std::vector<OutputField> &fields,
                      const double                    time,
                      const bool                      vtu,
                      const bool                      hdf5);

    /** What has been written, so that the series goes on. Collective. */
    void exchange(Archive &archive);

  private:
    const std::vector<dealii::DataOutBase::Patch<dim, dim>> &get_patches() const override
    {
      return patches;
    }
    std::vector<std::string> get_dataset_names() const override
    {
      return names;
    }
    std::vector<std::tuple<unsigned int,
                           unsigned int,
                           std::string,
                           dealii::DataComponentInterpretation::DataComponentInterpretation>>
    get_nonscalar_data_ranges() const override;

    /** Name, first component and number of components of each table. */
    std::vector<std::tuple<std::string, unsigned int, unsigned int>> tables() const;

    /** Of a table at the patches' corners; vectors have three components in files. */
    std::vector<double> corner_values(const unsigned int first,
                                      const unsigned int n_components) const;

    void build_patches(const std::vector<OutputField> &fields);
    void write_vtu_series(const double time);

    /**
     * The cells of this process as part of a VTU file, and what deal.II cannot write there: a
     * tensor of nine components in 2D.
     */
    std::string vtu_piece() const;
    std::string tensor_text() const;

    void write_vtu_file(const std::string &name) const;
    void write_hdf5_file(const std::string &name) const;
    void write_xdmf_file(const std::string &hdf5_name, const double time);

    const dealii::DoFHandler<dim>                    &dofs;
    ResultFolder                                     &folder;
    const std::string                                 series;
    const Choice                                      shows;
    const dealii::DataOutBase::VtkFlags               flags;
    unsigned int                                      n_written = 0;
    std::vector<dealii::DataOutBase::Patch<dim, dim>> patches;
    std::vector<std::string>                          names; // of the components
    std::vector<Vector>                               nodal; // of the components
    std::vector<std::pair<unsigned int, std::string>>
      vectors; // first component and name of each vector field
    std::vector<std::pair<double, std::string>> vtu_records;
    std::string                                 xdmf_entries;
  };


  /**
   * To be called by a program before MPI_Init: else HDF5 ends with MPI, tries again then to close
   * files that could not be closed since the disk is full, and fails over them.
   */
  void start_hdf5();
} // namespace PeriDeal
