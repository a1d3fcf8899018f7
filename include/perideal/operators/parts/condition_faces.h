// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/mpi.h>
#include <deal.II/base/std_cxx20/iota_view.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/lac/full_matrix.h>

#include <perideal/base/user_error.h>
#include <perideal/mesh/part_nodes.h>

#include <array>
#include <map>
#include <vector>

namespace PeriDeal
{
  /**
   * Quadrature points on what of a face lies in a part, with what is asked of an FEFaceValues
   * there.
   */
  template <int dim>
  class PartValues
  {
  public:
    PartValues(const dealii::FiniteElement<dim> &fe, FacePoints<dim> points)
      : points(std::move(points))
      , shapes(fe.n_dofs_per_cell(), this->points.area.size())
    {
      for (unsigned int i = 0; i < shapes.m(); ++i)
        for (unsigned int q = 0; q < shapes.n(); ++q)
          shapes(i, q) = fe.shape_value(i, this->points.unit[q]);
    }

    bool empty() const
    {
      return points.area.empty();
    }

    dealii::std_cxx20::ranges::iota_view<unsigned int, unsigned int> quadrature_point_indices()
      const
    {
      return {0u, static_cast<unsigned int>(points.area.size())};
    }

    const dealii::Point<dim> &quadrature_point(const unsigned int q) const
    {
      return points.real[q];
    }

    double JxW(const unsigned int q) const
    {
      return points.area[q];
    }

    void scale(const double factor)
    {
      for (double &area : points.area)
        area *= factor;
    }

    double shape_value(const unsigned int i, const unsigned int q) const
    {
      return shapes(i, q);
    }

  private:
    FacePoints<dim>            points;
    dealii::FullMatrix<double> shapes;
  };


  /**
   * Which conditions act on the faces of a finite element mesh, and on what of them. On stairs in
   * place of the rim of a hole areas are those of the rim.
   */
  template <int dim>
  class ConditionFaces
  {
  public:
    using Cell = typename dealii::DoFHandler<dim>::active_cell_iterator;

    /** Throws UserError for parts of sides that are empty. Collective. */
    ConditionFaces(const dealii::DoFHandler<dim> &dofs, const BoundaryConditions<dim> &conditions)
      : conditions(conditions)
    {
      const auto           &fe = dofs.get_fe();
      std::vector<double>   areas(conditions.parts.size(), 0.);
      const RimFactors<dim> rim_over_face(conditions.holes, dofs.get_triangulation());
      Part                  whole;
      whole.inside = Expression(1.);
      for (const auto &cell : dofs.active_cell_iterators())
        if (!cell->is_artificial() && cell->at_boundary())
          for (const unsigned int f : cell->face_indices())
            if (cell->face(f)->at_boundary())
              {
                const auto   id  = cell->face(f)->boundary_id();
                const double rim = rim_over_face(cell->face(f));
                const auto   add = [&](const Part &part, const auto of) {
                  PartValues<dim> values(
                    fe,
                    points_in_part<dim>(vertices_of<dim>(cell), f, part, fe.degree + 1));
                  values.scale(rim);
                  if (of >= first_part_id)
                    for (const unsigned int q : values.quadrature_point_indices())
                      areas[of - first_part_id] += values.JxW(q);
                  if (!values.empty())
                    on_faces.emplace(Key{cell->active_cell_index(), f, of}, std::move(values));
                };
                if (rim != 1.)
                  add(whole, id);
                for (const Part &part : conditions.parts)
                  if (part.side == id)
                    add(part, part.id);
              }
      if (!conditions.parts.empty())
        require_areas(conditions, areas, dofs.get_communicator());
    }

    /**
     * Call visit(condition, values) for each condition of a list on a boundary face of an own cell,
     * with the quadrature points of what of the face it acts on.
     * @param whole is set to the face if some condition acts on all of it
     */
    template <typename Condition, typename Visit>
    void for_each(const std::vector<Condition> &list,
                  const Cell                   &cell,
                  const unsigned int            f,
                  dealii::FEFaceValues<dim>    &whole,
                  const Visit                  &visit) const
    {
      const auto id = cell->face(f)->boundary_id();
      for (const Condition &condition : list)
        if (conditions.side_of(condition.id) == id)
          {
            const auto found = on_faces.find({cell->active_cell_index(), f, condition.id});
            if (found != on_faces.end())
              visit(condition, found->second);
            else if (condition.id == id)
              {
                whole.reinit(cell, f);
                visit(condition, whole);
              }
          }
    }

  private:
    using Key = std::array<unsigned int, 3>; // cell, face, part or side

    const BoundaryConditions<dim> &conditions;
    std::map<Key, PartValues<dim>> on_faces;
  };


  /** An unknown in a region, or nearest to a point. */
  template <int dim>
  struct PartUnknown : PartNode
  {
    dealii::Point<dim> position;
  };

  /**
   * The regions and points among the parts: this process's unknowns there. The volume of an unknown
   * is an equal share of its cells.
   * @param dofs with one component
   * @param is_hanging by global number: those that follow from others and cannot be held. They
   *                   belong to no part.
   *
   * Collective.
   */
  template <int dim, typename IsHanging>
  std::vector<PartUnknown<dim>> unknowns_of_parts(const dealii::DoFHandler<dim> &dofs,
                                                  const BoundaryConditions<dim> &conditions,
                                                  const IsHanging               &is_hanging)
  {
    if (conditions.parts.empty())
      return {};
    const dealii::MappingQ1<dim>    mapping;
    const auto                     &owned = dofs.locally_owned_dofs();
    const auto                      first = owned.is_empty() ? dealii::types::global_dof_index(0) :
                                                               owned.nth_index_in_set(0);
    std::vector<double>             volumes(owned.n_elements(), 0.);
    std::vector<dealii::Point<dim>> positions(owned.n_elements());
    std::vector<dealii::types::global_dof_index> indices(dofs.get_fe().n_dofs_per_cell());
    for (const auto &cell : dofs.active_cell_iterators())
      if (!cell->is_artificial())
        {
          cell->get_dof_indices(indices);
          for (unsigned int i = 0; i < indices.size(); ++i)
            if (indices[i] >= first && indices[i] < first + positions.size())
              {
                volumes[indices[i] - first] += cell->measure() / indices.size();
                positions[indices[i] - first] =
                  mapping.transform_unit_to_real_cell(cell, dofs.get_fe().unit_support_point(i));
              }
        }
    std::vector<unsigned int> numbers;
    for (unsigned int i = 0; i < positions.size(); ++i)
      if (!is_hanging(first + i))
        {
          positions[numbers.size()] = positions[i];
          volumes[numbers.size()]   = volumes[i];
          numbers.push_back(i);
        }
    positions.resize(numbers.size());
    volumes.resize(numbers.size());
    std::vector<PartUnknown<dim>> unknowns;
    for (const PartNode &node :
         nodes_of_parts(conditions, positions, volumes, dofs.get_communicator()))
      {
        unknowns.push_back({node, positions[node.node]});
        unknowns.back().node = numbers[node.node];
      }
    return unknowns;
  }


  /**
   * An error if a condition on a part prescribes nothing: no node lies in it, or what is named
   * before it holds them all.
   * @param counts of each condition of the list, on this process. Collective.
   */
  template <typename Condition, int dim>
  void require_held_parts(const BoundaryConditions<dim>         &conditions,
                          const std::vector<Condition>          &list,
                          const std::vector<unsigned long long> &n_nodes,
                          const std::vector<unsigned long long> &n_held,
                          const std::string                     &entry,
                          const MPI_Comm                         communicator)
  {
    std::vector<unsigned long long> nodes(n_nodes), held(n_held);
    dealii::Utilities::MPI::sum(n_nodes, communicator, nodes);
    dealii::Utilities::MPI::sum(n_held, communicator, held);
    for (std::size_t k = 0; k < list.size(); ++k)
      if (conditions.part(list[k].id) != nullptr && held[k] == 0)
        AssertThrow(
          false,
          UserError(
            "Entry " + conditions.where(entry) + ": the part '" + list[k].name +
            (nodes[k] == 0 ?
               "' holds no node; it is narrower than the mesh is fine. Make it wider or the mesh finer, or take 'point X, "
               "Y' in 'Parts' for the nearest node." :
               "' is without effect: what is named before it holds all of its nodes. Name the part first.")));
  }
} // namespace PeriDeal
