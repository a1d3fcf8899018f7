// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/grid/tria.h>

#include <perideal/analysis/coupling_certificate.h>
#include <perideal/scene/scene.h>

#include <nlohmann/json.hpp>

namespace PeriDeal
{
  /** What summary.json says of any scene before its results: title, program, units, names, domain, cells. Collective. */
  template <int dim>
  nlohmann::ordered_json describe_scene(const Scene<dim>                 &scene,
                                        const SceneText                  &text,
                                        const dealii::Triangulation<dim> &mesh,
                                        const MPI_Comm                    communicator);

  /** With `Shape = image` write image_as_read.png into the output directory: one pixel per cell in the colours of the phases. Collective. */
  template <int dim>
  void write_image_as_read(const Scene<dim> &scene, const MPI_Comm communicator);

  /** Of a coupled model, for summary.json and, in a line, for the progress. Not collective. */
  nlohmann::ordered_json describe_certificate(const CouplingCertificate &certificate);
  std::string            certificate_line(const CouplingCertificate &certificate);

  /** Write files of these names into a directory, on rank 0. Throws UserError everywhere if one cannot be written. Collective. */
  void write_files(const std::vector<std::pair<std::string, std::string>> &files,
                   const std::string                                      &directory,
                   const MPI_Comm                                          communicator);

  /** As written to summary.json. */
  std::string json_text(const nlohmann::ordered_json &summary);
} // namespace PeriDeal
