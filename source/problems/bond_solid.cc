// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/analysis/bond_intensities.h>
#include <perideal/laws/entropy_of_deformation.h>
#include <perideal/operators/solid/state_operator.h>
#include <perideal/operators/solid/surface_stiffness.h>
#include <perideal/scene/beyond_sides.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "diffusion_parts.h"
#include "solid_fields.h"
#include "solid_scene_notes.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    class BondSolid : public SolidProblem<dim>
    {
    public:
      using SolidProblem<dim>::scene;

      BondSolid(Model<dim> &model, const Scene<dim> &scene)
        : SolidProblem<dim>(scene)
        , handler(model.dofs())
      {
        {
          Timings::Scope scope(this->timings, "unknowns");
          node_set = &make_bond_nodes(model, scene);
        }
        Timings::Scope scope(this->timings, "operator");
        states                       = std::make_unique<StateOperator<dim>>(*node_set, scene);
        const SolidBonds<dim> &bonds = states->bonds();
        if (families_end(scene))
          stiffer = surface_stiffness(bonds);
        if (bonds.thinnest < std::numeric_limits<double>::infinity())
          {
            double volume = 0.;
            for (unsigned int i = 0; i < node_set->n_owned(); ++i)
              volume += node_set->volume(i);
            spacing = std::pow(Utilities::MPI::sum(volume, handler.get_communicator()) /
                                 handler.get_triangulation().n_global_active_cells(),
                               1. / dim);
          }
      }

      std::string name() const override
      {
        return scene.general.name_of(ModelKind::peridynamics);
      }

      const DoFHandler<dim> &dofs() const override
      {
        return handler;
      }

      const Nodes<dim> *nodes() const override
      {
        return node_set;
      }

      ElasticOperator &op() const override
      {
        return *states;
      }

      const Families<dim> *families() const override
      {
        return states->brittle() ? &states->bonds().families : nullptr;
      }

      std::vector<BondBreak> breaks() const override
      {
        const auto            &layout = *node_set->partitioner();
        const BondRows<dim>   &rows   = states->bonds().rows.body;
        std::vector<BondBreak> list;
        std::size_t            n_known = 0;
        for (const auto &[number, time] : rows.state.marked_since(n_known))
          {
            const unsigned int i = rows.node_of(number), j = rows.neighbors[number];
            if (rows.state.is_broken(number) &&
                layout.local_to_global(i) < layout.local_to_global(j))
              list.push_back({i, j, time});
          }
        return list;
      }

      std::vector<double> damage() const override
      {
        return states->breaking().damage();
      }

      Point<dim> position(const unsigned int node) const override
      {
        return node_set->position(node);
      }

      double volume(const unsigned int node) const override
      {
        return node_set->volume(node);
      }

      std::vector<double> at_points(const PointEvaluator<dim>              &reader,
                                    const std::vector<std::vector<double>> &points) const override
      {
        constexpr unsigned int n_stresses = SymmetricTensor<2, 3>::n_independent_components;
        const auto             stress     = nodal_stress(states->tensors(this->displacement));
        std::vector<std::vector<double>> columns;
        for (unsigned int d = 0; d < dim; ++d)
          columns.push_back(reader.evaluate(this->displacement, dim, d));
        // Von Mises' stress of interpolated components would be smaller than that of the nodes: it
        // is interpolated itself.
        for (unsigned int k = 0; k <= n_stresses; ++k)
          {
            Vector values(node_set->partitioner());
            for (unsigned int i = 0; i < node_set->n_owned(); ++i)
              values.local_element(i) = k < n_stresses ? stress[i].access_raw_entry(k) :
                                                         von_mises(stress[i]);
            columns.push_back(reader.evaluate(values));
          }
        const std::vector<double> change     = changes_at_points(reader);
        const auto                velocities = velocities_at_points(scene, reader, this->velocity);
        std::vector<double>       rows;
        for (std::size_t k = 0; k < points.size(); ++k)
          {
            double                values[dim];
            SymmetricTensor<2, 3> at_point;
            for (unsigned int d = 0; d < dim; ++d)
              values[d] = columns[d][k];
            for (unsigned int c = 0; c < n_stresses; ++c)
              at_point.access_raw_entry(c) = columns[dim + c][k];
            append_row(values, at_point, dim, rows);
            rows.back() = columns.back()[k];
            if (!change.empty())
              rows.push_back(change[k] + scene.elasticity.reference_temperature);
            for (const std::vector<double> &component : velocities)
              rows.push_back(component[k]);
          }
        return rows;
      }

      std::vector<OutputField> fields(const double) const override
      {
        const NodalTensors<dim>   tensors = states->tensors(this->displacement);
        const std::vector<double> theta   = nodal_dilatations(states->bonds(), this->displacement);
        SolidFields<dim>          list(node_set->partitioner());
        list.add_vector("displacement", this->displacement);
        if (this->stepper)
          list.add_vector("velocity", this->velocity);
        list.add_stress(nodal_stress(tensors));
        list.add_strain(tensors.strain);
        list.add_temperature(states->temperature_change(), scene);
        list.add("dilatation", [&](const unsigned int i) { return theta[i]; });
        if (states->brittle() || !scene.cracks.cracks.empty())
          {
            const std::vector<double> lost = damage();
            list.add("damage", [&](const unsigned int i) { return lost[i]; });
            if (scene.material.scatter)
              list.add("critical_stretch", [&](const unsigned int i) {
                return states->breaking().critical_stretches()[i];
              });
          }
        list.add("node_volume", [&](const unsigned int i) { return node_set->volume(i); });
        return list.take();
      }

      SymmetricTensor<2, 3> mean_stress() const override
      {
        const auto            stress = nodal_stress(states->tensors(this->displacement));
        SymmetricTensor<2, 3> sum;
        double                volume = 0.;
        for (unsigned int i = 0; i < stress.size(); ++i)
          {
            sum += volume_in_body(i) * stress[i];
            volume += volume_in_body(i);
          }
        return Utilities::MPI::sum(sum, handler.get_communicator()) /
               Utilities::MPI::sum(volume, handler.get_communicator());
      }

      std::vector<double> entropies_of_deformation(const Vector &change) const override
      {
        // Of the displacement alone: the dilatations have thermal extensions taken off.
        Vector at_rest(this->displacement);
        at_rest                           = 0.;
        const std::vector<double> taken   = nodal_dilatations(states->bonds(), at_rest);
        std::vector<double>       entropy = nodal_dilatations(states->bonds(), this->displacement);
        for (unsigned int i = 0; i < entropy.size(); ++i)
          {
            const Point<dim> &p = node_set->position(i);
            entropy[i]          = node_set->volume(i) *
                         entropy_of_deformation(scene.material.moduli(p),
                                                scene.material.thermal_expansion.value(p),
                                                dim,
                                                scene.elasticity.plane,
                                                entropy[i] - taken[i],
                                                change.local_element(i));
          }
        return entropy;
      }

      std::vector<StressIntensity> stress_intensities(const double time) const override
      {
        std::vector<StressIntensity> list;
        if constexpr (dim > 1)
          {
            const ThermalStrains &thermal = states->bonds().thermal;
            this->displacement.update_ghost_values();
            list = bond_intensities<dim>(
              scene,
              states->bonds().families,
              [&](const unsigned int i, const unsigned int k) {
                return k < dim ? this->displacement.local_element(dim * i + k) : thermal[i];
              },
              thermal.any(),
              time,
              states->crack_time());
            this->displacement.set_ghost_state(false);
          }
        return list;
      }

      std::vector<StressSample> stress_samples() const override
      {
        const auto                stress = nodal_stress(states->tensors(this->displacement));
        std::vector<StressSample> samples;
        for (unsigned int i = 0; i < stress.size(); ++i)
          if (const double volume = volume_in_body(i); volume > 0.)
            samples.push_back(
              {scene.material.phases.all().at(node_set->position(i)), volume, stress[i]});
        return samples;
      }

      std::vector<std::pair<std::string, std::string>> settings() const override
      {
        auto list = bond_settings(scene, states->bonds().families);
        if (!states->brittle())
          return list;
        double lowest = 1e300, highest = 0.;
        for (const double s : states->breaking().critical_stretches())
          {
            lowest  = std::min(lowest, s);
            highest = std::max(highest, s);
          }
        lowest  = Utilities::MPI::min(lowest, handler.get_communicator());
        highest = Utilities::MPI::max(highest, handler.get_communicator());
        list.emplace_back("critical stretch",
                          number_text(lowest) +
                            (highest > lowest ? " to " + number_text(highest) : ""));
        return list;
      }

      std::vector<std::string> notes() const override
      {
        constexpr double  tolerable = 1e-8;
        const std::string entry     = "'Surface correction = moments' in section 'Peridynamics' ";
        const unsigned long long n  = states->bonds().corrections.n_left;
        std::vector<std::string> list;
        for (const std::string &note :
             {note_on_cut_sides(scene), note_on_stiff_surfaces(), note_on_held_rows(scene)})
          if (!note.empty())
            list.push_back(note);
        if (dim > 1 && scene.elasticity.model == ElasticModel::bond_based &&
            scene.elasticity.micromodulus == Micromodulus::family)
          list.push_back(
            "'Model = bond-based' in section 'Elasticity' divides the stiffness of a bond by sums over the families of its ends, which are smaller at surfaces: these are "
            "stiffer than those of the prototype microelastic material, which has the same constant everywhere. 'Micromodulus = constant' is that one.");
        if (n > 0)
          list.push_back(
            entry + "leaves " + std::to_string(n) + " of " + std::to_string(node_set->n_global()) +
            " nodes as they are, whose bonds would get negative factors, as in convex corners and beside the ends of cracks.");
        if (states->bonds().corrections.gap > tolerable)
          list.push_back(
            entry +
            "has not found all factors: moments of families differ from those of a complete one by up to " +
            number_text(states->bonds().corrections.gap) + " of them.");
        const auto  &family   = states->bonds().families.weights().members();
        const double thinnest = states->bonds().thinnest;
        for (const std::string &note :
             {note_on_few_bonds(scene, family),
              note_on_bending(scene),
              spacing > 0. ? note_on_thin_parts(thinnest / spacing,
                                                scene.horizon() / spacing,
                                                completes_at_surfaces<dim>(scene)) :
                             "",
              states->brittle() ? note_on_trapping(scene, family) : "",
              note_on_critical_stretch()})
          if (!note.empty())
            list.push_back(note);
        return list;
      }

    private:
      std::string note_on_critical_stretch() const
      {
        if (!states->brittle() || scene.material.fracture_energy || scene.material.scatter ||
            !scene.domain.has_lattice() || states->bonds().families.nodes().n_owned() == 0)
          return {};
        const auto [energy, of_ball] = states->breaking().energies_of_first();
        return note_on_stretch(scene, energy, of_ball);
      }

      /** Without what lies in extra layers: half of a vertex on a side of the body. */
      double volume_in_body(const unsigned int i) const
      {
        const Domain<dim> &domain = scene.domain;
        const Point<dim>  &p      = node_set->position(i);
        double             volume = node_set->volume(i);
        if (!domain.has_extra_layers())
          return volume;
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double slack = 1e-9 * (domain.upper[d] - domain.lower[d]);
            if ((domain.extra.layers[2 * d] > 0 && p[d] < domain.extra.body_lower[d] + slack) ||
                (domain.extra.layers[2 * d + 1] > 0 && p[d] > domain.extra.body_upper[d] - slack))
              volume *= 0.5;
          }
        return domain.shows(p) ? volume : 0.;
      }

      std::vector<SymmetricTensor<2, 3>> nodal_stress(const NodalTensors<dim> &tensors) const
      {
        std::vector<SymmetricTensor<2, 3>> stress;
        const Vector                      &change = states->temperature_change();
        for (unsigned int i = 0; i < node_set->n_owned(); ++i)
          {
            const Point<dim> &p = node_set->position(i);
            stress.push_back(full_stress(tensors.stress[i],
                                         scene,
                                         p,
                                         change.size() > 0 ?
                                           change.local_element(i) :
                                           scene.elasticity.temperature_change.value(p)));
          }
        return stress;
      }

      /** Of the temperature where it is computed, else none. */
      std::vector<double> changes_at_points(const PointEvaluator<dim> &reader) const
      {
        if (states->temperature_change().size() == 0)
          return {};
        const Vector change(states->temperature_change());
        return reader.evaluate(change);
      }

      /** In figures what families that end at surfaces do to the stiffness. */
      std::string note_on_stiff_surfaces() const
      {
        constexpr double tolerable = 0.01;
        std::string      axes;
        for (unsigned int d = 0; d < dim; ++d)
          if (std::abs(stiffer[d]) > tolerable)
            axes += std::string(axes.empty() ? "" : ", ") +
                    (stiffer[d] > 0. ? "stiffer" : "softer") + " by about " +
                    number_text(std::round(1000. * std::abs(stiffer[d])) / 10.) + " % along " +
                    std::string(1, "xyz"[d]);
        if (axes.empty())
          return {};
        return "Families of peridynamics that end at surfaces make this body, if it is stretched as a whole, " +
               axes +
               " than its Young's modulus (mean over its nodes); the speed of waves changes by half of that.";
      }

      const DoFHandler<dim>              &handler;
      Nodes<dim>                         *node_set = nullptr; // of the model
      std::unique_ptr<StateOperator<dim>> states;
      Tensor<1, dim>                      stiffer;      // by families that end, along the axes
      double                              spacing = 0.; // of a mesh with thin parts
    };
  } // namespace


  template <int dim>
  std::unique_ptr<SolidProblem<dim>> make_bond_solid(Model<dim> &model, const Scene<dim> &scene)
  {
    return std::make_unique<BondSolid<dim>>(model, scene);
  }

#define PERIDEAL_INSTANTIATE(dim) \
  template std::unique_ptr<SolidProblem<dim>> make_bond_solid(Model<dim> &, const Scene<dim> &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
