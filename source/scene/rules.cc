// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/rules.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    const std::string needs_lattice =
      " needs a lattice of cells ('Shape' in section 'Domain' = box or plate with hole), not a mesh file.";
  }


  template <int dim>
  void refuse_cracks(const Scene<dim> &scene)
  {
    const Cracks<dim> &cracks = scene.cracks;
    const auto         refuse = [&](const bool fault, const std::string &what) {
      cracks.refuse(fault && cracks.through_tips == ThroughTips::in_part,
                    "Bonds through tips",
                    "'in part' " + what + "; use 'auto', 'cut' or 'keep'.");
    };
    refuse(!scene.deforms, "is for 'Physics = elasticity'");
    refuse(dim != 2, "is for 'Dimension = 2'");
    refuse(!scene.domain.has_lattice(),
           "is for bodies on a lattice; in one of a mesh file any end of a crack may lie on the "
           "surface");
    refuse(cracks.on_faces(),
           "is for bonds and cells that cracks cut; with 'Mesh = faces' they cut none");
    refuse(cracks.change(), "is for cracks that lie still; here cracks grow or change with time");
    refuse(scene.material.breaks(),
           "is for bonds that do not break; section 'Material' has 'Fracture energy' or "
           "'Critical stretch'");
    cracks.refuse(cracks.on_faces() && cracks.conduct() && scene.domain.coarsening.times > 0,
                  "Contact conductance",
                  "is for meshes without 'Coarsening' (section 'Domain') where 'Mesh' is 'faces'; "
                  "use 'pairs'.");
  }


  template <int dim>
  void refuse_families(const BodyParameters<dim> &body)
  {
    const Domain<dim>  &domain = body.domain;
    const Peridynamics &pd     = body.peridynamics;
    pd.refuse(dim > 1 && pd.extrapolates_layers(),
              "Flux treatment",
              "'layer extrapolation' is for 'Dimension' 1 only; use 'extrapolation'.");
    pd.refuse(dim > 2 && pd.sampling.self_term == SelfTerm::paper,
              "Self term",
              "'paper' is defined for 'Dimension' 1 and 2 only.");
    pd.refuse(pd.correction_direction != CorrectionDirection::both &&
                static_cast<unsigned int>(pd.correction_direction) >= dim,
              "Correction direction",
              "there is no such direction with 'Dimension' = " + std::to_string(dim) + ".");
    pd.refuse(!domain.has_lattice() && pd.sampling.volume_fraction == VolumeFraction::exact,
              "Volume fraction",
              "'exact'" + needs_lattice);
    pd.refuse(!domain.has_lattice() && pd.sampling.calibration == Calibration::isotropic,
              "Calibration",
              "'isotropic'" + needs_lattice);
    pd.refuse(!domain.has_lattice() && pd.sampling.self_term == SelfTerm::paper,
              "Self term",
              "'paper'" + needs_lattice);
    pd.refuse(!domain.has_lattice() && pd.wants_lattice_form(),
              "Operator form",
              "'lattice'" + needs_lattice);
    if (!domain.has_lattice())
      {
        pd.refuse(
          !(pd.horizon > 0.),
          "Horizon",
          "is empty; a mesh file has no node spacing that 'Horizon ratio' could refer to: give a length.");
        return;
      }
    const std::string    entry   = pd.horizon > 0. ? "Horizon" : "Horizon ratio";
    const Tensor<1, dim> h       = domain.spacing();
    const double         horizon = body.horizon();
    double               longest = 0.;
    for (unsigned int d = 0; d < dim; ++d)
      {
        pd.refuse(horizon < h[d] * (1. - 1e-9),
                  entry,
                  "the horizon, " + number_text(horizon) +
                    ", is shorter than the node spacing in " + std::string(1, "xyz"[d]) + ", " +
                    number_text(h[d]) + ": nodes have no neighbours there.");
        longest = std::max(longest, domain.upper[d] - domain.lower[d]);
      }
    pd.refuse(horizon > longest * (1. + 1e-9),
              entry,
              "the horizon, " + number_text(horizon) + ", is longer than the body, " +
                number_text(longest) + ". " +
                (pd.horizon > 0. ?
                   "Choose a shorter one: three spacings of the nodes are " +
                     number_text(3. * *std::max_element(h.begin_raw(), h.end_raw())) + "." :
                   "Choose a smaller one, or more 'Cells' in section 'Domain'."));
  }


  template <int dim>
  void refuse_beyond_sides(const BodyParameters<dim> &body)
  {
    const Peridynamics &pd         = body.peridynamics;
    const auto         &conditions = body.boundary_conditions;
    const auto         &symmetry   = conditions.symmetry;
    const auto          refuse     = [&](const bool fault, const std::string &what) {
      pd.refuse(fault, "Surface correction", "'fictitious nodes' " + what);
    };
    const std::string other = " Use another correction, or ";
    refuse(
      body.domain.has_nodes_at_centers(),
      "continues the displacement from nodes on the sides, and 'Nodes' in section 'Domain' is 'cell centers'." +
        other + "'vertices'.");
    refuse(!body.domain.has_lattice() || body.domain.is_image(),
           "needs flat sides of a lattice, which this 'Shape' in section 'Domain' has not." +
             other + "'box' or 'plate with hole'.");
    refuse(pd.sampling.nodal_volume != NodalVolume::partial,
           "needs 'Nodal volume = partial'." + other + "that.");
    refuse(body.cracks.double_nodes(),
           "is not for cracks with 'Mesh = faces', where two nodes are at one place." + other +
             "'removed'.");
    refuse(body.elasticity.has_full_kinematics(),
           "is not for 'Kinematics = full'." + other + "'linear'.");
    const double reach = body.horizon() + body.domain.spacing().norm();
    for (const types::boundary_id side : symmetry)
      {
        const std::string name = "'" + name_of_side(side, true) + "'";
        refuse(body.cracks.distance_to_side(side) < reach,
               "cannot mirror a crack that comes within a horizon of the plane of symmetry " +
                 name + ". Hold that side by 'Displacement', or use another correction.");
        refuse(
          side % 2 == 0 && std::count(symmetry.begin(), symmetry.end(), side + 1) > 0,
          "knows one plane of symmetry along each axis, and 'Symmetry' in section 'Boundary conditions' has " +
            name + " and '" + name_of_side(side + 1, true) +
            "'. Hold one of these sides by 'Displacement'.");
      }
    refuse(body.material.breaks(),
           "is not for bonds that may break." + other +
             "leave 'Fracture energy' and 'Critical stretch' out.");
    refuse(
      conditions.traction_layer > 0.,
      "lets tractions act on the sides themselves; 'Traction layer' in section 'Boundary conditions' has no effect. Leave that out.");
    refuse(dim > 1 && body.elasticity.is_bond_based(),
           "is for 'Model = state-based' in section 'Elasticity'." + other + "that.");
    refuse(pd.wants_lattice_form(),
           "makes a matrix; 'Operator form' is 'lattice'." + other + "'auto'.");
  }


  namespace
  {
    /** Fictitious nodes of diffusion, or layers in their place. */
    template <int dim>
    void refuse_fictitious_nodes(const BodyParameters<dim> &body)
    {
      const Peridynamics            &pd = body.peridynamics;
      const BoundaryConditions<dim> &bc = body.boundary_conditions;
      pd.refuse(!body.domain.is_box() && pd.has_fictitious_nodes(),
                "Boundary treatment",
                "fictitious nodes need the sides of a box ('Shape' in section 'Domain' = box).");
      pd.refuse(!body.domain.has_lattice() && pd.has_layers(),
                "Boundary treatment",
                "'layer'" + needs_lattice);
      bc.refuse(
        !body.domain.has_lattice() && !bc.symmetry.empty(),
        "Symmetry",
        "mirrors peridynamics in the sides of a box; this body is from a mesh file. Leave the entry out: "
        "a side that is named nowhere is insulated, which is what a plane of symmetry is.");
      bc.refuse(
        !bc.symmetry.empty() && body.cracks.double_nodes() && !body.domain.has_nodes_at_centers(),
        "Symmetry",
        "is not for cracks with 'Mesh = faces' in section 'Cracks', where two nodes are at one place. Use 'Mesh = pairs', or leave the entry out: a side that is named nowhere "
        "is insulated.");
    }


    /** Values that follow from fluxes. */
    template <int dim>
    void refuse_flux_treatment(const BodyParameters<dim> &body)
    {
      const BoundaryConditions<dim> &bc        = body.boundary_conditions;
      const bool                     in_layers = body.peridynamics.extrapolates_layers();
      for (const SurfaceTransfer &given : bc.transfers)
        {
          if (body.peridynamics.natural_fluxes() || given.fixes_level())
            continue;
          const Part *const part    = bc.part(given.id);
          const bool        of_side = part == nullptr || part->kind == Part::of_side;
          bc.refuse(part != nullptr && (!of_side || in_layers),
                    given.kind->entry,
                    "the part '" + given.name +
                      "' is not for 'Flux treatment' in section 'Peridynamics' = " +
                      (of_side ? "layer extrapolation, which is for whole sides." :
                                 "extrapolation, which is for sides and their parts.") +
                      " Use 'natural'.");
          for (const SurfaceTransfer &other : bc.transfers)
            bc.refuse(
              other.fixes_level() && other.id == given.id,
              other.kind->entry,
              "the side '" + given.name + "' is named in '" + given.kind->entry +
                "', too, and with 'Flux treatment' in section 'Peridynamics' = extrapolation its values "
                "follow from the flux alone. Use 'natural' to have both.");
        }
    }
  } // namespace


  template <int dim>
  void refuse_coupling(const BodyParameters<dim> &body)
  {
    const CouplingControl &control  = body.coupling;
    const auto             obstacle = body.obstacle_to_bonds_on_elements();
    if (!obstacle.first.empty())
      entry_error(obstacle.first, obstacle.second + ", for 'Models = coupled'.");
    control.refuse(
      dim == 1 && control.is_near_cracks(),
      "Zone",
      "'" + control.zone_text() +
        "' needs a crack, and bodies of 'Dimension' 1 have none. Give a formula of x, or 'everywhere'.");
    control.refuse(
      (control.is_near_cracks() || control.is_adaptive()) && body.cracks.cracks.empty(),
      "Zone",
      "'" + control.zone_text() +
        "' lies around cracks, but section 'Cracks' has none: the zone is empty. Give a formula, or 'everywhere'" +
        (body.material.breaks() ?
           ", or 'follow', with which bonds appear where the body is about to break." :
           "."));
    double widest = 0.;
    for (unsigned int d = 0; d < dim; ++d)
      widest = std::max(widest, body.domain.upper[d] - body.domain.lower[d]);
    const double overlap =
      body.domain.has_lattice() && control.overlap > 0. ? control.overlap * body.horizon() : 0.;
    control.refuse(overlap > widest,
                   "Overlap",
                   "is " + number_text(control.overlap) + " horizons, " + number_text(overlap) +
                     ", wider than the body, " + number_text(widest) + ".");
    body.finite_elements.refuse(
      body.finite_elements.degree > 1,
      "Degree",
      "found " + std::to_string(body.finite_elements.degree) +
        "; bonds and elements share the nodes of elements of degree 1 ('Models = coupled').");
    refuse_families(body);
    if (!body.deforms)
      refuse_fictitious_nodes(body);
  }


  template <int dim>
  void refuse_coupled_families(const BodyParameters<dim> &body)
  {
    const Peridynamics      &pd      = body.peridynamics;
    const ElasticityControl &control = body.elasticity;
    const std::string        scheme =
      "'Scheme = " + body.coupling.scheme_text() + "' in section 'Coupling'";
    const bool splice = body.coupling.splices();
    if (pd.completes_families())
      refuse_beyond_sides(body);
    pd.refuse(
      pd.completes_families() && splice && !body.boundary_conditions.symmetry.empty(),
      "Surface correction",
      "'fictitious nodes' and 'Scheme = splice' do not go with 'Symmetry' in section 'Boundary conditions': nothing would tell its lost forces from those of the other half. "
      "Hold the side by 'Displacement', or use 'blending'.");
    body.cracks.refuse(
      body.cracks.double_nodes(),
      "Mesh",
      "'faces' is for 'Scheme = exchange' in section 'Coupling': the families of others know one node at each place. Use 'removed'.");
    body.domain.refuse(
      !body.domain.has_lattice(),
      "Shape",
      "'mesh file' is for 'Scheme = exchange' in section 'Coupling': the families of others lie on a lattice. Use 'box' or 'plate with hole'.");
    pd.refuse(pd.surface_correction != SurfaceCorrection::none &&
                pd.surface_correction != SurfaceCorrection::automatic && !pd.completes_families(),
              "Surface correction",
              "is for 'Scheme = exchange', not for " + scheme +
                "; use 'none' or 'fictitious nodes'.");
    control.refuse(
      dim > 1 && control.is_bond_based(),
      "Model",
      "'bond-based' is not for " + scheme +
        ": its zone would have a Poisson ratio of its own. Use 'state-based', or 'Scheme = exchange'.");
    control.refuse(splice && control.solver != ElasticSolver::linear,
                   "Solver",
                   "'" + control.solver_name() +
                     "' needs forces that have an energy, which those of " + scheme +
                     " have not. Use 'linear', or 'Scheme = blending'.");
  }


  template <int dim>
  void refuse_diffusion(const Scene<dim> &scene)
  {
    const Peridynamics   &pd       = scene.peridynamics;
    const FiniteElements &elements = scene.finite_elements;
    scene.domain.refuse(scene.domain.has_extra_layers(),
                        "Extra layers",
                        "is for 'Physics = elasticity'.");
    pd.refuse(
      !scene.domain.has_lattice() && !(pd.horizon > 0.) && scene.cracks.conduct() &&
        scene.cracks.contact_conductance < 0.,
      "Horizon",
      "is empty; 'Transmission' in section 'Cracks' is the fraction that bonds of one horizon keep, in finite "
      "elements too, and a mesh file has no node spacing that 'Horizon ratio' could refer to: give a length, "
      "or 'Contact conductance' in its place.");
    for (const ModelKind model : scene.general.models)
      if (model == ModelKind::coupled)
        refuse_coupling(scene);
      else if (model == ModelKind::finite_elements)
        elements.refuse(elements.degree > 1 && !scene.cracks.cracks.empty() &&
                          scene.cracks.cut_pairs(),
                        "Degree",
                        "found " + std::to_string(elements.degree) +
                          "; cracks with 'Mesh' in section 'Cracks' = pairs need degree 1.");
      else
        {
          if (const auto [where, why] = scene.obstacle_to_bonds_on_elements();
              pd.treatment == BoundaryTreatment::exchange && !where.empty())
            entry_error(
              where,
              why +
                ", for 'Boundary treatment = exchange'. Use 'Boundary treatment = none' (section 'Peridynamics') for bonds alone.");
          refuse_families(scene);
          refuse_fictitious_nodes(scene);
          refuse_flux_treatment(scene);
        }
  }


  /** Cracks that go across a mean of the tension about their tips. */
  template <int dim>
  void refuse_crack_direction(const Scene<dim> &scene)
  {
    scene.elasticity.refuse(
      scene.elasticity.is_given("Crack direction") && !scene.material.breaks(),
      "Crack direction",
      "is for bonds that break: give 'Fracture energy' or 'Critical stretch' in section 'Material', too, or leave it out.");
    const bool has_planes_of_symmetry = !scene.boundary_conditions.symmetry.empty();
    scene.elasticity.refuse(
      scene.elasticity.text("Crack direction") == "mean tension" &&
        (scene.cracks.cracks.empty() || scene.cracks.change() || has_planes_of_symmetry),
      "Crack direction",
      std::string("found 'mean tension', which is for ") +
        (has_planes_of_symmetry ?
           "whole bodies, but there is 'Symmetry' in section 'Boundary conditions'. Compute the whole body, or leave the entry out." :
         scene.cracks.cracks.empty() ?
           "what grows from cracks of section 'Cracks', but there is none. Leave the entry out." :
           "cracks that grow as bonds break, but those of section 'Cracks' change by themselves. Leave one of them out."));
  }


  /** Criteria and what they are not for. */
  template <int dim>
  void refuse_breaking(const Scene<dim> &scene)
  {
    const Material                &material = scene.material;
    const Material::Law::Breaking &breaking = material.law.breaking;
    const bool                     is_other = breaking.criterion != BreakCriterion::stretch;
    scene.elasticity.refuse(
      is_other && scene.elasticity.text("Crack direction") == "mean tension",
      "Crack direction",
      "found 'mean tension', which is for 'Criterion = stretch' in section 'Material', where 'Criterion' is '" +
        material.text("Criterion") + "'. Leave one of them out.");
    material.refuse(
      is_other && !scene.boundary_conditions.symmetry.empty(),
      "Criterion",
      "found '" + material.text("Criterion") +
        "', which knows nothing of what is beyond the body ('Symmetry' in section 'Boundary conditions'). Compute the whole body, or use 'stretch'.");
    const auto refuse_rates = [&](const bool is_so, const std::string &why) {
      material.refuse(breaking.rate_factor && is_so, "Rate factor", why);
    };
    refuse_rates(
      scene.elasticity.is_static(),
      "is for bodies in motion ('Solver = dynamics' in section 'Elasticity'); 'Solver' is '" +
        scene.elasticity.solver_name() + "'. Leave the entry out.");
    refuse_rates(runs(scene, ModelKind::coupled),
                 "is for 'Models = peridynamics', not 'coupled'. Leave one of them out.");
    scene.elasticity.refuse(
      scene.elasticity.controls_loads() && material.law.kind != SolidLaw::linear &&
        !material.law.softens(),
      "Breaking",
      "found 'controlled', which is for 'Law = linear' and 'softening' (section 'Material'), where displacements are in proportion to the loads. Use another of them, or 'at rest' or 'in motion' here.");
    scene.elasticity.refuse(
      scene.elasticity.controls_loads() && !scene.is_loaded_slowly(),
      "Breaking",
      "found 'controlled', but no load depends on t: give displacements, tractions or forces that grow with it, as in 'top: 0, 0.01*t'.");
    material.refuse(
      breaking.criterion == BreakCriterion::energy &&
        scene.elasticity.model == ElasticModel::correspondence,
      "Criterion",
      "found 'energy', which bonds of 'Model = correspondence' (section 'Elasticity') do not have by themselves. Use 'stretch', 'principal stress' or 'von mises'.");
  }


  template <int dim>
  void refuse_deformation(const Scene<dim> &scene)
  {
    const Peridynamics &pd       = scene.peridynamics;
    const Material     &material = scene.material;
    const bool          bonds    = runs(scene, ModelKind::peridynamics),
               none              = !bonds && !runs(scene, ModelKind::coupled);
    pd.refuse(
      none && pd.completes_families(),
      "Surface correction",
      "'fictitious nodes' has no effect without 'Models = peridynamics' or 'coupled'. Use 'none'.");
    pd.refuse(
      !runs(scene, ModelKind::coupled) && pd.scales_beside_cracks(),
      "Surface correction",
      "'crack scaling' without 'Models = coupled' has no effect with 'Physics = elasticity'; use 'none', 'energy' or 'moments'.");
    material.refuse(
      none && material.breaks(),
      name_of_limit(material),
      "has no effect: finite elements do not break. Add 'peridynamics' or 'coupled' to 'Models', or leave the entry out.");
    material.refuse(material.scatter && runs(scene, ModelKind::coupled),
                    "Weibull modulus",
                    "is for 'Models = peridynamics', not 'coupled'; leave the entry out.");
    scene.elasticity.refuse(
      scene.elasticity.is_given("Breaking") && !material.breaks(),
      "Breaking",
      "is for bonds that break: give 'Fracture energy', 'Critical stretch' or 'Critical stress' in section 'Material', too, or leave it out.");
    refuse_crack_direction(scene);
    refuse_breaking(scene);
    scene.elasticity.refuse(
      scene.elasticity.contact_is_asked() && !bonds &&
        (none || !scene.coupling.exchanges() || scene.cracks.on_faces()),
      "Contact",
      "has no effect: it is for 'Models = peridynamics', and for 'coupled' with 'Scheme = exchange' where 'Mesh' in section 'Cracks' is not 'faces'. Leave it out, or add one of these.");
    pd.refuse(
      !bonds && pd.corrects_elastic_bonds(),
      "Surface correction",
      "without 'Models = peridynamics' has no effect with 'Physics = elasticity'; use 'none'.");
    pd.refuse(
      !bonds && pd.wants_lattice_form(),
      "Operator form",
      "'lattice' is not defined without 'Models = peridynamics' with 'Physics = elasticity'; use 'auto'.");
    scene.boundary_conditions.refuse(
      !bonds && scene.boundary_conditions.traction_layer > 0.,
      "Traction layer",
      "has no effect without 'Models = peridynamics': finite elements have "
      "tractions on their faces. Leave it empty.");
    scene.elasticity.refuse(
      !bonds && scene.elasticity.micromodulus == Micromodulus::constant,
      "Micromodulus",
      "'constant' is for peridynamics in the whole body: add 'peridynamics' to 'Models', or leave the entry out.");
    const auto refuse = [&](const bool fault, const std::string &what) {
      scene.elasticity.refuse(fault && scene.elasticity.absolute_reference,
                              "Heat of deformation",
                              "found 'true', which is not for " + what);
    };
    refuse(
      scene.material.storage_depends_on_temperature(),
      "a 'Heat capacity' or 'Density' of T in section 'Material'. Let them not depend on T there.");
    refuse(scene.finite_elements.consistent_capacity,
           "'Capacity = consistent' in section 'Finite elements'. Use 'lumped'.");
    refuse(scene.domain.coarsening.times > 0,
           "meshes with 'Coarsening' in section 'Domain'. Leave that out.");
  }


  template <int dim>
  void refuse_grading(const Scene<dim> &scene)
  {
    const CouplingControl &coupling = scene.coupling;
    const bool adaptive = coupling.is_adaptive(), coarse = scene.domain.coarsening.times > 0,
               coupled = runs(scene, ModelKind::coupled);
    coupling.refuse(adaptive && !coupled,
                    "Zone",
                    "is 'adaptive', but 'Models' has no 'coupled', which the mesh would follow.");
    coupling.refuse(
      adaptive && !coarse,
      "Zone",
      "'adaptive' changes the mesh, but 'Coarsening' in section 'Domain' is 0: no cell may be "
      "larger than those of 'Cells'. Give it at least 1.");
    coupling.refuse(
      adaptive && scene.cracks.on_faces(),
      "Zone",
      "'adaptive' is for cracks that lie across cells; 'Mesh' in section 'Cracks' is 'faces'.");
    coupling.refuse(
      adaptive && scene.time.time_step > 0. &&
        (scene.time.stepper == "euler" || scene.time.stepper == "rk4"),
      "Zone",
      "'adaptive' changes the mesh and with it the stability bound of '" + scene.time.stepper +
        "', for which 'Time step' in section 'Time' is given. Use 'Time step = auto' or 'Stepper = auto'.");
    const auto refuse = [&](const bool fault, const std::string &what) {
      scene.domain.refuse(coarse && fault,
                          "Coarsening",
                          "found " + std::to_string(scene.domain.coarsening.times) + ", but " +
                            what);
    };
    refuse(
      runs(scene, ModelKind::peridynamics),
      "'Models' has peridynamics, whose bonds need fine cells everywhere. Use 'coupled', or 0 here.");
    refuse(coupled && !coupling.exchanges(),
           "'Scheme' in section 'Coupling' is not 'exchange', the only one for graded meshes.");
    refuse(scene.domain.coarsening.at_ends && !scene.domain.coarsening.at_corners &&
             scene.cracks.cracks.empty(),
           "'Fine where' is 'crack ends', and section 'Cracks' has no crack.");
    refuse(
      !scene.domain.coarsening.by_formula && !scene.domain.coarsening.at_corners &&
        (adaptive || coupling.is_near_cracks()) && scene.cracks.cracks.empty(),
      "section 'Cracks' has none for which cells would stay fine. Give a formula in 'Fine where'.");
  }


  namespace
  {
    /** What a strength and the path of a crack need. */
    template <int dim>
    void refuse_measure_of_growth(const Scene<dim> &scene)
    {
      const Material &material = scene.material;
      const bool      is_long  = scene.peridynamics.horizon > 0.;
      const auto      refuse   = [&](const bool fault, const std::string &what) {
        scene.accuracy.refuse(fault,
                              "Measure",
                              "is '" + scene.accuracy.measure_text() + "', but " + what);
      };
      refuse(!scene.deforms, "'Physics' is not elasticity.");
      refuse(dim == 1, "'Dimension' is 1; bars have no cracks that grow.");
      refuse(
        !material.breaks(),
        "nothing breaks: give 'Fracture energy' in section 'Material' (or 'Critical stretch', with 'Horizon' in section 'Peridynamics' as a length).");
      refuse(limit_of_bonds(material).changes(),
             "'" + name_of_limit(material) + "' in section 'Material' depends on t or T.");
      refuse(!scene.elasticity.is_static(),
             "'Solver' in section 'Elasticity' is 'dynamics'; it is for bodies at rest.");
      refuse(
        !scene.is_loaded_slowly(),
        "no load depends on t: give displacements, tractions or forces that grow with it, as in 'top: 0, 0.01*t'.");
      if (is_long)
        return;
      refuse(
        !material.fracture_energy,
        "'Critical stretch' in section 'Material' without a 'Horizon' in section 'Peridynamics' that is a length is no fracture energy: the finer the lattice, the less a crack takes, and nothing converges. Give 'Fracture energy', or that 'Horizon'.");
      refuse(
        scene.cracks.cracks.empty(),
        "section 'Cracks' has no crack: without one the body bears the more, the smaller the horizon. Give a crack, or 'Horizon' in section 'Peridynamics' as a length.");
      refuse(
        dim == 3,
        "'Dimension' is 3: cracks are followed in two dimensions. Give 'Horizon' in section 'Peridynamics' as a length.");
    }
  } // namespace


  template <int dim>
  void refuse_measure(const Scene<dim> &scene)
  {
    const AccuracyControl &accuracy = scene.accuracy;
    const bool             deforms  = scene.deforms;
    accuracy.refuse(accuracy.measure == AccuracyMeasure::probes && scene.output.probes.empty(),
                    "Measure",
                    "is 'probes', but 'Probes' in section 'Output' has no point.");
    if (accuracy.measures_growth())
      refuse_measure_of_growth(scene);
    accuracy.refuse(accuracy.measure == AccuracyMeasure::flow && deforms,
                    "Measure",
                    "is 'flow', but nothing flows in an elastic body; 'field', 'probes' and "
                    "'stress intensity' are for it.");
    accuracy.refuse(accuracy.measure == AccuracyMeasure::stress_intensity &&
                      (!deforms || dim != 2 || scene.cracks.cracks.empty()),
                    "Measure",
                    std::string("is 'stress intensity', but ") +
                      (!deforms                    ? "'Physics' is not elasticity." :
                       scene.cracks.cracks.empty() ? "section 'Cracks' has no crack." :
                                                     "only two dimensions have it."));
  }


  namespace
  {
    /** The same where cracks that grow are measured. */
    template <int dim>
    std::string obstacle_to_growth(const Scene<dim> &scene)
    {
      const bool is_long = scene.peridynamics.horizon > 0.;
      if (scene.domain.shape != Shape::box)
        return "bonds that break in bodies other than a box ('Shape' and 'Holes' in section 'Domain')";
      if (scene.material.law.kind != SolidLaw::linear)
        return "bonds that break by another 'Law' than 'linear' (section 'Material')";
      if (scene.elasticity.computes_temperature)
        return "bonds that break with a computed temperature ('Temperature change' in section 'Elasticity')";
      if (scene.elasticity.has_full_kinematics())
        return "bonds that break with 'Kinematics = full' (section 'Elasticity')";
      if (scene.cracks.change())
        return "prescribed cracks that grow beside bonds that break ('Growth' in section 'Cracks')";
      if (scene.material.scatter)
        return "strengths that scatter from node to node, another body on each lattice ('Weibull modulus' in section 'Material')";
      if (scene.material.law.breaking.criterion != BreakCriterion::stretch)
        return "another 'Criterion' than 'stretch' (section 'Material')";
      if (scene.material.law.breaking.rate_factor)
        return "limits that depend on the rate ('Rate factor' in section 'Material')";
      if (scene.material.is_given("Unbreakable") || scene.material.phases.gives("Unbreakable"))
        return "bonds that never break ('Unbreakable' in section 'Material')";
      if (!scene.material.law.interfaces.empty())
        return "interfaces with a fracture energy of their own ('Interfaces' in section 'Material')";
      if (is_long)
        return "";
      if (!scene.material.uniform_moduli())
        return "cracks that grow where moduli vary, unless 'Horizon' in section 'Peridynamics' is a length";
      if (scene.material.phases.gives("Fracture energy") ||
          scene.material.phases.gives("Critical stretch"))
        return "phases with a 'Fracture energy' of their own (section 'Material/Phases'), unless 'Horizon' in section 'Peridynamics' is a length. Give it as a formula";
      return "";
    }


    /** What is not yet chosen for, in words, or nothing. */
    template <int dim>
    std::string obstacle_to_choice(const Scene<dim> &scene)
    {
      const bool moves  = scene.deforms && !scene.elasticity.is_static();
      const bool is_box = scene.domain.shape == Shape::box;
      if (scene.domain.is_image())
        return "images ('Shape' in section 'Domain')";
      if (scene.accuracy.measures_growth() && scene.deforms && !moves)
        return obstacle_to_growth(scene);
      if (!is_box && scene.peridynamics.horizon > 0.)
        return "a horizon that is a length in bodies other than a box ('Shape' and 'Holes' in section 'Domain')";
      if (!is_box && scene.cracks.change())
        return "cracks that grow or change in bodies other than a box ('Shape' and 'Holes' in section 'Domain')";
      if (moves && (!scene.cracks.cracks.empty() || scene.peridynamics.horizon > 0.))
        return "motion with cracks, or with a horizon that is a length";
      if (scene.material.law.kind != SolidLaw::linear)
        return "another 'Law' than 'linear' (section 'Material')";
      if (scene.elasticity.is_correspondence())
        return "'Model = correspondence' (section 'Elasticity')";
      if (!scene.material.law.orthotropy.young.empty())
        return "orthotropic bodies ('Young moduli' in section 'Material')";
      if (!scene.time.steady && scene.deforms && !moves &&
          (scene.cracks.change() || scene.peridynamics.horizon > 0.))
        return "bodies at rest whose loads change with time, with cracks that grow or a horizon that is a length";
      if (scene.cracks.change() && (scene.time.steady || scene.peridynamics.horizon > 0.))
        return "cracks that grow or change ('Growth', 'Transmission' in section 'Cracks') in a steady state, or with a "
               "horizon that is a length";
      if (scene.moduli_change())
        return "moduli that depend on a computed temperature (section 'Material')";
      if (scene.elasticity.computes_temperature &&
          (scene.warms_slowly() || !scene.cracks.cracks.empty()))
        return "a computed temperature ('Temperature change' in section 'Elasticity') that changes with time, or with cracks";
      if (scene.material.breaks())
        return "bonds that break ('Fracture energy', 'Critical stretch' in section 'Material'), unless 'Measure' in section 'Accuracy' is 'strength' or 'path' and the body is at rest";
      if (scene.cracks.conduct() && scene.cracks.contact_conductance < 0.)
        return "'Transmission' of cracks, a share of bonds of one horizon, another crack on each lattice: give 'Contact conductance'";
      return "";
    }
  } // namespace


  template <int dim>
  void refuse_choice(const Scene<dim> &scene)
  {
    const std::string what = obstacle_to_choice(scene);
    AssertThrow(what.empty(),
                UserError("Entry 'Models': 'auto' does not choose for " + what +
                          ". Name models instead: finite elements, peridynamics, coupled."));
  }


  template <int dim>
  Calibration calibration_of(const BodyParameters<dim> &body)
  {
    constexpr double    fewest = 2., most_oblong = 1.5, slack = 1e-6; // test Laws.IsotropicFamilies
    const Peridynamics &pd = body.peridynamics;
    if (dim == 1 || !body.deforms || pd.text("Calibration") != "auto" ||
        !body.domain.has_lattice() || body.material.breaks() ||
        body.elasticity.is_correspondence()) // which has the moduli whatever the weights
      return pd.sampling.calibration;
    const dealii::Tensor<1, dim> h       = body.domain.spacing();
    const double                 longest = *std::max_element(h.begin_raw(), h.end_raw()),
                 shortest                = *std::min_element(h.begin_raw(), h.end_raw());
    return body.horizon() >= fewest * longest * (1. - slack) &&
               longest <= most_oblong * shortest * (1. + slack) ?
             Calibration::isotropic :
             pd.sampling.calibration;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(calibration_of);
  PERIDEAL_INSTANTIATE_FUNCTION(refuse_cracks);
  PERIDEAL_INSTANTIATE_FUNCTION(refuse_families);
  PERIDEAL_INSTANTIATE_FUNCTION(refuse_beyond_sides);
  PERIDEAL_INSTANTIATE_FUNCTION(refuse_coupling);
  PERIDEAL_INSTANTIATE_FUNCTION(refuse_coupled_families);
  PERIDEAL_INSTANTIATE_FUNCTION(refuse_diffusion);
  PERIDEAL_INSTANTIATE_FUNCTION(refuse_deformation);
  PERIDEAL_INSTANTIATE_FUNCTION(refuse_grading);
  PERIDEAL_INSTANTIATE_FUNCTION(refuse_measure);
  PERIDEAL_INSTANTIATE_FUNCTION(refuse_choice);
} // namespace PeriDeal
