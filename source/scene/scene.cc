// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/rules.h>

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
    declare(title, "Title", "")                                = "Headline of the report.";
    declare(dimension, "Dimension", "2", Bounds::one_to_three) = "Number of dimensions: 1, 2 or 3.";
    declare(physics, "Physics", "heat", physics_choices()) =
      "Diffusion: heat (temperature), moisture (wetness, the concentration over the saturated one) or electricity "
      "(potential); or elasticity (displacement).";
    declare("Models",
            EntryType::choices,
            "finite elements, peridynamics",
            "",
            {"finite elements", "peridynamics", "coupled", "auto"}) =
      "The models that are run, on the same mesh, and compared: finite elements and peridynamics, each in the whole body, and "
      "`coupled`, peridynamics in the zone of section `Coupling` with finite elements elsewhere. Or `auto` alone: the cheapest model and mesh that "
      "section `Accuracy` allows.";
    declare(output_directory, "Output directory", "output") =
      "Directory of all files that a run writes, relative to the working directory. Results of an "
      "earlier run in it are replaced.";
    parse();
  }


  void General::parse()
  {
    SceneSection::parse();
    refuse(output_directory.empty(),
           "Output directory",
           "is empty, needs the name of a directory.");
    models.clear();
    const std::vector<unsigned int> chosen    = choice_indices("Models");
    constexpr unsigned int          choose_it = 3;
    automatic                                 = has(chosen, choose_it);
    refuse(
      automatic && chosen.size() > 1,
      "Models",
      "found '" + text("Models") +
        "'; 'auto' chooses a model by itself and stands alone. Leave the others out, or name those that are to be compared.");
    for (const unsigned int index : chosen)
      models.push_back(automatic ? ModelKind::finite_elements : static_cast<ModelKind>(index));
  }


  namespace
  {
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
        const Point<dim> p = point_of<dim>(x.data());
        if (!scene.domain.contains(p))
          entry_error(scene.output.where(entry),
                      "the point " + point_text(p) + " lies outside the body.");
        if (entry == "Probes" && !is_in_some_cell(scene.domain, p))
          entry_error(scene.output.where(entry),
                      "the point " + point_text(p) +
                        " lies in a hole. Move it into the body, or leave it out.");
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
    this->run       = {time.steady, time.time_step};
    cracks.end_time = time.steady ? 0. : time.end_time;
  }


  template <int dim>
  bool Scene<dim>::is_loaded_slowly() const
  {
    const auto &forces = initial_and_source.body_force;
    return general.physics == Physics::elasticity && elasticity.is_static() &&
           (warms_slowly() || !cracks.tips.empty() || material.law.kind == SolidLaw::viscoelastic ||
            (!material.law.user.library.empty() && !time.steady) || // which may know time
            boundary_conditions.depends_on_time() ||
            (material.breaks() && limit_of_bonds(material).depends_on_time()) ||
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
            &formulas,
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
            &guards,
            &accuracy,
            &reference,
            &units};
  }


  namespace
  {
    void forgo_contact(ElasticityControl &elasticity)
    {
      elasticity.refuse(
        elasticity.contact_is_asked(),
        "Contact",
        "found 'true', which with 'Kinematics = full' is for 'Stepper = verlet' only; 'Stepper' in section 'Time' is 'newmark'. Leave one of them out.");
      elasticity.contact = false;
    }
  } // namespace


  template <int dim>
  void Scene<dim>::parse_and_validate()
  {
    general.parse();
    general.dimension    = dim;
    formulas.parse(domain.files.folder, domain.files.communicator);
    const bool has_holes = domain.text("Shape") == "plate with hole" ||
                           !domain.text("Holes").empty();
    if (general.automatic && has_holes) // a mesh that is chosen follows the rims
      domain.set("Rims", "fitted");
    domain.parse();
    const MeshGroups groups = take_groups_of_mesh(*this);
    elasticity.parse(general.physics, dim);
    time.parse();
    take_times();
    if (elasticity.has_full_kinematics() && time.stepper == "newmark")
      forgo_contact(elasticity);
    material.law.user.of_bonds = general.models ==
                                   std::vector<ModelKind>{ModelKind::peridynamics} &&
                                 !elasticity.is_correspondence();
    material.parse(general.physics,
                   dim,
                   elasticity.plane,
                   domain.image,
                   general.physics == Physics::elasticity ? !elasticity.is_static() : !time.steady);
    initial_and_source.parse(general.physics, dim, elasticity.computes_temperature);
    boundary_conditions.holes = domain.image || !domain.has_lattice() ? Holes<dim>() : domain.holes;
    boundary_conditions.parse(domain.has_lattice(),
                              domain.has_voids(),
                              general.physics,
                              elasticity.computes_temperature);
    cracks.parse(general.physics);
    add_interfaces(*this, groups);
    peridynamics.parse(general.physics);
    if (this->deforms && elasticity.is_correspondence() &&
        peridynamics.text("Kernel exponent") == "auto")
      peridynamics.kernel_exponent = 1; // near neighbours tell more of a gradient
    coupling.parse(this->deforms && material.breaks());
    lay_cracks_on_faces(*this);
    keep_cracks_off_nodes(*this);
    finite_elements.parse(general.physics, elasticity.computes_temperature);
    make_heat_problem(*this);
    // a conductor without capacitance is always in its steady state, and an equilibrium has a time
    // only where its loads have
    const bool rests = this->deforms && elasticity.is_static() && !is_loaded_slowly();
    time.steady = (time.steady && !elasticity.computes_temperature) || !material.stores || rests;
    take_times();
    solver.parse();
    // an elastic body may not be steady, though it is said to be: its solver says so
    output.parse(time.end_time, this->deforms ? rests : time.steady);
    checkpoint.parse(time.end_time, this->deforms ? rests : time.steady);
    guards.parse();
    accuracy.parse();
    const bool layers = domain.has_extra_layers();
    output.make_grid(domain.is_box(),
                     layers ? domain.extra.body_lower : domain.lower,
                     layers ? domain.extra.body_upper : domain.upper);
    reference.parse();
    units.parse();
    validate();
  }


  namespace
  {
    /**
     * Whether `Surface correction = auto` is crack scaling: for diffusion beside insulated cracks
     * that lie still, where every model of the scene gets more accurate by it (doc/theory.md).
     */
    template <int dim>
    bool is_scaled_by_itself(const Scene<dim> &scene)
    {
      const Cracks<dim>  &cracks = scene.cracks;
      const Peridynamics &pd     = scene.peridynamics;
      // A crack that conducts gets better by it if it ends in the body, else worse.
      if (dim == 1 || scene.deforms || cracks.cracks.empty() || cracks.change() ||
          cracks.conduct() || !cracks.cut_pairs() || scene.finite_elements.degree != 1 ||
          !scene.domain.has_lattice())
        return false;
      const bool complete = pd.treatment == BoundaryTreatment::exchange ||
                            (pd.treatment == BoundaryTreatment::fictitious_mirror &&
                             pd.sampling.calibration != Calibration::analytic &&
                             pd.sampling.self_term == SelfTerm::none && !scene.domain.has_voids());
      return complete || !runs(scene, ModelKind::peridynamics);
    }
  } // namespace


  template <int dim>
  void Scene<dim>::validate()
  {
    refuse_cracks(*this);
    if (domain.has_lattice())
      {
        cracks.set_box(domain.lower, domain.upper);
        cracks.check_inside();
        // Beyond planes of symmetry is the other half of the crack.
        Point<dim> lower = domain.lower, upper = domain.upper;
        for (const types::boundary_id side : boundary_conditions.symmetry)
          for (const auto &corners : cracks.cracks)
            for (const Point<dim> &p : corners)
              if (double &bound = (side % 2 == 0 ? lower : upper)[side / 2];
                  side % 2 == 0 ? p[side / 2] < bound : p[side / 2] > bound)
                bound = p[side / 2];
        for (const std::string &note : cracks.parts_outside(lower, upper))
          domain.notes.push_back(note);
      }
    if (peridynamics.treatment == BoundaryTreatment::automatic)
      peridynamics.treatment = this->deforms ||
                                   !this->obstacle_to_bonds_on_elements().first.empty() ?
                                 BoundaryTreatment::none :
                                 BoundaryTreatment::exchange;
    peridynamics.sampling.calibration = calibration_of(*this);
    if (!this->deforms && peridynamics.surface_correction == SurfaceCorrection::automatic)
      peridynamics.surface_correction =
        is_scaled_by_itself(*this) ? SurfaceCorrection::crack_scaling : SurfaceCorrection::none;
    if (domain.has_lattice() && material.phases.all().need_mesh())
      entry_error(
        material.phases.where("Regions"),
        "mesh(id) refers to the material ids of a mesh file, but 'Shape' in section 'Domain' is another.");
    this->crack_history(); // for its errors
    check_image(*this);
    check_points_of_output(*this);
    note_doubtful_entries(*this);
  }


  template <int dim>
  std::vector<std::pair<std::string, std::string>> files_of(const Scene<dim> &scene)
  {
    std::vector<std::pair<std::string, std::string>> files;
    const auto add = [&](const std::string &entry, const std::string &file_name) {
      if (!file_name.empty())
        files.emplace_back(entry, file_name);
    };
    add("Domain/Mesh file", scene.domain.files.mesh);
    add("Domain/Image", scene.domain.files.image);
    for (const FormulaTable &table : scene.formulas.names->tables)
      add("Formulas/Tables: " + table.name, table.file);
    return files;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(files_of);
  PERIDEAL_INSTANTIATE_CLASS(struct Scene);
} // namespace PeriDeal
