// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/vector_operation.h>

#include <perideal/analysis/coupling_certificate.h>
#include <perideal/base/user_error.h>
#include <perideal/laws/entropy_of_deformation.h>
#include <perideal/operators/solid/elastic_elements.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "diffusion_parts.h"
#include "element_intensities.h"
#include "solid_fields.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    class ElementSolid : public SolidProblem<dim>
    {
    public:
      using SolidProblem<dim>::scene;

      /** @param on finite elements or coupled */
      ElementSolid(Model<dim> &on, const Scene<dim> &scene)
        : SolidProblem<dim>(scene)
        , model(on.kind)
        , handler(on.dofs())
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
        if (model == ModelKind::coupled && scene.coupling.certificate &&
            elements->mirrors().empty())
          certify(on);
      }

      std::string name() const override
      {
        return scene.general.name_of(model);
      }

      const DoFHandler<dim> &dofs() const override
      {
        return handler;
      }

      const Nodes<dim> *nodes() const override
      {
        return nullptr;
      }

      ElasticOperator &op() const override
      {
        return *elements;
      }

      const Families<dim> *families() const override
      {
        return elements->brittle() ? &elements->bonds().families() : nullptr;
      }

      std::vector<BondBreak> breaks() const override
      {
        return elements->breaks();
      }

      std::vector<double> damage() const override
      {
        return elements->damage();
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
        std::array<std::vector<Tensor<1, dim>>, dim> slopes;
        for (unsigned int d = 0; d < dim; ++d)
          {
            u[d]      = reader.evaluate(this->displacement, dim, d);
            slopes[d] = reader.gradients(this->displacement, dim, d);
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
            Tensor<2, dim> gradient;
            double         values[dim];
            for (unsigned int d = 0; d < dim; ++d)
              {
                values[d]   = u[d][k];
                gradient[d] = slopes[d][k];
              }
            append_row(
              values,
              stress_of_strain(symmetrize(gradient), scene, reader.inner_points()[k], changes[k]),
              dim,
              rows);
            if (scene.elasticity.computes_temperature)
              rows.push_back(changes[k] + scene.elasticity.reference_temperature);
            for (const std::vector<double> &component : velocities)
              rows.push_back(component[k]);
          }
        return rows;
      }

      std::vector<OutputField> fields(const double) const override
      {
        std::vector<SymmetricTensor<2, 3>>   stress;
        std::vector<SymmetricTensor<2, dim>> strain;
        find_nodal_tensors(stress, strain);
        SolidFields<dim> list(elements->node_layout());
        list.add_vector("displacement", this->displacement);
        if (this->stepper)
          list.add_vector("velocity", this->velocity);
        list.add_stress(stress);
        list.add_strain(strain);
        list.add_temperature(elements->temperature_change(), scene);
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
            const Point<dim> p       = values.quadrature_point(q);
            const double     entropy = entropy_of_deformation(scene.material.moduli(p),
                                                          scene.material.thermal_expansion.value(p),
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
        if constexpr (dim > 1)
          return intensities_of_cells(scene,
                                      *elements,
                                      handler,
                                      this->displacement,
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

      std::vector<std::pair<std::string, std::string>> settings() const override
      {
        std::vector<std::pair<std::string, std::string>> list;
        list.emplace_back("elements", "Q" + std::to_string(degree()));
        if (model == ModelKind::coupled)
          {
            list.emplace_back("coupling", scene.coupling.scheme_text());
            list.emplace_back("zone", scene.coupling.zone_text());
            list.emplace_back("share of the body in the zone",
                              to_text(100. * elements->bonds().zone_share()) + " %");
          }
        if (model == ModelKind::coupled)
          for (auto setting : bond_settings(scene, elements->bonds().families()))
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
        if (!certificate || certificate->fault().empty())
          return {};
        return {
          "'Scheme = " + scene.coupling.scheme_text() +
          "' in section 'Coupling': " + certificate->fault() +
          ". A zone that stays more than two horizons clear of the sides, and a wider 'Overlap', make it less; 'exchange' has none of it."};
      }

      const CouplingCertificate *examined() const override
      {
        return certificate ? &*certificate : nullptr;
      }

    private:
      void certify(Model<dim> &on)
      {
        Timings::Scope scope(this->timings, "certificate");
        // Where nodes join the zone later, as if they had.
        std::unique_ptr<ElasticElements<dim>> at_end;
        if (elements->zone_follows_cracks())
          {
            at_end = std::make_unique<ElasticElements<dim>>(
              handler,
              scene,
              make_solid_coupling(on.nodes(scene, NodalVolume::partial), scene));
            at_end->join_whole_way();
          }
        certificate = examine_coupling(at_end ? *at_end : *elements);
        if (scene.coupling.exchanges()) // of the others the user is told
          certificate->require_sound();
      }

      unsigned int degree() const
      {
        return model == ModelKind::finite_elements ? scene.finite_elements.degree : 1;
      }

      /**
       * Call visit(values, point, indices of the nodes, gradient of the displacement) at the points
       * of all own cells, or of those that are chosen.
       */
      template <typename Visit>
      void visit_cells(const Quadrature<dim> &points, const Visit &visit) const
      {
        visit_cells(points, visit, [](const auto &) { return true; });
      }

      template <typename Visit, typename Choose>
      void visit_cells(const Quadrature<dim> &points,
                       const Visit           &visit,
                       const Choose          &choose) const
      {
        FEValues<dim>                        values(handler.get_fe(),
                             points,
                             update_values | update_gradients | update_quadrature_points |
                               update_JxW_values);
        std::vector<types::global_dof_index> indices(handler.get_fe().n_dofs_per_cell());
        this->displacement.update_ghost_values();
        for (const auto &cell : handler.active_cell_iterators())
          if (cell->is_locally_owned() && choose(cell))
            {
              values.reinit(cell);
              cell->get_dof_indices(indices);
              for (const unsigned int q : values.quadrature_point_indices())
                {
                  Tensor<2, dim> gradient;
                  for (unsigned int i = 0; i < indices.size(); ++i)
                    for (unsigned int d = 0; d < dim; ++d)
                      gradient[d] +=
                        this->displacement(dim * indices[i] + d) * values.shape_grad(i, q);
                  visit(values, q, indices, gradient);
                }
            }
        this->displacement.set_ghost_state(false);
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

      /** The stress in a cell, with the material at p and the temperature at the point q. */
      SymmetricTensor<2, 3> stress_at(const FEValues<dim>                        &values,
                                      const unsigned int                          q,
                                      const std::vector<types::global_dof_index> &indices,
                                      const Tensor<2, dim>                       &gradient,
                                      const Point<dim>                           &p) const
      {
        const Vector &at_nodes = elements->temperature_change();
        const double  change = at_nodes.size() == 0 ? scene.elasticity.temperature_change.value(p) :
                                                      value_at(values, q, indices, at_nodes);
        return stress_of_strain(symmetrize(gradient), scene, p, change);
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
            const SymmetricTensor<2, dim> e    = symmetrize(gradient);
            const auto                   &cell = values.get_cell();
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
      const DoFHandler<dim>                &handler;
      std::unique_ptr<ElasticElements<dim>> elements;
      std::optional<CouplingCertificate>    certificate;
    };
  } // namespace


  template <int dim>
  std::unique_ptr<SolidProblem<dim>> make_element_solid(Model<dim> &model, const Scene<dim> &scene)
  {
    return std::make_unique<ElementSolid<dim>>(model, scene);
  }

#define PERIDEAL_INSTANTIATE(dim) \
  template std::unique_ptr<SolidProblem<dim>> make_element_solid(Model<dim> &, const Scene<dim> &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
