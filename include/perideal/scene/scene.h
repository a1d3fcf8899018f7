// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/body_parameters.h>
#include <perideal/scene/control.h>
#include <perideal/scene/formula_names.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/physics.h>

#include <mpi.h>

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace PeriDeal
{
  enum class ModelKind
  {
    finite_elements,
    peridynamics,
    coupled
  };

  /** `finite elements`, `peridynamics` or `coupled`: as in scenes and in all output files. */
  std::string to_string(const ModelKind model);


  /** The entries outside all sections. */
  class General : public SceneSection
  {
  public:
    General();

    std::string            title, output_directory;
    Physics                physics;
    unsigned int           dimension;
    std::vector<ModelKind> models;            // in the order the user named them
    bool                   automatic = false; // `Models = auto`; models are finite elements then

    /**
     * Throws UserError: unknown physics or models, none or one twice, a dimension other than 1,
     * 2, 3.
     */
    void parse();

    /** Of a model in output files and messages: its own name, or `auto` if that was asked for. */
    std::string name_of(const ModelKind model) const
    {
      return automatic ? "auto" : to_string(model);
    }
  };


  /**
   * All that a user describes in one .prm file, parsed and checked. A scene has the defaults once
   * it is constructed; its values come from parse_scene(), or from SceneSection::set() and
   * parse_and_validate().
   *
   * Scenes can follow each other in one program. While parse_scene() works, only the scene that it
   * fills should be alive, since deal.II's ParameterAcceptor gives the texts of a section to all
   * objects of that section.
   */
  template <int dim>
  struct Scene : BodyParameters<dim>
  {
    using BodyParameters<dim>::domain;
    using BodyParameters<dim>::material;
    using BodyParameters<dim>::initial_and_source;
    using BodyParameters<dim>::boundary_conditions;
    using BodyParameters<dim>::cracks;
    using BodyParameters<dim>::peridynamics;
    using BodyParameters<dim>::coupling;
    using BodyParameters<dim>::elasticity;
    using BodyParameters<dim>::finite_elements;

    General                 general;
    Formulas                formulas;
    TimeControl             time;
    SolverControlParameters solver;
    OutputControl<dim>      output;
    CheckpointControl       checkpoint;
    GuardControl            guards;
    AccuracyControl         accuracy;
    Reference               reference;
    Units                   units;

    /**
     * What `Temperature change = computed` solves first: the values of the same sections, with
     * `Physics = heat` and without what acts on the solid; else null. No text is parsed for it but
     * that of cracks and peridynamics, which mean something else there.
     */
    std::shared_ptr<const Scene<dim>> heat;

    /**
     * An elastic body in equilibrium at each time, under loads or with a temperature that depend on
     * time, or with cracks that grow.
     */
    bool is_loaded_slowly() const;

    /** An elastic body whose temperature is computed and changes in time. */
    bool warms_slowly() const;

    /** All sections in the order of a scene file. */
    std::vector<SceneSection *> sections();

    /**
     * Parse all sections and check them one by one. What the components that will compute the scene
     * cannot do they say themselves: require_computable(). Throws UserError.
     */
    void parse_and_validate();

    /** Check the sections against each other, once all have their values. Throws UserError. */
    void validate();

    /** Those of a run, for the parameters. */
    void take_times();
  };


  /** The files that a scene reads besides itself, by the entry that names them. */
  template <int dim>
  std::vector<std::pair<std::string, std::string>> files_of(const Scene<dim> &scene);


  /** Do what concerns Scene::heat: a UserError from there says so. Not collective. */
  void of_heat_problem(const std::function<void()> &action);


  /** Whether `Models` names this one. */
  template <int dim>
  bool runs(const Scene<dim> &scene, const ModelKind model)
  {
    const std::vector<ModelKind> &models = scene.general.models;
    return has(models, model);
  }


  /**
   * The text of a scene file with command line overrides (`Section/Entry=value`) applied.
   */
  struct SceneText
  {
    std::string file_name, text;
    MPI_Comm    communicator = MPI_COMM_SELF; // of those who read it, and its image, together
  };

  /**
   * Read a scene file on rank 0 and broadcast it, scan its lines against the declared entries
   * (unknown section or entry with the nearest known name, entry in the wrong section, duplicate,
   * missing `end`, ...), and apply the overrides. Collective; throws the same UserError on all
   * processes.
   */
  SceneText read_scene(const std::string              &file_name,
                       const std::vector<std::string> &overrides,
                       const MPI_Comm                  communicator);

  /** First pass: the entry `Dimension`. Throws UserError unless 1, 2 or 3. */
  unsigned int dimension_of(const SceneText &text);

  /** Second pass: the entries into the scene, then parse_and_validate(); parse_computable(). */
  template <int dim>
  void parse_scene(const SceneText &text, Scene<dim> &scene);

  /** An entry as overrides name it, "Section/Entry" or "Entry", and its text. */
  using Setting = std::pair<std::string, std::string>;

  /**
   * A scene with the texts of another one but for some entries, parsed and checked. Both can live
   * on. Throws UserError.
   */
  template <int dim>
  std::shared_ptr<Scene<dim>> scene_variant(const Scene<dim>           &scene,
                                            const std::vector<Setting> &settings);

  /**
   * Do something, and put file and line of the entry that a UserError names before its message.
   */
  void with_location(const SceneText &text, const std::function<void()> &action);

  /** The scene with all defaults, as .prm text (after parse_scene). */
  std::string scene_with_defaults();

  /** All entries with type, default, unit and explanation; format is prm, markdown, JSON or XML. */
  std::string parameter_manual(const std::string &format);
} // namespace PeriDeal
