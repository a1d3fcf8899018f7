// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/point_order.h>
#include <perideal/problems/check_sides.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

namespace PeriDeal
{
  using namespace dealii;

  using json = nlohmann::ordered_json;

  namespace
  {
    /**
     * A piece of a side, or of two dimensions its ends, with the outward normal; of a region a
     * cell.
     */
    template <int dim>
    struct Piece
    {
      static constexpr unsigned int n_numbers = 4 * dim;

      Point<dim>     center, from, to;
      Tensor<1, dim> normal;
    };


    /** Conditions of all kinds by the name that results give their place. */
    template <int dim>
    std::map<types::boundary_id, std::string> named_places(const Scene<dim> &scene)
    {
      const auto                               &conditions = scene.boundary_conditions;
      std::map<types::boundary_id, std::string> names;
      const bool                                box = scene.domain.has_lattice();
      const auto add = [&](const types::boundary_id id, const std::string &name) {
        if (!box || id >= 2 * dim)
          names.emplace(id, name);
      };
      conditions.for_each([&](const auto &, const auto &c) { add(c.id, c.name); });
      for (const auto side : conditions.symmetry)
        add(side, conditions.name_of(side));
      return names;
    }


    template <int dim, typename Face>
    Tensor<1, dim> outward_normal(const Face &face, const Point<dim> &center_of_cell)
    {
      Tensor<1, dim> normal;
      if constexpr (dim == 2)
        normal = cross_product_2d(face->vertex(1) - face->vertex(0));
      else if constexpr (dim == 3)
        normal =
          cross_product_3d(face->vertex(3) - face->vertex(0), face->vertex(2) - face->vertex(1));
      const double length = normal.norm();
      if (length > 0.)
        normal /= normal * (face->center() - center_of_cell) < 0. ? -length : length;
      return normal;
    }


    /**
     * The pieces of this process on a side, or on a part of one: a face in eighths where it is in
     * part.
     */
    template <int dim>
    void add_faces(const Triangulation<dim> &mesh,
                   const types::boundary_id  side,
                   const Part               *part,
                   std::vector<Piece<dim>>  &pieces)
    {
      const unsigned int n = part != nullptr && dim == 2 ? 8 : 1;
      for (const auto &cell : mesh.active_cell_iterators())
        if (cell->is_locally_owned() && cell->at_boundary())
          for (const auto &face : cell->face_iterators())
            {
              if (!face->at_boundary() || face->boundary_id() != side)
                continue;
              Piece<dim> piece;
              piece.normal = outward_normal<dim>(face, cell->center());
              // The body lies to the left of the way from one end to the other.
              Point<dim> a = face->vertex(0), b = face->vertex(1);
              if constexpr (dim == 2)
                if (cross_product_2d(b - a) * piece.normal < 0.)
                  std::swap(a, b);
              for (unsigned int k = 0; k < n; ++k)
                {
                  piece.from   = a + (double(k) / n) * (b - a);
                  piece.to     = a + (double(k + 1) / n) * (b - a);
                  piece.center = dim == 2 ? Point<dim>(0.5 * (piece.from + piece.to)) :
                                            face->center();
                  if (part == nullptr || part->template holds<dim>(piece.center))
                    pieces.push_back(piece);
                }
            }
    }


    template <int dim>
    void add_cells(const Triangulation<dim> &mesh,
                   const Part               &part,
                   std::vector<Piece<dim>>  &pieces)
    {
      for (const auto &cell : mesh.active_cell_iterators())
        if (cell->is_locally_owned() && part.template holds<dim>(cell->center()))
          pieces.push_back({cell->center(), cell->center(), cell->center(), Tensor<1, dim>()});
    }


    /**
     * Those of all processes on process 0, in an order that does not depend on their number.
     * Collective.
     */
    template <int dim>
    std::vector<Piece<dim>> gathered(const std::vector<Piece<dim>> &own,
                                     const MPI_Comm                 communicator)
    {
      std::vector<double> numbers;
      for (const Piece<dim> &piece : own)
        for (unsigned int d = 0; d < dim; ++d)
          for (const double v : {piece.center[d], piece.from[d], piece.to[d], piece.normal[d]})
            numbers.push_back(v);
      std::vector<Piece<dim>> all;
      for (const std::vector<double> &of_process : Utilities::MPI::gather(communicator, numbers, 0))
        for (std::size_t k = 0; k < of_process.size(); k += Piece<dim>::n_numbers)
          {
            Piece<dim> piece;
            for (unsigned int d = 0; d < dim; ++d)
              {
                piece.center[d] = of_process[k + 4 * d];
                piece.from[d]   = of_process[k + 4 * d + 1];
                piece.to[d]     = of_process[k + 4 * d + 2];
                piece.normal[d] = of_process[k + 4 * d + 3];
              }
            all.push_back(piece);
          }
      std::sort(all.begin(), all.end(), [](const Piece<dim> &a, const Piece<dim> &b) {
        return comes_first(a.center, b.center);
      });
      return all;
    }


    /** Pieces one after the other along a side, each time as far as it goes. */
    std::vector<Piece<2>> in_order(std::vector<Piece<2>> pieces)
    {
      double extent = 0.;
      for (const Piece<2> &piece : pieces)
        for (const Point<2> &end : {piece.from, piece.to})
          extent = std::max(extent, end.distance(pieces[0].from));
      const double                                    grain = 1e-8 * std::max(extent, 1e-300);
      std::map<std::array<long long, 2>, std::size_t> starting;
      std::map<std::array<long long, 2>, bool>        ending;
      const auto                                      key = [grain](const Point<2> &p) {
        return std::array<long long, 2>{{std::llround(p[0] / grain), std::llround(p[1] / grain)}};
      };
      for (std::size_t k = 0; k < pieces.size(); ++k)
        {
          starting[key(pieces[k].from)] = k;
          ending[key(pieces[k].to)]     = true;
        }
      std::vector<Piece<2>> ordered;
      std::vector<bool>     taken(pieces.size());
      const auto            follow = [&](std::size_t k) {
        while (!taken[k])
          {
            taken[k] = true;
            ordered.push_back(pieces[k]);
            const auto next = starting.find(key(pieces[k].to));
            if (next != starting.end())
              k = next->second;
          }
      };
      for (std::size_t k = 0; k < pieces.size(); ++k) // beginnings of lines first, then closed ones
        if (!ending.count(key(pieces[k].from)))
          follow(k);
      for (std::size_t k = 0; k < pieces.size(); ++k)
        follow(k);
      return ordered;
    }


    /** Neighbours in one straight line as one. */
    json straight_lines(const std::vector<Piece<2>> &ordered)
    {
      json       lines = json::array();
      Point<2>   from, to;
      const auto add = [&] { lines.push_back({from[0], from[1], to[0], to[1]}); };
      for (std::size_t k = 0; k < ordered.size(); ++k)
        {
          const Piece<2> &piece   = ordered[k];
          const bool      goes_on = k > 0 &&
                               piece.from.distance(to) < 1e-6 * piece.from.distance(piece.to) &&
                               (piece.normal - ordered[k - 1].normal).norm() < 1e-6;
          if (k > 0 && !goes_on)
            add();
          if (!goes_on)
            from = piece.from;
          to = piece.to;
        }
      if (!ordered.empty())
        add();
      return lines;
    }


    template <int dim>
    json numbers_of(const Tensor<1, dim> &v)
    {
      json list = json::array();
      for (unsigned int d = 0; d < dim; ++d)
        list.push_back(v[d]);
      return list;
    }


    /** At most n of the pieces, spread evenly over their order. */
    template <int dim>
    void add_samples(const std::vector<Piece<dim>> &pieces,
                     const std::size_t              n,
                     const bool                     on_side,
                     json                          &place)
    {
      place["at"] = json::array();
      if (on_side)
        place["normals"] = json::array();
      const std::size_t most = std::min(n, pieces.size());
      for (std::size_t k = 0; k < most; ++k)
        {
          const Piece<dim> &piece = pieces[(2 * k + 1) * pieces.size() / (2 * most)];
          place["at"].push_back(numbers_of<dim>(piece.center));
          if (on_side)
            place["normals"].push_back(numbers_of<dim>(piece.normal));
        }
    }


    /** Collective. */
    template <int dim>
    json describe_place(const Scene<dim>         &scene,
                        const Triangulation<dim> &mesh,
                        const types::boundary_id  id,
                        const MPI_Comm            communicator)
    {
      constexpr std::size_t   n_on_side = dim == 2 ? 9 : 6, n_in_region = 60;
      const Part             *part = scene.boundary_conditions.part(id);
      std::vector<Piece<dim>> pieces;
      if (part != nullptr && part->kind == Part::point)
        return {{"kind", "point"},
                {"at", json::array({numbers_of<dim>(part->template position<dim>())})}};
      const bool on_side = part == nullptr || part->kind == Part::of_side;
      if (on_side)
        add_faces(mesh, part == nullptr ? id : part->side, part, pieces);
      else
        add_cells(mesh, *part, pieces);
      pieces     = gathered(pieces, communicator);
      json place = {{"kind", part == nullptr ? "side" : on_side ? "part of a side" : "region"}};
      if constexpr (dim == 2)
        if (on_side)
          {
            pieces         = in_order(pieces);
            place["lines"] = straight_lines(pieces);
          }
      add_samples(pieces, on_side ? n_on_side : n_in_region, on_side, place);
      return place;
    }
  } // namespace


  template <int dim>
  json places_of_conditions(const Scene<dim>         &scene,
                            const Triangulation<dim> &mesh,
                            const MPI_Comm            communicator)
  {
    json places = json::object();
    if constexpr (dim > 1)
      for (const auto &[id, name] : named_places(scene))
        {
          const json place = describe_place(scene, mesh, id, communicator);
          if (Utilities::MPI::this_mpi_process(communicator) == 0)
            places[name] = place;
        }
    return places;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(places_of_conditions);
} // namespace PeriDeal
