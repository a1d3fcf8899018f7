// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/mpi.h>
#include <deal.II/fe/mapping_q1.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/point_order.h>
#include <perideal/base/user_error.h>
#include <perideal/mesh/mesh_builder.h>
#include <perideal/mesh/part_nodes.h>
#include <perideal/problems/check_sides.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <limits>
#include <set>
#include <sstream>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** What a condition says of one unknown of the places that it is on. */
    struct Claim
    {
      std::string            entry, name;
      types::boundary_id     id;
      bool                   gives_value; // else it is a load
      bool                   of_heat;
      unsigned int           component;
      const Expression      *formula; // of values
      const VectorCondition *vector;  // null for heat
    };


    template <int dim>
    std::vector<Claim> claims_of(const BoundaryConditions<dim> &conditions)
    {
      std::vector<Claim> claims;
      for (const SideCondition &c : conditions.dirichlet)
        claims.push_back({"Dirichlet", c.name, c.id, true, true, 0, &c.value, nullptr});
      for (const SurfaceTransfer &c : conditions.transfers)
        if (!c.insulates())
          claims.push_back({c.kind->entry, c.name, c.id, false, true, 0, nullptr, nullptr});
      for (const auto *const list : {&conditions.displacement, &conditions.traction})
        for (const VectorCondition &c : *list)
          for (unsigned int d = 0; d < dim; ++d)
            if (const bool given = list == &conditions.displacement;
                c.values[d] && (given || !is_zero(*c.values[d])))
              claims.push_back({given ? (c.rate ? "Velocity" : "Displacement") : "Traction",
                                c.name,
                                c.id,
                                given,
                                false,
                                d,
                                &*c.values[d],
                                &c});
      return claims;
    }


    /**
     * Whether two claims that meet in a place cannot both hold, and the list does not say which of
     * them does.
     */
    template <int dim>
    bool contradict(const Claim                   &a,
                    const Claim                   &b,
                    const BoundaryConditions<dim> &conditions,
                    const Point<dim>              &p)
    {
      if (a.of_heat != b.of_heat || a.component != b.component)
        return false;
      if (a.gives_value != b.gives_value)
        return true;
      if (!a.gives_value)
        return a.entry == b.entry;
      // Of a side and a part of it the one named first holds.
      if (conditions.part(a.id) == nullptr || conditions.part(b.id) == nullptr)
        return false;
      return a.entry != b.entry || (a.formula->text() != b.formula->text() &&
                                    (a.formula->depends_on_time() || b.formula->depends_on_time() ||
                                     a.formula->value(p) != b.formula->value(p)));
    }


    template <int dim>
    bool holds(const Claim                   &claim,
               const BoundaryConditions<dim> &conditions,
               const types::boundary_id       side,
               const Point<dim>              &p)
    {
      const Part *const part  = conditions.part(claim.id);
      const bool        there = part == nullptr || part->kind == Part::of_side ?
                                  conditions.side_of(claim.id) == side &&
                             conditions.holds_at(claim.id, p) :
                                  part->kind == Part::region && part->holds(p);
      return there && (claim.vector == nullptr || !claim.gives_value ||
                       claim.vector->holds(claim.component, p));
    }


    std::string remedy(const Claim &a, const Claim &b)
    {
      if (a.gives_value && b.gives_value)
        return "they give different values there. Make them disjoint, or give one value.";
      if (a.gives_value != b.gives_value)
        return "what is given there takes no load in that direction. Make them disjoint, or the load 0 there.";
      return "loads are not added. Make them disjoint, or name a part with the sum of both.";
    }


    /** The contradiction of claims in a place on a side, or nothing. */
    template <int dim>
    std::string find_contradiction(const std::vector<Claim>      &claims,
                                   const BoundaryConditions<dim> &conditions,
                                   const types::boundary_id       side,
                                   const Point<dim>              &p)
    {
      std::vector<const Claim *> here;
      for (const Claim &claim : claims)
        if (holds(claim, conditions, side, p))
          here.push_back(&claim);
      for (const Claim *const a : here)
        for (const Claim *const b : here)
          if (a < b && (conditions.part(a->id) != nullptr || conditions.part(b->id) != nullptr) &&
              contradict(*a, *b, conditions, p))
            {
              std::ostringstream message;
              message << "Entry " << conditions.where(b->entry) << ": '" << b->name
                      << "' overlaps '" << a->name << "' of '" << a->entry << "', at (";
              for (unsigned int d = 0; d < dim; ++d)
                message << (d > 0 ? ", " : "") << p[d];
              message << "), and " << remedy(*a, *b);
              return message.str();
            }
      return "";
    }


    /**
     * Throws UserError where conditions on parts meet others (looked for at quadrature points of
     * faces, for regions also at vertices) and neither can give way: two different values on two
     * parts, a value and a load in the same direction, two loads. Of a side and its part with
     * values the one named first holds. Collective.
     */
    template <int dim>
    void check_overlaps(const Scene<dim> &scene, const Triangulation<dim> &mesh)
    {
      const BoundaryConditions<dim> &conditions = scene.boundary_conditions;
      if (conditions.parts.empty())
        return;
      const std::vector<Claim> claims = claims_of(conditions);
      std::string              message;
      const auto               look = [&](const types::boundary_id side, const Point<dim> &p) {
        if (message.empty())
          message = find_contradiction(claims, conditions, side, p);
      };
      const bool regions = std::any_of(conditions.parts.begin(),
                                       conditions.parts.end(),
                                       [](const Part &part) { return part.kind == Part::region; });
      for (const auto &cell : mesh.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            for (const unsigned int v : cell->vertex_indices())
              if (regions)
                look(numbers::invalid_boundary_id, cell->vertex(v));
            for (const unsigned int f : cell->face_indices())
              if (cell->face(f)->at_boundary())
                {
                  const auto side = cell->face(f)->boundary_id();
                  if (regions)
                    look(side, cell->face(f)->center());
                  for (const Part &part : conditions.parts)
                    if (part.side == side)
                      for (const Point<dim> &p :
                           points_in_part<dim>(vertices_of<dim>(cell), f, part, 1).real)
                        look(side, p);
                }
          }
      throw_on_all_if_any(mesh.get_communicator(), message);
    }


    /** What of the body is near a point. */
    template <int dim>
    struct Nearest
    {
      bool       inside   = false;                              // of the body
      double     distance = std::numeric_limits<double>::max(); // from the nearest vertex
      double     diameter = 0.;                                 // of the largest cell there
      Point<dim> vertex;
    };


    template <int dim>
    bool holds(const typename Triangulation<dim>::active_cell_iterator &cell, const Point<dim> &p)
    {
      constexpr double slack = 1e-6;
      if (!cell->bounding_box().point_inside(p, slack))
        return false;
      try
        {
          const Point<dim> unit = MappingQ1<dim>().transform_real_to_unit_cell(cell, p);
          return GeometryInfo<dim>::is_inside_unit_cell(unit, slack);
        }
      catch (const typename Mapping<dim>::ExcTransformationFailed &)
        {
          return false;
        }
    }


    /** The same on any number of processes. Collective. */
    template <int dim>
    Nearest<dim> nearest_in(const Triangulation<dim> &mesh, const Point<dim> &p)
    {
      Nearest<dim> own;
      const auto   take = [](Nearest<dim> &best, const Nearest<dim> &other) {
        const bool as_near = other.distance == best.distance;
        if (other.distance < best.distance || (as_near && comes_first(other.vertex, best.vertex)))
          {
            best.distance = other.distance;
            best.diameter = other.diameter;
            best.vertex   = other.vertex;
          }
        else if (as_near && other.vertex == best.vertex)
          best.diameter = std::max(best.diameter, other.diameter);
      };
      for (const auto &cell : mesh.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            own.inside = own.inside || holds<dim>(cell, p);
            for (const unsigned int v : cell->vertex_indices())
              if (const double distance = cell->vertex(v).distance(p); distance <= own.distance)
                take(own, {false, distance, cell->diameter(), cell->vertex(v)});
          }
      const MPI_Comm communicator = mesh.get_communicator();
      Nearest<dim>   all;
      all.inside = Utilities::MPI::max(own.inside ? 1 : 0, communicator) > 0;
      std::vector<double> numbers{own.distance, own.diameter};
      numbers.insert(numbers.end(), own.vertex.begin_raw(), own.vertex.end_raw());
      for (const std::vector<double> &of_one : Utilities::MPI::all_gather(communicator, numbers))
        {
          Nearest<dim> other{false, of_one[0], of_one[1], Point<dim>()};
          std::copy(of_one.begin() + 2, of_one.end(), other.vertex.begin_raw());
          take(all, other);
        }
      return all;
    }


    template <int dim>
    std::string text_of(const Point<dim> &p)
    {
      std::string text;
      for (unsigned int d = 0; d < dim; ++d)
        text += (d > 0 ? ", " : "(") + rounded_text(p[d], 6);
      return text + ")";
    }


    /** What is wrong with what a transfer's formulas give at the start, or nothing. */
    template <int dim>
    std::string fault_of(const SurfaceTransfer &transfer,
                         const Expression      &initial_value,
                         const Point<dim>      &p)
    {
      try
        {
          return transfer.fault(p, 0., initial_value.value(p));
        }
      catch (const UserError &error) // of a formula that is no number here, on this process alone
        {
          return error.message();
        }
    }


    /** The boundary ids of the body on all processes, without those of cracks. Collective. */
    template <int dim>
    std::set<types::boundary_id> sides_of(const Scene<dim> &scene, const Triangulation<dim> &mesh)
    {
      const auto                  &conditions = scene.boundary_conditions;
      std::set<types::boundary_id> present;
      std::string                  message;
      for (const auto &cell : mesh.active_cell_iterators())
        if (cell->is_locally_owned())
          for (const unsigned int f : cell->face_indices())
            if (cell->face(f)->at_boundary())
              {
                const auto id = cell->face(f)->boundary_id();
                present.insert(id);
                const auto p = cell->face(f)->center();
                for (const SurfaceTransfer &transfer : conditions.transfers)
                  if (conditions.side_of(transfer.id) == id && message.empty() &&
                      conditions.holds_at(transfer.id, p))
                    message = fault_of<dim>(transfer, scene.initial_and_source.initial_value, p);
              }
      throw_on_all_if_any(mesh.get_communicator(), message);
      present = Utilities::MPI::compute_set_union(present, mesh.get_communicator());
      present.erase(crack_boundary_id);
      return present;
    }
  } // namespace


  template <int dim>
  void check_points_of_parts(const Scene<dim>         &scene,
                             const Triangulation<dim> &mesh,
                             std::vector<std::string> &notes)
  {
    constexpr double negligible = 1e-3; // of a cell: that of roundings and of polygons for circles
    for (const Part &part : scene.boundary_conditions.parts)
      {
        if (part.kind != Part::point)
          continue;
        const Point<dim>   p    = part.position<dim>();
        const Nearest<dim> near = nearest_in(mesh, p);
        if (near.inside || near.distance <= negligible * near.diameter)
          continue;
        const std::string where = scene.boundary_conditions.where("Parts") + ", part '" +
                                  part.name + "': the point " + text_of(p) +
                                  " lies outside the body, " + rounded_text(near.distance, 6) +
                                  " from the nearest corner of a cell, " + text_of(near.vertex);
        if (near.distance > near.diameter)
          AssertThrow(
            false,
            UserError(
              "Entry " + where +
              ". Move it into the body; a load on the rim of a hole is one on the side 'hole', "
              "or on a region around the point."));
        notes.push_back(where + ". The node nearest to it bears what is given there.");
      }
  }


  template <int dim>
  void check_sides(const Scene<dim> &scene, const Triangulation<dim> &mesh)
  {
    const std::set<types::boundary_id> present = sides_of(scene, mesh);
    check_overlaps(scene, mesh);
    if (scene.domain.shape == Shape::box)
      return;
    const bool               from_file = !scene.domain.has_lattice();
    std::vector<std::string> known;
    for (const auto id : present)
      known.push_back(scene.boundary_conditions.name_of(id));
    const auto check =
      [&](const std::string &entry, const types::boundary_id id, const std::string &name) {
        AssertThrow(
          id >= first_part_id || present.count(id) > 0,
          UserError(
            "'" + entry + "' in section 'Boundary conditions' names the side '" + name +
            (from_file ?
               "', which the mesh '" + scene.domain.mesh_text() +
                 "' does not have. Its boundary ids and names are: " :
               "', but the hole in section 'Domain' leaves nothing of it. Sides that there are: ") +
            join_names(known) + "."));
      };
    const auto &conditions = scene.boundary_conditions;
    conditions.for_each([&](const std::string &entry, const auto &condition) {
      check(entry, condition.id, condition.name);
    });
    for (const auto id : conditions.symmetry)
      check("Symmetry", id, conditions.name_of(id));
    for (const Part &part : conditions.parts)
      if (part.kind == Part::of_side)
        check("Parts", part.side, conditions.name_of(part.side));
  }


  PERIDEAL_INSTANTIATE_FUNCTION(check_points_of_parts);
  PERIDEAL_INSTANTIATE_FUNCTION(check_sides);
} // namespace PeriDeal
