// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "model_runs.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  void set_start(ModelRun<dim> &run)
  {
    run.op().initialize_vector(run.solution);
    run.set_initial_value(run.solution);
    run.op().distribute(run.solution, 0.);
    run.op().take_material_at(run.solution); // with the prescribed values
    run.op().distribute(run.solution, 0.);
  }


  template <int dim>
  std::unique_ptr<ModelRun<dim>> make_model_run(const ModelKind           model,
                                                const Triangulation<dim> &mesh,
                                                const Scene<dim>         &scene)
  {
    std::unique_ptr<ModelRun<dim>> run;
    if (model == ModelKind::peridynamics &&
        scene.peridynamics.treatment != BoundaryTreatment::exchange)
      run = make_bond_run(mesh, scene);
    else
      run = make_element_run(model, mesh, scene);
    set_start(*run);
    return run;
  }

  template void                         set_start(ModelRun<1> &);
  template void                         set_start(ModelRun<2> &);
  template void                         set_start(ModelRun<3> &);
  template std::unique_ptr<ModelRun<1>> make_model_run(const ModelKind,
                                                       const Triangulation<1> &,
                                                       const Scene<1> &);
  template std::unique_ptr<ModelRun<2>> make_model_run(const ModelKind,
                                                       const Triangulation<2> &,
                                                       const Scene<2> &);
  template std::unique_ptr<ModelRun<3>> make_model_run(const ModelKind,
                                                       const Triangulation<3> &,
                                                       const Scene<3> &);
} // namespace PeriDeal
