// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_dgq.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>

#include <perideal/analysis/heat_flux.h>
#include <perideal/operators/bond_operator.h>
#include <perideal/operators/coupling.h>
#include <perideal/operators/fem_operator.h>
#include <perideal/simulation/model_run.h>

#include <sstream>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    std::string to_text(const double x)
    {
      std::ostringstream out;
      out << x;
      return out.str();
    }


    template <int dim>
    OutputField vector_field(const std::string &name, VectorField<dim> &components)
    {
      OutputField field;
      field.name = name;
      for (Vector &component : components)
        {
          component.update_ghost_values();
          field.components.push_back(std::move(component));
        }
      return field;
    }


    template <int dim>
    class FEMRun : public ModelRun<dim>
    {
    public:
            /** @param model finite elements, coupled, or peridynamics by exchange, which is `coupled` with the zone everywhere */
      FEMRun(const Model model, const Triangulation<dim> &mesh, const Scene<dim> &scene)
        : scene(scene)
        , model(model)
                , element(model == Model::finite_elements ? scene.finite_elements.degree : 1)
        , handler(mesh)
      {
        {
          Timings::Scope scope(this->timings, "unknowns");
          handler.distribute_dofs(element);
          if (scene.domain.shape != Shape::mesh_file && element.degree == 1)
            number_along_lattice(handler, scene.domain);
        }
                Timings::Scope                 scope(this->timings, "operator");
        std::unique_ptr<Coupling<dim>> coupling;
                if (model != Model::finite_elements)
          {
            node_set =  std::make_unique<Nodes<dim>>(handler,
                                                    scene.domain,
                                                    scene.cracks,
                                                    NodalVolume::partial);
                        coupling = make_coupling(*node_set,
                                     scene,
                                     model == Model::coupled ?
                                       Zone<dim>(scene.coupling, scene.horizon()) :
                                       Zone<dim>());
          }
        fem = std::make_unique<FEMOperator<dim>>(handler, scene, std::move(coupling));
      }

      std::string name() const override
      {
                return to_string(model);
      }

      const DoFHandler<dim> &dofs() const override
      {
        return handler;
      }

            const Nodes<dim> *nodes() const override
      {
        return model == Model::peridynamics ? node_set.get() : nullptr;
      }

      Operator &op() const override
      {
        return *fem;
      }

      bool update(const double t) override
      {
        return fem->update(t);
      }

      void set_initial_value(Vector &u) const override
      {
                // Lumped projection for Q1, so that a jump inside a cell is averaged; interpolation for higher degrees, which it would spoil, and for
        // peridynamics, whose values are those of points.
        const bool                           project = element.degree == 1 && model != Model::peridynamics;
        FEValues<dim>                        values(element,
                             project ? Quadrature<dim>(QGauss<dim>(2)) :
                                                              Quadrature<dim>(element.get_unit_support_points()),
                             update_values | update_quadrature_points | update_JxW_values);
        Vector                               weight(u);
        std::vector<types::global_dof_index> indices(element.n_dofs_per_cell());
        u      = 0.;
        weight = 0.;
        for (const auto &cell : handler.active_cell_iterators())
          if (cell->is_locally_owned())
            {
              values.reinit(cell);
              cell->get_dof_indices(indices);
              for (const unsigned int q : values.quadrature_point_indices())
                for (unsigned int i = 0; i < indices.size(); ++i)
                  {
                    const double share = project ? values.shape_value(i, q) * values.JxW(q) :
                                                   (i == q ? 1. : 0.);
                    if (share == 0.)
                      continue;
                    weight(indices[i]) += share;
                    u(indices[i]) += share * scene.initial_and_source.initial_value.value(
                                               values.quadrature_point(q));
                  }
            }
        u.compress(VectorOperation::add);
        weight.compress(VectorOperation::add);
        for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
          u.local_element(i) /= weight.local_element(i);
      }

      std::vector<OutputField> derived_fields(const Vector &u, const double) const override
      {
        VectorField<dim> flux;
        for (Vector &component : flux)
          fem->initialize_vector(component);
        element_heat_flux<dim>(handler, scene.material, fem->cut_cells(), u, flux);
                std::vector<OutputField> fields;
        fields.push_back(vector_field<dim>(names_of(scene.general.physics).flux, flux));
                if (model != Model::finite_elements)
          add_bond_fields(u, fields);
        if (scene.general.physics == Physics::moisture)
          {
            std::array<Vector, 1> concentration{u};
            for_each_node([&](const unsigned int i, const Point<dim> &p) {
              concentration[0].local_element(i) =
                scene.material.saturated_concentration.value(p) * u.local_element(i);
            });
            fields.push_back(vector_field<1>("concentration", concentration));
          }
        return fields;
      }

      double weight(const Vector &u) const override
      {
        FEValues<dim>       values(element,
                             QGauss<dim>(element.degree + 1),
                             update_values | update_quadrature_points | update_JxW_values);
        std::vector<double> wetness(values.n_quadrature_points);
        double              sum = 0.;
        u.update_ghost_values();
        for (const auto &cell : handler.active_cell_iterators())
          if (cell->is_locally_owned())
            {
              values.reinit(cell);
              values.get_function_values(u, wetness);
              for (const unsigned int q : values.quadrature_point_indices())
                sum += scene.material.saturated_concentration.value(values.quadrature_point(q)) *
                       wetness[q] * values.JxW(q);
            }
        u.set_ghost_state(false);
        return Utilities::MPI::sum(sum, handler.get_communicator());
      }

      Difference error(const Vector                                    &u,
                       const std::function<double(const Point<dim> &)> &exact) const override
      {
                if (scene.cracks.cracks.empty() || scene.cracks.mesh == CrackMesh::faces ||
            element.degree > 1)
          return element_difference(handler, u, exact);
        // Inside a cut cell the interpolant runs across the crack: only the values at the nodes are the model's.
        Vector expected(u), weights(u);
        for_each_node([&](const unsigned int i, const Point<dim> &p) {
          expected.local_element(i) = exact(p);
        });
        weights = 0.;
        FEValues<dim>                        values(element, QGauss<dim>(2), update_values | update_JxW_values);
        std::vector<types::global_dof_index> indices(element.n_dofs_per_cell());
        for (const auto &cell : handler.active_cell_iterators())
          if (cell->is_locally_owned())
            {
              values.reinit(cell);
              cell->get_dof_indices(indices);
              for (const unsigned int q : values.quadrature_point_indices())
                for (unsigned int i = 0; i < indices.size(); ++i)
                  weights(indices[i]) += values.shape_value(i, q) * values.JxW(q);
            }
        weights.compress(VectorOperation::add);
        return nodal_difference(u, expected, [&](const unsigned int i) {
          return weights.local_element(i);
        });
      }

      std::vector<std::pair<std::string, std::string>> settings() const override
      {
                std::vector<std::pair<std::string, std::string>> list{
          {"element", "Q" + std::to_string(element.degree)},
          {"capacity", scene.finite_elements.consistent_capacity ? "consistent" : "lumped"}};
                if (model != Model::finite_elements)
          {
            list.emplace_back("horizon", to_text(scene.horizon()));
            list.emplace_back("m", to_text(scene.horizon() / node_set->smallest_spacing()));
                        list.emplace_back("coupling", "exchange");
            list.emplace_back("zone",
                              model == Model::coupled ? scene.coupling.zone_text() : "everywhere");
            list.emplace_back("share of the body in the zone",
                              to_text(100. * fem->bonds().zone_share()) + " %");
          }
        if (!scene.cracks.cracks.empty())
          list.emplace_back("cracks",
                            scene.cracks.mesh == CrackMesh::pairs ? "pairs" :
                            scene.cracks.mesh == CrackMesh::faces ? "faces" :
                                                                    "removed");
        return list;
      }

    private:
            /** Which nodes are in the zone, and the part of their bonds that cracks have cut. */
      void add_bond_fields(const Vector &u, std::vector<OutputField> &fields) const
      {
        std::array<Vector, 1>                     zone{u}, cut{u};
        std::vector<typename Coupling<dim>::Bond> bonds;
        for (unsigned int i = 0; i < node_set->n_owned(); ++i)
          {
            zone[0].local_element(i) = fem->bonds().in_zone(i);
            cut[0].local_element(i)  = 0.;
            if (!fem->bonds().families().near_crack(i))
              continue;
            fem->bonds().bonds_of(i, bonds);
            double all = 0., gone = 0.;
            for (const auto &bond : bonds)
              {
                all += bond.intact;
                gone += bond.cut ? bond.intact : 0.;
              }
            cut[0].local_element(i) = all > 0. ? gone / all : 0.;
          }
        if (model == Model::coupled)
          fields.push_back(vector_field<1>("zone", zone));
        fields.push_back(vector_field<1>("cut_fraction", cut));
      }


      /** Call visit(local index, position) for each owned dof. */
      void for_each_node(
        const std::function<void(const unsigned int, const Point<dim> &)> &visit) const
      {
        FEValues<dim>                        values(element,
                             Quadrature<dim>(element.get_unit_support_points()),
                             update_quadrature_points);
        std::vector<types::global_dof_index> indices(element.n_dofs_per_cell());
        const auto                          &owned = this->solution.get_partitioner();
        for (const auto &cell : handler.active_cell_iterators())
          if (!cell->is_artificial())
            {
              values.reinit(cell);
              cell->get_dof_indices(indices);
              for (unsigned int i = 0; i < indices.size(); ++i)
                if (owned->in_local_range(indices[i]))
                  visit(owned->global_to_local(indices[i]), values.quadrature_point(i));
            }
      }

            const Scene<dim>                 &scene;
      const Model                       model;
      FE_Q<dim>                         element;
      DoFHandler<dim>                   handler;
      std::unique_ptr<Nodes<dim>>       node_set; // null for finite elements alone
      std::unique_ptr<FEMOperator<dim>> fem;
    };


    template <int dim>
    class BondRun : public ModelRun<dim>
    {
    public:
      BondRun(const Triangulation<dim> &mesh, const Scene<dim> &scene)
        : scene(scene)
        , handler(mesh)
      {
        {
          Timings::Scope scope(this->timings, "unknowns");
          if (scene.domain.nodes == NodePlacement::vertices)
            handler.distribute_dofs(FE_Q<dim>(1));
          else
            handler.distribute_dofs(FE_DGQ<dim>(0));
          if (scene.domain.shape != Shape::mesh_file)
            number_along_lattice(handler, scene.domain);
          node_set = std::make_unique<Nodes<dim>>(handler,
                                                  scene.domain,
                                                  scene.cracks,
                                                  scene.peridynamics.nodal_volume);
        }
        Timings::Scope scope(this->timings, "operator");
        bonds = std::make_unique<BondOperator<dim>>(*node_set, scene);
      }

      std::string name() const override
      {
        return to_string(Model::peridynamics);
      }

      const DoFHandler<dim> &dofs() const override
      {
        return handler;
      }

      const Nodes<dim> *nodes() const override
      {
        return node_set.get();
      }

      Operator &op() const override
      {
        return *bonds;
      }

      bool update(const double t) override
      {
        const bool changed = bonds->update(t);
        if (changed)
          cut.reinit(0);
        return changed;
      }

      void set_initial_value(Vector &u) const override
      {
        for (unsigned int i = 0; i < node_set->n_owned(); ++i)
          u.local_element(i) = scene.initial_and_source.initial_value.value(node_set->position(i));
      }

      std::vector<OutputField> derived_fields(const Vector &u, const double t) const override
      {
        VectorField<dim>    two_sided, one_sided;
        std::vector<double> outside;
        for (unsigned int d = 0; d < dim; ++d)
          {
            bonds->initialize_vector(two_sided[d]);
            bonds->initialize_vector(one_sided[d]);
          }
        bonds->fictitious_values(u, t, outside);
        bond_heat_flux<dim>(bonds->families(), u, outside, two_sided, one_sided);
        if (volume.size() == 0)
          {
            bonds->initialize_vector(volume);
            for (unsigned int i = 0; i < node_set->n_owned(); ++i)
              volume.local_element(i) = node_set->volume(i);
          }
        if (cut.size() == 0)
          {
            bonds->initialize_vector(cut);
            cut_fraction(bonds->families(), cut);
          }
        std::array<Vector, 1>    volumes{volume}, cuts{cut};
        std::vector<OutputField> fields;
        const std::string        name = names_of(scene.general.physics).flux;
        fields.push_back(vector_field<dim>(name, two_sided));
        fields.push_back(vector_field<dim>(name + "_one_sided", one_sided));
        if (scene.general.physics == Physics::moisture)
          {
            std::array<Vector, 1> concentration{u};
            for (unsigned int i = 0; i < node_set->n_owned(); ++i)
              concentration[0].local_element(i) =
                scene.material.saturated_concentration.value(node_set->position(i)) *
                u.local_element(i);
            fields.push_back(vector_field<1>("concentration", concentration));
          }
        fields.push_back(vector_field<1>("node_volume", volumes));
        fields.push_back(vector_field<1>("cut_fraction", cuts));
        return fields;
      }

      double weight(const Vector &u) const override
      {
        double sum = 0.;
        for (unsigned int i = 0; i < node_set->n_owned(); ++i)
          sum += scene.material.saturated_concentration.value(node_set->position(i)) *
                 node_set->volume(i) * u.local_element(i);
        return Utilities::MPI::sum(sum, handler.get_communicator());
      }

      Difference error(const Vector                                    &u,
                       const std::function<double(const Point<dim> &)> &exact) const override
      {
        Vector expected;
        bonds->initialize_vector(expected);
        for (unsigned int i = 0; i < node_set->n_owned(); ++i)
          expected.local_element(i) = exact(node_set->position(i));
        return nodal_difference(u, expected, [&](const unsigned int i) {
          return node_set->volume(i);
        });
      }

      std::vector<std::pair<std::string, std::string>> settings() const override
      {
        static const char *const kernels[]    = {"constant", "conical", "gaussian"};
        static const char *const fractions[]  = {"none", "linear", "exact"};
                        static const char *const treatments[] = {"auto", "exchange", "none",
                                                 "layer",
                                                 "fictitious mirror",
                                                 "fictitious constant"};
        static const char *const fluxes[]     = {"natural", "extrapolation", "layer extrapolation"};
        const Peridynamics      &p            = scene.peridynamics;
        std::vector<std::pair<std::string, std::string>> list{
          {"nodes", scene.domain.nodes == NodePlacement::vertices ? "vertices" : "cell centers"},
          {"horizon", to_text(scene.horizon())},
          {"m", to_text(scene.horizon() / node_set->smallest_spacing())},
          {"kernel",
           std::string(kernels[static_cast<int>(p.kernel)]) + ", exponent " +
             std::to_string(p.kernel_exponent)},
          {"volume fraction", fractions[static_cast<int>(p.volume_fraction)]},
          {"calibration",
           p.calibration == Calibration::analytic    ? "analytic" :
           bonds->families().has_complete_families() ? "discrete" :
                                                       "analytic, because no family is complete"},
          {"self term", p.self_term == SelfTerm::none ? "none" : "paper"},
          {"boundary treatment", treatments[static_cast<int>(p.treatment)]},
          {"flux treatment", fluxes[static_cast<int>(p.flux_treatment)]},
          {"surface correction",
           p.surface_correction == SurfaceCorrection::none ?
             "none" :
           p.surface_correction == SurfaceCorrection::crack_scaling ?
             "crack scaling" :
           p.correction_direction == CorrectionDirection::both ?
             "energy, each direction" :
             std::string("energy, direction ") + "xyz"[static_cast<int>(p.correction_direction)]},
          {"operator form", bonds->form_note()}};
        return list;
      }

      std::vector<std::string> notes() const override
      {
        const Peridynamics      &p = scene.peridynamics;
        std::vector<std::string> list;
        const double             effective = bonds->families().effective_conductivity();
        if (std::abs(effective - 1.) > 5e-3)
          list.push_back(
            "complete families conduct " + to_text(effective) +
            " times 'Conductivity' (section 'Material'), because of '" +
            (p.self_term == SelfTerm::paper ? "Self term = paper" : "Calibration = analytic") +
            "' in section 'Peridynamics'; with " +
            (p.self_term == SelfTerm::paper ? "'Self term = none' and " : "") +
            "'Calibration = discrete' it is 1.");
        if (p.treatment == BoundaryTreatment::fictitious_constant)
          list.emplace_back(
            "'Boundary treatment = fictitious constant' in section 'Peridynamics' is of first order in the spacing "
            "only; 'fictitious mirror' is of second order.");
        return list;
      }

    private:
      const Scene<dim>                  &scene;
      DoFHandler<dim>                    handler;
      std::unique_ptr<Nodes<dim>>        node_set;
      std::unique_ptr<BondOperator<dim>> bonds;
      mutable Vector                     volume,
        cut; // for output; empty until needed, and when the cracks have changed
    };
  } // namespace


  template <int dim>
  std::unique_ptr<ModelRun<dim>> make_model_run(const Model               model,
                                                const Triangulation<dim> &mesh,
                                                const Scene<dim>         &scene)
  {
    std::unique_ptr<ModelRun<dim>> run;
            if (model == Model::peridynamics && scene.peridynamics.treatment != BoundaryTreatment::exchange)
      run = std::make_unique<BondRun<dim>>(mesh, scene);
    else
      run = std::make_unique<FEMRun<dim>>(model, mesh, scene);
    run->op().initialize_vector(run->solution);
    run->set_initial_value(run->solution);
    run->op().distribute(run->solution, 0.);
    run->op().take_material_at(run->solution); // with the prescribed values
    run->op().distribute(run->solution, 0.);
    return run;
  }

  template std::unique_ptr<ModelRun<1>> make_model_run(const Model,
                                                       const Triangulation<1> &,
                                                       const Scene<1> &);
  template std::unique_ptr<ModelRun<2>> make_model_run(const Model,
                                                       const Triangulation<2> &,
                                                       const Scene<2> &);
  template std::unique_ptr<ModelRun<3>> make_model_run(const Model,
                                                       const Triangulation<3> &,
                                                       const Scene<3> &);
} // namespace PeriDeal
