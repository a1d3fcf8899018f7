// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/laws/elasticity.h>
#include <perideal/operators/solid/elastic_elements.h>
#include <perideal/operators/solid/state_operator.h>
#include <perideal/problems/diffusion_problem.h>
#include <perideal/problems/solid_problem.h>
#include <perideal/scene/expression.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/rules.h>
#include <perideal/solvers/static_solver.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "problem_parts.h"
#include "solid_parts.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /**
     * Of the end of a crack along an axis: how much farther than it the cells go that it takes
     * away, in cells. A cell goes from its middle on.
     */
    double beyond_tip(const double place, const bool upwards)
    {
      const double part = place - std::floor(place), here = upwards ? part : 1. - part;
      return here < 0.5 ? -here : 1. - here;
    }


    /** What of a crack along an axis is in a box. */
    struct CrackAlongAxis
    {
      unsigned int        axis;
      double              length, ligament; // what of its line is crack, and what is whole
      double              arm;              // up to the nearest side that it runs along
      std::vector<double> beyond;           // beyond_tip() of its ends in the body
    };


    /** Nothing where a crack lies across the cells: there it is a staircase. */
    std::optional<CrackAlongAxis> along_axis(const Scene<2>              &scene,
                                             const std::vector<Point<2>> &crack)
    {
      const Tensor<1, 2> h     = scene.domain.spacing();
      const Point<2>     lower = scene.domain.lower, upper = scene.domain.upper;
      const Point<2>    &a = crack[0], &b = crack[1];
      const unsigned int axis   = std::abs(b[0] - a[0]) > std::abs(b[1] - a[1]) ? 0 : 1,
                         across = 1 - axis;
      if (std::abs(b[across] - a[across]) > 1e-9 * h[across])
        return {};
      const double from = std::max(lower[axis], std::min(a[axis], b[axis])),
                   to   = std::min(upper[axis], std::max(a[axis], b[axis]));
      CrackAlongAxis found{axis,
                           to - from,
                           upper[axis] - lower[axis] - (to - from),
                           std::min(a[across] - lower[across], upper[across] - a[across]),
                           {}};
      for (const bool upwards : {false, true})
        {
          const double tip = upwards ? to : from;
          if (tip > lower[axis] + 1e-9 * h[axis] && tip < upper[axis] - 1e-9 * h[axis])
            found.beyond.push_back(
              beyond_tip((tip - lower[axis]) / h[axis] + (upwards ? 1e-9 : -1e-9), upwards));
        }
      return found;
    }


    /** A crack is twice as long as the arms beside it are high, for each of its ends. */
    bool is_slender(const CrackAlongAxis &crack)
    {
      return crack.beyond.size() > 0 && crack.arm > 0. &&
             crack.length > 2. * crack.arm * crack.beyond.size();
    }


    /**
     * Elements of degree 1 in a box of a material that hardly changes its volume.
     * @param poisson the largest Poisson ratio in the body
     */
    template <int dim>
    void note_locking(const Scene<dim>         &scene,
                      const double              poisson,
                      std::vector<std::string> &notes)
    {
      constexpr double hardly_changes = 0.45, tolerable = 1.1;
      const bool       elements =
        (runs(scene, ModelKind::finite_elements) && scene.finite_elements.degree == 1) ||
        runs(scene, ModelKind::coupled);
      const bool plane_strain = dim == 3 || scene.elasticity.plane == PlaneState::strain;
      if (dim == 1 || !elements || !plane_strain || scene.domain.shape != Shape::box ||
          poisson < hardly_changes ||
          scene.material.law.kind == SolidLaw::hyperelastic) // whose dilatation is projected
        return;
      const Tensor<1, dim> h    = scene.domain.spacing();
      unsigned int         thin = 0, slender = 0;
      for (unsigned int d = 1; d < dim; ++d)
        {
          const auto extent = [&](const unsigned int e) {
            return scene.domain.upper[e] - scene.domain.lower[e];
          };
          thin    = extent(d) < extent(thin) ? d : thin;
          slender = extent(d) > extent(slender) ? d : slender;
        }
      if (thin == slender)
        slender = (thin + 1) % dim;
      // A rectangle a x b bent along a, of the displacement (x y, 0): over the exact energy; of n
      // of them over the height 1/n^2 is bending of cells.
      const double nu = poisson / (1. - poisson), aspect = h[slender] / h[thin];
      const double one_cell = (1. / (1. - nu) + 0.5 * aspect * aspect) / (1. + nu);
      const double n        = scene.domain.cells[thin];
      const double stiffer  = 1. + (one_cell - 1.) / (n * n);
      if (stiffer < tolerable)
        return;
      notes.push_back(
        "elements of degree 1 cannot bend without changing their volume, and with a Poisson ratio of " +
        number_text(poisson) + " that takes almost any force: " + rounded_text(n) +
        " cells across make the body up to " + rounded_text(stiffer) +
        " times too stiff in bending. 'Degree = 2' in section 'Finite elements' does not lock.");
    }


    /** Ends of cracks inside the cells that they take away, or leave. */
    template <int dim>
    void note_tips_in_cells(const Scene<dim> &scene, std::vector<std::string> &notes)
    {
      constexpr double tolerable = 0.1; // of a cell
      if constexpr (dim == 2)
        {
          const auto &cracks = scene.cracks;
          if (!runs(scene, ModelKind::finite_elements) || cracks.mesh != CrackMesh::removed ||
              scene.domain.shape != Shape::box || !cracks.tips.empty() ||
              scene.cuts_in_part_at_tips())
            return;
          for (unsigned int k = 0; k < cracks.cracks.size(); ++k)
            {
              const auto crack = along_axis(scene, cracks.cracks[k]);
              if (!crack || is_slender(*crack))
                continue;
              const double h      = scene.domain.spacing()[crack->axis];
              double       gained = 0., most = 0.;
              for (const double beyond : crack->beyond)
                {
                  gained += beyond;
                  most = std::max(most, std::abs(beyond));
                }
              if (most < tolerable)
                continue;
              // K goes with the root of the length over that of the ligament (Feddersen's centre
              // crack), where the crack comes from a side with its third power: the ligament bends.
              const double of_ligament = crack->beyond.size() == 1 ? 1.5 : 0.5;
              const double share =
                gained * h * (0.5 / crack->length + of_ligament / crack->ligament);
              notes.push_back(
                "crack " + std::to_string(k + 1) + " (section 'Cracks') ends " +
                rounded_text(most) +
                " of a cell from the cells that it takes away ('Mesh = removed'): to finite elements it is " +
                rounded_text(std::abs(gained) * h) + (gained > 0. ? " longer" : " shorter") +
                " in all, which makes stress intensities " + rounded_text(100. * std::abs(share)) +
                " % or more too " + (gained > 0. ? "large" : "small") +
                ". 'Cells' in section 'Domain' with which its ends lie on edges of cells, or 'Mesh = faces', make up for it.");
            }
        }
    }


    /**
     * Cracks along sides nearer than they are long, as in cantilevers: what stress intensities are
     * off, by models.
     */
    template <int dim>
    void note_slender_cracks(const Scene<dim> &scene, std::vector<std::string> &notes)
    {
      if constexpr (dim == 2)
        {
          const auto &cracks  = scene.cracks;
          const bool  removed = cracks.mesh == CrackMesh::removed,
                     bonds    = runs(scene, ModelKind::peridynamics);
          if (scene.domain.shape != Shape::box || !cracks.tips.empty() ||
              !scene.elasticity.is_static() || scene.material.breaks() || !(removed || bonds))
            return;
          for (unsigned int k = 0; k < cracks.cracks.size(); ++k)
            {
              const auto crack = along_axis(scene, cracks.cracks[k]);
              if (!crack || !is_slender(*crack))
                continue;
              // Measured (doc/fracture.md), over the heights of arms.
              const Tensor<1, 2> h     = scene.domain.spacing();
              const double       along = h[crack->axis] / crack->arm,
                           cell        = h[1 - crack->axis] / crack->arm,
                           m           = scene.horizon() / h[1 - crack->axis];
              std::vector<std::string> parts;
              const auto add = [&](const ModelKind kind, const double first, const double second) {
                const auto size = [](const double share) {
                  return rounded_text(100. * std::abs(share)) + " % too " +
                         (share > 0. ? "large" : "small");
                };
                if (runs(scene, kind))
                  parts.push_back("K_I " + size(first) + " and K_II " + size(second) + " (" +
                                  to_string(kind) + ")");
              };
              if (removed && !scene.cuts_in_part_at_tips())
                {
                  double first = 0., second = 0.;
                  for (const double beyond : crack->beyond)
                    if (const double found = 0.63 * cell + 2.1 * beyond * along;
                        first == 0. || std::abs(found) > std::abs(first))
                      {
                        first  = found;
                        second = 2.7 * cell + 0.9 * beyond * along;
                      }
                  add(ModelKind::finite_elements, first, second);
                }
              if (removed)
                add(ModelKind::coupled, 0.09 * m * cell, 0.5 * m * cell);
              if (bonds)
                parts.push_back("K_I up to " + rounded_text(100. * (removed ? 0.25 : 0.5) * cell) +
                                " % off and K_II " + rounded_text(60. * cell) +
                                " % too small (peridynamics)");
              if (parts.empty())
                continue;
              notes.push_back(
                "crack " + std::to_string(k + 1) + " (section 'Cracks') parts slender arms" +
                (removed ? ", which the cells that it takes away ('Mesh = removed') make thinner" :
                           "") +
                ". By what double cantilevers and end-notched beams have shown, expect " +
                join_names(parts) + "." +
                (removed ?
                   " To elements twice as many cells halve that; on faces ('Mesh = faces') they are off by some tenths of a percent." :
                   ""));
            }
        }
    }


    /** Round holes of few cells with a load on their rim: how much too wide they get, by models. */
    template <int dim>
    void note_loaded_holes(const Scene<dim> &scene, std::vector<std::string> &notes)
    {
      const auto &conditions = scene.boundary_conditions;
      if (dim == 1 || !scene.domain.has_lattice() ||
          std::none_of(conditions.traction.begin(),
                       conditions.traction.end(),
                       [&](const VectorCondition &condition) {
                         return conditions.side_of(condition.id) == hole_boundary_id;
                       }))
        return;
      // The radius of the circle of the same area, of holes that are about as long as wide and have
      // a side that is not along the cells.
      const Holes<dim> &holes  = scene.domain.holes;
      double            radius = std::numeric_limits<double>::max();
      if (holes.has_one &&
          (holes.shape == HoleShape::circle || std::abs(std::remainder(holes.angle, 90.)) > 1e-9))
        radius = holes.radius;
      for (const Hole &hole : holes.listed)
        if (const auto [low, high] = hole.box();
            !hole.text.empty() && hole.area() > 0.3 * low.distance_square(high) / 2. &&
            hole.area() < (1. - 1e-9) * (high[0] - low[0]) * (high[1] - low[1]))
          radius = std::min(radius, std::sqrt(hole.area() / numbers::PI));
      const Tensor<1, dim> h     = scene.domain.spacing();
      const double         cells = radius / std::max(h[0], h[std::min(1, dim - 1)]);
      // Measured (doc/parts.md).
      std::vector<std::string> parts;
      const auto               add = [&](const ModelKind kind, const double share) {
        if (runs(scene, kind) && share >= 0.05 * cells)
          parts.push_back(rounded_text(100. * share / cells) + " % (" + to_string(kind) + ")");
      };
      add(ModelKind::finite_elements, 0.6);
      add(ModelKind::coupled, 0.6);
      add(ModelKind::peridynamics, 1.5);
      if (!parts.empty())
        notes.push_back(
          "A hole with a load on its rim has " + rounded_text(cells) +
          " cells to its radius, and stairs of cells in place of the rim. What acts there is that of the true rim, but circular bores under pressure were found up to " +
          join_names(parts) +
          " too wide at their rims. Twice as many cells halve that; on a mesh from a file faces can lie on the rim.");
    }


    /** Cracks at an angle to the rows of nodes, from which bonds break in groups. */
    template <int dim>
    void note_slow_oblique_cracks(const Scene<dim> &scene, std::vector<std::string> &notes)
    {
      constexpr double from = 3., to = 42.; // degrees
      if constexpr (dim == 2)
        {
          if (!scene.material.breaks() || !scene.elasticity.is_static() ||
              scene.elasticity.breaks_in_motion() || !scene.domain.has_lattice() ||
              scene.elasticity.text("Crack direction") == "mean tension")
            return;
          for (unsigned int k = 0; k < scene.cracks.cracks.size(); ++k)
            {
              const Tensor<1, 2> way   = scene.cracks.cracks[k][1] - scene.cracks.cracks[k][0];
              const double       angle = std::atan2(std::min(std::abs(way[0]), std::abs(way[1])),
                                              std::max(std::abs(way[0]), std::abs(way[1]))) *
                                   180. / numbers::PI;
              if (angle > from && angle < to)
                notes.push_back(
                  "crack " + std::to_string(k + 1) + " (section 'Cracks') lies at " +
                  rounded_text(angle) +
                  " degrees to the rows of nodes. In slow loading bonds break in groups where bodies are at rest, and it turns into the rows, where fewest are in its way. "
                  "With 'Breaking = in motion' in section 'Elasticity' it hardly does, with 'Solver = dynamics' it does not, nor where the lattice lies along it.");
            }
        }
    }


    /** The smallest and the largest Poisson ratio in cells of the body. Collective. */
    template <int dim>
    std::pair<double, double> poisson_ratios(const Scene<dim>         &scene,
                                             const Triangulation<dim> &mesh)
    {
      double lowest = 1., highest = -1.;
      for (const auto &cell : mesh.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            const double nu = scene.moduli(cell->center()).poisson();
            lowest          = std::min(lowest, nu);
            highest         = std::max(highest, nu);
          }
      return {Utilities::MPI::min(lowest, mesh.get_communicator()),
              Utilities::MPI::max(highest, mesh.get_communicator())};
    }


    /** Bonds alone have a Poisson ratio of their own, and keep the bulk modulus. */
    template <int dim>
    void note_own_poisson_ratio(const Scene<dim>         &scene,
                                const double              lowest,
                                const double              highest,
                                std::vector<std::string> &notes)
    {
      if (dim == 1 || !scene.elasticity.is_bond_based() || !runs(scene, ModelKind::peridynamics))
        return;
      const double own = bond_based_poisson(dim, scene.elasticity.plane);
      if (std::max(highest - own, own - lowest) < 1e-3)
        return;
      std::string found = number_text(lowest);
      if (highest > lowest)
        found += " to " + number_text(highest);
      notes.push_back(
        "'Model = bond-based' in section 'Elasticity' has a Poisson ratio of " + number_text(own) +
        " whatever 'Material' says, which is " + found +
        ": only the stiffness against equal strains in all directions is that of the material. "
        "Use 'state-based', or that Poisson ratio.");
    }


    template <int dim>
    class SolidFactory : public ProblemFactory<dim>
    {
    public:
      void require_computable(const Scene<dim> &scene) const override
      {
        for (const ModelKind model : scene.general.models)
          if (model == ModelKind::peridynamics)
            StateOperator<dim>::require(scene);
          else
            ElasticElements<dim>::require(scene, model == ModelKind::coupled);
        refuse_deformation(scene);
        if (scene.elasticity.is_static())
          require_equilibrium(scene);
        if (scene.heat)
          of_heat_problem([&] { require_diffusion(*scene.heat); });
      }

      unsigned int n_components() const override
      {
        return dim;
      }

      bool may_solve_again(const Scene<dim> &scene) const override
      {
        return scene.elasticity.is_static() &&
               (scene.material.breaks() || !scene.cracks.tips.empty());
      }

      void note_scene(const Scene<dim>         &scene,
                      const Triangulation<dim> &mesh,
                      std::vector<std::string> &notes) const override
      {
        const auto [lowest, highest] = poisson_ratios(scene, mesh);
        note_own_poisson_ratio(scene, lowest, highest, notes);
        note_locking(scene, highest, notes);
        note_tips_in_cells(scene, notes);
        note_slender_cracks(scene, notes);
        note_loaded_holes(scene, notes);
        note_slow_oblique_cracks(scene, notes);
        note_growth(scene, notes);
      }

      std::unique_ptr<Problem<dim>> make_problem(Model<dim>       &model,
                                                 const Scene<dim> &scene) const override
      {
        if (scene.heat)
          {
            model.share_nodes(scene);
            model.share_nodes(*scene.heat);
          }
        return std::make_unique<SolidProblem<dim>>(make_solid_field(model, scene));
      }

      /** What computes the temperature. */
      void add_companions(const Models<dim>        &models,
                          const Scene<dim>         &scene,
                          std::vector<std::string> &notes) const override
      {
        if (!scene.heat)
          return;
        std::vector<std::string> of_heat;
        note_diffusion(*scene.heat, of_heat);
        for (const auto &model : models)
          {
            std::unique_ptr<DiffusionField<dim>> field;
            with_formulas(model->mesh.get_communicator(),
                          [&] { field = make_diffusion_field(*model, *scene.heat); });
            auto heat = std::make_unique<DiffusionProblem<dim>>(std::move(field));
            for (const std::string &note : heat->notes())
              of_heat.push_back(note);
            const auto solid = dynamic_cast<SolidProblem<dim> *>(model->problem.get());
            Assert(solid, ExcMessage("Only problems of this factory have a temperature to find."));
            solid->heat = heat.get();
            model->companions.push_back(std::move(heat));
          }
        for (const std::string &note : of_heat)
          notes.push_back("temperature: " + note);
      }
    };
  } // namespace


  template <int dim>
  std::unique_ptr<ProblemFactory<dim>> make_solid_factory()
  {
    return std::make_unique<SolidFactory<dim>>();
  }


  PERIDEAL_INSTANTIATE_FUNCTION(make_solid_factory);
} // namespace PeriDeal
