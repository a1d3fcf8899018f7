// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/hdf5.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/full_matrix.h>

#include <perideal/output/field_writer.h>

#include <fstream>
#include <numeric>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  FieldWriter<dim>::FieldWriter(const DoFHandler<dim> &dofs,
                                const std::string     &directory,
                                const std::string     &series,
                                const Choice          &shows)
    : dofs(dofs)
    , directory(directory)
    , series(series)
    , shows(shows)
  {
    // The default compression takes ten times as long for files that are a tenth smaller.
    DataOutBase::VtkFlags flags;
    flags.compression_level = DataOutBase::VtkFlags::best_speed;
    this->set_flags(flags);
  }


  template <int dim>
  const std::vector<DataOutBase::Patch<dim, dim>> &FieldWriter<dim>::get_patches() const
  {
    return patches;
  }

  template <int dim>
  std::vector<std::string> FieldWriter<dim>::get_dataset_names() const
  {
    return names;
  }

  template <int dim>
  std::vector<std::tuple<unsigned int,
                         unsigned int,
                         std::string,
                         DataComponentInterpretation::DataComponentInterpretation>>
  FieldWriter<dim>::get_nonscalar_data_ranges() const
  {
    std::vector<std::tuple<unsigned int,
                           unsigned int,
                           std::string,
                           DataComponentInterpretation::DataComponentInterpretation>>
      ranges;
    for (const auto &[first, name] : vectors)
      ranges.emplace_back(first,
                          first + dim - 1,
                          name,
                          DataComponentInterpretation::component_is_part_of_vector);
    return ranges;
  }


  template <int dim>
  void FieldWriter<dim>::build_patches(const std::vector<OutputField> &fields)
  {
    names.clear();
    vectors.clear();
    for (const OutputField &field : fields)
      {
        if (field.components.size() > 1)
          vectors.emplace_back(static_cast<unsigned int>(names.size()), field.name);
        for (std::size_t c = 0; c < field.components.size(); ++c)
          names.push_back(
            field.components.size() > 1 ? field.name + "_" + std::string(1, "xyz"[c]) : field.name);
      }
    const bool                           at_vertices = dofs.get_fe().n_dofs_per_vertex() > 0;
    const unsigned int                   n_vertices  = GeometryInfo<dim>::vertices_per_cell;
    std::vector<types::global_dof_index> indices(dofs.get_fe().n_dofs_per_cell());
    // The ghosts of a model's own vectors need not be those of the mesh.
    IndexSet relevant;
    DoFTools::extract_locally_relevant_dofs(dofs, relevant);
    const auto partitioner =
      std::make_shared<const Utilities::MPI::Partitioner>(dofs.locally_owned_dofs(),
                                                          relevant,
                                                          dofs.get_communicator());
    std::vector<Vector> values;
    for (const OutputField &field : fields)
      for (const Vector &component : field.components)
        {
          values.emplace_back(partitioner);
          std::copy(component.begin(), component.end(), values.back().begin());
        }
    for (const Vector &value : values) // copies of vectors lose their ghosts, so only now
      value.update_ghost_values();
    patches.clear();
    patches.reserve(dofs.get_triangulation().n_active_cells());
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned() && (!shows || shows(cell->center())))
        {
          patches.emplace_back();
          auto &patch          = patches.back();
          patch.patch_index    = static_cast<unsigned int>(patches.size() - 1);
          patch.n_subdivisions = 1;
          patch.reference_cell = cell->reference_cell();
          patch.data.reinit(names.size(), n_vertices);
          for (unsigned int v = 0; v < n_vertices; ++v)
            patch.vertices[v] = cell->vertex(v);
          cell->get_dof_indices(indices);
          // In FE_Q the first dofs of a cell are those of its vertices.
          for (unsigned int row = 0; row < values.size(); ++row)
            for (unsigned int v = 0; v < n_vertices; ++v)
              patch.data(row, v) = values[row](indices[at_vertices ? v : 0]);
        }
  }


  template <int dim>
  void FieldWriter<dim>::write_vtu_series(const double time)
  {
    const MPI_Comm    communicator = dofs.get_communicator();
    const std::string record       = this->write_vtu_with_pvtu_record(directory + "/fields/",
                                                                series,
                                                                n_written,
                                                                communicator,
                                                                4,
                                                                1);
    vtu_records.emplace_back(time, "fields/" + record);
    if (Utilities::MPI::this_mpi_process(communicator) == 0)
      {
        std::ofstream pvd(directory + "/" + series + ".pvd");
        DataOutBase::write_pvd_record(pvd, vtu_records);
      }
  }


  template <int dim>
  void FieldWriter<dim>::write_1d_hdf5_file(const std::string &name) const
  {
    std::vector<double> own;
    for (const auto &patch : patches)
      for (unsigned int v = 0; v < 2; ++v)
        {
          own.push_back(patch.vertices[v][0]);
          for (unsigned int k = 0; k < names.size(); ++k)
            own.push_back(patch.data(k, v));
        }
    const auto parts = Utilities::MPI::gather(dofs.get_communicator(), own, 0);
    if (Utilities::MPI::this_mpi_process(dofs.get_communicator()) != 0)
      return;
    const std::size_t                width = 1 + names.size();
    std::vector<std::vector<double>> columns(width);
    for (const auto &part : parts)
      for (std::size_t k = 0; k < part.size(); ++k)
        columns[k % width].push_back(part[k]);
    HDF5::File        file(directory + "/" + name, HDF5::File::FileAccessMode::create);
    const std::size_t n     = columns[0].size();
    const auto        write = [&](const std::string &field, const std::vector<double> &values) {
      auto               data = file.create_dataset<double>(field, {n, 1});
      FullMatrix<double> matrix(n, 1);
      for (std::size_t i = 0; i < n; ++i)
        matrix(i, 0) = values[i];
      data.write(matrix);
    };
    write("nodes", columns[0]);
    for (std::size_t k = 0; k < names.size(); ++k)
      write(names[k], columns[k + 1]);
    auto                      cells = file.create_dataset<unsigned int>("cells", {n / 2, 2});
    std::vector<unsigned int> pairs(n);
    std::iota(pairs.begin(), pairs.end(), 0u);
    cells.write(pairs);
  }


  template <int dim>
  void FieldWriter<dim>::write_hdf5_file(const std::string &name, const double time)
  {
    if constexpr (dim == 1)
      {
        (void)time;
        write_1d_hdf5_file(name);
      }
    else
      {
        const MPI_Comm             communicator = dofs.get_communicator();
        DataOutBase::DataOutFilter filter(DataOutBase::DataOutFilterFlags(false, true));
        this->write_filtered_data(filter);
        this->write_hdf5_parallel(filter, directory + "/" + name, communicator);
        xdmf_entries.push_back(this->create_xdmf_entry(filter, name, time, communicator));
        this->write_xdmf_file(xdmf_entries, directory + "/" + series + ".xdmf", communicator);
      }
  }


  template <int dim>
  std::string FieldWriter<dim>::write(const std::vector<OutputField> &fields,
                                      const double                    time,
                                      const bool                      vtu,
                                      const bool                      hdf5)
  {
    if (!vtu && !hdf5)
      return {};
    build_patches(fields);
    if (vtu)
      write_vtu_series(time);
    std::string name;
    if (hdf5)
      {
        name = "fields/" + series + "_" + Utilities::int_to_string(n_written, 4) + ".h5";
        write_hdf5_file(name, time);
      }
    ++n_written;
    patches.clear();
    patches.shrink_to_fit();
    return name;
  }

  template class FieldWriter<1>;
  template class FieldWriter<2>;
  template class FieldWriter<3>;
} // namespace PeriDeal
