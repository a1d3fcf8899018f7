// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "diffusion_notes.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

#include <perideal/analysis/decay_rate.h>
#include <perideal/base/place_text.h>
#include <perideal/laws/crack_conductance.h>
#include <perideal/laws/lattice_family.h>
#include <perideal/problems/diffusion_bounds.h>
#include <perideal/scene/expression.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <array>
#include <cmath>


namespace PeriDeal
{
  using namespace dealii;

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


    /** Sides of the box at which the families of bonds alone end. */
    template <int dim>
    std::array<bool, 2 * dim> sides_that_cut(const Scene<dim> &scene)
    {
      const auto               &conditions = scene.boundary_conditions;
      const bool                fictitious = scene.peridynamics.has_fictitious_nodes();
      std::array<bool, 2 * dim> cut;
      for (unsigned int side = 0; side < 2 * dim; ++side)
        {
          const bool given = std::any_of(conditions.dirichlet.begin(),
                                         conditions.dirichlet.end(),
                                         [&](const auto &value) { return value.id == side; });
          cut[side]        = !(fictitious && given) &&
                      std::count(conditions.symmetry.begin(), conditions.symmetry.end(), side) == 0;
        }
      return cut;
    }


    /**
     * How many spacings longer (or shorter) a body seems between two opposite sides with given
     * values, which the outermost rows of nodes have: by a chain of rows.
     */
    template <int dim>
    double extra_length(const std::vector<FamilyMember<dim>> &family,
                        const unsigned int                    axis,
                        const unsigned int                    n_rows,
                        const double                          first_row,
                        const bool                            at_centers)
    {
      int reach = 0; // of a member
      for (const FamilyMember<dim> &member : family)
        reach = std::max(reach, member.offset[axis]);
      const int           n = std::min<int>(n_rows, 12 * reach + 2);
      std::vector<double> along(reach + 1, 0.); // conductance between rows, relative
      double              whole = 0.;
      for (const FamilyMember<dim> &member : family)
        if (const int step = member.offset[axis]; step > 0)
          {
            along[step] += member.weight;
            whole += member.weight * step * step;
          }
      const auto volume = [&](const int row) { return row == 0 || row == n - 1 ? first_row : 1.; };
      FullMatrix<double>     matrix(n - 2, n - 2);
      dealii::Vector<double> right(n - 2), values(n - 2);
      const auto             conductance = [&](const int a, const int b) {
        const int step = std::abs(a - b);
        return step == 0 || step > reach ? 0. : along[step] / whole * volume(a) * volume(b);
      };
      for (int a = 1; a < n - 1; ++a)
        for (int b = 0; b < n; ++b)
          {
            matrix(a - 1, a - 1) += conductance(a, b);
            if (b > 0 && b < n - 1 && a != b)
              matrix(a - 1, b - 1) -= conductance(a, b);
            if (b == n - 1)
              right(a - 1) += conductance(a, b);
          }
      matrix.gauss_jordan();
      matrix.vmult(values, right);
      double flow = conductance(0, n - 1);
      for (int a = 1; a < n - 1; ++a)
        flow += conductance(0, a) * values(a - 1);
      return 1. / flow - (at_centers ? n : n - 1);
    }


    /** Of the two sides across a direction those with a given value. */
    template <int dim>
    unsigned int n_given(const Scene<dim> &scene, const unsigned int axis)
    {
      const auto &given = scene.boundary_conditions.dirichlet;
      return std::count_if(given.begin(), given.end(), [&](const auto &value) {
        return value.id < 2 * dim && value.id / 2 == axis;
      });
    }
  } // namespace


  template <int dim>
  double missing_width(const std::vector<FamilyMember<dim>> &family,
                       const unsigned int                    axis,
                       const double                          first_row)
  {
    const unsigned int along = (axis + 1) % dim;
    const auto         part  = [&](const FamilyMember<dim> &member) {
      const double step = member.offset[along];
      return member.weight * step * step;
    };
    double whole   = 0.;
    int    reaches = 0;
    for (const FamilyMember<dim> &member : family)
      {
        whole += part(member);
        reaches = std::max(reaches, member.offset[axis]);
      }
    double     missing = 0.;
    const auto volume  = [&](const int row) { return row == 0 ? first_row : 1.; };
    for (int row = 0; row < reaches; ++row)
      {
        double there = 0.;
        for (const FamilyMember<dim> &member : family)
          if (row + member.offset[axis] >= 0)
            there += volume(row + member.offset[axis]) * part(member);
        missing += volume(row) * (1. - there / whole);
      }
    return missing;
  }


  template <int dim>
  void note_unseen_source(const Scene<dim>         &scene,
                          const Triangulation<dim> &mesh,
                          std::vector<std::string> &notes)
  {
    constexpr double   most_points = 2e5, tolerable = 0.1;
    const Expression  &source = scene.initial_and_source.source;
    const unsigned int n      = static_cast<unsigned int>(
      std::min(16., std::pow(most_points / mesh.n_global_active_cells(), 1. / dim)));
    if (source.is_constant() || n < 4)
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
    const double horizon = scene.horizon(), kappa = scene.material.conductivity.value(Point<dim>());
    double       ratio = 3.;
    if (scene.domain.has_lattice())
      {
        const Tensor<1, dim> h = scene.domain.spacing();
        ratio                  = horizon / *std::min_element(h.begin_raw(), h.end_raw());
      }
    const double H = contact_conductance_of_transmission(t, kappa, horizon, ratio);
    notes.push_back(
      "'Transmission = " + rounded_text(t) +
      "' in section 'Cracks' is the fraction that bonds of this horizon, " + rounded_text(horizon) +
      ", keep: it acts like a contact conductance of about " + rounded_text(H) +
      " here, and with half the horizon of " + rounded_text(2. * H) +
      ". 'Contact conductance' is a property of the crack, the same on each lattice.");
  }


  template <int dim>
  void note_smooth_field(const Scene<dim> &scene, std::vector<std::string> &notes)
  {
    constexpr double    tolerable = 1e-3, worse = 2.;
    const Peridynamics &p = scene.peridynamics;
    if (!runs(scene, ModelKind::peridynamics) || scene.domain.shape != Shape::box ||
        !scene.cracks.cracks.empty() || p.horizon > 0. || scene.time.steady ||
        p.self_term != SelfTerm::none || !scene.material.phases.all().names.empty() ||
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
                                            p.volume_fraction,
                                            p.calibration);
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
          (length > 0. ?
             ", a gap " + rounded_text(volume / length) + " wide in the mean, in place of a crack" :
             std::string()) +
          ". 'pairs' with 'Surface correction = crack scaling' (section 'Peridynamics') keeps the conduction along it.");
      }
    return list;
  }


  template <int dim>
  std::string note_on_cut_families(const Scene<dim> &scene, const KernelWeights<dim> &weights)
  {
    const Peridynamics &p = scene.peridynamics;
    if (!scene.domain.has_lattice() || weights.members().empty() ||
        p.surface_correction == SurfaceCorrection::energy)
      return {};
    const auto cut         = sides_that_cut(scene);
    const bool partial     = p.nodal_volume == NodalVolume::partial,
               at_centers  = scene.domain.has_nodes_at_centers(),
               of_itself   = !p.is_given("Boundary treatment");
    const double first_row = at_centers || !partial ? 1. : 0.5;
    double       most = 0., width = 0., longest = 0., length = 0.;
    unsigned int axis = 0, along = 0;
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double cells = scene.domain.cells[d];
        if (const unsigned int n = cut[2 * d] + cut[2 * d + 1]; dim > 1 && n > 0)
          {
            const double one = missing_width<dim>(weights.members(), d, first_row);
            if (n * one / cells > most)
              {
                most  = n * one / cells;
                width = one * scene.domain.spacing()[d];
                axis  = d;
              }
          }
        if (const unsigned int n = n_given(scene, d);
            p.treatment == BoundaryTreatment::none && n > 0 && cells > 3)
          {
            const double extra = 0.5 * n *
                                 extra_length<dim>(weights.members(),
                                                   d,
                                                   scene.domain.cells[d] + (at_centers ? 0 : 1),
                                                   first_row,
                                                   at_centers);
            if (std::abs(extra) / cells > std::abs(longest))
              {
                longest = extra / cells;
                length  = extra * scene.domain.spacing()[d];
                along   = d;
              }
          }
      }
    if (!of_itself && most < tolerable_missing_share && std::abs(longest) < tolerable_missing_share)
      return {};
    std::string what;
    if (most > 0.)
      {
        std::vector<std::string> names;
        for (unsigned int side = 2 * axis; side < 2 * axis + 2; ++side)
          if (cut[side])
            names.push_back("'" + name_of_side(side, true) + "'");
        what = "families end at the " + std::string(names.size() == 1 ? "side " : "sides ") +
               join_names(names) + ": along " + (names.size() == 1 ? "it" : "each of them") +
               " the body conducts as if it was " + rounded_text(width) + " narrower, " +
               rounded_text(100. * most) + " % of its width in all. ";
      }
    if (longest != 0.)
      what +=
        std::string(most > 0. ? "Between" : "families end at sides with given values: between") +
        " sides with given values it conducts along " + "xyz"[along] + " as if it was " +
        rounded_text(std::abs(length)) + (length > 0. ? " longer, " : " shorter, ") +
        rounded_text(100. * std::abs(longest)) + " %. ";
    if (what.empty())
      return {};
    const auto        obstacle = scene.obstacle_to_bonds_on_elements();
    const std::string symmetry =
      dim > 1 ?
        ", nor does 'Symmetry' (section 'Boundary conditions') at sides without a given value." :
        ".";
    const std::string exchange = "'Boundary treatment = exchange' in section 'Peridynamics'";
    if (obstacle.first.empty())
      return what + exchange + " lacks nothing there" + symmetry;
    return what +
           (of_itself ?
              "'Boundary treatment = auto' in section 'Peridynamics' is 'none' here and not "
              "'exchange', which lacks nothing there: " :
              exchange + " lacks nothing there, but is not for what this scene has: ") +
           obstacle.first + " " + obstacle.second + ".";
  }


  template <int dim>
  std::string note_on_one_direction(const Scene<dim> &scene, const DiffusionBonds<dim> &bonds)
  {
    constexpr double    much = 1.1;
    const Peridynamics &p    = scene.peridynamics;
    if (dim == 1 || scene.cracks.cracks.empty() ||
        p.surface_correction != SurfaceCorrection::energy ||
        p.correction_direction == CorrectionDirection::both)
      return {};
    double                                          largest = 0.;
    std::vector<typename DiffusionBonds<dim>::Bond> family;
    for (unsigned int i = 0; i < bonds.nodes().n_owned(); ++i)
      if (bonds.near_crack(i))
        {
          bonds.bonds_of(i, family, false);
          for (const auto &bond : family)
            if (!bond.cut)
              largest = std::max(largest, bond.weight / bond.intact);
        }
    largest = Utilities::MPI::max(largest, bonds.nodes().communicator());
    if (largest < much)
      return {};
    const std::string direction(1, "xyz"[static_cast<unsigned int>(p.correction_direction)]);
    return "'Correction direction = " + direction +
           "' in section 'Peridynamics' makes all bonds of a node stronger for those that it lacks in " +
           direction + ", beside cracks up to " + rounded_text(largest) +
           " times: along the crack the body conducts too much there. With 'both' each direction has its own factor.";
  }


  std::string note_on_fast_waves(const Stepper &stepper, const double end_time)
  {
    constexpr double tolerable = 0.02;
    const double     left      = stepper.left_of_fast_waves();
    if (!(left > 0.))
      return {};
    const double n = std::max(1., std::round(end_time / stepper.current_step()));
    if (std::pow(left, n) < tolerable)
      return {};
    return "a step of '" + stepper.name() + "' leaves up to " + rounded_text(left) +
           " of waves that it does not resolve, the " + rounded_text(n) + " steps of this run " +
           rounded_text(std::pow(left, n)) +
           ": what jumps, at the start or at a side, stays and rings. 'Time step = auto' in section 'Time' begins with steps that damp it, and 'Stepper = sdirk2' damps it in steps of any size.";
  }


  std::string note_on_divided_steps(const Stepper &stepper)
  {
    const StepperCost &cost = stepper.cost();
    if (cost.divided == 0)
      return {};
    return (cost.divided == 1 ?
              "one 'Time step' was divided, into " :
              std::to_string(cost.divided) +
                " steps of 'Time step' (section 'Time') were divided, into up to ") +
           std::to_string(cost.most_parts) +
           " parts, since the iterations for the material's dependence on the temperature did not converge in longer ones.";
  }


#define PERIDEAL_INSTANTIATE(dim)                                                            \
  template double missing_width<dim>(const std::vector<FamilyMember<dim>> &,                 \
                                     const unsigned int,                                     \
                                     const double);                                          \
  template void   note_unseen_source(const Scene<dim> &,                                     \
                                     const Triangulation<dim> &,                             \
                                     std::vector<std::string> &);                            \
  template void   note_transmission(const Scene<dim> &, std::vector<std::string> &);         \
  template void   note_smooth_field(const Scene<dim> &, std::vector<std::string> &);         \
  template std::vector<std::string> notes_on_cells(const DoFHandler<dim> &,                  \
                                                   const Scene<dim> &,                       \
                                                   const std::vector<bool> &);               \
  template std::string note_on_cut_families(const Scene<dim> &, const KernelWeights<dim> &); \
  template std::string note_on_one_direction(const Scene<dim> &, const DiffusionBonds<dim> &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
