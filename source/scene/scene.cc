// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/scene/lists.h>
#include <perideal/scene/physical_names.h>
#include <perideal/scene/scene_notes.h>

#include <algorithm>
#include <cmath>

#include "scene_checks.h"

namespace PeriDeal
{
  using namespace dealii;

  std::string to_string(const ModelKind model)
  {
    return model == ModelKind::finite_elements ? "finite elements" :
           model == ModelKind::peridynamics    ? "peridynamics" :
                                                 "coupled";
  }


  General::General()
    : SceneSection("")
  {
    declare("Title", EntryType::text, "", "", "Headline of the report.");
    declare("Dimension", EntryType::whole_number, "2", "1", "Number of dimensions: 1, 2 or 3.");
    declare(
      "Physics",
      EntryType::choice,
      "heat",
      "",
      "What diffuses: heat (temperature), moisture (wetness, the concentration over the saturated one) or electricity "
      "(potential); or elasticity (displacement).",
      physics_choices());
    declare(
      "Models",
      EntryType::choices,
      "finite elements, peridynamics",
      "",
      "The models that are run, on the same mesh, and compared: finite elements and peridynamics, each in the whole body, and "
      "`coupled`, peridynamics in the zone of section `Coupling` with finite elements elsewhere.",
      {"finite elements", "peridynamics", "coupled"});
    declare(
      "Output directory",
      EntryType::text,
      "output",
      "",
      "Directory of all files that a run writes, relative to the working directory. Results of an "
      "earlier run in it are replaced.");
    parse();
  }


  void General::parse()
  {
    title            = text("Title");
    output_directory = text("Output directory");
    if (output_directory.empty())
      error("Output directory", "is empty, needs the name of a directory.");
    dimension = whole_number("Dimension");
    if (dimension < 1 || dimension > 3)
      error("Dimension", "found " + text("Dimension") + ", needs 1, 2 or 3.");
    physics = choice<Physics>("Physics");
    models.clear();
    for (const unsigned int index : choice_indices("Models"))
      models.push_back(static_cast<ModelKind>(index));
  }


  namespace
  {
    /** What a choice needs of the shape of the body. */
    template <int dim>
    void check_shape_for_peridynamics(const Scene<dim> &scene)
    {
      const Peridynamics &pd    = scene.peridynamics;
      const Shape         shape = scene.domain.shape;
      const auto require = [&](const bool ok, const std::string &entry, const std::string &what) {
        if (!ok)
          entry_error(pd.where(entry), what);
      };
      const std::string needs_lattice = " needs a lattice of cells ('Shape' in section 'Domain' = "
                                        "box or plate with hole), not a mesh file.";

      require(shape == Shape::box || !pd.has_fictitious_nodes(),
              "Boundary treatment",
              "fictitious nodes need the sides of a box ('Shape' in section 'Domain' = box).");
      require(dim == 1 || pd.flux_treatment != FluxTreatment::layer_extrapolation,
              "Flux treatment",
              "'layer extrapolation' is for 'Dimension' 1 only; use 'extrapolation'.");
      require(dim < 3 || pd.self_term != SelfTerm::paper,
              "Self term",
              "'paper' is defined for 'Dimension' 1 and 2 only.");
      require(pd.correction_direction == CorrectionDirection::both ||
                static_cast<int>(pd.correction_direction) < dim,
              "Correction direction",
              "there is no such direction with 'Dimension' = " + std::to_string(dim) + ".");
      if (shape != Shape::mesh_file)
        return;
      require(pd.treatment != BoundaryTreatment::layer,
              "Boundary treatment",
              "'layer'" + needs_lattice);
      require(pd.volume_fraction != VolumeFraction::exact,
              "Volume fraction",
              "'exact'" + needs_lattice);
      require(pd.self_term != SelfTerm::paper, "Self term", "'paper'" + needs_lattice);
      require(pd.form != OperatorForm::lattice, "Operator form", "'lattice'" + needs_lattice);
      if (scene.general.physics != Physics::elasticity &&
          !scene.boundary_conditions.symmetry.empty())
        entry_error(
          scene.boundary_conditions.where("Symmetry"),
          "mirrors peridynamics in the sides of a box; this body is from a mesh file. Leave the entry out: "
          "a side that is named nowhere is insulated, which is what a plane of symmetry is.");
      require(pd.horizon > 0.,
              "Horizon",
              "is empty; a mesh file has no node spacing that 'Horizon ratio' could refer to: give "
              "a length.");
    }


    template <int dim>
    void check_horizon(const Scene<dim> &scene)
    {
      if (!scene.domain.has_lattice())
        return;
      const Tensor<1, dim> h       = scene.domain.spacing();
      const double         horizon = scene.horizon();
      for (unsigned int d = 0; d < dim; ++d)
        if (horizon < h[d] * (1. - 1e-9))
          entry_error(
            scene.peridynamics.where(scene.peridynamics.horizon > 0. ? "Horizon" : "Horizon ratio"),
            "the horizon, " + number_text(horizon) + ", is shorter than the node spacing in " +
              std::string(1, "xyz"[d]) + ", " + number_text(h[d]) +
              ": nodes have no neighbours there.");
      double longest = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        longest = std::max(longest, scene.domain.upper[d] - scene.domain.lower[d]);
      if (horizon > longest * (1. + 1e-9))
        entry_error(
          scene.peridynamics.where(scene.peridynamics.horizon > 0. ? "Horizon" : "Horizon ratio"),
          "the horizon, " + number_text(horizon) + ", is longer than the body, " +
            number_text(longest) + ". " +
            (scene.peridynamics.horizon > 0. ?
               "Choose a shorter one: three spacings of the nodes are " +
                 number_text(3. * *std::max_element(h.begin_raw(), h.end_raw())) + "." :
               "Choose a smaller one, or more 'Cells' in section 'Domain'."));
    }


    /** What conditions, cracks and mesh need of each other. */
    template <int dim>
    void check_combinations(const Scene<dim> &scene)
    {
      const BoundaryConditions<dim> &bc        = scene.boundary_conditions;
      const FluxTreatment            treatment = scene.peridynamics.flux_treatment;
      if (runs(scene, ModelKind::peridynamics) && treatment != FluxTreatment::natural)
        {
          for (const SideCondition &condition : bc.flux)
            if (const Part *const part = bc.part(condition.id);
                part != nullptr &&
                (part->kind != Part::of_side || treatment == FluxTreatment::layer_extrapolation))
              entry_error(bc.where("Flux"),
                          "the part '" + condition.name +
                            "' is not for 'Flux treatment' in section 'Peridynamics' = " +
                            (part->kind != Part::of_side ?
                               "extrapolation, which is for sides and their parts." :
                               "layer extrapolation, which is for whole sides.") +
                            " Use 'natural'.");
            else if (BoundaryConditions<dim>::find(bc.convection, condition.id) != nullptr)
              entry_error(
                bc.where("Convection"),
                "the side '" + condition.name +
                  "' is named in 'Flux', too, and with 'Flux treatment' in section 'Peridynamics' = extrapolation its values "
                  "follow from the flux alone. Use 'natural' to have both.");
        }
      if (scene.general.physics != Physics::elasticity && !bc.symmetry.empty() &&
          scene.cracks.mesh == CrackMesh::faces && !scene.cracks.cracks.empty() &&
          scene.domain.nodes == NodePlacement::vertices &&
          (runs(scene, ModelKind::peridynamics) || runs(scene, ModelKind::coupled)))
        entry_error(
          bc.where("Symmetry"),
          "is not for cracks with 'Mesh = faces' in section 'Cracks', where two nodes are at one place. Use 'Mesh = pairs', or leave the entry out: a side that is named nowhere "
          "is insulated.");
      if (!scene.domain.has_lattice() && !(scene.peridynamics.horizon > 0.) &&
          scene.cracks.conduct() && scene.cracks.contact_conductance < 0.)
        entry_error(
          scene.peridynamics.where("Horizon"),
          "is empty; 'Transmission' in section 'Cracks' is the fraction that bonds of one horizon keep, in finite "
          "elements too, and a mesh file has no node spacing that 'Horizon ratio' could refer to: give a length, "
          "or 'Contact conductance' in its place.");
    }


    /** A steady state needs conditions that do not change in time and that fix the level of the
     * temperature. */
    template <int dim>
    void check_steady(const Scene<dim> &scene)
    {
      const BoundaryConditions<dim> &bc = scene.boundary_conditions;
      if (!scene.time.steady)
        return;
      if (!scene.cracks.tips.empty())
        scene.cracks.tip_error(scene.cracks.tips.front(),
                               "moves, but 'Steady' in section 'Time' is true.");
      if (scene.general.physics == Physics::elasticity)
        return; // the rest: check_elasticity()
      const auto refuse_time = [](const Expression &expression, const std::string &where) {
        if (expression.depends_on_time())
          entry_error(where,
                      "'" + expression.text() +
                        "' depends on t, but 'Steady' in section 'Time' is true.");
      };
      refuse_time(scene.initial_and_source.source, scene.initial_and_source.where("Source"));
      refuse_time(scene.cracks.transmission, scene.cracks.where("Transmission"));
      for (const SideCondition &condition : bc.dirichlet)
        refuse_time(condition.value, bc.where("Dirichlet"));
      for (const SideCondition &condition : bc.flux)
        refuse_time(condition.value, bc.where("Flux"));
      for (const SideCondition &condition : bc.convection)
        {
          refuse_time(condition.value, bc.where("Convection"));
          refuse_time(condition.coefficient, bc.where("Convection"));
        }
      if (bc.dirichlet.empty() && bc.convection.empty())
        entry_error(scene.time.where("Steady"),
                    "without a side in 'Dirichlet' or 'Convection' (section 'Boundary conditions') "
                    "the steady state is not determined.");
    }


    /**
     * Whether a place of a box is in a cell that no hole has taken; of cells that meet there, in
     * any.
     */
    template <int dim>
    bool is_in_some_cell(const Domain<dim> &domain, const Point<dim> &p)
    {
      constexpr double     slack = 1e-6;
      const Tensor<1, dim> h     = domain.spacing();
      for (unsigned int k = 0; k < (1u << dim); ++k)
        {
          Point<dim> middle;
          for (unsigned int d = 0; d < dim; ++d)
            {
              const double s = (p[d] - domain.lower[d]) / h[d] + ((k >> d) & 1 ? slack : -slack);
              middle[d]      = domain.lower[d] +
                          h[d] * (0.5 + std::clamp(std::floor(s), 0., domain.cells[d] - 1.));
            }
          if (!domain.holes.contains(middle))
            return true;
        }
      return false;
    }


    /** What the body shows of its places without its mesh. Those of a line may lie in holes. */
    template <int dim>
    void check_points_of_output(const Scene<dim> &scene)
    {
      if (!scene.domain.has_lattice())
        return;
      const auto check = [&](const std::vector<double> &x, const std::string &entry) {
        Point<dim>  p;
        std::string coordinates;
        for (unsigned int d = 0; d < dim; ++d)
          {
            p[d] = x[d];
            coordinates += (d > 0 ? ", " : "") + number_text(x[d]);
          }
        if (!scene.domain.contains(p))
          entry_error(scene.output.where(entry),
                      "the point (" + coordinates + ") lies outside the body.");
        if (entry == "Probes" && !is_in_some_cell(scene.domain, p))
          entry_error(scene.output.where(entry),
                      "the point (" + coordinates +
                        ") lies in a hole. Move it into the body, or leave it out.");
      };
      for (const std::vector<double> &probe : scene.output.probes)
        check(probe, "Probes");
      if (!scene.output.line.empty())
        {
          check(scene.output.line.front(), "Line");
          check(scene.output.line.back(), "Line");
        }
    }
  } // namespace


  template <int dim>
  void Scene<dim>::take_times()
  {
    this->deforms   = general.physics == Physics::elasticity;
    this->steady    = time.steady;
    this->time_step = time.time_step;
    cracks.end_time = time.steady ? 0. : time.end_time;
  }


  template <int dim>
  bool Scene<dim>::is_loaded_slowly() const
  {
    const auto &forces = initial_and_source.body_force;
    return general.physics == Physics::elasticity && elasticity.is_static() &&
           (warms_slowly() || !cracks.tips.empty() || boundary_conditions.depends_on_time() ||
            std::any_of(forces.begin(), forces.end(), [](const auto &force) {
              return force.depends_on_time();
            }));
  }


  template <int dim>
  bool Scene<dim>::warms_slowly() const
  {
    return heat && !heat->time.steady;
  }


  template <int dim>
  std::vector<SceneSection *> Scene<dim>::sections()
  {
    return {&general,
            &domain,
            &material,
            &material.phases,
            &initial_and_source,
            &boundary_conditions,
            &cracks,
            &peridynamics,
            &coupling,
            &elasticity,
            &finite_elements,
            &time,
            &solver,
            &output,
            &checkpoint,
            &reference,
            &units};
  }


  template <int dim>
  void Scene<dim>::parse_and_validate()
  {
    general.parse();
    general.dimension = dim;
    domain.parse();
    elasticity.parse(general.physics, dim);
    time.parse();
    take_times();
    material.parse(general.physics,
                   dim,
                   elasticity.plane,
                   domain.image,
                   general.physics == Physics::elasticity ? !elasticity.is_static() : !time.steady);
    initial_and_source.parse(general.physics, dim, elasticity.computes_temperature);
    boundary_conditions.physical_names.clear();
    if (!domain.mesh_file.empty())
      boundary_conditions.physical_names =
        read_physical_names(domain.mesh_file, domain.scene_folder, dim, domain.communicator);
    boundary_conditions.parse(domain.has_lattice(),
                              domain.shape == Shape::plate_with_hole ||
                                (domain.image && domain.image->has_voids()),
                              general.physics,
                              elasticity.computes_temperature);
    cracks.parse(general.physics);
    keep_cracks_off_nodes(*this);
    peridynamics.parse(general.physics);
    coupling.parse();
    finite_elements.parse();
    check_elasticity(*this);
    make_heat_problem(*this);
    // a conductor without capacitance is always in its steady state, and an equilibrium has a time
    // only where its loads have
    time.steady =
      (time.steady && !elasticity.computes_temperature) || !material.stores ||
      (general.physics == Physics::elasticity && elasticity.is_static() && !is_loaded_slowly());
    take_times();
    solver.parse();
    output.parse(time.end_time, time.steady);
    checkpoint.parse(time.end_time, time.steady);
    const bool layers = domain.has_extra_layers();
    output.make_grid(domain.shape == Shape::box,
                     layers ? domain.body_lower : domain.lower,
                     layers ? domain.body_upper : domain.upper);
    reference.parse();
    units.parse();

    if (domain.has_lattice())
      {
        cracks.set_box(domain.lower, domain.upper);
        cracks.check_inside(domain.lower, domain.upper);
        for (const std::string &note : cracks.parts_outside(domain.lower, domain.upper))
          domain.notes.push_back(note);
        cracks.check_tips_inside(domain.lower, domain.upper, cracks.end_time);
      }
    if (runs(*this, ModelKind::finite_elements) && finite_elements.degree > 1 &&
        !cracks.cracks.empty() && cracks.mesh == CrackMesh::pairs)
      entry_error(finite_elements.where("Degree"),
                  "found " + std::to_string(finite_elements.degree) +
                    "; cracks with 'Mesh' in section 'Cracks' = pairs need degree 1.");
    resolve_boundary_treatment(*this);
    check_coupling(*this);
    check_coarsening(*this);
    if (runs(*this, ModelKind::peridynamics) || runs(*this, ModelKind::coupled))
      {
        check_shape_for_peridynamics(*this);
        check_horizon(*this);
      }
    if (domain.has_lattice() && material.phases.all().need_mesh())
      entry_error(
        material.phases.where("Regions"),
        "mesh(id) refers to the material ids of a mesh file, but 'Shape' in section 'Domain' is another.");
    check_combinations(*this);
    check_steady(*this);
    this->crack_history(); // for its errors
    check_image(*this);
    check_points_of_output(*this);
    note_doubtful_entries(*this);
  }


  template struct Scene<1>;
  template struct Scene<2>;
  template struct Scene<3>;
} // namespace PeriDeal
