// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/grid/tria.h>

#include <perideal/analysis/coupling_certificate.h>
#include <perideal/output/result_folder.h>
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

} // namespace PeriDeal
