// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/geometry_info.h>
#include <deal.II/distributed/shared_tria.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/numerics/rtree.h>

#include <perideal/base/clipped.h>
#include <perideal/base/instantiate.h>
#include <perideal/base/memory.h>
#include <perideal/base/user_error.h>
#include <perideal/mesh/given_mesh.h>
#include <perideal/mesh/grading.h>
#include <perideal/mesh/mesh_builder.h>
#include <perideal/scene/boundary_conditions.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
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


    /** That of a lattice, or a crack that is cut into it. */
    template <int dim>
    types::boundary_id side_of_lattice(const Domain<dim>                     &domain,
                                       const std::vector<CrackGeometry<dim>> &cut,
                                       const Point<dim>                      &center)
    {
      const types::boundary_id side   = side_of_box(domain, center);
      const auto               has_it = [&](const auto &crack) { return crack.contains(center); };
      return side == hole_boundary_id && std::any_of(cut.begin(), cut.end(), has_it) ?
               crack_boundary_id :
               side;
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

    /** Coarse cells of a lattice, and how often they are to be refined. */
    template <int dim>
    std::pair<CoarseMesh<dim>, unsigned int> coarse_lattice(
      const Scene<dim>                      &scene,
      const std::vector<CrackGeometry<dim>> &cut)
    {
      const Domain<dim> &domain = scene.domain;
      CoarseMesh<dim>    coarse;
      unsigned int       n_refinements = 0;
      if (domain.shape == Shape::plate_with_hole)
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
      return {std::move(coarse), n_refinements};
    }


    /** Throws UserError where so many halvings would take more memory than there is. Collective. */
    template <int dim>
    void require_memory_for(const Domain<dim> &domain,
                            const std::size_t  n_coarse,
                            const MPI_Comm     communicator)
    {
      constexpr double   of_a_cell = 1000.; // bytes of a triangulation and its numbering, at least
      const unsigned int levels    = domain.coarsening.refinements - domain.coarsening.times;
      const double       n_cells   = n_coarse * std::exp2(dim * levels);
      const bool         too_many  = of_a_cell * n_cells > available_memory(communicator);
      domain.refuse(too_many,
                    "Refinements",
                    "found " + std::to_string(domain.coarsening.refinements) + ", which makes " +
                      number_text(n_cells) + " of the " + std::to_string(n_coarse) +
                      " cells of the mesh, more than there is memory for. Choose fewer.");
    }


    /** Coarse cells, which are to be refined `coarsening.refinements` times. Collective. */
    template <int dim>
    GivenMesh<dim> coarse_mesh(const Scene<dim>         &scene,
                               const MPI_Comm            communicator,
                               std::vector<std::string> &notes)
    {
      GivenMesh<dim> given = given_mesh(scene.domain, communicator);
      require_memory_for(scene.domain, given.coarse.cells.size(), communicator);
      note_cracks_on_faces(given.coarse, scene.cracks, notes);
      return given;
    }


    template <int dim>
    void set_sides_of_lattice(const Domain<dim>                     &domain,
                              const std::vector<CrackGeometry<dim>> &cut,
                              Triangulation<dim>                    &mesh)
    {
      for (const auto &cell : mesh.cell_iterators_on_level(0))
        for (const unsigned int f : cell->face_indices())
          if (cell->face(f)->at_boundary())
            cell->face(f)->set_boundary_id(side_of_lattice(domain, cut, cell->face(f)->center()));
    }
  } // namespace


  template <int dim>
  types::boundary_id side_of_box(const Domain<dim> &domain, const Point<dim> &center)
  {
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double tolerance = 1e-8 * domain.spacing()[d];
        if (std::abs(center[d] - domain.lower[d]) < tolerance)
          return 2 * d;
        if (std::abs(center[d] - domain.upper[d]) < tolerance)
          return 2 * d + 1;
      }
    return hole_boundary_id;
  }


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

    GivenMesh<dim> given;
    unsigned int   n_refinements = domain.coarsening.refinements;
    if (domain.has_lattice())
      std::tie(given.coarse, n_refinements) = coarse_lattice(scene, cut);
    else
      given = coarse_mesh(scene, communicator, notes);
    CoarseMesh<dim> &coarse = given.coarse;
    notes.insert(notes.end(), domain.notes.begin(), domain.notes.end());
    if (!domain.has_lattice() || (domain.shape != Shape::box && n_refinements == 0))
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
    if (domain.has_lattice())
      set_sides_of_lattice(domain, cut, *mesh);
    else
      given.mark(*mesh);
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


  template <int dim>
  void set_material_ids(const Triangulation<dim> &mesh, const Regions &regions)
  {
    if (!regions.need_mesh())
      return;
    using Entry = std::pair<BoundingBox<dim>, typename Triangulation<dim>::cell_iterator>;
    std::vector<Entry> boxes;
    std::set<int>      ids;
    for (const auto &cell : mesh.cell_iterators_on_level(0))
      {
        BoundingBox<dim> box = cell->bounding_box();
        box.extend(1e-10 * cell->diameter());
        boxes.emplace_back(box, cell);
        ids.insert(static_cast<int>(cell->material_id()));
      }
    for (std::size_t k = 0; k < regions.regions.size(); ++k)
      if (const int id = regions.regions[k].mesh_id(); id >= 0 && ids.count(id) == 0)
        {
          std::string known;
          for (const int i : ids)
            known += (known.empty() ? "" : ", ") + std::to_string(i);
          AssertThrow(false,
                      UserError("Entry " + regions.where + ": the phase '" + regions.names[k] +
                                "' is mesh(" + std::to_string(id) +
                                "), but no cell of the mesh file has this material id. Its ids: " +
                                known + "."));
        }
    const auto tree     = std::make_shared<const RTree<Entry>>(pack_rtree(boxes));
    regions.mesh->id_at = [tree](const double *x) {
      Point<dim> p;
      for (unsigned int d = 0; d < dim; ++d)
        p[d] = x[d];
      int                found = -1;
      std::vector<Entry> near;
      tree->query(boost::geometry::index::intersects(p), std::back_inserter(near));
      for (const auto &[box, cell] : near)
        {
          const int id = static_cast<int>(cell->material_id());
          if ((found < 0 || id < found) && (near.size() == 1 || cell->point_inside(p)))
            found = id;
        }
      if (found < 0) // beside coarse cells, at a side that is round
        for (const auto &[box, cell] : *tree | boost::geometry::index::adaptors::queried(
                                                 boost::geometry::index::nearest(p, 1)))
          found = static_cast<int>(cell->material_id());
      return found;
    };
  }


  namespace
  {
    template <int dim>
    constexpr unsigned int n_face_vertices = (dim == 1) ? 1 : (1 << (dim - 1));

    template <int dim>
    using FaceKey = std::array<unsigned int, n_face_vertices<dim>>;

    /** The vertices of face f of a cell, in deal.II's order. */
    template <int dim>
    FaceKey<dim> face_vertices(const CellData<dim> &cell, const unsigned int f)
    {
      FaceKey<dim> face;
      for (unsigned int v = 0; v < face.size(); ++v)
        face[v] = cell.vertices[GeometryInfo<dim>::face_to_cell_vertices(f, v)];
      return face;
    }

    template <int dim>
    double face_measure(const std::vector<Point<dim>> &p, const FaceKey<dim> &face)
    {
      if constexpr (dim == 2)
        return p[face[0]].distance(p[face[1]]);
      else if constexpr (dim == 3)
        return 0.5 * cross_product_3d(p[face[3]] - p[face[0]], p[face[2]] - p[face[1]]).norm();
      else
        return 1.;
    }

    template <int dim>
    bool on_crack(const std::vector<Point<dim>> &p,
                  const FaceKey<dim>            &face,
                  const CrackGeometry<dim>      &crack)
    {
      Point<dim> center;
      for (const unsigned int v : face)
        center += (p[v] - Point<dim>()) / static_cast<double>(face.size());
      // The centre too: all corners of a face may touch the edge of a crack that is not convex.
      return crack.contains(center) &&
             std::all_of(face.begin(), face.end(), [&](const unsigned int v) {
               return crack.contains(p[v]);
             });
    }


    /** Length of a segment, area of a planar polygon. */
    template <int dim>
    double measure(const std::vector<Point<dim>> &corners)
    {
      if (corners.size() < 2)
        return 0.;
      if constexpr (dim == 3)
        {
          Tensor<1, dim> doubled_area;
          for (std::size_t i = 1; i + 1 < corners.size(); ++i)
            doubled_area += cross_product_3d(corners[i] - corners[0], corners[i + 1] - corners[0]);
          return 0.5 * doubled_area.norm();
        }
      double longest = 0.;
      for (const Point<dim> &p : corners)
        longest = std::max(longest, p.distance(corners[0]));
      return longest;
    }


    /** Outward normal of face f, not of unit length. */
    template <int dim>
    Tensor<1, dim> face_normal(const std::vector<Point<dim>> &p,
                               const FaceKey<dim>            &face,
                               const Tensor<1, dim>          &outward)
    {
      Tensor<1, dim> normal;
      if constexpr (dim == 2)
        normal = cross_product_2d(p[face[1]] - p[face[0]]);
      else if constexpr (dim == 3)
        normal = cross_product_3d(p[face[3]] - p[face[0]], p[face[2]] - p[face[1]]);
      return normal * outward < 0. ? -normal : normal;
    }


    /** The middle of a cell, and the distance of its farthest corner from there. */
    template <int dim>
    std::pair<Point<dim>, double> ball_around(const std::vector<Point<dim>> &p,
                                              const CellData<dim>           &cell)
    {
      Point<dim> center;
      for (const unsigned int v : cell.vertices)
        center += (p[v] - Point<dim>()) / static_cast<double>(cell.vertices.size());
      double size = 0.;
      for (const unsigned int v : cell.vertices)
        size = std::max(size, p[v].distance(center));
      return {center, size};
    }


    template <int dim>
    bool is_near(const CrackGeometry<dim>      &crack,
                 const std::vector<Point<dim>> &p,
                 const CellData<dim>           &cell)
    {
      const auto [center, size] = ball_around(p, cell);
      return crack.is_near(center, 1.01 * size);
    }


    /** How much of a crack a cell holds, its faces included. */
    template <int dim>
    double measure_in_cell(const std::vector<Point<dim>> &p,
                           const CellData<dim>           &cell,
                           const CrackGeometry<dim>      &crack)
    {
      constexpr double slack    = 1e-8; // outwards, relative to the cell: its faces belong to it
      const auto [center, size] = ball_around(p, cell);
      if (!crack.is_near(center, 1.01 * size))
        return 0.;
      std::vector<Point<dim>> part = crack.corners();
      for (unsigned int f = 0; f < GeometryInfo<dim>::faces_per_cell && !part.empty(); ++f)
        {
          const FaceKey<dim> face = face_vertices<dim>(cell, f);
          Point<dim>         middle;
          for (const unsigned int v : face)
            middle += (p[v] - Point<dim>()) / static_cast<double>(face.size());
          const Tensor<1, dim> outward = middle - center;
          part = clipped<dim>(part, middle + slack * outward, face_normal<dim>(p, face, outward));
        }
      return measure<dim>(part);
    }

    /**
     * The (at most two) cells on each face, by the face's sorted vertices.
     * @param crack if given, of the faces near it
     */
    template <int dim>
    std::map<FaceKey<dim>, std::vector<unsigned int>> cells_of_faces(
      const CoarseMesh<dim>    &mesh,
      const CrackGeometry<dim> *crack = nullptr)
    {
      std::map<FaceKey<dim>, std::vector<unsigned int>> cells;
      for (unsigned int c = 0; c < mesh.cells.size(); ++c)
        if (crack == nullptr || is_near(*crack, mesh.vertices, mesh.cells[c]))
          for (unsigned int f = 0; f < GeometryInfo<dim>::faces_per_cell; ++f)
            {
              FaceKey<dim> key = face_vertices<dim>(mesh.cells[c], f);
              std::sort(key.begin(), key.end());
              cells[key].push_back(c);
            }
      return cells;
    }

    /**
     * Group number of each of the cells around one vertex, cells being joined by the given pairs.
     */
    std::vector<unsigned int> connected_groups(
      const std::vector<unsigned int>                          &cells,
      const std::vector<std::pair<unsigned int, unsigned int>> &joined)
    {
      std::vector<unsigned int> group(cells.size());
      std::iota(group.begin(), group.end(), 0u);
      const auto index = [&](const unsigned int c) {
        return std::find(cells.begin(), cells.end(), c) - cells.begin();
      };
      for (const auto &[a, b] : joined)
        {
          const unsigned int keep = group[index(a)], drop = group[index(b)];
          for (unsigned int &g : group)
            if (g == drop)
              g = keep;
        }
      return group;
    }
  } // namespace


  template <int dim>
  double measure_on_faces(const CoarseMesh<dim> &mesh, const CrackGeometry<dim> &crack)
  {
    double sum = 0.;
    for (const auto &[key, cells] : cells_of_faces(mesh, &crack))
      if (cells.size() == 2 && on_crack(mesh.vertices, key, crack))
        for (unsigned int f = 0; f < GeometryInfo<dim>::faces_per_cell; ++f)
          {
            // Once more through the cell, since the area needs the vertices in their order around
            // the face.
            const FaceKey<dim> ordered = face_vertices<dim>(mesh.cells[cells[0]], f);
            FaceKey<dim>       sorted  = ordered;
            std::sort(sorted.begin(), sorted.end());
            if (sorted == key)
              sum += face_measure<dim>(mesh.vertices, ordered);
          }
    return sum;
  }


  template <int dim>
  bool lies_on_faces(const CoarseMesh<dim> &mesh, const CrackGeometry<dim> &crack)
  {
    const double on_faces  = measure_on_faces(mesh, crack);
    const auto   is_all_of = [&](const double whole) {
      return std::abs(on_faces - whole) <= 1e-6 * crack.measure();
    };
    if (is_all_of(crack.measure()))
      return true;
    // What lies outside of the body needs no face.
    double held = 0.;
    for (const CellData<dim> &cell : mesh.cells)
      held += measure_in_cell<dim>(mesh.vertices, cell, crack);
    return is_all_of(0.5 * held);
  }


  template <int dim>
  void cut_along_faces(CoarseMesh<dim> &mesh, const std::vector<CrackGeometry<dim>> &cracks)
  {
    std::map<unsigned int, std::vector<std::pair<unsigned int, unsigned int>>> joined;
    std::map<unsigned int, std::vector<unsigned int>>                          around;
    const auto faces = cells_of_faces(mesh);
    for (const auto &[key, cells] : faces)
      if (cells.size() == 2)
        {
          bool cut = false;
          for (const CrackGeometry<dim> &crack : cracks)
            cut = cut || on_crack(mesh.vertices, key, crack);
          for (const unsigned int v : key)
            if (cut)
              around[v];
            else
              joined[v].emplace_back(cells[0], cells[1]);
        }
    for (unsigned int c = 0; c < mesh.cells.size(); ++c)
      for (const unsigned int v : mesh.cells[c].vertices)
        if (const auto entry = around.find(v); entry != around.end())
          entry->second.push_back(c);

    for (const auto &[v, cells] : around)
      {
        const std::vector<unsigned int>      group = connected_groups(cells, joined[v]);
        std::map<unsigned int, unsigned int> vertex_of_group{{group[0], v}};
        for (unsigned int i = 1; i < cells.size(); ++i)
          {
            const auto [entry, is_new] =
              vertex_of_group.try_emplace(group[i],
                                          static_cast<unsigned int>(mesh.vertices.size()));
            if (is_new)
              {
                const Point<dim> copy = mesh.vertices[v];
                mesh.vertices.push_back(copy);
              }
            std::replace(mesh.cells[cells[i]].vertices.begin(),
                         mesh.cells[cells[i]].vertices.end(),
                         v,
                         entry->second);
          }
      }
  }


  PERIDEAL_INSTANTIATE_FUNCTION(measure_on_faces);
  PERIDEAL_INSTANTIATE_FUNCTION(lies_on_faces);
  PERIDEAL_INSTANTIATE_FUNCTION(cut_along_faces);
  PERIDEAL_INSTANTIATE_FUNCTION(set_material_ids);
  PERIDEAL_INSTANTIATE_FUNCTION(build_mesh);
  PERIDEAL_INSTANTIATE_FUNCTION(side_of_box);
  PERIDEAL_INSTANTIATE_FUNCTION(require_cells_everywhere);
} // namespace PeriDeal
