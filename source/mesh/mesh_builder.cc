// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/distributed/shared_tria.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/grid/grid_in.h>
#include <deal.II/grid/grid_tools.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/text_file.h>
#include <perideal/base/user_error.h>
#include <perideal/mesh/crack_faces.h>
#include <perideal/mesh/grading.h>
#include <perideal/mesh/mesh_builder.h>
#include <perideal/scene/boundary_conditions.h>
#include <perideal/scene/msh_file.h>

#include <cmath>
#include <map>
#include <sstream>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /**
     * The lattice of a box, with the cells for which keep(centre) is true. Vertices without cells
     * are left out.
     */
    template <int dim, typename Keep>
    CoarseMesh<dim> lattice_mesh(const Domain<dim>                   &domain,
                                 const std::array<unsigned int, dim> &n,
                                 const Keep                          &keep)
    {
      CoarseMesh<dim>                     mesh;
      std::map<std::size_t, unsigned int> vertex_of_lattice;
      std::size_t                         n_cells = 1;
      for (const unsigned int k : n)
        n_cells *= k;
      const auto lattice_point = [&](const std::array<double, dim> &index) {
        Point<dim> p;
        for (unsigned int d = 0; d < dim; ++d)
          p[d] = domain.lower[d] + (domain.upper[d] - domain.lower[d]) * index[d] / n[d];
        return p;
      };
      for (std::size_t c = 0; c < n_cells; ++c)
        {
          std::array<std::size_t, dim> cell;
          std::array<double, dim>      middle;
          std::size_t                  rest = c;
          for (unsigned int d = 0; d < dim; ++d)
            {
              cell[d]   = rest % n[d];
              middle[d] = cell[d] + 0.5;
              rest /= n[d];
            }
          if (!keep(lattice_point(middle)))
            continue;
          CellData<dim> data;
          for (unsigned int v = 0; v < GeometryInfo<dim>::vertices_per_cell; ++v)
            {
              std::size_t             key = 0;
              std::array<double, dim> corner;
              for (unsigned int d = dim; d-- > 0;)
                {
                  const std::size_t i = cell[d] + ((v >> d) & 1);
                  corner[d]           = static_cast<double>(i);
                  key                 = key * (n[d] + 1) + i;
                }
              const auto [entry, is_new] =
                vertex_of_lattice.try_emplace(key, static_cast<unsigned int>(mesh.vertices.size()));
              if (is_new)
                mesh.vertices.push_back(lattice_point(corner));
              data.vertices[v] = entry->second;
            }
          mesh.cells.push_back(data);
        }
      return mesh;
    }


    /** Halvings that all cell counts allow, at most those that leave at least one coarse cell. */
    template <int dim>
    unsigned int common_halvings(const std::array<unsigned int, dim> &cells)
    {
      unsigned int levels = 0;
      while (std::all_of(cells.begin(), cells.end(), [&](const unsigned int n) {
        return n % (2u << levels) == 0;
      }))
        ++levels;
      return levels;
    }


    /** Does every crack lie on faces of this mesh? If not, the first one that does not. */
    template <int dim>
    const CrackGeometry<dim> *unresolved(const CoarseMesh<dim>                 &mesh,
                                         const std::vector<CrackGeometry<dim>> &cracks)
    {
      for (const CrackGeometry<dim> &crack : cracks)
        if (!lies_on_faces(mesh, crack))
          return &crack;
      return nullptr;
    }


    template <int dim>
    void require_resolved(const CoarseMesh<dim>                 &mesh,
                          const std::vector<CrackGeometry<dim>> &cracks)
    {
      const CrackGeometry<dim> *crack = unresolved(mesh, cracks);
      if (crack == nullptr)
        return;
      std::ostringstream where;
      where << crack->corners().front() << " to " << crack->corners().back();
      AssertThrow(
        false,
        UserError(
          "'Mesh = faces' in section 'Cracks' needs cracks that lie on cell faces all along, but the crack from " +
          where.str() + " does not. Choose cells so that it does, or use 'Mesh = pairs'."));
    }


    /** Coarse mesh of a box on which cracks to be cut lie on faces, and how often to refine it. */
    template <int dim>
    std::pair<CoarseMesh<dim>, unsigned int> box_mesh(const Domain<dim>                     &domain,
                                                      const std::vector<CrackGeometry<dim>> &cut)
    {
      const auto everywhere = [](const Point<dim> &) { return true; };
      for (unsigned int levels = common_halvings<dim>(domain.cells);; --levels)
        {
          std::array<unsigned int, dim> coarse = domain.cells;
          for (unsigned int &n : coarse)
            n >>= levels;
          CoarseMesh<dim> mesh = lattice_mesh<dim>(domain, coarse, everywhere);
          if (levels == 0)
            require_resolved(mesh, cut);
          if (levels == 0 || unresolved(mesh, cut) == nullptr)
            return {std::move(mesh), levels};
        }
    }


    /**
     * Of the boundary faces of a file, by the number of the cell and of its face; cutting along
     * cracks leaves both as they are.
     */
    using BoundaryIds = std::map<std::pair<unsigned int, unsigned int>, types::boundary_id>;


    /** The text of a mesh file, once it is known that deal.II can read it. Collective. */
    template <int dim>
    std::string checked_mesh_file(const std::string &file_name,
                                  const std::string &scene_folder,
                                  const MPI_Comm     communicator)
    {
      std::string text, message;
      if (Utilities::MPI::this_mpi_process(communicator) == 0)
        try
          {
            text = text_of_msh(read_msh(file_name, scene_folder, dim), dim);
          }
        catch (const UserError &error)
          {
            message = error.message();
          }
      throw_on_all_if_any(communicator, message);
      share_text(text, communicator);
      return text;
    }


    template <int dim>
    CoarseMesh<dim> read_mesh_file(const std::string &file_name,
                                   const std::string &scene_folder,
                                   const MPI_Comm     communicator,
                                   BoundaryIds       &ids)
    {
      std::istringstream file(checked_mesh_file<dim>(file_name, scene_folder, communicator));
      Triangulation<dim> mesh;
      try
        {
          GridIn<dim> reader(mesh);
          reader.read_msh(file);
        }
      catch (const std::exception &)
        {
          AssertThrow(false,
                      UserError("'Mesh file' in section 'Domain': '" + file_name +
                                "' is not a mesh of dimension " + std::to_string(dim) +
                                " that deal.II can use, or it is broken."));
        }
      AssertThrow(mesh.n_active_cells() > 0 && mesh.all_reference_cells_are_hyper_cube(),
                  ExcInternalError());
      CoarseMesh<dim> coarse;
      SubCellData     faces;
      std::tie(coarse.vertices, coarse.cells, faces) = GridTools::get_coarse_mesh_description(mesh);
      for (const auto &cell : mesh.active_cell_iterators())
        for (const unsigned int f : cell->face_indices())
          if (cell->face(f)->at_boundary())
            ids[{cell->active_cell_index(), f}] = cell->face(f)->boundary_id();
      return coarse;
    }


    /** Side of a box on which a boundary face lies, or the hole. */
    template <int dim>
    types::boundary_id box_side(const Domain<dim>                     &domain,
                                const std::vector<CrackGeometry<dim>> &cut,
                                const Point<dim>                      &center)
    {
      for (unsigned int d = 0; d < dim; ++d)
        {
          const double tolerance = 1e-8 * domain.spacing()[d];
          if (std::abs(center[d] - domain.lower[d]) < tolerance)
            return 2 * d;
          if (std::abs(center[d] - domain.upper[d]) < tolerance)
            return 2 * d + 1;
        }
      for (const CrackGeometry<dim> &crack : cut)
        if (crack.contains(center))
          return crack_boundary_id;
      return hole_boundary_id;
    }


    /** The most coarse cells that a mesh distributed by p4est may have. */
    constexpr std::size_t most_coarse_cells = 100000;

    /** Says where a crack runs along nodes of a mesh file that it could part. */
    template <int dim>
    void note_cracks_on_faces(const CoarseMesh<dim>    &coarse,
                              const Cracks<dim>        &cracks,
                              std::vector<std::string> &notes)
    {
      if (cracks.on_faces() || cracks.change() ||
          (cracks.conduct() && cracks.contact_conductance < 0.))
        return;
      for (const CrackGeometry<dim> &crack : make_crack_geometries(cracks.pieces(0.)))
        if (measure_on_faces(coarse, crack) > 0. && lies_on_faces(coarse, crack))
          {
            notes.push_back(
              "Crack " + std::to_string(crack.crack + 1) +
              " (section 'Cracks') lies on faces of the mesh's cells, and the nodes there belong to its left side. "
              "'Mesh = faces' cuts the mesh there, which is more accurate.");
            return;
          }
    }


    /** An empty triangulation, distributed by p4est or with all cells on every process. */
    template <int dim>
    std::unique_ptr<Triangulation<dim>> empty_triangulation(const bool           every_cell,
                                                            const CellWork<dim> &work,
                                                            const MPI_Comm       communicator)
    {
      if constexpr (dim > 1)
        if (!every_cell)
          {
            auto mesh = std::make_unique<parallel::distributed::Triangulation<dim>>(communicator);
            if (work)
              mesh->signals.weight.connect(
                [work](const auto &cell, const auto) { return work(cell); });
            return mesh;
          }
      using Shared            = parallel::shared::Triangulation<dim>;
      auto          mesh      = std::make_unique<Shared>(communicator,
                                           Triangulation<dim>::none,
                                           dim > 1,
                                           Shared::partition_custom_signal);
      Shared *const pointer   = mesh.get();
      const auto    partition = [pointer, work, communicator]() {
        const std::size_t n_proc = Utilities::MPI::n_mpi_processes(communicator);
        const auto  of  = [&](const auto &cell) -> std::size_t { return work ? work(cell) : 1; };
        std::size_t all = 0, before = 0;
        for (const auto &cell : pointer->active_cell_iterators())
          all += of(cell);
        for (const auto &cell : pointer->active_cell_iterators())
          {
            cell->set_subdomain_id(before * n_proc / all);
            before += of(cell);
          }
      };
      mesh->signals.create.connect(partition);
      mesh->signals.post_refinement.connect(partition);
      return mesh;
    }
  } // namespace


  template <int dim>
  std::unique_ptr<Triangulation<dim>> build_mesh(const Scene<dim>         &scene,
                                                 const MPI_Comm            communicator,
                                                 std::vector<std::string> &notes)
  {
    const Domain<dim>              &domain = scene.domain;
    const Cracks<dim>              &cracks = scene.cracks;
    std::vector<CrackGeometry<dim>> cut;
    if (cracks.on_faces())
      cut = make_crack_geometries(cracks.pieces(0.));

    CoarseMesh<dim> coarse;
    BoundaryIds     ids;
    unsigned int    n_refinements = 0;
    if (!domain.has_lattice())
      {
        coarse = read_mesh_file<dim>(domain.mesh_file, domain.files.folder, communicator, ids);
        note_cracks_on_faces(coarse, cracks, notes);
      }
    else if (domain.shape == Shape::plate_with_hole)
      {
        coarse = lattice_mesh<dim>(domain, domain.cells, [&](const Point<dim> &p) {
          return !domain.holes.contains(p);
        });
        AssertThrow(
          !coarse.cells.empty(),
          UserError("'Hole radius' in section 'Domain': the hole leaves no cell of the plate."));
      }
    else if (domain.has_voids()) // of an image
      coarse = lattice_mesh<dim>(domain, domain.cells, [&](const Point<dim> &p) {
        return domain.has_cell_at(p);
      });
    else
      std::tie(coarse, n_refinements) = box_mesh(domain, cut);
    notes.insert(notes.end(), domain.notes.begin(), domain.notes.end());
    if (domain.shape != Shape::box && n_refinements == 0)
      require_resolved(coarse, cut);
    AssertThrow(n_refinements >= domain.coarsening.times,
                UserError("'Coarsening' in section 'Domain' is " +
                          std::to_string(domain.coarsening.times) +
                          ", but with 'Mesh = faces' (section 'Cracks') cells can be merged " +
                          std::to_string(n_refinements) +
                          " times only, since the crack has to lie on faces of the largest ones."));
    // p4est sorts its coarse cells in a time that grows with the square of their number.
    const bool every_cell = dim == 1 || coarse.cells.size() > most_coarse_cells;
    AssertThrow(
      !every_cell || !scene.coupling.is_adaptive() || domain.coarsening.times == 0,
      UserError(
        "'Zone = adaptive' in section 'Coupling' needs a mesh that p4est distributes, of at most " +
        std::to_string(most_coarse_cells) + " coarse cells; this one has " +
        std::to_string(coarse.cells.size()) +
        ". Choose 'Cells' (section 'Domain') divisible by a higher power of two."));
    if (dim > 1 && every_cell && Utilities::MPI::n_mpi_processes(communicator) > 1)
      notes.push_back("Every process keeps all cells of the mesh, since it has " +
                      std::to_string(coarse.cells.size()) +
                      " coarse ones. 'Cells' (section 'Domain') divisible by a higher power of two "
                      "need less memory.");
    cut_along_faces(coarse, cut);

    const CellWork<dim>                 work = work_of_cells(scene);
    std::unique_ptr<Triangulation<dim>> mesh =
      empty_triangulation<dim>(every_cell, work, communicator);
    mesh->create_triangulation(coarse.vertices, coarse.cells, SubCellData());
    for (const auto &cell : mesh->cell_iterators_on_level(0))
      for (const unsigned int f : cell->face_indices())
        if (cell->face(f)->at_boundary())
          {
            const Point<dim> center = cell->face(f)->center();
            const auto       found  = ids.find({static_cast<unsigned int>(cell->index()), f});
            cell->face(f)->set_boundary_id(domain.has_lattice() ? box_side(domain, cut, center) :
                                           found != ids.end()   ? found->second :
                                                                  crack_boundary_id);
          }
    if (n_refinements > domain.coarsening.times)
      mesh->refine_global(n_refinements - domain.coarsening.times);
    if (domain.coarsening.times > 0)
      Grading<dim>(scene, *mesh).refine(*mesh);
    if constexpr (dim > 1)
      if (auto *distributed = dynamic_cast<parallel::distributed::Triangulation<dim> *>(mesh.get());
          distributed != nullptr && work)
        distributed->repartition();
    return mesh;
  }


  template <int dim>
  void require_cells_everywhere(const Triangulation<dim> &mesh)
  {
    const MPI_Comm communicator = mesh.get_communicator();
    unsigned int   n_own_cells  = 0;
    for (const auto &cell : mesh.active_cell_iterators())
      n_own_cells += cell->is_locally_owned() ? 1 : 0;
    AssertThrow(Utilities::MPI::min(n_own_cells, communicator) > 0,
                UserError("A mesh of " + std::to_string(mesh.n_global_active_cells()) +
                          " cells leaves some of the " +
                          std::to_string(Utilities::MPI::n_mpi_processes(communicator)) +
                          " processes without any. Use fewer processes or more 'Cells' (section "
                          "'Domain')."));
  }


  PERIDEAL_INSTANTIATE_FUNCTION(build_mesh);
  PERIDEAL_INSTANTIATE_FUNCTION(require_cells_everywhere);
} // namespace PeriDeal
