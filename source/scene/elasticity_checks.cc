// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// What elasticity needs of the rest of a scene.

#include <perideal/scene/lists.h>
#include <perideal/scene/rigid_motions.h>

#include <algorithm>
#include <limits>

#include "scene_checks.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** Of the corners of a crack to a side of the box. */
    template <int dim>
    double distance_to_side(const Scene<dim>              &scene,
                            const std::vector<Point<dim>> &crack,
                            const types::boundary_id       side)
    {
      const unsigned int axis    = side / 2;
      double             nearest = std::numeric_limits<double>::max();
      for (const Point<dim> &p : crack)
        nearest = std::min(nearest,
                           side % 2 == 0 ? p[axis] - scene.domain.lower[axis] :
                                           scene.domain.upper[axis] - p[axis]);
      return nearest;
    }


    /** What families that go on beyond the sides cannot have. */
    template <int dim>
    void check_fictitious_nodes(const Scene<dim> &scene)
    {
      const Peridynamics &pd = scene.peridynamics;
      if (!pd.completes_families())
        return;
      const auto refuse =
        [&](const bool given, const std::string &what, const std::string &remedy) {
          if (given)
            entry_error(pd.where("Surface correction"), "'fictitious nodes' " + what + remedy);
        };
      const std::string other = " Use another correction, or ";
      const bool        alone = runs(scene, ModelKind::peridynamics);
      refuse(!alone && !runs(scene, ModelKind::coupled),
             "has no effect without 'Models = peridynamics' or 'coupled'.",
             " Use 'none'.");
      refuse(runs(scene, ModelKind::coupled) && scene.coupling.scheme == CouplingScheme::exchange,
             "is not for 'Scheme = exchange', whose bonds need no correction.",
             " Use 'none', or 'splice' or 'blending'.");
      refuse(
        scene.domain.nodes != NodePlacement::vertices,
        "continues the displacement from nodes on the sides, and 'Nodes' in section 'Domain' is 'cell centers'.",
        other + "'vertices'.");
      refuse(!scene.domain.has_lattice() || scene.domain.shape == Shape::image,
             "needs flat sides of a lattice, which this 'Shape' in section 'Domain' has not.",
             other + "'box' or 'plate with hole'.");
      refuse(pd.nodal_volume != NodalVolume::partial,
             "needs 'Nodal volume = partial'.",
             other + "that.");
      refuse(scene.cracks.mesh == CrackMesh::faces && !scene.cracks.cracks.empty(),
             "is not for cracks with 'Mesh = faces', where two nodes are at one place.",
             other + "'removed'.");
      refuse(scene.elasticity.kinematics == Kinematics::full,
             "is not for 'Kinematics = full'.",
             other + "'linear'.");
      const auto &symmetry = scene.boundary_conditions.symmetry;
      refuse(
        !symmetry.empty() && runs(scene, ModelKind::coupled) &&
          scene.coupling.scheme == CouplingScheme::splice,
        "and 'Scheme = splice' do not go with 'Symmetry' in section 'Boundary conditions': nothing would tell its lost forces from those of the other half.",
        " Hold the side by 'Displacement', or use 'blending'.");
      const double reach = scene.horizon() + scene.domain.spacing().norm();
      for (const types::boundary_id side : symmetry)
        for (const CrackPiece<dim> &piece : scene.cracks.pieces(scene.time.end_time))
          refuse(distance_to_side(scene, piece.corners, side) < reach,
                 "cannot mirror a crack that comes within a horizon of the plane of symmetry '" +
                   name_of_side(side, true) + "'.",
                 " Hold that side by 'Displacement', or use another correction.");
      for (const types::boundary_id side : symmetry)
        refuse(
          side % 2 == 0 && std::count(symmetry.begin(), symmetry.end(), side + 1) > 0,
          "knows one plane of symmetry along each axis, and 'Symmetry' in section 'Boundary conditions' has '" +
            name_of_side(side, true) + "' and '" + name_of_side(side + 1, true) + "'.",
          " Hold one of these sides by 'Displacement'.");
      refuse(scene.material.fracture_energy || scene.material.critical_stretch,
             "is not for bonds that may break.",
             other + "leave 'Fracture energy' and 'Critical stretch' out.");
      refuse(
        scene.boundary_conditions.traction_layer > 0.,
        "lets tractions act on the sides themselves; 'Traction layer' in section 'Boundary conditions' has no effect.",
        " Leave that out.");
      refuse(dim > 1 && scene.elasticity.model == ElasticModel::bond_based,
             "is for 'Model = state-based' in section 'Elasticity'.",
             other + "that.");
      refuse(pd.form == OperatorForm::lattice,
             "makes a matrix; 'Operator form' is 'lattice'.",
             other + "'auto'.");
    }


    /** Entries of section `Peridynamics` that elasticity does not have. */
    template <int dim>
    void check_peridynamics(const Scene<dim> &scene)
    {
      const Peridynamics &pd     = scene.peridynamics;
      const auto          refuse = [&](const bool         given,
                              const std::string &entry,
                              const std::string &what,
                              const std::string &remedy) {
        if (given)
          entry_error(pd.where(entry), what + " with 'Physics = elasticity'; " + remedy);
      };
      const std::string no_effect = "has no effect";
      // On square cells any factor cancels; on others the factors of `discrete` make theta exact
      // (doc/elasticity.md).
      refuse(pd.calibration != Calibration::discrete,
             "Calibration",
             "'analytic' is not for use",
             "bonds are scaled by the sums over their own families. Leave the entry out.");
      refuse(pd.self_term != SelfTerm::none, "Self term", no_effect, "use 'none'.");
      refuse(pd.flux_treatment != FluxTreatment::natural,
             "Flux treatment",
             no_effect,
             "use 'natural'.");
      refuse(pd.surface_correction == SurfaceCorrection::crack_scaling &&
               !runs(scene, ModelKind::coupled),
             "Surface correction",
             "'crack scaling' without 'Models = coupled' " + no_effect,
             "use 'none', 'volume', 'energy' or 'moments'.");
      refuse(pd.corrects_elastic_bonds() && !runs(scene, ModelKind::peridynamics),
             "Surface correction",
             "without 'Models = peridynamics' " + no_effect,
             "use 'none'.");
      refuse(
        pd.corrects_elastic_bonds() && scene.material.fracture_energy,
        "Surface correction",
        "with 'Fracture energy' in section 'Material' bonds at surfaces would break at another energy",
        "use 'none', or give 'Critical stretch'.");
      check_fictitious_nodes(scene);
      refuse(pd.correction_direction != CorrectionDirection::both,
             "Correction direction",
             no_effect,
             "use 'both'.");
      refuse(
        pd.treatment != BoundaryTreatment::none && pd.treatment != BoundaryTreatment::automatic,
        "Boundary treatment",
        pd.treatment == BoundaryTreatment::exchange ?
          "'exchange' has no place for a nonlocal dilatation" :
          "fictitious nodes and layers are not defined",
        "use 'none'; 'Surface correction' and 'Traction layer' are for the surfaces of elastic bodies.");
      if (pd.form != OperatorForm::lattice)
        return;
      const std::string not_lattice = "'lattice' is not defined", use = "use 'auto'.";
      refuse(!runs(scene, ModelKind::peridynamics),
             "Operator form",
             not_lattice + " without 'Models = peridynamics'",
             use);
      refuse(pd.corrects_elastic_bonds(),
             "Operator form",
             not_lattice + " with 'Surface correction'",
             use);
      refuse(scene.elasticity.kinematics == Kinematics::full,
             "Operator form",
             not_lattice + " for 'Kinematics = full'",
             use);
      refuse(scene.material.fracture_energy || scene.material.critical_stretch,
             "Operator form",
             not_lattice + " where bonds may break",
             use);
    }


    /** Entries of other sections that elasticity does not have. */
    template <int dim>
    void check_other_sections(const Scene<dim> &scene)
    {
      if (scene.domain.has_extra_layers() && scene.elasticity.computes_temperature)
        entry_error(
          scene.domain.where("Extra layers"),
          "cannot be used with 'Temperature change = computed' in section 'Elasticity', whose heat would flow through them. Use 0, or a formula there.");
      if (scene.finite_elements.consistent_capacity && !scene.elasticity.computes_temperature)
        entry_error(
          scene.finite_elements.where("Capacity"),
          "'consistent' is for what diffuses; masses are lumped with 'Physics = elasticity'.");
    }


    template <int dim>
    void check_coupling_of_elasticity(const Scene<dim> &scene)
    {
      if (!runs(scene, ModelKind::coupled))
        return;
      if (scene.coupling.zone == ZoneKind::adaptive)
        entry_error(
          scene.coupling.where("Zone"),
          "'adaptive' is for what diffuses; with 'Physics = elasticity' use 'cracks: 1' or a formula.");
      if (scene.elasticity.kinematics == Kinematics::full)
        entry_error(
          scene.elasticity.where("Kinematics"),
          "'full' is not for 'Models = coupled', whose coefficients are those of the undeformed body.");
      if (scene.coupling.scheme == CouplingScheme::exchange)
        return;
      if (scene.cracks.mesh == CrackMesh::faces && !scene.cracks.cracks.empty())
        entry_error(
          scene.cracks.where("Mesh"),
          "'faces' is for 'Scheme = exchange' in section 'Coupling': the families of others know one node at each place. Use 'removed'.");
      if (!scene.domain.has_lattice())
        entry_error(
          scene.domain.where("Shape"),
          "'mesh file' is for 'Scheme = exchange' in section 'Coupling': the families of others lie on a lattice. Use 'box' or 'plate with hole'.");
      const std::string scheme =
        "'Scheme = " + scene.coupling.scheme_text() + "' in section 'Coupling'";
      if (scene.peridynamics.surface_correction != SurfaceCorrection::none &&
          scene.peridynamics.surface_correction != SurfaceCorrection::automatic &&
          !scene.peridynamics.completes_families())
        entry_error(scene.peridynamics.where("Surface correction"),
                    "is for 'Scheme = exchange', not for " + scheme +
                      "; use 'none' or 'fictitious nodes'.");
      if (dim > 1 && scene.elasticity.model == ElasticModel::bond_based)
        entry_error(
          scene.elasticity.where("Model"),
          "'bond-based' is not for " + scheme +
            ": its zone would have a Poisson ratio of its own. Use 'state-based', or 'Scheme = exchange'.");
      if (scene.coupling.scheme == CouplingScheme::splice &&
          scene.elasticity.solver != ElasticSolver::linear)
        entry_error(scene.elasticity.where("Solver"),
                    "'" + scene.elasticity.solver_name() +
                      "' needs forces that have an energy, which those of " + scheme +
                      " have not. Use 'linear', or 'Scheme = blending'.");
    }


    /** A crack that opens at a side of the body would be closed by the layers beyond. */
    template <int dim>
    void check_extra_layers(const Scene<dim> &scene)
    {
      const Domain<dim> &domain = scene.domain;
      for (const CrackPiece<dim> &piece : scene.cracks.pieces(scene.time.end_time))
        for (const Point<dim> &p : piece.corners)
          for (unsigned int d = 0; d < dim; ++d)
            {
              const double slack = 1e-9 * (domain.body_upper[d] - domain.body_lower[d]);
              if ((domain.extra_layers[2 * d] > 0 && p[d] < domain.body_lower[d] + slack) ||
                  (domain.extra_layers[2 * d + 1] > 0 && p[d] > domain.body_upper[d] - slack))
                entry_error(
                  domain.where("Extra layers"),
                  "a crack ends at a side of the body that has some, and would be closed by them. Leave them out at that side.");
            }
    }


    /**
     * The width of the body behind a flat side; an error for others, and for a layer that is
     * deeper.
     */
    template <int dim>
    void check_layer(const Scene<dim>      &scene,
                     const VectorCondition &condition,
                     const double           depth,
                     const std::string     &where,
                     const std::string     &list)
    {
      const types::boundary_id side = scene.boundary_conditions.side_of(condition.id);
      if (side >= 2 * dim)
        entry_error(where,
                    "needs flat sides, and '" + list + "' names '" + condition.name +
                      "'. Leave it empty.");
      const unsigned int axis  = side / 2;
      const double       width = scene.domain.upper[axis] - scene.domain.lower[axis];
      if (depth > width)
        entry_error(where,
                    "found " + number_text(depth) + ", wider than the body behind the side '" +
                      condition.name + "', " + number_text(width) +
                      (scene.domain.has_extra_layers() ? " with its extra layers." : "."));
    }


    /** Which bodies and sides displacements can be given in. */
    template <int dim>
    void check_displacement_layer(const Scene<dim> &scene)
    {
      const BoundaryConditions<dim> &conditions = scene.boundary_conditions;
      if (conditions.displacement_layer <= 0.)
        return;
      const std::string where = conditions.where("Displacement layer");
      if (!scene.domain.has_lattice())
        entry_error(
          where,
          "is for the sides of a box, and 'Shape' in section 'Domain' is 'mesh file'. Leave it empty.");
      for (const VectorCondition &condition : conditions.displacement)
        check_layer(scene, condition, conditions.displacement_layer, where, "Displacement");
    }


    /** Which bodies and sides tractions can be spread in. */
    template <int dim>
    void check_traction_layer(const Scene<dim> &scene)
    {
      const BoundaryConditions<dim> &conditions = scene.boundary_conditions;
      if (conditions.traction_layer <= 0.)
        return;
      const std::string where = conditions.where("Traction layer");
      if (!runs(scene, ModelKind::peridynamics))
        entry_error(where,
                    "has no effect without 'Models = peridynamics': finite elements have "
                    "tractions on their faces. Leave it empty.");
      if (!scene.domain.has_lattice())
        entry_error(
          where,
          "needs nodes in rows along the side, which 'Shape = mesh file' in section 'Domain' does not have. Leave it empty.");
      for (const VectorCondition &condition : conditions.traction)
        {
          check_layer(scene, condition, conditions.traction_layer, where, "Traction");
          for (const CrackPiece<dim> &piece : scene.cracks.pieces(scene.time.end_time))
            if (distance_to_side(scene, piece.corners, conditions.side_of(condition.id)) <
                conditions.traction_layer)
              entry_error(
                where,
                "a crack lies within it at the side '" + condition.name +
                  "', and what is behind the crack would be pulled. Leave it empty, or make it thinner.");
        }
    }


    bool is_for_motion(const std::string &stepper)
    {
      return stepper == "verlet" || stepper == "newmark";
    }


    /** An equilibrium has a time only where its loads have. */
    template <int dim>
    void check_time(const Scene<dim> &scene)
    {
      const InitialAndSource &loads     = scene.initial_and_source;
      const std::string      &stepper   = scene.time.stepper;
      const bool              with_heat = scene.elasticity.computes_temperature;
      if (stepper != "auto" && !is_for_motion(stepper) && !with_heat)
        entry_error(
          scene.time.where("Stepper"),
          "'" + stepper +
            "' is for what diffuses; with 'Physics = elasticity' the 'Solver' in section 'Elasticity' decides. Use 'auto', with "
            "'dynamics' also 'verlet' or 'newmark', and with 'Temperature change = computed' those of heat.");
      if (is_for_motion(stepper) && scene.elasticity.is_static())
        entry_error(scene.time.where("Stepper"),
                    "'" + stepper + "' is for motion, but 'Solver' in section 'Elasticity' is '" +
                      scene.elasticity.solver_name() + "'. Use 'Solver = dynamics'.");
      if (!scene.elasticity.is_static())
        {
          if (scene.time.steady)
            entry_error(
              scene.time.where("Steady"),
              "is true, but 'Solver' in section 'Elasticity' is 'dynamics'. Use another solver for the equilibrium.");
          return;
        }
      const auto has_start = [&](const std::vector<Expression> &list, const std::string &entry) {
        if (!list.empty())
          entry_error(loads.where(entry),
                      "has no effect: 'Solver' in section 'Elasticity' is '" +
                        scene.elasticity.solver_name() +
                        "', which finds an equilibrium. Use 'dynamics', or leave the entry out.");
      };
      has_start(loads.initial_displacement, "Initial displacement");
      has_start(loads.initial_velocity, "Initial velocity");
      for (const VectorCondition &condition : scene.boundary_conditions.displacement)
        if (condition.rate)
          entry_error(
            scene.boundary_conditions.where("Velocity"),
            "is for motion, but 'Solver' in section 'Elasticity' is '" +
              scene.elasticity.solver_name() +
              "', which finds an equilibrium. Use 'dynamics', or 'Displacement' with t in its formula.");
      // With a computed temperature it is the heat problem that is steady.
      if (scene.is_loaded_slowly() && scene.time.steady && !with_heat)
        entry_error(
          scene.time.where("Steady"),
          scene.cracks.tips.empty() ?
            "is true, but there are loads that depend on t." :
            "is true, but there are cracks that grow ('Growth' or 'Paths' in section 'Cracks').");
    }


    /** Bonds break where there are bonds. */
    template <int dim>
    void check_fracture(const Scene<dim> &scene)
    {
      const Material &material = scene.material;
      if (!material.fracture_energy && !material.critical_stretch)
        return;
      const std::string where =
        material.where(material.fracture_energy ? "Fracture energy" : "Critical stretch");
      if (runs(scene, ModelKind::coupled))
        entry_error(
          where,
          "is not for 'Models = coupled', whose bonds do not break; use 'peridynamics', or leave the entry out.");
      if (!runs(scene, ModelKind::peridynamics))
        entry_error(
          where,
          "has no effect: finite elements do not break. Add 'peridynamics' to 'Models', or leave the entry out.");
    }


    /** A constant micromodulus is that of a complete family of a lattice, uncorrected. */
    template <int dim>
    void check_micromodulus(const Scene<dim> &scene)
    {
      if (scene.elasticity.micromodulus != Micromodulus::constant)
        return;
      const auto refuse = [&](const bool fault, const std::string &what) {
        if (fault)
          entry_error(scene.elasticity.where("Micromodulus"), "'constant' " + what);
      };
      refuse(
        !runs(scene, ModelKind::peridynamics),
        "is for peridynamics in the whole body: add 'peridynamics' to 'Models', or leave the entry out.");
      refuse(
        !scene.domain.has_lattice(),
        "is that of the complete family of a lattice, which 'Shape = mesh file' has not. Leave the entry out.");
      refuse(
        scene.peridynamics.corrects_elastic_bonds() || scene.peridynamics.completes_families(),
        "leaves surfaces soft, which 'Surface correction' and fictitious nodes (section 'Peridynamics') mend. Leave one of them out.");
    }


    /** Every rigid motion has to be held by some side. */
    template <int dim>
    void check_rigid_motions(const Scene<dim> &scene)
    {
      if (!scene.elasticity.is_static())
        return; // a free body may move
      const std::vector<std::string> motions = free_rigid_motions(scene);
      if (!motions.empty())
        entry_error(scene.boundary_conditions.where("Displacement"),
                    "nothing holds the body against: " + join_names(motions) +
                      ". Give displacements, or 'Symmetry', on sides that do.");
    }
  } // namespace


  template <int dim>
  void check_elasticity(const Scene<dim> &scene)
  {
    if (scene.general.physics != Physics::elasticity)
      {
        if (is_for_motion(scene.time.stepper))
          entry_error(scene.time.where("Stepper"),
                      "'" + scene.time.stepper +
                        "' is for motion ('Physics = elasticity'); 'Physics' is '" +
                        names_of(scene.general.physics).physics + "'. Use 'auto'.");
        if (scene.domain.has_extra_layers())
          entry_error(scene.domain.where("Extra layers"), "is for 'Physics = elasticity'.");
        return;
      }
    const bool changes_temperature = scene.elasticity.computes_temperature ||
                                     !is_zero(scene.elasticity.temperature_change);
    if (changes_temperature && scene.material.thermal_expansion.is_constant() &&
        scene.material.thermal_expansion.value(Point<dim>()) == 0.)
      entry_error(scene.elasticity.where("Temperature change"),
                  "has no effect: 'Thermal expansion' in section 'Material' is 0.");
    if (scene.cracks.mesh == CrackMesh::pairs && !scene.cracks.cracks.empty())
      entry_error(
        scene.cracks.where("Mesh"),
        "'pairs' conduct what diffuses; with 'Physics = elasticity' use 'removed' or 'faces'.");
    if (scene.cracks.conduct())
      entry_error(scene.cracks.where(scene.cracks.contact_conductance < 0. ? "Transmission" :
                                                                             "Contact conductance"),
                  "is for what diffuses; cracks transmit no force with 'Physics = elasticity'.");
    check_displacement_layer(scene);
    check_traction_layer(scene);
    check_extra_layers(scene);
    check_time(scene);
    check_fracture(scene);
    check_micromodulus(scene);
    check_peridynamics(scene);
    check_other_sections(scene);
    check_coupling_of_elasticity(scene);
    check_rigid_motions(scene);
  }


  template void check_elasticity(const Scene<1> &);
  template void check_elasticity(const Scene<2> &);
  template void check_elasticity(const Scene<3> &);
} // namespace PeriDeal
