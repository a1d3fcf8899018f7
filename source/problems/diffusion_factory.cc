// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>

#include <perideal/analysis/decay_rate.h>
#include <perideal/base/instantiate.h>
#include <perideal/laws/crack_conductance.h>
#include <perideal/laws/lattice_family.h>
#include <perideal/problems/diffusion_problem.h>
#include <perideal/scene/expression.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/rules.h>
#include <perideal/solvers/linear_solver.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "problem_parts.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  void require_diffusion(const Scene<dim> &scene)
  {
    refuse_diffusion(scene);
    if (scene.time.steady)
      require_steady_state(scene);
  }


  /** Of cracks that grow, and entries that have no effect. */
  template <int dim>
  void note_diffusion(const Scene<dim> &scene, std::vector<std::string> &notes)
  {
    note_growth(scene, notes);
    const auto &transfers = scene.boundary_conditions.transfers;
    if (!scene.peridynamics.natural_fluxes() &&
        std::all_of(transfers.begin(), transfers.end(), [](const SurfaceTransfer &transfer) {
          return transfer.fixes_level();
        }))
      notes.push_back(
        "'Flux treatment' in section 'Peridynamics' has no effect: no side is named in 'Flux' by a formula without T (an insulated side "
        "needs 'side: 0' there, and what depends on T enters as with 'natural').");
  }


  namespace
  {
    /** The integral of abs(formula) over the own cells, by the points of a quadrature. */
    template <int dim>
    double seen_by(const Triangulation<dim> &mesh,
                   const Quadrature<dim>    &points,
                   const Expression         &formula)
    {
      const FE_Q<dim> element(1);
      FEValues<dim>   values(element, points, update_quadrature_points | update_JxW_values);
      double          sum = 0.;
      for (const auto &cell : mesh.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            values.reinit(cell);
            for (const unsigned int q : values.quadrature_point_indices())
              sum += std::abs(formula.value(values.quadrature_point(q))) * values.JxW(q);
          }
      return Utilities::MPI::sum(sum, mesh.get_communicator());
    }


    /**
     * A source narrower than the cells falls between the points at which a mesh looks at it.
     * Collective.
     */
    template <int dim>
    void note_unseen_source(const Scene<dim>         &scene,
                            const Triangulation<dim> &mesh,
                            std::vector<std::string> &notes)
    {
      constexpr double   most_points = 2e5, tolerable = 0.1;
      const Expression  &source = scene.initial_and_source.source;
      const unsigned int n      = static_cast<unsigned int>(
        std::min(16., std::pow(most_points / mesh.n_global_active_cells(), 1. / dim)));
      if (source.is_constant() || source.depends_on_temperature() || n < 4)
        return;
      double     whole = 0., seen = 0.;
      const bool bonds_alone = !runs(scene, ModelKind::finite_elements) &&
                               !runs(scene, ModelKind::coupled) &&
                               scene.peridynamics.treatment != BoundaryTreatment::exchange;
      with_formulas(mesh.get_communicator(), [&] {
        whole = seen_by<dim>(mesh, QIterated<dim>(QMidpoint<1>(), n), source);
        seen  = !bonds_alone ?
                  seen_by<dim>(mesh, QGauss<dim>(scene.finite_elements.degree + 1), source) :
                scene.domain.has_nodes_at_centers() ? seen_by<dim>(mesh, QMidpoint<dim>(), source) :
                                                      seen_by<dim>(mesh, QTrapezoid<dim>(), source);
      });
      if (std::abs(seen - whole) <= tolerable * whole)
        return;
      notes.push_back(
        std::string(bonds_alone ? "the nodes see " : "the quadrature points of the cells see ") +
        rounded_text(seen) + " of 'Source' in section 'Initial and source', whose integral is " +
        rounded_text(whole) + ": " + rounded_text(seen / whole) +
        " of it, since it is narrow beside the cells. Use more 'Cells' (section 'Domain'), or a wider source.");
    }


    /** A constant `Transmission` is another crack with each horizon. */
    template <int dim>
    void note_transmission(const Scene<dim> &scene, std::vector<std::string> &notes)
    {
      const Cracks<dim> &cracks = scene.cracks;
      if (dim == 1 || cracks.cracks.empty() || !cracks.transmission.is_constant() ||
          !scene.material.conductivity.is_constant())
        return;
      const double t = cracks.transmission.value(Point<dim>());
      if (t <= 0. || t >= 1.)
        return;
      const double horizon = scene.horizon(),
                   kappa   = scene.material.conductivity.value(Point<dim>());
      double ratio         = 3.;
      if (scene.domain.has_lattice())
        {
          const Tensor<1, dim> h = scene.domain.spacing();
          ratio                  = horizon / *std::min_element(h.begin_raw(), h.end_raw());
        }
      const double H = contact_conductance_of_transmission(t, kappa, horizon, ratio);
      notes.push_back(
        "'Transmission = " + rounded_text(t) +
        "' in section 'Cracks' is the fraction that bonds of this horizon, " +
        rounded_text(horizon) + ", keep: it acts like a contact conductance of about " +
        rounded_text(H) + " here, and with half the horizon of " + rounded_text(2. * H) +
        ". 'Contact conductance' is a property of the crack, the same on each lattice.");
    }


    /** Peridynamics without any need for it: the error of a wave as long as the body. */
    template <int dim>
    void note_smooth_field(const Scene<dim> &scene, std::vector<std::string> &notes)
    {
      constexpr double    tolerable = 1e-3, worse = 2.;
      const Peridynamics &p = scene.peridynamics;
      if (!runs(scene, ModelKind::peridynamics) || scene.domain.shape != Shape::box ||
          !scene.cracks.cracks.empty() || p.horizon > 0. || scene.time.steady ||
          p.sampling.self_term != SelfTerm::none || !scene.material.phases.all().names.empty() ||
          !scene.material.conductivity.is_constant())
        return;
      // In the direction with the fewest cells.
      unsigned int d = 0;
      for (unsigned int e = 1; e < dim; ++e)
        if (scene.domain.cells[e] < scene.domain.cells[d])
          d = e;
      const Tensor<1, dim>  h = scene.domain.spacing();
      std::array<double, 3> wave{};
      wave[d]             = numbers::PI / (scene.domain.upper[d] - scene.domain.lower[d]);
      const auto   family = lattice_family<dim>(h,
                                              scene.horizon(),
                                              p.kernel,
                                              p.kernel_exponent,
                                              p.sampling.volume_fraction,
                                              p.sampling.calibration);
      const double exact  = classical_decay_rate(wave, 1., 1.);
      const double bonds =
        1. - lattice_decay_rate(lattice_terms<dim>(family, h, 1.), wave, 1.) / exact;
      const double angle    = 0.5 * wave[d] * h[d];
      const double elements = 1. - std::pow(std::sin(angle) / angle, 2);
      if (std::abs(bonds) < tolerable || std::abs(bonds) < worse * elements)
        return;
      notes.push_back(
        "peridynamics: there is no crack, one material and no 'Horizon' of its own, and finite elements solve the same problem more accurately: the slowest wave across the body decays too slowly by " +
        rounded_text(100. * bonds) + " % with bonds up to " + rounded_text(scene.horizon()) +
        " long, and by " + rounded_text(100. * elements) +
        " % with elements. 'Models = finite elements' is all that this scene needs.");
    }


    /**
     * Tell of `Surface correction = crack scaling` for diffusion around insulating cracks without
     * it: bonds and cut cells beside a crack conduct too little along it.
     */
    template <int dim>
    void note_missing_crack_scaling(const Scene<dim> &scene, std::vector<std::string> &notes)
    {
      const SurfaceCorrection correction = scene.peridynamics.surface_correction;
      const bool bonds = runs(scene, ModelKind::peridynamics) || runs(scene, ModelKind::coupled),
                 pairs = scene.cracks.cut_pairs();
      if (dim == 1 || scene.cracks.cracks.empty() || scene.cracks.conduct() || (!bonds && !pairs) ||
          (correction != SurfaceCorrection::none && correction != SurfaceCorrection::automatic))
        return;
      const PhysicsNames &names = names_of(scene.general.physics);
      notes.push_back(
        "beside a crack bonds " + std::string(pairs ? "and the pairs of cut cells " : "") +
        "conduct too little along it, and the jump of the " + names.field +
        " across it comes out some percent too large: 'Surface correction = crack scaling' in section "
        "'Peridynamics' makes up for most of that.");
    }


    template <int dim>
    class DiffusionFactory : public ProblemFactory<dim>
    {
    public:
      void require_computable(const Scene<dim> &scene) const override
      {
        require_diffusion(scene);
      }

      void note_scene(const Scene<dim>         &scene,
                      const Triangulation<dim> &mesh,
                      std::vector<std::string> &notes) const override
      {
        note_missing_crack_scaling(scene, notes);
        note_diffusion(scene, notes);
        note_transmission(scene, notes);
        note_smooth_field(scene, notes);
        note_unseen_source(scene, mesh, notes);
      }

      std::unique_ptr<Problem<dim>> make_problem(Model<dim>       &model,
                                                 const Scene<dim> &scene) const override
      {
        std::unique_ptr<DiffusionField<dim>> field;
        with_formulas(model.mesh.get_communicator(),
                      [&] { field = make_diffusion_field(model, scene); });
        return std::make_unique<DiffusionProblem<dim>>(std::move(field));
      }
    };
  } // namespace


  template <int dim>
  std::unique_ptr<ProblemFactory<dim>> make_diffusion_factory()
  {
    return std::make_unique<DiffusionFactory<dim>>();
  }


  PERIDEAL_INSTANTIATE_FUNCTION(require_diffusion);
  PERIDEAL_INSTANTIATE_FUNCTION(note_diffusion);
  PERIDEAL_INSTANTIATE_FUNCTION(make_diffusion_factory);
} // namespace PeriDeal
