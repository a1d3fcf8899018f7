// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/affine_constraints.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/mesh/boundary_facet.h>
#include <perideal/mesh/mesh_builder.h>
#include <perideal/mesh/nodes.h>
#include <perideal/mesh/part_faces.h>
#include <perideal/mesh/part_nodes.h>
#include <perideal/scene/body_parameters.h>
#include <perideal/scene/crack_geometry.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>
#include <tuple>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    bool is_vertex_element(const DoFHandler<dim> &dofs)
    {
      return dofs.get_fe().n_dofs_per_vertex() > 0;
    }


    template <int dim>
    std::optional<Lattice<dim>> lattice_of(const Domain<dim> &domain, const bool at_centers)
    {
      if (!domain.has_lattice())
        return {};
      Lattice<dim> lattice;
      lattice.lower      = domain.lower;
      lattice.upper      = domain.upper;
      lattice.spacing    = domain.spacing();
      lattice.at_centers = at_centers;
      for (unsigned int d = 0; d < dim; ++d)
        lattice.n_sites[d] = static_cast<int>(domain.cells[d]) + (at_centers ? 0 : 1);
      return lattice;
    }


    /**
     * Call f(local node, cell, corner number) for each owned dof of each cell this process knows;
     * corner is 0 for cell centres.
     */
    template <int dim, typename Visit>
    void for_each_owned_dof(const DoFHandler<dim> &dofs, const Visit &visit)
    {
      const bool                           vertices = is_vertex_element(dofs);
      const IndexSet                      &owned    = dofs.locally_owned_dofs();
      const types::global_dof_index        first = owned.is_empty() ? 0 : owned.nth_index_in_set(0);
      const types::global_dof_index        end   = first + owned.n_elements();
      std::vector<types::global_dof_index> indices(dofs.get_fe().n_dofs_per_cell());
      for (const auto &cell : dofs.active_cell_iterators())
        if (!cell->is_artificial() && (vertices || cell->is_locally_owned()))
          {
            cell->get_dof_indices(indices);
            for (unsigned int v = 0; v < indices.size(); ++v)
              if (indices[v] >= first && indices[v] < end)
                visit(static_cast<unsigned int>(indices[v] - first), cell, v);
          }
    }


    /** How many cells of the lattice a cell spans in each direction. */
    template <int dim>
    int merged_sites(const typename DoFHandler<dim>::active_cell_iterator &cell,
                     const Lattice<dim>                                   &lattice)
    {
      return static_cast<int>(std::lround(cell->extent_in_direction(0) / lattice.spacing[0]));
    }


    template <int dim>
    std::array<double, dim> to_array(const Point<dim> &p)
    {
      std::array<double, dim> a;
      for (unsigned int d = 0; d < dim; ++d)
        a[d] = p[d];
      return a;
    }

    template <int dim>
    Point<dim> to_point(const std::array<double, dim> &a)
    {
      Point<dim> p;
      for (unsigned int d = 0; d < dim; ++d)
        p[d] = a[d];
      return p;
    }
  } // namespace


  template <int dim>
  Nodes<dim>::Nodes(const DoFHandler<dim> &dof_handler, const BodyParameters<dim> &body)
    : Nodes(dof_handler, body.domain, body.cracks, body.peridynamics.sampling.nodal_volume)
  {}


  template <int dim>
  Nodes<dim>::Nodes(const DoFHandler<dim> &dof_handler,
                    const Domain<dim>     &domain,
                    const Cracks<dim>     &cracks,
                    const NodalVolume      nodal_volume)
    : dofs(&dof_handler)
    , first(dof_handler.locally_owned_dofs().is_empty() ?
              0 :
              dof_handler.locally_owned_dofs().nth_index_in_set(0))
    , owned_count(dof_handler.locally_owned_dofs().n_elements())
    , regular(lattice_of(domain, !is_vertex_element(dof_handler)))
  {
    const FiniteElement<dim> &fe = dof_handler.get_fe();
    AssertThrow(fe.n_components() == 1 &&
                  fe.n_dofs_per_cell() == (fe.n_dofs_per_vertex() > 0 ? 1u << dim : 1u),
                ExcMessage("Peridynamic nodes are the dofs of FE_Q(1) or FE_DGQ(0), found " +
                           fe.get_name() + "."));
    find_hanging();
    find_positions();
    find_volumes(nodal_volume);
    find_boundary_shares(domain.has_lattice() && !domain.image ? domain.holes : Holes<dim>());
    find_crack_points(cracks);
    doubled = Utilities::MPI::max(crack_points.empty() ? 0 : 1, communicator()) > 0;
  }


  template <int dim>
  void Nodes<dim>::find_hanging()
  {
    if (is_vertex_element(*dofs) && dofs->get_triangulation().has_hanging_nodes())
      {
        IndexSet relevant;
        DoFTools::extract_locally_relevant_dofs(*dofs, relevant);
        AffineConstraints<double> constraints(relevant);
        DoFTools::make_hanging_node_constraints(*dofs, constraints);
        hanging.resize(owned_count);
        for (unsigned int i = 0; i < owned_count; ++i)
          hanging[i] = constraints.is_constrained(first + i);
      }
    if (!regular)
      return;
    for (const auto &cell : dofs->active_cell_iterators())
      graded = graded || (cell->is_locally_owned() && merged_sites(cell, *regular) > 1);
    graded = Utilities::MPI::max(graded ? 1 : 0, communicator()) > 0;
  }


  template <int dim>
  void Nodes<dim>::find_positions()
  {
    positions.resize(owned_count);
    const bool         vertices = is_vertex_element(*dofs);
    double             edge     = std::numeric_limits<double>::max();
    std::ostringstream message;
    for_each_owned_dof(*dofs, [&](const unsigned int node, const auto &cell, const unsigned int v) {
      const Point<dim> p = vertices ? cell->vertex(v) : cell->center();
      positions[node]    = regular ? regular->position(regular->index(p)) : p;
      if (regular && positions[node].distance(p) > 1e-6 * regular->spacing.norm())
        {
          message.str("");
          message << "The mesh has a node at (" << p
                  << "), which is not on the lattice that section "
                     "'Domain' describes by its corners and 'Cells'.";
        }
      if (!regular)
        edge = std::min(edge, cell->minimum_vertex_distance());
    });
    throw_on_all_if_any(communicator(), message.str());
    if (regular)
      for (unsigned int d = 0; d < dim; ++d)
        edge = std::min(edge, regular->spacing[d]);
    shortest_edge = Utilities::MPI::min(edge, communicator());
  }


  template <int dim>
  void Nodes<dim>::find_volumes(const NodalVolume nodal_volume)
  {
    volumes.assign(owned_count, 0.);
    const unsigned int n_corners = is_vertex_element(*dofs) ? (1u << dim) : 1;
    if (regular)
      {
        const double share = regular->cell_volume() / n_corners;
        for_each_owned_dof(*dofs,
                           [&](const unsigned int node, const auto &cell, const unsigned int) {
                             volumes[node] +=
                               graded ? share * std::pow(merged_sites(cell, *regular), dim) : share;
                           });
        if (nodal_volume == NodalVolume::full)
          std::fill(volumes.begin(), volumes.end(), regular->cell_volume());
        return;
      }
    AssertThrow(
      nodal_volume == NodalVolume::partial,
      UserError("'Nodal volume = full' in section 'Peridynamics' needs a lattice of equal cells "
                "(Shape = box or plate with hole); use 'partial' with a mesh file."));
    FEValues<dim> values(dofs->get_fe(), QGauss<dim>(2), update_values | update_JxW_values);
    unsigned int  current = numbers::invalid_unsigned_int; // index of the cell that values are of
    for_each_owned_dof(*dofs, [&](const unsigned int node, const auto &cell, const unsigned int v) {
      if (current != cell->active_cell_index())
        {
          values.reinit(cell);
          current = cell->active_cell_index();
        }
      for (const unsigned int q : values.quadrature_point_indices())
        volumes[node] += values.shape_value(v, q) * values.JxW(q);
    });
  }


  template <int dim>
  void Nodes<dim>::find_boundary_shares(const Holes<dim> &holes)
  {
    const RimFactors<dim> rim_over_face(holes, dofs->get_triangulation());
    for_each_owned_dof(*dofs, [&](const unsigned int node, const auto &cell, const unsigned int v) {
      for (const unsigned int f : cell->face_indices())
        if (cell->face(f)->at_boundary() && cell->face(f)->boundary_id() != crack_boundary_id)
          {
            const auto face    = cell->face(f);
            bool       touches = !is_vertex_element(*dofs);
            for (unsigned int w = 0; w < face->n_vertices(); ++w)
              touches = touches || face->vertex_index(w) == cell->vertex_index(v);
            double measure = 1.;
            if constexpr (dim > 1)
              measure = face->measure() * rim_over_face(face);
            if (touches)
              shares.push_back({node,
                                face->boundary_id(),
                                is_vertex_element(*dofs) ? measure / face->n_vertices() : measure});
          }
    });
    // One share per node and side.
    std::stable_sort(shares.begin(),
                     shares.end(),
                     [](const BoundaryShare &a, const BoundaryShare &b) {
                       return std::pair(a.node, a.id) < std::pair(b.node, b.id);
                     });
    std::vector<BoundaryShare> joined;
    for (const BoundaryShare &share : shares)
      if (!joined.empty() && joined.back().node == share.node && joined.back().id == share.id)
        joined.back().area += share.area;
      else
        joined.push_back(share);
    shares.swap(joined);
  }


  template <int dim>
  void Nodes<dim>::find_crack_points(const Cracks<dim> &cracks)
  {
    if (!is_vertex_element(*dofs))
      return;
    std::vector<CrackGeometry<dim>> geometries;
    if (cracks.on_faces())
      geometries = make_crack_geometries(cracks.pieces(0.));
    std::vector<bool> is_on_other(owned_count, false); // faces, of a mesh from a file
    if constexpr (dim > 1)
      if (!regular)
        is_on_other = nodes_on_other_facets(*dofs, 1e-7 * shortest_edge);
    std::unordered_map<unsigned int, std::pair<Point<dim>, unsigned int>> middle;
    for_each_owned_dof(*dofs, [&](const unsigned int node, const auto &cell, const unsigned int) {
      if (is_on_other[node] ||
          std::any_of(geometries.begin(), geometries.end(), [&](const CrackGeometry<dim> &crack) {
            return crack.contains(positions[node]);
          }))
        {
          auto &[sum, n] = middle[node];
          sum += cell->center() - Point<dim>();
          ++n;
        }
    });
    constexpr double nudge = 1e-6; // of the way to the middle of the node's own cells
    for (const auto &[node, sum] : middle)
      {
        const Tensor<1, dim> way = sum.first / sum.second - positions[node];
        crack_points[node] =
          positions[node] + nudge / std::max(1., way.norm() / shortest_edge) * way;
      }
  }


  template <int dim>
  types::global_dof_index Nodes<dim>::n_global() const
  {
    return dofs->n_dofs();
  }

  template <int dim>
  Point<dim> Nodes<dim>::crack_point(const unsigned int node) const
  {
    const auto entry = crack_points.find(node);
    return entry == crack_points.end() ? positions[node] : entry->second;
  }

  template <int dim>
  bool Nodes<dim>::is_hanging(const unsigned int node) const
  {
    AssertIndexRange(node, owned_count);
    return !hanging.empty() && hanging[node];
  }

  template <int dim>
  MPI_Comm Nodes<dim>::communicator() const
  {
    return dofs->get_communicator();
  }


  template <int dim>
  NodeRecord<dim> Nodes<dim>::record(const unsigned int node) const
  {
    NodeRecord<dim> record;
    record.global_index = first + node;
    record.volume       = volumes[node];
    record.position     = to_array(positions[node]);
    record.crack_point  = to_array(crack_point(node));
    return record;
  }


  template <int dim>
  void Nodes<dim>::set_ghosts(std::vector<NodeRecord<dim>> ghosts)
  {
    Assert(positions.size() == owned_count, ExcMessage("The halo has been set before."));
    std::sort(ghosts.begin(), ghosts.end(), [](const auto &a, const auto &b) {
      return a.global_index < b.global_index;
    });
    IndexSet ghost_indices(n_global());
    for (const NodeRecord<dim> &ghost : ghosts)
      {
        ghost_indices.add_index(ghost.global_index);
        const Point<dim> p = to_point<dim>(ghost.position), side = to_point<dim>(ghost.crack_point);
        if (p != side)
          crack_points[positions.size()] = side;
        positions.push_back(p);
        volumes.push_back(ghost.volume);
      }
    ghost_indices.compress();
    layout = std::make_shared<Utilities::MPI::Partitioner>(dofs->locally_owned_dofs(),
                                                           ghost_indices,
                                                           communicator());
  }


  template <int dim>
  void Nodes<dim>::set_search(std::shared_ptr<const NodeSearch<dim>> search)
  {
    finder = std::move(search);
  }


  template <int dim>
  const std::shared_ptr<const Utilities::MPI::Partitioner> &Nodes<dim>::partitioner() const
  {
    Assert(layout, ExcMessage("The halo has not been set."));
    return layout;
  }


  template <int dim>
  double Nodes<dim>::volume_share(const std::function<bool(const unsigned int)> &holds) const
  {
    double share = 0., all = 0.;
    for (unsigned int i = 0; i < n_owned(); ++i)
      {
        all += volume(i);
        share += holds(i) ? volume(i) : 0.;
      }
    return Utilities::MPI::sum(share, communicator()) / Utilities::MPI::sum(all, communicator());
  }

  template <int dim>
  std::size_t Nodes<dim>::memory_consumption() const
  {
    return positions.capacity() * sizeof(Point<dim>) + volumes.capacity() * sizeof(double) +
           shares.capacity() * sizeof(BoundaryShare);
  }


  template <int dim>
  void number_along_lattice(DoFHandler<dim> &dof_handler, const Domain<dim> &domain)
  {
    const std::optional<Lattice<dim>> lattice = lattice_of(domain, !is_vertex_element(dof_handler));
    Assert(lattice, ExcMessage("Only a lattice has an order of nodes along it."));
    const unsigned int       n_owned = dof_handler.locally_owned_dofs().n_elements();
    std::vector<std::size_t> site(n_owned);
    const bool               vertices = is_vertex_element(dof_handler);
    for_each_owned_dof(dof_handler,
                       [&](const unsigned int node, const auto &cell, const unsigned int v) {
                         const auto index =
                           lattice->index(vertices ? cell->vertex(v) : cell->center());
                         std::size_t key = 0;
                         for (unsigned int d = dim; d-- > 0;)
                           key = key * lattice->n_sites[d] + index[d];
                         site[node] = key;
                       });
    std::vector<unsigned int> order(n_owned);
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](const unsigned int a, const unsigned int b) {
      return site[a] < site[b];
    });
    const types::global_dof_index first =
      n_owned > 0 ? dof_handler.locally_owned_dofs().nth_index_in_set(0) : 0;
    std::vector<types::global_dof_index> numbers(n_owned);
    for (unsigned int i = 0; i < n_owned; ++i)
      numbers[order[i]] = first + i;
    dof_handler.renumber_dofs(numbers);
  }


  namespace
  {
    /**
     * Of this process's nodes the one nearest to a point, if no other process has a nearer one;
     * else invalid. Collective.
     */
    template <int dim>
    unsigned int nearest_node(const std::vector<Point<dim>> &positions,
                              const Point<dim>              &p,
                              const MPI_Comm                 communicator)
    {
      // Distance and coordinates decide, so that the node is the same on any number of processes.
      double nearest = std::numeric_limits<double>::max(), size = 0.;
      for (const Point<dim> &position : positions)
        {
          nearest = std::min(nearest, position.distance(p));
          size    = std::max(size, position.distance(p));
        }
      nearest             = Utilities::MPI::min(nearest, communicator);
      const double reach  = nearest + 1e-9 * Utilities::MPI::max(size, communicator);
      unsigned int chosen = numbers::invalid_unsigned_int;
      const auto   before = [](const Point<dim> &a, const Point<dim> &b) {
        for (unsigned int d = 0; d < dim; ++d)
          if (a[d] != b[d])
            return a[d] < b[d];
        return false;
      };
      for (unsigned int i = 0; i < positions.size(); ++i)
        if (positions[i].distance(p) <= reach &&
            (chosen == numbers::invalid_unsigned_int || before(positions[i], positions[chosen])))
          chosen = i;
      const bool own        = chosen != numbers::invalid_unsigned_int;
      const auto candidates = Utilities::MPI::all_gather(
        communicator,
        own ? std::vector<Point<dim>>{positions[chosen]} : std::vector<Point<dim>>());
      const unsigned int rank = Utilities::MPI::this_mpi_process(communicator);
      for (unsigned int r = 0; r < candidates.size() && own; ++r)
        if (r != rank && !candidates[r].empty() &&
            (before(candidates[r][0], positions[chosen]) ||
             (candidates[r][0] == positions[chosen] && r < rank)))
          return numbers::invalid_unsigned_int;
      return chosen;
    }


    /** What a node has of a part in one face. */
    template <int dim>
    struct Piece
    {
      unsigned int       node;
      types::boundary_id id;
      Point<dim>         face; // its centre
      double             area;
      Tensor<1, dim>     moment;
      bool               inside;

      auto key() const
      {
        std::array<double, dim> center;
        for (unsigned int d = 0; d < dim; ++d)
          center[d] = face[d];
        return std::make_tuple(node, id, center);
      }
    };
  } // namespace


  template <int dim>
  std::vector<PartNode> nodes_of_parts(const BoundaryConditions<dim> &conditions,
                                       const std::vector<Point<dim>> &positions,
                                       const std::vector<double>     &volumes,
                                       const MPI_Comm                 communicator)
  {
    std::vector<PartNode> found;
    std::string           message;
    for (const Part &part : conditions.parts)
      {
        if (part.kind == Part::of_side)
          continue;
        if (part.kind == Part::point)
          {
            const unsigned int i = nearest_node<dim>(positions, part.position<dim>(), communicator);
            if (i != numbers::invalid_unsigned_int)
              found.push_back({i, part.id, 1.});
            continue;
          }
        const std::size_t before = found.size();
        double            volume = 0.;
        for (unsigned int i = 0; i < positions.size(); ++i)
          if (part.holds(positions[i]))
            {
              found.push_back({i, part.id, volumes[i]});
              volume += volumes[i];
            }
        volume = Utilities::MPI::sum(volume, communicator);
        if (volume == 0.) // the same on all processes
          message =
            "Entry " + conditions.where("Parts") + ", part '" + part.name +
            "': no node lies in the region '" + part.inside.text() +
            "'. Make it larger or the mesh finer, or take 'point X, Y' for the nearest node.";
        for (std::size_t k = before; k < found.size(); ++k)
          found[k].share /= volume;
      }
    AssertThrow(message.empty(), UserError(message));
    return found;
  }


  template <int dim>
  void require_areas(const BoundaryConditions<dim> &conditions,
                     const std::vector<double>     &areas,
                     const MPI_Comm                 communicator)
  {
    std::vector<double> all(areas);
    Utilities::MPI::sum(areas, communicator, all);
    for (std::size_t k = 0; k < all.size(); ++k)
      AssertThrow(conditions.parts[k].kind != Part::of_side || all[k] > 0.,
                  UserError("Entry " + conditions.where("Parts") + ", part '" +
                            conditions.parts[k].name + "': the formula '" +
                            conditions.parts[k].inside.text() + "' holds nowhere on the side '" +
                            conditions.name_of(conditions.parts[k].side) +
                            "': the part is empty."));
  }


  namespace
  {
    /** Shares of parts of sides, from pieces in order. */
    template <int dim>
    void add_pieces(const BoundaryConditions<dim>    &conditions,
                    const std::vector<Piece<dim>>    &pieces,
                    const std::vector<BoundaryShare> &shares,
                    const std::vector<Point<dim>>    &positions,
                    std::vector<BoundaryShare>       &with_parts)
    {
      for (std::size_t begin = 0, end = 0; begin < pieces.size(); begin = end)
        {
          BoundaryShare  share{pieces[begin].node, pieces[begin].id, 0., false, {}};
          Tensor<1, dim> moment;
          for (;
               end < pieces.size() && pieces[end].node == share.node && pieces[end].id == share.id;
               ++end)
            {
              share.area += pieces[end].area;
              moment += pieces[end].moment;
              share.inside = share.inside || pieces[end].inside;
            }
          // Of an area that the part cuts, the middle: pieces of one node add up to what it has of
          // a load that is a straight line.
          const types::boundary_id side  = conditions.side_of(share.id);
          const auto               whole = std::lower_bound(
            shares.begin(),
            shares.end(),
            std::pair(share.node, side),
            [](const BoundaryShare &a, const auto &b) { return std::pair(a.node, a.id) < b; });
          const bool is_cut = share.area > 0. && share.area < (1. - 1e-9) * whole->area;
          for (unsigned int d = 0; d < dim; ++d)
            share.place[d] = is_cut ? moment[d] / share.area : positions[share.node][d];
          with_parts.push_back(share);
        }
    }
  } // namespace


  template <int dim>
  Nodes<dim> &Nodes<dim>::find_parts(const BoundaryConditions<dim> &conditions)
  {
    with_parts.clear();
    if (conditions.parts.empty())
      return *this;
    const bool                           vertices = dofs->get_fe().n_dofs_per_vertex() > 0;
    std::vector<types::global_dof_index> indices(dofs->get_fe().n_dofs_per_cell());
    const RimFactors<dim>                rim_over_face(conditions.holes, dofs->get_triangulation());
    std::vector<Piece<dim>>              pieces;
    std::vector<double>                  areas(conditions.parts.size(), 0.);
    for (const auto &cell : dofs->active_cell_iterators())
      {
        if (cell->is_artificial() || !cell->at_boundary())
          continue;
        cell->get_dof_indices(indices);
        for (const unsigned int f : cell->face_indices())
          for (std::size_t k = 0; k < conditions.parts.size(); ++k)
            {
              const Part &part = conditions.parts[k];
              if (!cell->face(f)->at_boundary() || part.kind != Part::of_side ||
                  part.side != cell->face(f)->boundary_id())
                continue;
              const double          rim = rim_over_face(cell->face(f));
              const FacePoints<dim> points =
                points_in_part<dim>(vertices_of<dim>(cell), f, part, 2);
              for (unsigned int v = 0; v < indices.size(); ++v)
                {
                  if (indices[v] < first || indices[v] >= first + owned_count ||
                      !(vertices ? dofs->get_fe().has_support_on_face(v, f) :
                                   cell->is_locally_owned()))
                    continue;
                  const unsigned int node = static_cast<unsigned int>(indices[v] - first);
                  Piece<dim>         piece{node, part.id, cell->face(f)->center(), 0., {}, false};
                  piece.inside = part.holds(vertices ? positions[node] : piece.face);
                  for (std::size_t q = 0; q < points.area.size(); ++q)
                    {
                      const double area =
                        rim * points.area[q] *
                        (vertices ? GeometryInfo<dim>::d_linear_shape_function(points.unit[q], v) :
                                    1.);
                      piece.area += area;
                      piece.moment += area * (points.real[q] - Point<dim>());
                    }
                  areas[k] += piece.area;
                  if (piece.area > 0. || piece.inside)
                    pieces.push_back(piece);
                }
            }
      }
    require_areas(conditions, areas, communicator());
    // In the order of their places, so that sums are the same to the last bit on any number of
    // processes.
    std::sort(pieces.begin(), pieces.end(), [](const Piece<dim> &a, const Piece<dim> &b) {
      return a.key() < b.key();
    });
    with_parts = shares;
    add_pieces(conditions, pieces, shares, positions, with_parts);
    for (const PartNode &node :
         nodes_of_parts(conditions,
                        std::vector<Point<dim>>(positions.begin(), positions.begin() + owned_count),
                        volumes,
                        communicator()))
      {
        BoundaryShare share{node.node, node.id, node.share, true, {}};
        for (unsigned int d = 0; d < dim; ++d)
          share.place[d] = positions[node.node][d];
        with_parts.push_back(share);
      }
    return *this;
  }


  template <int dim>
  const std::vector<BoundaryShare> &Nodes<dim>::condition_shares() const
  {
    return with_parts.empty() ? shares : with_parts;
  }


  template <int dim>
  Point<dim> Nodes<dim>::place_of(const BoundaryShare &share) const
  {
    if (share.id < first_part_id)
      return positions[share.node];
    Point<dim> p;
    for (unsigned int d = 0; d < dim; ++d)
      p[d] = share.place[d];
    return p;
  }


  PERIDEAL_INSTANTIATE_CLASS(class Nodes);
  PERIDEAL_INSTANTIATE_FUNCTION(number_along_lattice);
  PERIDEAL_INSTANTIATE_FUNCTION(nodes_of_parts);
  PERIDEAL_INSTANTIATE_FUNCTION(require_areas);
} // namespace PeriDeal
