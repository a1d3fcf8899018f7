// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/vector_operation.h>

#include <perideal/analysis/bond_intensities.h>
#include <perideal/analysis/coupling_certificate.h>
#include <perideal/analysis/front_intensity.h>
#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/laws/elasticity.h>
#include <perideal/laws/entropy_of_deformation.h>
#include <perideal/operators/coupling/nodal_family.h>
#include <perideal/operators/solid/elastic_elements.h>
#include <perideal/scene/law_text.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "solid_parts.h"

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
      return thermal_strain(scene,
                            p,
                            change.size() > 0 ? change(node) :
                                                scene.elasticity.temperature_change.value(p));
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
      const Moduli     moduli = scene.moduli(scene.domain.lower);
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


    /**
     * CrackEndIntegral, in three dimensions FrontIntegral, of elements. Cells that cracks cut have
     * no stress: up to the crack all is as on the faces of the cells beside them.
     * @param bonds that are along cracks bear what cut cells do not; else these are no part of the
     *              body (CrackEndIntegral::add_strip())
     * @param t     of body forces
     * Collective.
     */
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


    /** Of each of some points of a unit cell the nearest one at which a law knows its stress. */
    template <int dim>
    std::vector<unsigned int> nearest_points(const Quadrature<dim> &points,
                                             const unsigned int     degree)
    {
      const QGauss<dim>              of_law(degree + 1);
      const std::vector<Point<dim>> &list = of_law.get_points();
      std::vector<unsigned int>      nearest;
      for (const Point<dim> &p : points.get_points())
        nearest.push_back(std::min_element(list.begin(),
                                           list.end(),
                                           [&](const Point<dim> &a, const Point<dim> &b) {
                                             return p.distance_square(a) < p.distance_square(b);
                                           }) -
                          list.begin());
      return nearest;
    }


    template <int dim>
    class ElementSolid : public SolidField<dim>
    {
    public:
      using Field<dim>::scene;
      using Field<dim>::handler;
      using Field<dim>::solution;

      /** @param on finite elements or coupled */
      ElementSolid(Model<dim> &on, const Scene<dim> &scene)
        : SolidField<dim>(on, scene)
        , model(on.kind)
      {
        {
          Timings::Scope scope(this->timings, "unknowns");
          on.number(FE_Q<dim>(degree()), scene.domain, model == ModelKind::coupled);
        }
        {
          Timings::Scope                 scope(this->timings, "operator");
          std::unique_ptr<Coupling<dim>> coupling;
          if (model == ModelKind::coupled)
            coupling = make_solid_coupling(on.nodes(scene, NodalVolume::partial), scene);
          elements = std::make_unique<ElasticElements<dim>>(handler, scene, std::move(coupling));
        }
        // Its fields would have to be mirrored, too.
        const bool has_matrix = !has_nodal_law(scene);
        if (model == ModelKind::coupled && scene.coupling.certificate && has_matrix &&
            elements->mirrors().empty())
          certify();
      }

      ElasticElements<dim> &op() const override
      {
        return *elements;
      }

      const Families<dim> *families() const override
      {
        return elements->brittle() ? &elements->bonds().families() : nullptr;
      }

      std::vector<BondBreak> breaks() const override
      {
        return elements->brittle() ? elements->beside().breaking->breaks() :
                                     std::vector<BondBreak>();
      }

      std::vector<double> damage() const override
      {
        return elements->brittle() ? elements->beside().breaking->damage() : std::vector<double>();
      }

      Point<dim> position(const unsigned int node) const override
      {
        return elements->position(node);
      }

      double volume(const unsigned int node) const override
      {
        return elements->volume(node);
      }

      std::vector<double> at_points(const PointEvaluator<dim>              &reader,
                                    const std::vector<std::vector<double>> &points) const override
      {
        std::array<std::vector<double>, dim>         u;
        std::array<std::vector<Tensor<1, dim>>, dim> slopes, relaxed;
        Vector                                       change_by_law = find_relaxation();
        change_by_law.set_ghost_state(false);
        for (unsigned int d = 0; d < dim; ++d)
          {
            u[d]      = reader.evaluate(solution, dim, d);
            slopes[d] = reader.gradients(solution, dim, d);
            if (change_by_law.size() > 0)
              relaxed[d] = reader.gradients(change_by_law, dim, d);
          }
        std::vector<double> changes; // of the temperature
        if (const Vector change(elements->temperature_change()); change.size() > 0)
          changes = reader.evaluate(change);
        else
          for (unsigned int k = 0; k < points.size(); ++k)
            changes.push_back(reader.is_gap(k) ? 0. :
                                                 scene.elasticity.temperature_change.value(
                                                   reader.inner_points()[k]));
        const auto          velocities = velocities_at_points(scene, reader, this->velocity);
        const auto          by_law     = stresses_by_law(reader);
        std::vector<double> rows;
        for (std::size_t k = 0; k < points.size(); ++k)
          {
            if (reader.is_gap(k)) // where the material may have no moduli
              {
                rows.insert(rows.end(),
                            solid_columns(scene).size(),
                            std::numeric_limits<double>::quiet_NaN());
                continue;
              }
            Tensor<2, dim> gradient, by_relaxation;
            double         values[dim];
            for (unsigned int d = 0; d < dim; ++d)
              {
                values[d]   = u[d][k];
                gradient[d] = slopes[d][k];
                if (!relaxed[d].empty())
                  by_relaxation[d] = relaxed[d][k];
              }
            const Point<dim>     &p = reader.inner_points()[k];
            SymmetricTensor<2, 3> stress =
              by_law.empty() ? stress_of_strain(symmetrize(gradient), scene, p, changes[k]) :
                               by_law[k];
            if (change_by_law.size() > 0)
              stress += shear_stress(symmetrize(by_relaxation), scene, p);
            append_row(values, stress, dim, rows);
            if (scene.elasticity.computes_temperature)
              rows.push_back(changes[k] + scene.elasticity.reference_temperature);
            for (const std::vector<double> &component : velocities)
              rows.push_back(component[k]);
          }
        return rows;
      }

      std::vector<OutputField> fields() const override
      {
        std::vector<SymmetricTensor<2, 3>>   stress;
        std::vector<SymmetricTensor<2, dim>> strain;
        find_nodal_tensors(stress, strain);
        NodalFields<dim> list(elements->node_layout());
        list.add_vector("displacement", solution);
        if (this->velocity.size() > 0)
          list.add_vector("velocity", this->velocity);
        list.add_stress(stress);
        list.add_strain(strain);
        list.add_temperature(elements->temperature_change(), scene);
        if (const auto *const stresses = elements->beside().stresses)
          for (const auto &[name, number] : stresses->law().shown())
            {
              const std::vector<double> values =
                nodal_means([&](const LawPoint &point) { return point.state[number]; });
              list.add(name, [&](const unsigned int i) { return values[i]; });
            }
        if (const std::vector<double> lost = damage(); !lost.empty())
          {
            list.add("damage", [&](const unsigned int i) { return lost[i]; });
            list.add("zone",
                     [&](const unsigned int i) { return elements->bonds().in_zone(i) ? 1. : 0.; });
          }
        return list.take();
      }

      SymmetricTensor<2, 3> mean_stress() const override
      {
        SymmetricTensor<2, 3> sum;
        double                volume = 0.;
        visit_cells(
          QGauss<dim>(handler.get_fe().degree + 1),
          [&](const auto &values, const unsigned int q, const auto &indices, const auto &gradient) {
            if (!scene.domain.shows(values.get_cell()->center()))
              return;
            volume += values.JxW(q);
            if (!elements->cut_cells()[values.get_cell()->active_cell_index()])
              sum +=
                values.JxW(q) * stress_at(values, q, indices, gradient, values.quadrature_point(q));
          });
        return Utilities::MPI::sum(sum, handler.get_communicator()) /
               Utilities::MPI::sum(volume, handler.get_communicator());
      }

      std::vector<double> entropies_of_deformation(const Vector &change) const override
      {
        // At nodes beside cells that carry nothing, of all of their volume the mean of the others.
        Vector sums(elements->node_layout()), parts(elements->node_layout());
        change.update_ghost_values();
        visit_cells(
          QGauss<dim>(handler.get_fe().degree + 1),
          [&](const auto &values, const unsigned int q, const auto &indices, const auto &gradient) {
            if (elements->cut_cells()[values.get_cell()->active_cell_index()])
              return;
            const Point<dim> p = values.quadrature_point(q);
            const double     entropy =
              entropy_of_deformation(scene.moduli(p),
                                     scene.material.thermal_expansion.value(p), // of no T
                                     dim,
                                     scene.elasticity.plane,
                                     trace(gradient),
                                     value_at(values, q, indices, change));
            for (unsigned int i = 0; i < indices.size(); ++i)
              {
                const double part = values.JxW(q) * values.shape_value(i, q);
                sums(indices[i]) += part * entropy;
                parts(indices[i]) += part;
              }
          });
        change.set_ghost_state(false);
        sums.compress(VectorOperation::add);
        parts.compress(VectorOperation::add);
        std::vector<double> entropies(sums.locally_owned_size(), 0.);
        for (unsigned int i = 0; i < entropies.size(); ++i)
          if (parts.local_element(i) != 0.)
            entropies[i] = volume(i) * sums.local_element(i) / parts.local_element(i);
        return entropies;
      }

      std::vector<StressIntensity> stress_intensities(const double time) const override
      {
        if (scene.elasticity.has_full_kinematics()) // they are those of small strains
          return {};
        if constexpr (dim > 1)
          return intensities_of_cells(scene,
                                      *elements,
                                      handler,
                                      solution,
                                      model == ModelKind::coupled,
                                      time);
        else
          return {};
      }

      std::vector<StressSample> stress_samples() const override
      {
        std::vector<StressSample> samples;
        visit_cells(
          QGauss<dim>(handler.get_fe().degree + 1),
          [&](const auto &values, const unsigned int q, const auto &indices, const auto &gradient) {
            if (elements->cut_cells()[values.get_cell()->active_cell_index()] ||
                !scene.domain.shows(values.get_cell()->center()))
              return;
            if (q == 0)
              samples.push_back(
                {scene.material.phases.all().at(values.get_cell()->center()), 0., {}});
            samples.back().volume += values.JxW(q);
            samples.back().stress +=
              values.JxW(q) * stress_at(values, q, indices, gradient, values.quadrature_point(q));
          });
        for (StressSample &sample : samples)
          sample.stress /= sample.volume;
        return samples;
      }

      ChosenSettings settings() const override
      {
        ChosenSettings list;
        list.emplace_back("elements", "Q" + std::to_string(degree()));
        if (const std::string law = law_text(scene, model); !law.empty())
          list.emplace_back("law", law);
        if (model == ModelKind::coupled)
          {
            list.emplace_back("coupling", scene.coupling.scheme_text());
            list.emplace_back("zone", scene.coupling.zone_text());
            list.emplace_back("share of the body in the zone",
                              rounded_text(100. * elements->bonds().zone_share(), 6) + " %");
          }
        if (model == ModelKind::coupled)
          for (auto setting : this->bond_settings(elements->bonds().families()))
            {
              // Bonds of the zone are not continued beyond sides by themselves.
              if (setting.first == "surface correction" &&
                  scene.peridynamics.surface_correction == SurfaceCorrection::automatic)
                setting.second = "auto: none";
              list.push_back(setting);
            }
        if (!scene.cracks.cracks.empty())
          list.emplace_back("cracks", scene.cracks.on_faces() ? "faces" : "removed");
        return list;
      }

      std::vector<std::string> notes() const override
      {
        std::vector<std::string> list;
        if (scene.material.law.softens())
          list.push_back(
            "stress in the results of 'coupled' is that of the linear law of its cells, in the zone, too, where bonds that have softened bear less: see 'damage'.");
        if (scene.material.law.kind == SolidLaw::formula)
          list.push_back(
            "stress in the results of 'coupled' is that of the linear law of its cells, in the zone, too, where bonds bear what 'Bond force' (section 'Material') says.");
        const bool is_nodal = model == ModelKind::coupled && scene.elasticity.is_correspondence();
        if (is_nodal && elements->brittle())
          list.push_back(note_on_nodal_cracks());
        if (!this->certificate || this->certificate->fault().empty())
          return list;
        list.push_back(
          "'Scheme = " + scene.coupling.scheme_text() +
          "' in section 'Coupling': " + this->certificate->fault() +
          ". A zone that stays more than two horizons clear of the sides, and a wider 'Overlap', make it less" +
          (is_nodal ? "." : "; 'exchange' has none of it."));
        return list;
      }

    private:
      void certify()
      {
        Timings::Scope scope(this->timings, "certificate");
        // Where nodes join the zone later, as if they had.
        std::unique_ptr<ElasticElements<dim>> at_end;
        if (elements->zone_follows_cracks())
          {
            at_end = std::make_unique<ElasticElements<dim>>(
              handler,
              scene,
              make_solid_coupling(this->on.nodes(scene, NodalVolume::partial), scene));
            at_end->join_whole_way();
          }
        const auto found = examine_coupling(at_end ? *at_end : *elements);
        if (scene.coupling.exchanges()) // of the others the user is told
          found.require_sound();
        this->certificate = std::make_shared<CouplingCertificate>(found);
      }

      unsigned int degree() const
      {
        return model == ModelKind::finite_elements ? scene.finite_elements.degree : 1;
      }

      static Tensor<2, dim> gradient_of(const Vector                               &u,
                                        const FEValues<dim>                        &values,
                                        const unsigned int                          q,
                                        const std::vector<types::global_dof_index> &indices)
      {
        Tensor<2, dim> gradient;
        for (unsigned int i = 0; i < indices.size(); ++i)
          for (unsigned int d = 0; d < dim; ++d)
            gradient[d] += u(dim * indices[i] + d) * values.shape_grad(i, q);
        return gradient;
      }

      /**
       * Call visit(values, point, indices of the nodes, gradient of the displacement) at the points
       * of all own cells.
       */
      template <typename Visit>
      void visit_cells(const Quadrature<dim> &points, const Visit &visit) const
      {
        FEValues<dim>                        values(handler.get_fe(),
                             points,
                             update_values | update_gradients | update_quadrature_points |
                               update_JxW_values);
        std::vector<types::global_dof_index> indices(handler.get_fe().n_dofs_per_cell());
        relaxation           = find_relaxation();
        const auto *stresses = elements->beside().stresses;
        if (stresses)
          of_law.nearest = nearest_points(points, handler.get_fe().degree);
        solution.update_ghost_values();
        for (const auto &cell : handler.active_cell_iterators())
          if (cell->is_locally_owned())
            {
              values.reinit(cell);
              cell->get_dof_indices(indices);
              of_law.points = stresses ? &stresses->points_of(cell, solution) : nullptr;
              for (const unsigned int q : values.quadrature_point_indices())
                visit(values, q, indices, gradient_of(solution, values, q, indices));
            }
        if (stresses)
          stresses->throw_faults();
        solution.set_ghost_state(false);
      }

      /** What numbers of nodes, with current ghosts, are at the point q of a cell. */
      static double value_at(const FEValues<dim>                        &values,
                             const unsigned int                          q,
                             const std::vector<types::global_dof_index> &indices,
                             const Vector                               &at_nodes)
      {
        double value = 0.;
        for (unsigned int i = 0; i < indices.size(); ++i)
          value += at_nodes(indices[i]) * values.shape_value(i, q);
        return value;
      }

      /** What a law that relaxes makes of the displacements, less these; empty: none does. */
      Vector find_relaxation() const
      {
        Vector          change;
        const NodalLaw *law = elements->beside().law;
        if (law == nullptr || !law->relaxes())
          return change;
        change.reinit(solution);
        const bool is_known = solution.has_ghost_elements();
        solution.update_ghost_values();
        law->find_change(change, solution);
        solution.set_ghost_state(is_known);
        return change;
      }

      using LawPoint = typename StressCells<dim>::LawPoint;

      /**
       * Of a number that a law knows at points: means over the cells around each node, by their
       * volumes, of its value at the point that is nearest to the node. (What follows from points
       * that yield is not beyond the yield stress itself.)
       */
      template <typename Number>
      std::vector<double> nodal_means(const Number &number) const
      {
        Vector sums(elements->node_layout()), volumes(elements->node_layout());
        visit_cells(
          Quadrature<dim>(handler.get_fe().get_unit_support_points()),
          [&](const auto &values, const unsigned int q, const auto &indices, const auto &) {
            if (elements->cut_cells()[values.get_cell()->active_cell_index()])
              return;
            const double size = values.get_cell()->measure();
            sums(indices[q]) += size * number((*of_law.points)[of_law.nearest[q]]);
            volumes(indices[q]) += size;
          });
        sums.compress(VectorOperation::add);
        volumes.compress(VectorOperation::add);
        std::vector<double> means(sums.locally_owned_size(), 0.);
        for (unsigned int i = 0; i < means.size(); ++i)
          if (volumes.local_element(i) > 0.)
            means[i] = sums.local_element(i) / volumes.local_element(i);
        return means;
      }

      /** The stress of a law, between its nodal means. Empty: there is none. Collective. */
      std::vector<SymmetricTensor<2, 3>> stresses_by_law(const PointEvaluator<dim> &reader) const
      {
        std::vector<SymmetricTensor<2, 3>> stresses;
        if (elements->beside().stresses == nullptr)
          return stresses;
        std::vector<SymmetricTensor<2, 3>>   means;
        std::vector<SymmetricTensor<2, dim>> strains;
        find_nodal_tensors(means, strains);
        Vector component(elements->node_layout());
        for (unsigned int k = 0; k < SymmetricTensor<2, 3>::n_independent_components; ++k)
          {
            for (unsigned int i = 0; i < means.size(); ++i)
              component.local_element(i) = means[i].access_raw_entry(k);
            const std::vector<double> values = reader.evaluate(component);
            stresses.resize(values.size());
            for (std::size_t p = 0; p < values.size(); ++p)
              stresses[p].access_raw_entry(k) = values[p];
          }
        return stresses;
      }

      /** The stress in a cell, with the material at p and the temperature at the point q. */
      SymmetricTensor<2, 3> stress_at(const FEValues<dim>                        &values,
                                      const unsigned int                          q,
                                      const std::vector<types::global_dof_index> &indices,
                                      const Tensor<2, dim>                       &gradient,
                                      const Point<dim>                           &p) const
      {
        if (of_law.points != nullptr)
          return elements->beside().stresses->stress_at(of_law.nearest[q]);
        const Vector &at_nodes = elements->temperature_change();
        const double  change = at_nodes.size() == 0 ? scene.elasticity.temperature_change.value(p) :
                                                      value_at(values, q, indices, at_nodes);
        SymmetricTensor<2, 3> stress = stress_of_strain(symmetrize(gradient), scene, p, change);
        if (relaxation.size() > 0)
          stress += shear_stress(symmetrize(gradient_of(relaxation, values, q, indices)), scene, p);
        return stress;
      }

      /**
       * Means over the cells around each node, by their volumes. Each cell's own material counts,
       * so that a jump is smeared over one row of cells.
       */
      void find_nodal_tensors(std::vector<SymmetricTensor<2, 3>>   &stress,
                              std::vector<SymmetricTensor<2, dim>> &strain) const
      {
        constexpr unsigned int n_stresses = SymmetricTensor<2, 3>::n_independent_components,
                               n_strains  = SymmetricTensor<2, dim>::n_independent_components;
        const auto         &fe            = handler.get_fe();
        std::vector<Vector> sums(n_stresses + 1 + n_strains);
        for (Vector &sum : sums)
          sum.reinit(elements->node_layout());
        visit_cells(
          Quadrature<dim>(fe.get_unit_support_points()),
          [&](const auto &values, const unsigned int q, const auto &indices, const auto &gradient) {
            SymmetricTensor<2, dim> e = symmetrize(gradient);
            if (scene.elasticity.has_full_kinematics())
              e += 0.5 * symmetrize(transpose(gradient) * gradient);
            const auto &cell = values.get_cell();
            if (elements->cut_cells()[cell->active_cell_index()])
              return; // it carries nothing
            const double size = cell->measure();
            // The material inside the cell, not at its edge.
            const Point<dim> p =
              values.quadrature_point(q) + 1e-6 * (cell->center() - values.quadrature_point(q));
            const SymmetricTensor<2, 3> s = stress_at(values, q, indices, gradient, p);
            for (unsigned int k = 0; k < n_stresses; ++k)
              sums[k](indices[q]) += s.access_raw_entry(k) * size;
            sums[n_stresses](indices[q]) += size;
            for (unsigned int k = 0; k < n_strains; ++k)
              sums[n_stresses + 1 + k](indices[q]) += e.access_raw_entry(k) * size;
          });
        for (Vector &sum : sums)
          sum.compress(VectorOperation::add);
        const unsigned int n = sums[0].locally_owned_size();
        stress.resize(n);
        strain.resize(n);
        for (unsigned int i = 0; i < n; ++i)
          {
            const double v = sums[n_stresses].local_element(i);
            if (v == 0.)
              continue; // all cells around are cut
            for (unsigned int k = 0; k < n_stresses; ++k)
              stress[i].access_raw_entry(k) = sums[k].local_element(i) / v;
            for (unsigned int k = 0; k < n_strains; ++k)
              strain[i].access_raw_entry(k) = sums[n_stresses + 1 + k].local_element(i) / v;
          }
      }

      const ModelKind                       model;
      std::unique_ptr<ElasticElements<dim>> elements;
      mutable Vector                        relaxation; // while cells are visited

      /** Of a law of stresses, while cells are visited. */
      struct OfLaw
      {
        const std::vector<typename StressCells<dim>::LawPoint> *points = nullptr;

        std::vector<unsigned int> nearest; // to those that are visited
      };
      mutable OfLaw of_law;
    };
  } // namespace


  template <int dim>
  std::unique_ptr<SolidField<dim>> make_element_solid(Model<dim> &model, const Scene<dim> &scene)
  {
    return std::make_unique<ElementSolid<dim>>(model, scene);
  }


  PERIDEAL_INSTANTIATE_FUNCTION(make_element_solid);
} // namespace PeriDeal
