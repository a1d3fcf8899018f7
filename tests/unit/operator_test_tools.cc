// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "operator_test_tools.h"

#include <perideal/problems/computable.h>
#include <perideal/solvers/linear_solver.h>

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace PeriDeal
{
  namespace OperatorTests
  {
    template <int dim>
    void set(Scene<dim> &scene, const Settings &settings)
    {
      scene.general.set("Dimension", std::to_string(dim));
      scene.cracks.set("Nodes on cracks", "left"); // the lattice is the one asked for
      // Nor are bonds of diffusion corrected by themselves.
      if (std::none_of(settings.begin(), settings.end(), [](const auto &entry) {
            return entry.second == "elasticity";
          }))
        scene.peridynamics.set("Surface correction", "none");
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
      require_computable(scene, {});
    }


    template <int dim>
    Problem<dim>::Problem(const Settings &settings,
                          const ModelKind model,
                          const MPI_Comm  communicator)
    {
      scene.general.set("Models", to_string(model));
      set(scene, settings);
      mesh = build_mesh(scene, communicator, notes);
      set_material_ids(*mesh, scene.material.phases.all());
      handler.reinit(*mesh);
      if (model == ModelKind::peridynamics && scene.domain.nodes == NodePlacement::cell_centers)
        handler.distribute_dofs(dealii::FE_DGQ<dim>(0));
      else
        handler.distribute_dofs(dealii::FE_Q<dim>(
          model == ModelKind::finite_elements ? scene.finite_elements.degree : 1));
      if (scene.domain.has_lattice() && handler.get_fe().degree <= 1)
        number_along_lattice(handler, scene.domain);
      if (model == ModelKind::peridynamics)
        {
          nodes = std::make_unique<Nodes<dim>>(handler,
                                               scene.domain,
                                               scene.cracks,
                                               scene.peridynamics.sampling.nodal_volume);
          field = field_of_bonds(*nodes, scene);
        }
      else
        {
          std::unique_ptr<Coupling<dim>> coupling;
          if (model == ModelKind::coupled)
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
          field = field_of_elements(handler, scene, std::move(coupling));
        }
      find_positions();
    }


    template <int dim>
    Problem<dim>::~Problem() = default;


    template <int dim>
    Vector Problem<dim>::vector() const
    {
      Vector v;
      op().initialize_vector(v);
      return v;
    }


    template <int dim>
    Vector Problem<dim>::product(const Vector &x) const
    {
      Vector y = vector();
      op().apply(y, x);
      return y;
    }


    template <int dim>
    Vector Problem<dim>::residual(const Vector &u, const double t) const
    {
      Vector r = vector();
      op().residual(r, u, t);
      return r;
    }


    template <int dim>
    Vector Problem<dim>::steady(const double tolerance, Vector u) const
    {
      if (u.size() == 0)
        u = vector();
      solve_steady(op(), u, 0., tolerance, 2000);
      return u;
    }


    template <int dim>
    void Problem<dim>::find_positions()
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
                  positions[i] =
                    dealii::MappingQ1<dim>().transform_unit_to_real_cell(cell,
                                                                         fe.unit_support_point(v));
                sides[i] += cell->center();
              }
        }
      for (unsigned int i = 0; i < count.size(); ++i)
        sides[i] = positions[i] + 1e-3 * (sides[i] / count[i] - positions[i]);
    }


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


    double largest_difference(const Vector &a, const Vector &b)
    {
      Vector d(a);
      d -= b;
      return d.linfty_norm();
    }


    double relative_difference(const Vector &a, const Vector &b)
    {
      return largest_difference(a, b) / b.linfty_norm();
    }


    dealii::FullMatrix<double> dense(const Operator &op)
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


    DenseProperties::DenseProperties(const Operator &op)
    {
      const dealii::FullMatrix<double> k = dense(op);
      const unsigned int               n = k.m();
      const Vector                    &c = op.lumped_capacity();
      std::vector<double>              own(n, 0.), capacity(n);
      for (unsigned int i = 0; i < c.locally_owned_size(); ++i)
        own[c.get_partitioner()->local_to_global(i)] = c.local_element(i);
      dealii::Utilities::MPI::sum(own, c.get_mpi_communicator(), capacity);
      Eigen::MatrixXd scaled(n, n);
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
          {
            entry        = std::max(entry, std::abs(k(i, j)));
            asymmetry    = std::max(asymmetry, std::abs(k(i, j) - k(j, i)));
            scaled(i, j) = k(i, j) / std::sqrt(capacity[i] * capacity[j]);
          }
      asymmetry /= entry;
      if (asymmetry < 1e-10)
        {
          const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled,
                                                                      Eigen::EigenvaluesOnly);
          smallest = solver.eigenvalues()[0];
          largest  = solver.eigenvalues()[n - 1];
        }
      else
        largest = scaled.eigenvalues().cwiseAbs().maxCoeff();
    }


    template void set(Scene<1> &, const Settings &);
    template void set(Scene<2> &, const Settings &);
    template void set(Scene<3> &, const Settings &);
    template struct Problem<1>;
    template struct Problem<2>;
    template struct Problem<3>;
    template std::map<std::array<long, 1>, double> gathered<1>(const Problem<1> &, const Vector &);
    template std::map<std::array<long, 2>, double> gathered<2>(const Problem<2> &, const Vector &);
    template std::map<std::array<long, 3>, double> gathered<3>(const Problem<3> &, const Vector &);
    template double                                difference(const Problem<1> &,
                                                              const Vector &,
                                                              const Problem<1> &,
                                                              const Vector &);
    template double                                difference(const Problem<2> &,
                                                              const Vector &,
                                                              const Problem<2> &,
                                                              const Vector &);
    template double                                difference(const Problem<3> &,
                                                              const Vector &,
                                                              const Problem<3> &,
                                                              const Vector &);
  } // namespace OperatorTests
} // namespace PeriDeal
