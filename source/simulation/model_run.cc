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
  std::vector<std::string> ModelRun<dim>::columns() const
  {
    return {"value"};
  }


  template <int dim>
  std::vector<double> ModelRun<dim>::at_points(const PointEvaluator<dim> &reader,
                                               const std::vector<std::vector<double>> &) const
  {
    return reader.evaluate(solution);
  }


  template <int dim>
  std::vector<OutputField> ModelRun<dim>::fields(const double t) const
  {
    std::vector<OutputField> list{{field_name(), {solution}}};
    list[0].components[0].update_ghost_values();
    for (OutputField &field : derived_fields(solution, t))
      list.push_back(std::move(field));
    return list;
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

  template class ModelRun<1>;
  template class ModelRun<2>;
  template class ModelRun<3>;
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
