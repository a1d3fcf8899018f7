// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/grid/tria.h>

#include <perideal/analysis/coupling_certificate.h>
#include <perideal/output/result_folder.h>
#include <perideal/problems/problem.h>
#include <perideal/problems/result_record.h>
#include <perideal/scene/scene.h>

#include <nlohmann/json.hpp>

namespace PeriDeal
{
  /**
   * What summary.json says of any scene at its start: title, program, units, names; no models and
   * no fields yet. Not collective.
   */
  template <int dim>
  nlohmann::ordered_json describe_start(const Scene<dim> &scene,
                                        const SceneText  &text,
                                        const MPI_Comm    communicator);

  /** That, and the body: domain, cells. Collective. */
  template <int dim>
  nlohmann::ordered_json describe_scene(const Scene<dim>                 &scene,
                                        const SceneText                  &text,
                                        const dealii::Triangulation<dim> &mesh,
                                        const MPI_Comm                    communicator);

  /**
   * What summary.json says of any run: cracks, end, notes, fields, times, memory of the mesh,
   * comparisons of its models. Collective.
   */
  template <int dim>
  void describe_run(const Scene<dim>                 &scene,
                    const dealii::Triangulation<dim> &mesh,
                    const ResultRecord               &record,
                    const Timings                    &timings,
                    nlohmann::ordered_json           &summary);

  /**
   * What it says of a problem: sizes, costs, settings, certificate, results so far. Collective.
   * @param own what this physics says besides
   */
  template <int dim>
  nlohmann::ordered_json describe_problem(const Problem<dim>           &problem,
                                          const nlohmann::ordered_json &own,
                                          const ResultRecord           &record);

  /**
   * With `Shape = image` write image_as_read.png: one pixel per cell in the colours of the phases.
   * Not collective.
   */
  template <int dim>
  void write_image_as_read(const Scene<dim> &scene, ResultFolder &folder);

  /** The name of a model in file names. */
  std::string series_of(const std::string &model);

  /** Of a coupled model, for summary.json and, in a line, for the progress. Not collective. */
  nlohmann::ordered_json describe_certificate(const CouplingCertificate &certificate);
  std::string            certificate_line(const CouplingCertificate &certificate);

  /** Lines about the size of a problem, the form of its operator, its coupling. Collective. */
  template <int dim>
  void say_size(const Problem<dim> &problem, const Progress &progress);
} // namespace PeriDeal
