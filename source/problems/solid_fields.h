// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/laws/elasticity.h>
#include <perideal/problems/solid_problem.h>

namespace PeriDeal
{
  /** Fields of the tensors at the nodes, as the models of an elastic body write them. */
  template <int dim>
  class SolidFields
  {
  public:
    /** @param layout of scalar vectors, one number per node */
    explicit SolidFields(const std::shared_ptr<const dealii::Utilities::MPI::Partitioner> &layout)
      : layout(layout)
    {}

    /** @param value of the owned nodes */
    template <typename Value>
    void add(const std::string &name, const Value &value)
    {
      fields.push_back({name, {}});
      add_component(value);
    }

    /** The displacement. */
    void add_vector(const std::string &name, const Vector &u)
    {
      fields.push_back({name, {}});
      for (unsigned int d = 0; d < dim; ++d)
        add_component([&](const unsigned int i) { return u.local_element(dim * i + d); });
    }

    void add_stress(const std::vector<dealii::SymmetricTensor<2, 3>> &stress)
    {
      add("stress_xx", [&](const unsigned int i) { return stress[i][0][0]; });
      if (dim > 1)
        {
          add("stress_yy", [&](const unsigned int i) { return stress[i][1][1]; });
          add("stress_zz", [&](const unsigned int i) { return stress[i][2][2]; });
          add("stress_xy", [&](const unsigned int i) { return stress[i][0][1]; });
        }
      if (dim > 2)
        {
          add("stress_xz", [&](const unsigned int i) { return stress[i][0][2]; });
          add("stress_yz", [&](const unsigned int i) { return stress[i][1][2]; });
        }
      add("von_mises", [&](const unsigned int i) { return von_mises(stress[i]); });
      add("pressure", [&](const unsigned int i) { return pressure(stress[i]); });
    }

    /** The temperature, where it is computed. */
    void add_temperature(const Vector &change, const Scene<dim> &scene)
    {
      if (change.size() > 0)
        add("temperature", [&](const unsigned int i) {
          return change.local_element(i) + scene.elasticity.reference_temperature;
        });
    }

    void add_strain(const std::vector<dealii::SymmetricTensor<2, dim>> &strain)
    {
      for (unsigned int a = 0; a < dim; ++a)
        for (unsigned int b = a; b < dim; ++b)
          add(std::string("strain_") + "xyz"[a] + "xyz"[b],
              [&](const unsigned int i) { return strain[i][a][b]; });
    }

    std::vector<OutputField> take()
    {
      return std::move(fields);
    }

  private:
    template <typename Value>
    void add_component(const Value &value)
    {
      Vector component(layout);
      for (unsigned int i = 0; i < component.locally_owned_size(); ++i)
        component.local_element(i) = value(i);
      component.update_ghost_values();
      fields.back().components.push_back(std::move(component));
    }

    std::shared_ptr<const dealii::Utilities::MPI::Partitioner> layout;
    std::vector<OutputField>                                   fields;
  };


  /** Append one row of solid_columns() but the temperature. */
  void append_row(const double                        *displacement,
                  const dealii::SymmetricTensor<2, 3> &stress,
                  const unsigned int                   dim,
                  std::vector<double>                 &rows);

  template <int dim>
  std::unique_ptr<SolidProblem<dim>> make_element_solid(Model<dim> &model, const Scene<dim> &scene);

  template <int dim>
  std::unique_ptr<SolidProblem<dim>> make_bond_solid(Model<dim> &model, const Scene<dim> &scene);

  /** By component, of a body in motion: the last columns of tables of points; else none. */
  template <int dim>
  std::vector<std::vector<double>> velocities_at_points(const Scene<dim>          &scene,
                                                        const PointEvaluator<dim> &reader,
                                                        const Vector              &velocity);
} // namespace PeriDeal
