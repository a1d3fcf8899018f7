// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/distributed/solution_transfer.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>

#include <perideal/analysis/coupling_certificate.h>
#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/operators/coupling/coupling.h>
#include <perideal/operators/diffusion/cell_term.h>
#include <perideal/scene/lists.h>

#include "diffusion_parts.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /**
     * Cells in which materials of different conductivity meet, and cells that cracks take away.
     * Collective.
     *
     * @param cut by the active index of cells
     */
    template <int dim>
    std::vector<std::string> notes_on_cells(const DoFHandler<dim>   &dofs,
                                            const Scene<dim>        &scene,
                                            const std::vector<bool> &cut)
    {
      constexpr double much      = 3.; // of conductivities
      const bool       one       = scene.material.uniform_conductivity(),
                 removes         = scene.cracks.mesh == CrackMesh::removed;
      unsigned long long n_mixed = 0, n_removed = 0;
      double             largest = 1., volume = 0.;
      FEValues<dim>      values(dofs.get_fe(),
                           QGauss<dim>(dofs.get_fe().degree + 1),
                           update_quadrature_points);
      for (const auto &cell : dofs.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            if (removes && cut[cell->active_cell_index()])
              {
                ++n_removed;
                volume += cell->measure();
                continue;
              }
            if (one || cut[cell->active_cell_index()]) // cut cells conduct in pairs
              continue;
            values.reinit(cell);
            double sum = 0., resistance = 0., least = 1e300, most = 0.;
            for (const Point<dim> &x : values.get_quadrature_points())
              {
                const double T     = scene.initial_and_source.initial_value.value(x);
                const double kappa = scene.material.conductivity.value(x, T);
                sum += kappa;
                resistance += 1. / kappa;
                least = std::min(least, kappa);
                most  = std::max(most, kappa);
              }
            if (most < much * least)
              continue;
            ++n_mixed;
            largest = std::max(largest, sum * resistance / std::pow(values.n_quadrature_points, 2));
          }
      const auto communicator = dofs.get_communicator();
      n_mixed                 = Utilities::MPI::sum(n_mixed, communicator);
      n_removed               = Utilities::MPI::sum(n_removed, communicator);
      largest                 = Utilities::MPI::max(largest, communicator);
      volume                  = Utilities::MPI::sum(volume, communicator);
      std::vector<std::string> list;
      if (n_mixed > 0)
        list.push_back(
          "in " + std::to_string(n_mixed) + (n_mixed == 1 ? " cell" : " cells") +
          " materials meet inside, with the mean of their conductivities: right for what flows along the interface, and up to " +
          rounded_text(largest) +
          " times too much for what crosses it. 'Cells' in section 'Domain' with which interfaces lie on faces make it exact; more cells make it less.");
      if (n_removed > 0)
        {
          double length = 0.;
          for (const auto &crack : scene.cracks.cracks)
            length += dim == 2 ? crack[0].distance(crack[1]) : 0.;
          list.push_back(
            "the crack takes away " + std::to_string(n_removed) +
            " cells ('Mesh = removed' in section 'Cracks')" +
            (length > 0. ? ", a gap " + rounded_text(volume / length) +
                             " wide in the mean, in place of a crack" :
                           std::string()) +
            ". 'pairs' with 'Surface correction = crack scaling' (section 'Peridynamics') keeps the conduction along it.");
        }
      return list;
    }


    template <int dim>
    class ElementDiffusion : public DiffusionField<dim>
    {
    public:
      using Field<dim>::on;
      using Field<dim>::scene;
      using Field<dim>::handler;
      using Field<dim>::node_set;
      using Field<dim>::solution;

      /**
       * @param on finite elements, coupled, or peridynamics by exchange, which is `coupled` with
       *           the zone everywhere
       */
      ElementDiffusion(Model<dim> &on, const Scene<dim> &scene)
        : DiffusionField<dim>(on, scene)
        , model(on.kind)
        , element(model == ModelKind::finite_elements ? scene.finite_elements.degree : 1)
      {
        number_unknowns();
        build_operator();
        doubts = notes_on_cells(handler, scene, cells().cut_cells());
        if (model == ModelKind::coupled && scene.coupling.certificate)
          certify();
        if (!node_set && !scene.output.quantities.empty())
          find_nodes();
      }

      Point<dim> position(const unsigned int node) const override
      {
        return node_set ? Field<dim>::position(node) : nodes.positions[node];
      }

      double volume(const unsigned int node) const override
      {
        return node_set ? Field<dim>::volume(node) : nodes.volumes[node];
      }

      FieldOperator<dim> &op() const override
      {
        return *diffusion;
      }

      void set_initial_value(Vector &u) const override
      {
        // Lumped projection for Q1, so that a jump inside a cell is averaged; interpolation for
        // higher degrees, which it would spoil, and for peridynamics, whose values are those of
        // points.
        const auto initial = [&](const Point<dim> &p) {
          return scene.initial_and_source.initial_value.value(p);
        };
        if (element.degree == 1 && model != ModelKind::peridynamics)
          {
            Vector volumes(u);
            integrate(initial, u);
            integrate([](const Point<dim> &) { return 1.; }, volumes);
            if (scene.domain.coarsening.times > 0)
              {
                cells().hanging_nodes().condense(u);
                cells().hanging_nodes().condense(volumes);
                cells().hanging_nodes().set(volumes, 1.);
              }
            for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
              u.local_element(i) /= volumes.local_element(i);
            if (scene.domain.coarsening.times > 0)
              move_to_nodes(initial, volumes, u);
          }
        else
          for_each_node(
            [&](const unsigned int i, const Point<dim> &p) { u.local_element(i) = initial(p); });
      }

      RecoveryIndicators indicators() const override
      {
        solution.update_ghost_values();
        const RecoveryIndicators found =
          recovery_indicators<dim>(handler, scene.material, cells().cut_cells(), solution);
        solution.set_ghost_state(false);
        return found;
      }

      void before_remesh() override
      {
        heat_before = diffusion->heat(solution);
        solution.update_ghost_values();
        transfer = std::make_unique<Transfer>(handler);
        transfer->prepare_for_coarsening_and_refinement(solution);
      }

      void rebuild(const double t) override
      {
        const unsigned long long applications = diffusion->n_applications();
        diffusion.reset();
        on.forget();
        number_unknowns();
        build_operator(t);
        diffusion->carry_over_applications(applications);
        diffusion->initialize_vector(solution);
      }

      double move_solution(const double t, const bool steady) override
      {
        transfer->interpolate(solution);
        transfer.reset();
        cells().hanging_nodes().interpolate(solution);
        const double kept = diffusion->heat(solution), lost = heat_before - kept;
        diffusion->distribute(solution,
                              t); // what new nodes on Dirichlet sides get comes from outside
        const double came = diffusion->heat(solution) - kept;
        if (!steady)
          give_heat(lost, t);
        return came;
      }

      std::vector<OutputField> derived_fields(const Vector &u, const double) const override
      {
        VectorField<dim> flux;
        for (Vector &component : flux)
          diffusion->initialize_vector(component);
        std::vector<OutputField> fields;
        const std::string        flux_name = names_of(scene.general.physics).flux;
        if (model == ModelKind::finite_elements)
          {
            element_heat_flux<dim>(handler, scene.material, cells().cut_cells(), u, flux);
            fields.push_back(vector_field<dim>(flux_name, flux));
          }
        else
          {
            VectorField<dim> one_sided = flux;
            coupled_heat_flux<dim>(cells(), u, flux, one_sided);
            fields.push_back(vector_field<dim>(flux_name, flux));
            fields.push_back(vector_field<dim>(flux_name + "_one_sided", one_sided));
            add_bond_fields(u, fields);
          }
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

      Difference difference_to(
        const Vector                                    &u,
        const std::function<double(const Point<dim> &)> &exact) const override
      {
        if (scene.cracks.cracks.empty() || scene.cracks.on_faces() || element.degree > 1)
          return element_difference(handler, u, exact);
        // Inside a cut cell the interpolant runs across the crack: only the values at the nodes are
        // the model's.
        Vector expected(u), volumes(u);
        for_each_node(
          [&](const unsigned int i, const Point<dim> &p) { expected.local_element(i) = exact(p); });
        integrate([](const Point<dim> &) { return 1.; }, volumes);
        return nodal_difference(u, expected, [&](const unsigned int i) {
          return volumes.local_element(i);
        });
      }

      std::vector<std::string> notes() const override
      {
        std::vector<std::string> list = doubts;
        if (this->certificate && !this->certificate->fault().empty())
          list.push_back(this->certificate->fault() +
                         ". 'Scheme = exchange' (section 'Coupling') has neither fault.");
        return list;
      }

      ChosenSettings settings() const override
      {
        ChosenSettings list{
          {"element", "Q" + std::to_string(element.degree)},
          {"capacity", scene.finite_elements.consistent_capacity ? "consistent" : "lumped"}};
        if (model != ModelKind::finite_elements)
          {
            for (const auto &setting : this->bond_settings(cells().bonds().families()))
              if (setting.first != "boundary treatment" || model == ModelKind::peridynamics)
                list.push_back(setting);
            list.emplace_back("coupling",
                              model == ModelKind::coupled ? scene.coupling.scheme_text() :
                                                            "exchange");
            list.emplace_back("zone",
                              model == ModelKind::coupled ? scene.coupling.zone_text() :
                                                            "everywhere");
            list.emplace_back("share of the body in the zone",
                              rounded_text(100. * cells().bonds().zone_share(), 6) + " %");
          }
        else if (scene.peridynamics.scales_beside_cracks() && scene.cracks.cut_pairs())
          list.emplace_back("surface correction", "crack scaling");
        if (!scene.cracks.cracks.empty())
          list.emplace_back("cracks",
                            scene.cracks.cut_pairs() ? "pairs" :
                            scene.cracks.on_faces()  ? "faces" :
                                                       "removed");
        return list;
      }

    private:
      using Transfer = parallel::distributed::SolutionTransfer<dim, Vector>;

      const CellTerm<dim> &cells() const
      {
        return cells_of(*diffusion);
      }

      void number_unknowns()
      {
        Timings::Scope scope(this->timings, "unknowns");
        on.number(element, scene.domain, element.degree == 1);
      }

      /**
       * Where sizes of cells meet, the mean around a node is that of a place beside it, which
       * shifts smooth fields: correct by the difference of the values there. On the surface of the
       * body the mean stays, as on uniform meshes.
       */
      void move_to_nodes(const std::function<double(const Point<dim> &)> &initial,
                         const Vector                                    &volumes,
                         Vector                                          &u) const
      {
        std::array<Vector, dim> centers;
        for (unsigned int d = 0; d < dim; ++d)
          {
            diffusion->initialize_vector(centers[d]);
            integrate([d](const Point<dim> &p) { return p[d]; }, centers[d]);
            cells().hanging_nodes().condense(centers[d]);
          }
        Vector on_surface(u);
        on_surface = 0.;
        std::vector<types::global_dof_index> indices(element.n_dofs_per_cell());
        for (const auto &cell : handler.active_cell_iterators())
          if (cell->is_locally_owned() && cell->at_boundary())
            {
              cell->get_dof_indices(indices);
              for (const unsigned int f : cell->face_indices())
                for (unsigned int i = 0; i < indices.size() && cell->face(f)->at_boundary(); ++i)
                  if (element.has_support_on_face(i, f))
                    on_surface(indices[i]) = 1.;
            }
        on_surface.compress(VectorOperation::max);
        const double apart = 1e-9 * scene.domain.spacing().norm();
        const Vector mean(u); // nodes are visited from each of their cells
        for_each_node([&](const unsigned int i, const Point<dim> &p) {
          Point<dim> center;
          for (unsigned int d = 0; d < dim; ++d)
            center[d] = centers[d].local_element(i) / volumes.local_element(i);
          if (on_surface.local_element(i) == 0. && center.distance(p) > apart)
            {
              // At a jump of the initial value it stays between the mean and the value there.
              const double here = initial(p), old = mean.local_element(i);
              u.local_element(i) =
                std::clamp(old + here - initial(center), std::min(old, here), std::max(old, here));
            }
        });
      }

      /**
       * Where cells have been merged the interpolant holds a little more or less heat than the
       * finer field did. The difference goes to the nodes of merged cells, each by the same
       * temperature.
       */
      void give_heat(const double lost, const double t)
      {
        Vector                               share(solution.get_partitioner());
        const double                         spacing = scene.domain.spacing()[0];
        std::vector<types::global_dof_index> indices(element.n_dofs_per_cell());
        for (const auto &cell : handler.active_cell_iterators())
          if (cell->is_locally_owned() && cell->extent_in_direction(0) > 1.5 * spacing)
            {
              cell->get_dof_indices(indices);
              for (const auto i : indices)
                share(i) = 1.;
            }
        share.compress(VectorOperation::max);
        diffusion->clear_constrained(share);
        cells().hanging_nodes().interpolate(share);
        const double capacity = diffusion->heat(share);
        if (capacity > 0.)
          solution.add(lost / capacity, share);
        diffusion->distribute(solution, t);
      }

      void build_operator(const double start = 0.)
      {
        Timings::Scope                 scope(this->timings, "operator");
        std::unique_ptr<Coupling<dim>> coupling;
        if (model != ModelKind::finite_elements)
          {
            node_set = &on.nodes(scene, NodalVolume::partial);
            Zone<dim> zone;
            if (model == ModelKind::coupled)
              zone = Zone<dim>(scene.coupling, scene.horizon());
            if (scene.domain.has_lattice())
              zone.stay_in({{scene.domain.lower, scene.domain.upper}});
            coupling = make_coupling(*node_set, scene, zone, scheme());
          }
        diffusion = field_of_elements(handler, scene, std::move(coupling), start);
      }

      void certify()
      {
        Timings::Scope scope(this->timings, "certificate");
        const auto     found = examine_coupling(*diffusion, diffusion->symmetric());
        if (scheme() == CouplingScheme::exchange) // of the others the user is told
          found.require_sound();
        this->certificate = std::make_shared<CouplingCertificate>(found);
      }

      /** Peridynamics alone has nothing to splice or to blend with. */
      CouplingScheme scheme() const
      {
        return model == ModelKind::coupled ? scene.coupling.scheme : CouplingScheme::exchange;
      }

      /** Which nodes are in the zone, and the part of their bonds that cracks have cut. */
      void add_bond_fields(const Vector &u, std::vector<OutputField> &fields) const
      {
        std::array<Vector, 1>                     zone{u}, cut{u}, volume{u};
        std::vector<typename Coupling<dim>::Bond> bonds;
        for (unsigned int i = 0; i < node_set->n_owned(); ++i)
          {
            zone[0].local_element(i)   = cells().bonds().in_zone(i);
            volume[0].local_element(i) = node_set->volume(i);
            cut[0].local_element(i)    = 0.;
            if (!cells().bonds().families().near_crack(i))
              continue;
            cells().bonds().bonds_of(i, bonds);
            double all = 0., gone = 0.;
            for (const auto &bond : bonds)
              {
                all += bond.intact;
                gone += bond.cut ? bond.intact : 0.;
              }
            cut[0].local_element(i) = all > 0. ? gone / all : 0.;
          }
        if (model == ModelKind::coupled)
          fields.push_back(vector_field<1>("zone", zone));
        fields.push_back(vector_field<1>("node_volume", volume));
        fields.push_back(vector_field<1>("cut_fraction", cut));
      }

      /**
       * Integral of f times the shape function of each owned unknown, with two Gauss points along
       * each direction. Collective.
       */
      void integrate(const std::function<double(const Point<dim> &)> &f, Vector &integrals) const
      {
        FEValues<dim>                        values(element,
                             QGauss<dim>(2),
                             update_values | update_quadrature_points | update_JxW_values);
        std::vector<types::global_dof_index> indices(element.n_dofs_per_cell());
        integrals = 0.;
        for (const auto &cell : handler.active_cell_iterators())
          if (cell->is_locally_owned())
            {
              values.reinit(cell);
              cell->get_dof_indices(indices);
              for (const unsigned int q : values.quadrature_point_indices())
                {
                  const double weight = f(values.quadrature_point(q)) * values.JxW(q);
                  for (unsigned int i = 0; i < indices.size(); ++i)
                    integrals(indices[i]) += values.shape_value(i, q) * weight;
                }
            }
        integrals.compress(VectorOperation::add);
      }

      /** Places and volumes, which elements have no other use for. Collective. */
      void find_nodes()
      {
        Vector volumes;
        diffusion->initialize_vector(volumes);
        integrate([](const Point<dim> &) { return 1.; }, volumes);
        cells().hanging_nodes().condense(volumes);
        nodes.volumes.assign(volumes.begin(), volumes.begin() + volumes.locally_owned_size());
        nodes.positions.resize(nodes.volumes.size());
        for_each_node([&](const unsigned int i, const Point<dim> &p) { nodes.positions[i] = p; },
                      &volumes);
      }

      /** Call visit(local index, position) for each owned dof of a vector (none: the solution). */
      void for_each_node(const std::function<void(const unsigned int, const Point<dim> &)> &visit,
                         const Vector *of_nodes = nullptr) const
      {
        FEValues<dim>                        values(element,
                             Quadrature<dim>(element.get_unit_support_points()),
                             update_quadrature_points);
        std::vector<types::global_dof_index> indices(element.n_dofs_per_cell());
        const auto &owned = (of_nodes ? *of_nodes : solution).get_partitioner();
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

      const ModelKind                     model;
      FE_Q<dim>                           element;
      std::unique_ptr<FieldOperator<dim>> diffusion;
      struct
      {
        std::vector<Point<dim>> positions;
        std::vector<double>     volumes;
      } nodes;                            // where quantities are asked for, without a node_set
      std::vector<std::string>  doubts;   // about cells at the start
      std::unique_ptr<Transfer> transfer; // while the mesh changes
      double                    heat_before = 0.;
    };
  } // namespace


  template <int dim>
  std::unique_ptr<DiffusionField<dim>> make_element_diffusion(Model<dim>       &model,
                                                              const Scene<dim> &scene)
  {
    return std::make_unique<ElementDiffusion<dim>>(model, scene);
  }


  PERIDEAL_INSTANTIATE_FUNCTION(make_element_diffusion);
} // namespace PeriDeal
