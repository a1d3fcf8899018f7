// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_dgq.h>
#include <deal.II/fe/fe_q.h>

#include <perideal/base/instantiate.h>
#include <perideal/bonds/families.h>
#include <perideal/problems/guards.h>
#include <perideal/problems/model.h>
#include <perideal/problems/problem.h>
#include <perideal/problems/run_context.h>
#include <perideal/scene/beyond_sides.h>
#include <perideal/scene/lists.h>
#include <perideal/solvers/stepper.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <ctime>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  Model<dim>::Model(const ModelKind kind, const Triangulation<dim> &mesh)
    : kind(kind)
    , mesh(mesh)
    , handler(mesh)
  {}


  template <int dim>
  Model<dim>::~Model() = default;


  template <int dim>
  void Model<dim>::number(const FiniteElement<dim> &element,
                          const Domain<dim>        &domain,
                          const bool                along_lattice)
  {
    if (numbered)
      {
        AssertThrow(handler.get_fe().get_name() == element.get_name(),
                    ExcMessage("The problems of a model have the same nodes."));
        return;
      }
    handler.distribute_dofs(element);
    if (along_lattice && domain.has_lattice())
      number_along_lattice(handler, domain);
    numbered = true;
  }


  template <int dim>
  Nodes<dim> &Model<dim>::nodes(const BodyParameters<dim> &body, const NodalVolume volume)
  {
    for (const auto &[kind_of_volume, set] : node_sets)
      if (kind_of_volume == volume)
        return *set;
    node_sets.emplace_back(volume,
                           std::make_unique<Nodes<dim>>(handler, body.domain, body.cracks, volume));
    prepare(*node_sets.back().second);
    return *node_sets.back().second;
  }


  template <int dim>
  void Model<dim>::share_nodes(const BodyParameters<dim> &body)
  {
    bodies.push_back(&body);
  }


  template <int dim>
  void Model<dim>::prepare(Nodes<dim> &nodes) const
  {
    if (bodies.empty())
      return;
    HaloNeed                     need{0., HaloAround::cells};
    typename Lattice<dim>::Index margin{};
    for (const BodyParameters<dim> *const body : bodies)
      {
        const KernelWeights<dim>           weights = kernel_weights(nodes, *body);
        const typename Lattice<dim>::Index reach   = weights.reach_in_sites();
        need = need.joined({halo_reach(nodes, *body, weights), HaloAround::cells});
        for (unsigned int d = 0; d < dim; ++d)
          margin[d] = std::max(margin[d], reach[d]);
      }
    prepare_search(nodes, need, margin);
  }


  template <int dim>
  void Model<dim>::forget()
  {
    node_sets.clear();
    numbered = false;
  }


  template <int dim>
  Field<dim>::Field(Model<dim> &on, const Scene<dim> &scene, const unsigned int n_components)
    : on(on)
    , scene(scene)
    , n_components(n_components)
    , handler(on.dofs())
  {}


  template <int dim>
  Point<dim> Field<dim>::position(const unsigned int node) const
  {
    Assert(node_set, ExcMessage("Finite elements alone have no peridynamic nodes."));
    return node_set->position(node);
  }


  template <int dim>
  double Field<dim>::volume(const unsigned int node) const
  {
    Assert(node_set, ExcMessage("Finite elements alone have no peridynamic nodes."));
    return node_set->volume(node);
  }


  template <int dim>
  void Field<dim>::make_bond_nodes()
  {
    Timings::Scope scope(timings, "unknowns");
    if (scene.domain.nodes == NodePlacement::vertices)
      on.number(FE_Q<dim>(1), scene.domain, true);
    else
      on.number(FE_DGQ<dim>(0), scene.domain, true);
    node_set = &on.nodes(scene, scene.peridynamics.sampling.nodal_volume);
  }


  template <int dim>
  ChosenSettings Field<dim>::bond_settings(const Families<dim> &families) const
  {
    static const char *const kernels[]   = {"constant", "conical", "gaussian"};
    static const char *const fractions[] = {"none", "linear", "exact"};
    static const char *const treatments[] =
      {"auto", "exchange", "none", "layer", "fictitious mirror", "fictitious constant"};
    static const char *const fluxes[] = {"natural", "extrapolation", "layer extrapolation"};
    const Peridynamics      &p        = scene.peridynamics;
    return {
      {"nodes", scene.domain.nodes == NodePlacement::vertices ? "vertices" : "cell centers"},
      {"horizon", rounded_text(scene.horizon(), 6)},
      {"m", rounded_text(scene.horizon() / families.nodes().smallest_spacing(), 6)},
      {"kernel",
       std::string(kernels[static_cast<int>(p.kernel)]) + ", exponent " +
         std::to_string(p.kernel_exponent)},
      {"volume fraction", fractions[static_cast<int>(p.sampling.volume_fraction)]},
      {"calibration",
       p.sampling.calibration == Calibration::analytic  ? "analytic" :
       p.sampling.calibration == Calibration::isotropic ? "isotropic" :
       families.weights().has_complete_families()       ? "discrete" :
                                                          "analytic, because no family is complete"},
      {"self term", p.sampling.self_term == SelfTerm::none ? "none" : "paper"},
      {"boundary treatment", treatments[static_cast<int>(p.treatment)]},
      {"flux treatment", fluxes[static_cast<int>(p.flux_treatment)]},
      {"surface correction",
       p.surface_correction == SurfaceCorrection::automatic ?
         "auto: " + automatic_correction(scene) :
       p.surface_correction == SurfaceCorrection::none          ? "none" :
       p.surface_correction == SurfaceCorrection::crack_scaling ? "crack scaling" :
       p.surface_correction == SurfaceCorrection::moments       ? "moments" :
       p.completes_families()                                   ? "fictitious nodes" :
       scene.general.physics == Physics::elasticity ?
                                "energy" :
       p.correction_direction == CorrectionDirection::both ?
                                "energy, each direction" :
                                std::string("energy, direction ") +
                                  "xyz"[static_cast<int>(p.correction_direction)]}};
  }


  template <int dim>
  std::string Problem<dim>::doing(const unsigned int, const unsigned int, const double) const
  {
    return name() + ": time stepping";
  }


  template <int dim>
  Trip Problem<dim>::watch(const double t)
  {
    return extent_of(state()).finite ?
             Trip() :
             values_not_finite(state(), n_components(), place_of_nodes(dofs()), field_name(), t);
  }


  template <int dim>
  void Problem<dim>::explain(Trip &trip)
  {
    if (trip.cause.empty() && trip.monitor == "balance")
      trip.cause = cause_in_balance(scene.solver.tolerance);
    if (trip.cause.empty())
      trip.cause = own_cause(trip);
    if (trip.cause.empty())
      trip.cause = cause_in_operator(op(), place_of_nodes(dofs()), trip);
  }


  template <int dim>
  std::vector<std::string> Problem<dim>::notes() const
  {
    return field->notes();
  }


  template <int dim>
  StepperOptions Problem<dim>::stepper_options() const
  {
    StepperOptions options;
    options.time_step        = scene.time.time_step;
    options.tolerance        = scene.time.tolerance;
    options.solver_tolerance = scene.solver.tolerance;
    options.max_iterations   = scene.solver.max_iterations;
    options.direct_up_to     = scene.solver.direct_up_to;
    return options;
  }


  template <int dim>
  Vector component_of(const DoFHandler<dim> &dofs,
                      const Vector          &u,
                      const unsigned int     n,
                      const unsigned int     c)
  {
    IndexSet relevant;
    DoFTools::extract_locally_relevant_dofs(dofs, relevant);
    Vector component(dofs.locally_owned_dofs(), relevant, dofs.get_communicator());
    for (unsigned int i = 0; i < component.locally_owned_size(); ++i)
      component.local_element(i) = u.local_element(n * i + c);
    component.update_ghost_values();
    return component;
  }


  double processor_seconds()
  {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  }


  double time_of_application(const Operator &op)
  {
    Vector x, y;
    op.initialize_vector(x);
    op.initialize_vector(y);
    op.apply(y, x);
    constexpr unsigned int n_trials = 20;
    const double           start    = processor_seconds();
    for (unsigned int k = 0; k < n_trials; ++k)
      op.apply(y, x);
    return (processor_seconds() - start) / n_trials;
  }


  PERIDEAL_INSTANTIATE_CLASS(class Model);
  PERIDEAL_INSTANTIATE_CLASS(class Field);
  PERIDEAL_INSTANTIATE_CLASS(class Problem);
  PERIDEAL_INSTANTIATE_FUNCTION(component_of);
} // namespace PeriDeal
