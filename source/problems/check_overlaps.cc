// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/user_error.h>
#include <perideal/mesh/part_nodes.h>
#include <perideal/problems/check_sides.h>

#include <algorithm>
#include <sstream>

namespace PeriDeal
{
  using namespace dealii;

  namespace Overlaps
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
  } // namespace Overlaps

  using namespace Overlaps;


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


  template void check_overlaps(const Scene<1> &, const Triangulation<1> &);
  template void check_overlaps(const Scene<2> &, const Triangulation<2> &);
  template void check_overlaps(const Scene<3> &, const Triangulation<3> &);
} // namespace PeriDeal
