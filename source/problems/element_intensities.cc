// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "element_intensities.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <perideal/analysis/bond_intensities.h>
#include <perideal/laws/elasticity.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /**
     * Gauss points along an edge in rings about ends of cracks, above the degree of elements: the
     * weights and near fields are no polynomials, and cells may be a third of a ring.
     */
    constexpr unsigned int more_points_in_rings(const unsigned int dim)
    {
      return dim == 2 ? 5 : 2;
    }


    template <int dim>
    bool is_warm(const ElasticityControl &elasticity)
    {
      return elasticity.computes_temperature || !elasticity.temperature_change.is_constant() ||
             elasticity.temperature_change.value(Point<dim>()) != 0.;
    }


    /** Within the plane. @param change of the temperature, if it is computed */
    template <int dim>
    double strain_of_heat(const Scene<dim>             &scene,
                          const Point<dim>             &p,
                          const Vector                 &change,
                          const types::global_dof_index node)
    {
      return thermal_strain_factor(scene.material.moduli(p), dim, scene.elasticity.plane) *
             scene.material.thermal_expansion.value(p) *
             (change.size() > 0 ? change(node) : scene.elasticity.temperature_change.value(p));
    }


    /** What an element knows of one of its points; FEValues has been through reinit(). */
    template <int dim>
    class CellPoints
    {
    public:
      CellPoints(const FEValuesBase<dim>                    &values,
                 const std::vector<types::global_dof_index> &nodes,
                 const Scene<dim>                           &scene,
                 const Vector                               &change,
                 const bool                                  warm)
        : values(values)
        , nodes(nodes)
      {
        const auto &cell = values.get_cell();
        for (unsigned int k = 0; k < nodes.size() && warm; ++k)
          {
            const Point<dim> node = values.get_mapping().transform_unit_to_real_cell(
              cell,
              values.get_fe().unit_support_point(k));
            // On the cell's own side of cracks, with its own material.
            strains.push_back(
              strain_of_heat(scene, node + 1e-6 * (cell->center() - node), change, nodes[k]));
          }
      }

      RingPoint<dim> at(const unsigned int q, const Vector &u) const
      {
        RingPoint<dim> point;
        point.place  = values.quadrature_point(q);
        point.weight = values.JxW(q);
        for (unsigned int k = 0; k < nodes.size(); ++k)
          for (unsigned int d = 0; d < dim; ++d)
            point.gradient[d] += u(dim * nodes[k] + d) * values.shape_grad(k, q);
        for (unsigned int k = 0; k < strains.size(); ++k)
          {
            point.thermal_strain += strains[k] * values.shape_value(k, q);
            point.thermal_slope += strains[k] * values.shape_grad(k, q);
          }
        return point;
      }

    private:
      const FEValuesBase<dim>                    &values;
      const std::vector<types::global_dof_index> &nodes;
      std::vector<double>                         strains; // of heat, at the nodes
    };
  } // namespace


  namespace
  {
    UpdateFlags needed_in_rings()
    {
      return update_values | update_gradients | update_quadrature_points | update_JxW_values;
    }


    /** Gives the ends of cracks what cells know. */
    template <int dim>
    class RingCells
    {
    public:
      using Cell = typename DoFHandler<dim>::active_cell_iterator;

      /**
       * @param bonds there are some along cracks
       * @param t     of body forces
       */
      RingCells(const Scene<dim>           &scene,
                const ElasticElements<dim> &elements,
                const DoFHandler<dim>      &dofs,
                const Vector               &u,
                const bool                  bonds,
                const double                t)
        : scene(scene)
        , elements(elements)
        , u(u)
        , bonds(bonds)
        , t(t)
        , inside(dofs.get_fe(),
                 QGauss<dim>(dofs.get_fe().degree + more_points_in_rings(dim)),
                 needed_in_rings())
        , edge(dofs.get_fe(),
               QGauss<dim - 1>(dofs.get_fe().degree + more_points_in_rings(dim)),
               needed_in_rings() | update_normal_vectors)
        , nodes(dofs.get_fe().n_dofs_per_cell())
      {}

      template <typename Integral>
      void add(const Cell &cell, std::vector<Integral> &ends)
      {
        inside.reinit(cell);
        visit(cell, inside, [&](const RingPoint<dim> &point, const unsigned int) {
          for (auto &end : ends)
            end.add(point);
        });
        // Beside a crack that bonds know there is a body up to the crack.
        for (const unsigned int face : cell->face_indices())
          {
            if (cell->at_boundary(face) || !cell->neighbor(face)->is_active() ||
                !elements.cut_cells()[cell->neighbor(face)->active_cell_index()])
              continue;
            edge.reinit(cell, face);
            visit(cell, edge, [&](const RingPoint<dim> &point, const unsigned int q) {
              for (auto &end : ends)
                end.add_strip(point, edge.normal_vector(q), bonds);
            });
          }
      }

    private:
      template <typename Visit>
      void visit(const Cell &cell, const FEValuesBase<dim> &values, const Visit &give)
      {
        cell->get_dof_indices(nodes);
        const auto           &force = scene.initial_and_source.body_force;
        const CellPoints<dim> points(values,
                                     nodes,
                                     scene,
                                     elements.temperature_change(),
                                     is_warm<dim>(scene.elasticity));
        for (const unsigned int q : values.quadrature_point_indices())
          {
            RingPoint<dim> point = points.at(q, u);
            for (unsigned int d = 0; d < dim && !force.empty(); ++d)
              point.force[d] = force[d].value(point.place, t);
            give(point, q);
          }
      }

      const Scene<dim>                    &scene;
      const ElasticElements<dim>          &elements;
      const Vector                        &u;
      const bool                           bonds;
      const double                         t;
      FEValues<dim>                        inside;
      FEFaceValues<dim>                    edge;
      std::vector<types::global_dof_index> nodes;
    };


    /**
     * J is right to the order of the energy, the interaction integrals to that of stresses: so
     * their ratio tells the modes, and J how much there is of both.
     */
    template <int dim>
    void take_amount_of_j(const Scene<dim> &scene, StressIntensity &found)
    {
      constexpr double alike  = 0.2;
      const Moduli     moduli = scene.material.moduli(scene.domain.lower);
      const double     E = moduli.young(), nu = moduli.poisson(),
                   plane_modulus =
                     scene.elasticity.plane == PlaneState::stress ? E : E / (1. - nu * nu),
                   square = found.mode_1 * found.mode_1 + found.mode_2 * found.mode_2,
                   ratio  = plane_modulus * found.j / square;
      if (dim != 2 || !(square > 0.) || !(std::abs(ratio - 1.) < alike))
        return;
      found.mode_1 *= std::sqrt(ratio);
      found.mode_2 *= std::sqrt(ratio);
    }
  } // namespace


  template <int dim>
  std::vector<StressIntensity> intensities_of_cells(const Scene<dim>           &scene,
                                                    const ElasticElements<dim> &elements,
                                                    const DoFHandler<dim>      &dofs,
                                                    const Vector               &u,
                                                    const bool                  bonds,
                                                    const double                t)
  {
    std::vector<StressIntensity> list;
    auto                         ends = crack_end_integrals(scene, elements.crack_time());
    if (ends.empty())
      return list;
    RingCells<dim> cells(scene, elements, dofs, u, bonds, t);
    u.update_ghost_values();
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned() && !elements.cut_cells()[cell->active_cell_index()] &&
          std::any_of(ends.begin(), ends.end(), [&](const auto &end) {
            return end.reaches(cell->center(), cell->diameter());
          }))
        cells.add(cell, ends);
    u.set_ghost_state(false);
    for (auto &end : ends)
      list.push_back(end.result(dofs.get_communicator()));
    if (scene.cracks.on_faces())
      for (StressIntensity &found : list)
        take_amount_of_j(scene, found);
    return list;
  }


#define PERIDEAL_INSTANTIATE(dim)                                                          \
  template std::vector<StressIntensity> intensities_of_cells(const Scene<dim> &,           \
                                                             const ElasticElements<dim> &, \
                                                             const DoFHandler<dim> &,      \
                                                             const Vector &,               \
                                                             const bool,                   \
                                                             const double);
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
