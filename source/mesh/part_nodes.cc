// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/user_error.h>
#include <perideal/mesh/mesh_builder.h>
#include <perideal/mesh/nodes.h>
#include <perideal/mesh/part_nodes.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <limits>
#include <tuple>

namespace PeriDeal
{
  using namespace dealii;

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
    for (std::size_t begin = 0, end = 0; begin < pieces.size(); begin = end)
      {
        BoundaryShare  share{pieces[begin].node, pieces[begin].id, 0., false, {}};
        Tensor<1, dim> moment;
        for (; end < pieces.size() && pieces[end].node == share.node && pieces[end].id == share.id;
             ++end)
          {
            share.area += pieces[end].area;
            moment += pieces[end].moment;
            share.inside = share.inside || pieces[end].inside;
          }
        // Of an area that the part cuts, the middle: pieces of one node add up to what it has of a
        // load that is a straight line.
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


#define PERIDEAL_INSTANTIATE(dim)                                                         \
  template std::vector<PartNode> nodes_of_parts(const BoundaryConditions<dim> &,          \
                                                const std::vector<Point<dim>> &,          \
                                                const std::vector<double> &,              \
                                                const MPI_Comm);                          \
  template void                  require_areas(const BoundaryConditions<dim> &,           \
                                               const std::vector<double> &,               \
                                               const MPI_Comm);                           \
  template Nodes<dim>           &Nodes<dim>::find_parts(const BoundaryConditions<dim> &); \
  template const std::vector<BoundaryShare> &Nodes<dim>::condition_shares() const;        \
  template Point<dim>                        Nodes<dim>::place_of(const BoundaryShare &) const;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
