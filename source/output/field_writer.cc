// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/exceptions.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>
#include <deal.II/dofs/dof_tools.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/process_end.h>
#include <perideal/output/field_writer.h>

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "exchange_of_first.h"
#include "gather_in_turn.h"
#include "hdf5_file.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    const std::string stem = "stress_"; // of the one tensor that models write


    /** What VTU files of ours call the tensor of the components `stress_xx`, ... */
    std::string name_of_tensor(const std::vector<std::string> &names)
    {
      return std::find(names.begin(), names.end(), stem + "xx") == names.end() ? "" : "stress";
    }


    /**
     * For each of the nine components of the tensor, row by row, the position of its field among
     * the names; -1 where there is none, which stands for 0.
     */
    std::vector<int> components_of_tensor(const std::vector<std::string> &names)
    {
      std::vector<int> places;
      for (unsigned int a = 0; a < 3; ++a)
        for (unsigned int b = 0; b < 3; ++b)
          {
            const std::string component = stem + "xyz"[std::min(a, b)] + "xyz"[std::max(a, b)];
            const auto        at        = std::find(names.begin(), names.end(), component);
            places.push_back(at == names.end() ? -1 : static_cast<int>(at - names.begin()));
          }
      return places;
    }


    /** A `DataArray` of a VTU file with nine numbers a point, compressed as deal.II's are. */
    std::string tensor_array(const std::string &name, const std::vector<float> &values)
    {
      // One block: number of blocks, size of a block, size of the last one, compressed size.
      const std::size_t size = values.size() * sizeof(float);
      AssertThrow(size < (std::size_t(1) << 32),
                  dealii::ExcMessage("a process has too many cells for a block of a VTU file"));
      uLongf                     compressed = compressBound(size);
      std::vector<unsigned char> data(compressed);
      const int                  status = compress2(data.data(),
                                   &compressed,
                                   reinterpret_cast<const Bytef *>(values.data()),
                                   size,
                                   Z_BEST_SPEED);
      AssertThrow(status == Z_OK, dealii::ExcMessage("zlib could not compress a field"));
      data.resize(compressed);
      const std::array<std::uint32_t, 4> head{{1u,
                                               static_cast<std::uint32_t>(size),
                                               static_cast<std::uint32_t>(size),
                                               static_cast<std::uint32_t>(compressed)}};
      std::vector<unsigned char>         head_bytes(sizeof head);
      std::memcpy(head_bytes.data(), head.data(), sizeof head);
      return "    <DataArray type=\"Float32\" Name=\"" + name +
             "\" NumberOfComponents=\"9\" format=\"binary\">\n" +
             dealii::Utilities::encode_base64(head_bytes) + dealii::Utilities::encode_base64(data) +
             "\n    </DataArray>\n";
    }


    /** The default compression takes ten times as long for files that are a tenth smaller. */
    DataOutBase::VtkFlags quick_flags()
    {
      DataOutBase::VtkFlags flags;
      flags.compression_level = decltype(flags.compression_level)::best_speed;
      return flags;
    }


    /** A file that is written under another name and gets its own when it is whole. On rank 0. */
    class UnfinishedFile
    {
    public:
      UnfinishedFile(ResultFolder &folder, const std::string &name)
        : folder(folder)
        , name(name)
        , path(folder.claim(name))
      {
        if (is_listed())
          set_unfinished_file(part());
      }

      /** Else nothing must be written. */
      bool is_listed() const
      {
        return !path.empty();
      }

      /** An exception has come between. */
      ~UnfinishedFile()
      {
        if (is_listed() && !finished)
          finish(-1);
      }

      std::string part() const
      {
        return path + ".part";
      }

      /** @param problem an error number, 0 if all was written, -1 if the system gave no reason */
      void finish(int problem)
      {
        finished = true;
        if (problem == 0 && std::rename(part().c_str(), path.c_str()) != 0)
          problem = errno;
        if (problem != 0)
          {
            folder.keep_failure(name, std::max(problem, 0));
            std::remove(part().c_str());
          }
        set_unfinished_file("");
      }

    private:
      ResultFolder     &folder;
      const std::string name, path;
      bool              finished = false;
    };
  } // namespace


  template <int dim>
  FieldWriter<dim>::FieldWriter(const DoFHandler<dim> &dofs,
                                ResultFolder          &folder,
                                const std::string     &series,
                                const Choice          &shows)
    : dofs(dofs)
    , folder(folder)
    , series(series)
    , shows(shows)
    , flags(quick_flags())
  {
    this->set_flags(flags);
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
    nodal.clear();
    for (const OutputField &field : fields)
      for (const Vector &component : field.components)
        {
          nodal.emplace_back(partitioner);
          std::copy(component.begin(), component.end(), nodal.back().begin());
        }
    for (const Vector &value : nodal) // copies of vectors lose their ghosts, so only now
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
          for (unsigned int row = 0; row < nodal.size(); ++row)
            for (unsigned int v = 0; v < n_vertices; ++v)
              patch.data(row, v) = nodal[row](indices[at_vertices ? v : 0]);
        }
  }


  template <int dim>
  std::string FieldWriter<dim>::tensor_text() const
  {
    const std::string name = name_of_tensor(names);
    if (name.empty() || patches.empty())
      return "";
    const std::vector<int> places = components_of_tensor(names);
    std::vector<float>     values;
    values.reserve(patches.size() * GeometryInfo<dim>::vertices_per_cell * places.size());
    for (const auto &patch : patches)
      for (unsigned int v = 0; v < GeometryInfo<dim>::vertices_per_cell; ++v)
        for (const int place : places)
          values.push_back(place < 0 ? 0.f : static_cast<float>(patch.data(place, v)));
    return tensor_array(name, values);
  }


  template <int dim>
  std::string FieldWriter<dim>::vtu_piece() const
  {
    std::ostringstream piece;
    if (patches.empty())
      return "";
    DataOutBase::write_vtu_main(patches, names, get_nonscalar_data_ranges(), flags, piece);
    std::string       text = piece.str();
    const std::size_t end  = text.rfind("</PointData>");
    return end == std::string::npos ? text : text.insert(end, tensor_text());
  }


  template <int dim>
  void FieldWriter<dim>::write_vtu_file(const std::string &name) const
  {
    std::ostringstream head, foot; // deal.II throws where a file cannot be written to
    const std::string  piece = vtu_piece();
    DataOutBase::write_vtu_header(head, flags);
    DataOutBase::write_vtu_footer(foot);
    std::unique_ptr<UnfinishedFile> target;
    std::ofstream                   out;
    int                             problem = 0;
    const auto                      add     = [&](const std::string &text) {
      errno = 0;
      if (problem == 0 && !(out << text << std::flush))
        problem = errno != 0 ? errno : -1;
    };
    if (folder.writes())
      {
        target = std::make_unique<UnfinishedFile>(folder, name);
        errno  = 0;
        if (target->is_listed())
          out.open(target->part(), std::ios::binary);
        problem = out.is_open() ? 0 : errno != 0 ? errno : -1;
        add(head.str());
      }
    gather_in_turn(piece, dofs.get_communicator(), add);
    if (!target || !target->is_listed())
      return;
    add(foot.str());
    errno = 0;
    out.close();
    if (!out && problem == 0)
      problem = errno != 0 ? errno : -1;
    target->finish(problem);
  }


  template <int dim>
  void FieldWriter<dim>::write_vtu_series(const double time)
  {
    const std::string name  = series + "_" + Utilities::int_to_string(n_written, 4);
    const std::string piece = name + ".0.vtu", record = "fields/" + name + ".pvtu";
    write_vtu_file("fields/" + piece);
    if (!folder.writes() || folder.failed())
      return;
    std::ostringstream pvtu, pvd;
    this->write_pvtu_record(pvtu, {piece});
    std::string text = pvtu.str();
    if (const std::size_t end = text.rfind("</PPointData>");
        end != std::string::npos && !name_of_tensor(names).empty())
      text.insert(end,
                  "    <PDataArray type=\"Float32\" Name=\"" + name_of_tensor(names) +
                    "\" NumberOfComponents=\"9\" format=\"ascii\"/>\n");
    folder.write(record, text);
    vtu_records.emplace_back(time, record);
    DataOutBase::write_pvd_record(pvd, vtu_records);
    if (!folder.failed())
      folder.write(series + ".pvd", pvd.str());
  }


  template <int dim>
  std::vector<std::tuple<std::string, unsigned int, unsigned int>> FieldWriter<dim>::tables() const
  {
    std::vector<std::tuple<std::string, unsigned int, unsigned int>> list;
    for (unsigned int row = 0, next = 0; row < names.size(); ++row)
      if (next < vectors.size() && vectors[next].first == row)
        {
          list.emplace_back(vectors[next++].second, row, dim);
          row += dim - 1;
        }
      else
        list.emplace_back(names[row], row, 1);
    return list;
  }


  template <int dim>
  std::vector<double> FieldWriter<dim>::corner_values(const unsigned int first,
                                                      const unsigned int n_components) const
  {
    constexpr unsigned int               n_corners   = GeometryInfo<dim>::vertices_per_cell;
    const unsigned int                   width       = n_components == 1 ? 1 : 3;
    const bool                           at_vertices = dofs.get_fe().n_dofs_per_vertex() > 0;
    std::vector<types::global_dof_index> indices(dofs.get_fe().n_dofs_per_cell());
    std::vector<double>                  values(patches.size() * n_corners * width, 0.);
    auto                                 next = values.begin();
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned() && (!shows || shows(cell->center())))
        {
          cell->get_dof_indices(indices);
          for (unsigned int v = 0; v < n_corners; ++v, next += width)
            for (unsigned int d = 0; d < n_components; ++d)
              next[d] = nodal[first + d](indices[at_vertices ? v : 0]);
        }
    return values;
  }


  template <int dim>
  void FieldWriter<dim>::write_hdf5_file(const std::string &name) const
  {
    constexpr unsigned int                n_corners = GeometryInfo<dim>::vertices_per_cell;
    constexpr std::array<unsigned int, 8> order{{0, 1, 3, 2, 4, 5, 7, 6}}; // around a face
    const MPI_Comm                        communicator = dofs.get_communicator();
    const std::uint64_t                   n_own        = patches.size();
    const std::uint64_t                   n_cells      = Utilities::MPI::sum(n_own, communicator);
    std::uint64_t                         first        = 0;
    MPI_Exscan(&n_own, &first, 1, MPI_UINT64_T, MPI_SUM, communicator);
    std::unique_ptr<UnfinishedFile> target;
    std::unique_ptr<Hdf5File>       file;
    if (folder.writes())
      {
        target = std::make_unique<UnfinishedFile>(folder, name);
        if (target->is_listed())
          file = std::make_unique<Hdf5File>(target->part());
      }
    const auto add = [&](const std::string &table, const auto &own, const unsigned int n_columns) {
      using number        = typename std::decay_t<decltype(own)>::value_type;
      const bool of_cells = std::is_same<number, std::uint32_t>::value;
      if (file)
        file->begin_table<number>(table, of_cells ? n_cells : n_cells * n_corners, n_columns);
      gather_in_turn(own, communicator, [&](const std::vector<number> &rows) {
        if (file)
          file->append(rows.data(), rows.size() / n_columns);
      });
    };
    std::vector<double>        nodes;
    std::vector<std::uint32_t> cells;
    for (const auto &patch : patches)
      for (unsigned int v = 0; v < n_corners; ++v)
        {
          for (unsigned int d = 0; d < dim; ++d)
            nodes.push_back(patch.vertices[v][d]);
          cells.push_back((first + patch.patch_index) * n_corners + (dim == 1 ? v : order[v]));
        }
    add("nodes", nodes, dim);
    add("cells", cells, n_corners);
    for (const auto &[name_of_table, first_component, n_components] : tables())
      add(name_of_table, corner_values(first_component, n_components), n_components == 1 ? 1 : 3);
    if (file)
      target->finish(file->close());
  }


  template <int dim>
  void FieldWriter<dim>::write_xdmf_file(const std::string &hdf5_name, const double time)
  {
    const std::uint64_t n_cells =
      Utilities::MPI::sum(static_cast<std::uint64_t>(patches.size()), dofs.get_communicator());
    const std::uint64_t n_points = n_cells * GeometryInfo<dim>::vertices_per_cell;
    if (!folder.writes() || folder.failed())
      return;
    const auto item = [&](const std::string  &table,
                          const std::uint64_t n_rows,
                          const unsigned int  n_columns,
                          const std::string  &type) {
      return "          <DataItem Dimensions=\"" + std::to_string(n_rows) + " " +
             std::to_string(n_columns) + "\" NumberType=\"" + type + "\" Precision=\"" +
             (type == "Float" ? "8" : "4") + "\" Format=\"HDF\">" + hdf5_name + ":/" + table +
             "</DataItem>\n";
    };
    std::ostringstream grid;
    grid.precision(17);
    grid << "      <Grid Name=\"mesh\" GridType=\"Uniform\">\n        <Time Value=\"" << time
         << "\"/>\n        <Geometry GeometryType=\"" << (dim == 2 ? "XY" : "XYZ") << "\">\n"
         << item("nodes", n_points, dim, "Float")
         << "        </Geometry>\n        <Topology TopologyType=\""
         << (dim == 2 ? "Quadrilateral" : "Hexahedron") << "\" NumberOfElements=\"" << n_cells
         << "\">\n"
         << item("cells", n_cells, GeometryInfo<dim>::vertices_per_cell, "UInt")
         << "        </Topology>\n";
    for (const auto &[table, first_component, n_components] : tables())
      grid << "        <Attribute Name=\"" << table << "\" AttributeType=\""
           << (n_components == 1 ? "Scalar" : "Vector") << "\" Center=\"Node\">\n"
           << item(table, n_points, n_components == 1 ? 1 : 3, "Float") << "        </Attribute>\n";
    grid << "      </Grid>\n";
    xdmf_entries += grid.str();
    folder.write(series + ".xdmf",
                 "<?xml version=\"1.0\"?>\n"
                 "<Xdmf Version=\"3.0\">\n"
                 "  <Domain>\n"
                 "    <Grid Name=\"times\" GridType=\"Collection\" CollectionType=\"Temporal\">\n" +
                   xdmf_entries +
                   "    </Grid>\n"
                   "  </Domain>\n"
                   "</Xdmf>\n");
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
        write_hdf5_file(name);
        if (dim > 1) // XDMF knows no lines of its own
          write_xdmf_file(name, time);
      }
    ++n_written;
    patches.clear();
    patches.shrink_to_fit();
    nodal.clear();
    return name;
  }


  template <int dim>
  void FieldWriter<dim>::exchange(Archive &archive)
  {
    auto state = nlohmann::ordered_json::array({n_written, vtu_records, xdmf_entries});
    exchange_of_first(archive, series, state, folder.processes());
    state[0].get_to(n_written);
    state[1].get_to(vtu_records);
    state[2].get_to(xdmf_entries);
  }


  PERIDEAL_INSTANTIATE_CLASS(class FieldWriter);
} // namespace PeriDeal
