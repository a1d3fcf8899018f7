// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/mpi.h>
#include <deal.II/fe/fe_dgq.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/lac/full_matrix.h>

#include <perideal/mesh/material_ids.h>
#include <perideal/mesh/mesh_builder.h>
#include <perideal/operators/bond_operator.h>
#include <perideal/operators/fem_operator.h>

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /** What the tests of meshes, bonds, operators and solvers share. */
  namespace OperatorTests
  {
    /** Entries of a scene: "Section/Entry" and its text. Later ones replace earlier ones. */
    using Settings = std::vector<std::pair<std::string, std::string>>;


    inline Settings operator+(Settings a, const Settings &b)
    {
      a.insert(a.end(), b.begin(), b.end());
      return a;
    }


    template <int dim>
    void set(Scene<dim> &scene, const Settings &settings)
    {
      scene.general.set("Dimension", std::to_string(dim));
      for (const auto &[path, text] : settings)
        {
          const auto  slash   = path.rfind('/');
          bool        found   = false;
          const auto &section = path.substr(0, slash);
          for (SceneSection *s : scene.sections())
            if (s->name() == section)
              {
                s->set(path.substr(slash + 1), text);
                found = true;
              }
          ASSERT_TRUE(found) << path;
        }
      scene.parse_and_validate();
    }


    /** A scene with its mesh and the operator of one model. */
    template <int dim>
    struct Problem
    {
      explicit Problem(const Settings &settings,
                       const Model     model        = Model::peridynamics,
                       const MPI_Comm  communicator = MPI_COMM_WORLD)
      {
        scene.general.set("Models", to_string(model));
        set(scene, settings);
        mesh = build_mesh(scene, communicator, notes);
        set_material_ids(*mesh, scene.material.phases.all());
        handler.reinit(*mesh);
        if (model == Model::peridynamics && scene.domain.nodes == NodePlacement::cell_centers)
          handler.distribute_dofs(dealii::FE_DGQ<dim>(0));
        else
          handler.distribute_dofs(
            dealii::FE_Q<dim>(model == Model::finite_elements ? scene.finite_elements.degree : 1));
        if (scene.domain.shape != Shape::mesh_file && handler.get_fe().degree <= 1)
          number_along_lattice(handler, scene.domain);
        if (model == Model::peridynamics)
          {
            nodes = std::make_unique<Nodes<dim>>(handler,
                                                 scene.domain,
                                                 scene.cracks,
                                                 scene.peridynamics.nodal_volume);
            bonds = std::make_unique<BondOperator<dim>>(*nodes, scene);
          }
        else
          {
            std::unique_ptr<Coupling<dim>> coupling;
            if (model == Model::coupled)
              {
                nodes    = std::make_unique<Nodes<dim>>(handler,
                                                     scene.domain,
                                                     scene.cracks,
                                                     NodalVolume::partial);
                coupling = make_coupling(*nodes,
                                         scene,
                                         Zone<dim>(scene.coupling, scene.horizon()),
                                         scene.coupling.scheme);
              }
            fem = std::make_unique<FEMOperator<dim>>(handler, scene, std::move(coupling));
          }
        find_positions();
      }

      DiffusionOperator &op() const
      {
        return bonds ? static_cast<DiffusionOperator &>(*bonds) : *fem;
      }

      Vector vector() const
      {
        Vector v;
        op().initialize_vector(v);
        return v;
      }

      /** A vector with the values of a function at the owned unknowns. */
      template <typename Function>
      Vector values(const Function &f) const
      {
        Vector v = vector();
        for (unsigned int i = 0; i < v.locally_owned_size(); ++i)
          v.local_element(i) = f(positions[i]);
        return v;
      }

      Scene<dim>                                  scene;
      std::vector<std::string>                    notes;
      std::unique_ptr<dealii::Triangulation<dim>> mesh;
      dealii::DoFHandler<dim>                     handler;
      std::unique_ptr<Nodes<dim>>                 nodes;
      std::unique_ptr<BondOperator<dim>>          bonds;
      std::unique_ptr<FEMOperator<dim>>           fem;
      std::vector<dealii::Point<dim>>             positions; // of owned unknowns
      std::vector<dealii::Point<dim>> sides; // the same, a little towards the unknown's own cells

    private:
      void find_positions()
      {
        const auto               &fe    = handler.get_fe();
        const auto               &owned = handler.locally_owned_dofs();
        const auto                first = owned.is_empty() ? 0 : owned.nth_index_in_set(0);
        std::vector<unsigned int> count(owned.n_elements(), 0);
        positions.resize(owned.n_elements());
        sides.resize(owned.n_elements());
        std::vector<dealii::types::global_dof_index> indices(fe.n_dofs_per_cell());
        for (const auto &cell : handler.active_cell_iterators())
          {
            if (cell->is_artificial())
              continue;
            cell->get_dof_indices(indices);
            for (unsigned int v = 0; v < indices.size(); ++v)
              if (owned.is_element(indices[v]))
                {
                  const auto i = indices[v] - first;
                  if (count[i]++ == 0)
                    positions[i] = dealii::MappingQ1<dim>().transform_unit_to_real_cell(
                      cell,
                      fe.unit_support_point(v));
                  sides[i] += cell->center();
                }
          }
        for (unsigned int i = 0; i < count.size(); ++i)
          sides[i] = positions[i] + 1e-3 * (sides[i] / count[i] - positions[i]);
      }
    };


    /** Place of an unknown, rounded, as a key. */
    template <int dim>
    std::array<long, dim> place(const dealii::Point<dim> &p)
    {
      std::array<long, dim> key;
      for (unsigned int d = 0; d < dim; ++d)
        key[d] = std::lround(p[d] * 1e7);
      return key;
    }


    /** All values of a vector by place, on every process of its communicator. */
    template <int dim>
    std::map<std::array<long, dim>, double> gathered(const Problem<dim> &problem, const Vector &v)
    {
      std::vector<std::pair<std::array<long, dim>, double>> own;
      for (unsigned int i = 0; i < v.locally_owned_size(); ++i)
        own.emplace_back(place<dim>(problem.sides[i]), v.local_element(i));
      std::map<std::array<long, dim>, double> all;
      for (const auto &part :
           dealii::Utilities::MPI::all_gather(problem.handler.get_communicator(), own))
        for (const auto &[key, value] : part)
          EXPECT_TRUE(all.emplace(key, value).second) << "two unknowns at one place";
      return all;
    }


    /** Largest difference of two vectors of the same unknowns on different processes; infinite if the unknowns differ. */
    template <int dim>
    double difference(const Problem<dim> &a,
                      const Vector       &x,
                      const Problem<dim> &b,
                      const Vector       &y)
    {
      const auto all_x = gathered(a, x), all_y = gathered(b, y);
      if (all_x.size() != all_y.size())
        return INFINITY;
      double largest = 0.;
      for (const auto &[key, value] : all_x)
        {
          const auto found = all_y.find(key);
          if (found == all_y.end())
            return INFINITY;
          largest = std::max(largest, std::abs(value - found->second));
        }
      return largest;
    }


    inline double largest_difference(const Vector &a, const Vector &b)
    {
      Vector d(a);
      d -= b;
      return d.linfty_norm();
    }


    /** A field without any symmetry. */
    template <int dim>
    double bumpy(const dealii::Point<dim> &p)
    {
      double s = 0.3;
      for (unsigned int d = 0; d < dim; ++d)
        s += std::sin((3.1 + d) * p[d] + 0.7 * d) + (1 + d) * 0.4 * p[d] * p[(d + 1) % dim];
      return s;
    }


    /** The matrix that apply() multiplies with, on every process; for small problems. */
    inline dealii::FullMatrix<double> dense(const Operator &op)
    {
      Vector x, y;
      op.initialize_vector(x);
      op.initialize_vector(y);
      const unsigned int         n = x.size();
      dealii::FullMatrix<double> matrix(n, n), sum(n, n);
      for (unsigned int j = 0; j < n; ++j)
        {
          x = 0.;
          if (x.in_local_range(j))
            x(j) = 1.;
          op.clear_constrained(x);
          op.apply(y, x);
          for (unsigned int i = 0; i < y.locally_owned_size(); ++i)
            matrix(y.get_partitioner()->local_to_global(i), j) = y.local_element(i);
        }
      dealii::Utilities::MPI::sum(matrix, x.get_mpi_communicator(), sum);
      return sum;
    }


    /** Eigenvalues' largest, of C^{-1} K for symmetric K, and how unsymmetric K is: largest entry of K - K^T relative to the largest of K. */
    struct DenseProperties
    {
      explicit DenseProperties(const Operator &op);

      double asymmetry = 0., smallest = 0., largest = 0., entry = 0.;
    };


    inline unsigned int n_processes()
    {
      return dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
    }
  } // namespace OperatorTests
} // namespace PeriDeal
