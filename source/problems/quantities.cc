// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/problems/quantities.h>
#include <perideal/problems/result_record.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/quantities.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** A number of a field at the nodes. */
    struct Values
    {
      std::vector<const Vector *> components; // more than one: their magnitude

      double operator()(const types::global_dof_index node) const
      {
        if (components.size() == 1)
          return (*components[0])(node);
        double square = 0.;
        for (const Vector *const component : components)
          square += (*component)(node) * (*component)(node);
        return std::sqrt(square);
      }
    };


    /**
     * By names: a field of one component by its own, vectors by that for their magnitude and with
     * _x, _y, _z (those of displacements and velocities, as in tables, ux and vx, ...).
     */
    std::map<std::string, Values> values_by_name(const std::vector<OutputField> &fields)
    {
      static const std::map<std::string, std::string> in_tables = {{"displacement", "u"},
                                                                   {"velocity", "v"}};
      std::map<std::string, Values>                   found;
      for (const OutputField &field : fields)
        {
          const auto short_name = in_tables.find(field.name);
          for (unsigned int c = 0; c < field.components.size(); ++c)
            {
              found[field.name].components.push_back(&field.components[c]);
              const std::string axis(1, "xyz"[c]);
              if (short_name != in_tables.end())
                found[short_name->second + axis].components = {&field.components[c]};
              else if (field.components.size() > 1)
                found[field.name + "_" + axis].components = {&field.components[c]};
            }
        }
      return found;
    }


    /** What visit(value, weight, place) is called for: extremes, the sum and the weight. */
    template <int dim>
    struct Summary
    {
      struct Candidate
      {
        double     value;
        Point<dim> place;
      };

      void operator()(const double value, const double weight, const Point<dim> &place)
      {
        any = true;
        if (std::isnan(value))
          return;
        sum += value * weight;
        whole += weight;
        if (kind == Quantity::minimum || kind == Quantity::maximum)
          candidates.push_back({kind == Quantity::minimum ? -value : value, place});
      }

      Quantity::Kind         kind = Quantity::sum;
      bool                   any  = false;
      double                 sum = 0., whole = 0.;
      std::vector<Candidate> candidates;
    };


    template <int dim>
    bool is_less(const Point<dim> &a, const Point<dim> &b)
    {
      return std::lexicographical_compare(a.begin_raw(), a.end_raw(), b.begin_raw(), b.end_raw());
    }


    /** The largest candidate of all processes, of equal ones the one with smallest coordinates. */
    template <int dim>
    typename Summary<dim>::Candidate largest(const Summary<dim> &summary, const MPI_Comm comm)
    {
      constexpr double equal = 1e-9;
      double           most = -std::numeric_limits<double>::infinity(), size = 0.;
      for (const auto &candidate : summary.candidates)
        {
          most = std::max(most, candidate.value);
          size = std::max(size, std::abs(candidate.value));
        }
      most = Utilities::MPI::max(most, comm);
      size = Utilities::MPI::max(size, comm);
      std::vector<double> own; // nothing, or the place
      Point<dim>          best;
      for (const auto &candidate : summary.candidates)
        if (candidate.value >= most - equal * size &&
            (own.empty() || is_less(candidate.place, best)))
          {
            best = candidate.place;
            own.assign(best.begin_raw(), best.end_raw());
          }
      bool any = false;
      for (const std::vector<double> &place : Utilities::MPI::all_gather(comm, own))
        if (!place.empty())
          {
            const Point<dim> p = point_of<dim>(place.data());
            if (!any || is_less(p, best))
              best = p;
            any = true;
          }
      return {most, best};
    }


    /** Visit the faces of a side, or of a part of one. */
    template <int dim, typename Visit>
    void for_each_face(const Problem<dim>      &problem,
                       const types::boundary_id id,
                       const Values            &values,
                       const Visit             &visit)
    {
      const auto                          &conditions  = problem.scene.boundary_conditions;
      const DoFHandler<dim>               &dofs        = problem.dofs();
      const bool                           at_vertices = dofs.get_fe().n_dofs_per_vertex() > 0;
      std::vector<types::global_dof_index> of_cell(dofs.get_fe().n_dofs_per_cell());
      for (const auto &cell : dofs.active_cell_iterators())
        if (cell->is_locally_owned() && cell->at_boundary())
          for (const unsigned int f : cell->face_indices())
            {
              const auto face = cell->face(f);
              if (!face->at_boundary() || face->boundary_id() != conditions.side_of(id) ||
                  !conditions.holds_at(id, face->center()) ||
                  !problem.scene.domain.shows(cell->center()))
                continue;
              cell->get_dof_indices(of_cell);
              const unsigned int n    = GeometryInfo<dim>::vertices_per_face;
              double             area = 1.; // of a point
              if constexpr (dim > 1)
                area = face->measure();
              for (unsigned int v = 0; v < n; ++v)
                {
                  const unsigned int of_face = GeometryInfo<dim>::face_to_cell_vertices(f, v);
                  visit(values(of_cell[at_vertices ? of_face : 0]),
                        area / n,
                        at_vertices ? cell->vertex(of_face) : cell->center());
                }
            }
    }


    /** Visit the nodes of the body, or of a region of it. */
    template <int dim, typename Visit>
    void for_each_node(const Problem<dim> &problem,
                       const Quantity     &quantity,
                       const Values       &values,
                       const Visit        &visit)
    {
      const auto &scene  = problem.scene;
      const auto &layout = *values.components[0]->get_partitioner();
      for (unsigned int i = 0; i < layout.locally_owned_size(); ++i)
        {
          const Point<dim> p = problem.position(i);
          const bool       is_there =
            quantity.region ? quantity.region->value(p) > 0. :
                  quantity.phase  ? scene.material.phases.all().at(p) == *quantity.phase :
                  quantity.place  ? scene.boundary_conditions.holds_at(*quantity.place, p) :
                                    true;
          if (is_there && scene.domain.shows(p))
            visit(values(layout.local_to_global(i)), problem.volume(i), p);
        }
    }


    /** What a quantity is in a model, and where; @p where its entry for messages. Collective. */
    template <int dim>
    std::pair<double, Point<dim>> find(const Problem<dim> &problem,
                                       const Quantity     &quantity,
                                       const Values       &values,
                                       const std::string  &where)
    {
      const MPI_Comm comm      = problem.dofs().get_communicator();
      const bool     has_faces = quantity.place && problem.scene.boundary_conditions.side_of(
                                                 *quantity.place) != numbers::invalid_boundary_id;
      Summary<dim> summary;
      summary.kind = quantity.kind;
      if (has_faces)
        for_each_face(problem, *quantity.place, values, std::ref(summary));
      else
        for_each_node(problem, quantity, values, std::ref(summary));
      AssertThrow(Utilities::MPI::max(summary.any ? 1 : 0, comm) > 0,
                  UserError("Entry " + where + ": no " + (has_faces ? "face" : "node") + " of '" +
                            problem.name() + "' lies there."));
      if (quantity.has_place())
        {
          const auto most = largest(summary, comm);
          return {quantity.kind == Quantity::minimum ? -most.value : most.value, most.place};
        }
      const double sum = Utilities::MPI::sum(summary.sum, comm);
      return {quantity.kind == Quantity::sum ? sum : sum / Utilities::MPI::sum(summary.whole, comm),
              Point<dim>()};
    }
  } // namespace


  template <int dim>
  void add_quantities(const std::vector<const Problem<dim> *> &problems,
                      const double                             t,
                      ResultRecord                            &record)
  {
    if (problems[0]->scene.output.quantities.empty())
      return;
    const OutputControl<dim> &output = problems[0]->scene.output;
    std::set<std::string>     found, names;
    for (const Problem<dim> *const problem : problems)
      {
        const std::vector<OutputField> fields = problem->fields(t);
        const auto                     known  = values_by_name(fields);
        for (const auto &[name, values] : known)
          names.insert(name);
        for (const Quantity &quantity : output.quantities)
          {
            const auto values = known.find(quantity.field);
            if (values == known.end()) // perhaps one of another model
              continue;
            found.insert(quantity.field);
            std::pair<double, Point<dim>> of_model;
            with_formulas(problem->dofs().get_communicator(), [&] {
              of_model = find(*problem,
                              quantity,
                              values->second,
                              output.where("Quantities") + ", '" + quantity.name + "'");
            });
            record.add_row(problem->name(), quantity.name, of_model.first, t);
            for (unsigned int d = 0; d < dim && quantity.has_place(); ++d)
              record.add_row(problem->name(),
                             quantity.name + " at " + "xyz"[d],
                             of_model.second[d],
                             t);
          }
      }
    for (const Quantity &quantity : output.quantities)
      if (found.count(quantity.field) == 0)
        entry_error(output.where("Quantities") + ", '" + quantity.name + "'",
                    "no model has a field '" + quantity.field +
                      "'; there are: " + join_names(names) + "." +
                      did_you_mean(quantity.field, {names.begin(), names.end()}));
  }


  template <int dim>
  void check_quantities(const std::vector<const Problem<dim> *> &problems)
  {
    ResultRecord nowhere;
    add_quantities(problems, 0., nowhere);
  }


  PERIDEAL_INSTANTIATE_FUNCTION(add_quantities);
  PERIDEAL_INSTANTIATE_FUNCTION(check_quantities);
} // namespace PeriDeal
