// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "elastic_test_tools.h"

#include <perideal/solvers/linear_solver.h>

namespace PeriDeal
{
  namespace OperatorTests
  {
    template <int dim>
    Body<dim>::Body(const Settings &settings, const ModelKind model, const MPI_Comm communicator)
    {
      scene.general.set("Models", to_string(model));
      scene.general.set("Physics", "elasticity");
      set(scene, settings);
      std::vector<std::string> notes;
      mesh = build_mesh(scene, communicator, notes);
      handler.reinit(*mesh);
      if (model != ModelKind::peridynamics)
        {
          handler.distribute_dofs(dealii::FE_Q<dim>(scene.finite_elements.degree));
          std::unique_ptr<Coupling<dim>> coupling;
          if (model == ModelKind::coupled)
            {
              if (scene.domain.has_lattice())
                number_along_lattice(handler, scene.domain);
              nodes    = std::make_unique<Nodes<dim>>(handler,
                                                   scene.domain,
                                                   scene.cracks,
                                                   NodalVolume::partial);
              coupling = make_solid_coupling(*nodes, scene);
            }
          elements = std::make_unique<ElasticElements<dim>>(handler, scene, std::move(coupling));
        }
      else
        {
          if (scene.domain.nodes == NodePlacement::cell_centers)
            handler.distribute_dofs(dealii::FE_DGQ<dim>(0));
          else
            handler.distribute_dofs(dealii::FE_Q<dim>(1));
          if (scene.domain.has_lattice())
            number_along_lattice(handler, scene.domain);
          nodes  = std::make_unique<Nodes<dim>>(handler,
                                               scene.domain,
                                               scene.cracks,
                                               scene.peridynamics.sampling.nodal_volume);
          states = std::make_unique<StateOperator<dim>>(*nodes, scene);
        }
    }


    template <int dim>
    Body<dim>::~Body() = default;


    template <int dim>
    ElasticOperator &Body<dim>::op() const
    {
      return elements ? static_cast<ElasticOperator &>(*elements) : *states;
    }


    template <int dim>
    const dealii::Point<dim> &Body<dim>::position(const unsigned int node) const
    {
      return elements ? elements->position(node) : nodes->position(node);
    }


    template <int dim>
    unsigned int Body<dim>::n_owned() const
    {
      return op().lumped_capacity().locally_owned_size() / dim;
    }


    template <int dim>
    Vector Body<dim>::vector() const
    {
      Vector v;
      op().initialize_vector(v);
      return v;
    }


    template <int dim>
    Vector Body<dim>::product(const Vector &x) const
    {
      Vector y = vector();
      op().multiply(y, x);
      return y;
    }


    template <int dim>
    Vector Body<dim>::unbalanced(const Vector &u) const
    {
      Vector r = vector();
      op().unbalanced(r, u, 0.);
      return r;
    }


    template <int dim>
    Vector Body<dim>::residual(const Vector &u) const
    {
      Vector r = vector();
      op().residual(r, u, 0.);
      return r;
    }


    template <int dim>
    Vector Body<dim>::at_rest(const double tolerance) const
    {
      Vector u = vector(), change = vector();
      op().distribute(u, 0.);
      LinearSolver(op(), tolerance, 2000).solve(0., 1., change, residual(u));
      u += change;
      op().distribute(u, 0.); // hanging nodes
      return u;
    }


    template <int dim>
    double difference(const Body<dim> &body,
                      const Vector    &x,
                      const Body<dim> &whole,
                      const Vector    &y,
                      const double     above)
    {
      double largest = 0.;
      for_each_pair(
        body,
        whole,
        [&](const unsigned int i, const unsigned int k) {
          for (unsigned int d = 0; d < dim; ++d)
            largest =
              std::max(largest,
                       std::abs(x.local_element(dim * i + d) - y.local_element(dim * k + d)));
        },
        above);
      return largest;
    }


    template <int dim>
    void expect_derivatives(const Body<dim> &body,
                            const Vector    &u,
                            const Vector    &of_bumpy,
                            const double     step,
                            const double     accuracy_of_forces,
                            const double     accuracy_of_tangent)
    {
      const ElasticOperator &op  = body.op();
      const Vector           way = body.values(bumpy_vector<dim>);
      Vector                 up = u, down = u;
      up.add(step, way);
      down.add(-step, way);
      const double slope = (op.energy(up) - op.energy(down)) / (2. * step);
      EXPECT_NEAR(slope, -(body.unbalanced(u) * way), accuracy_of_forces * std::abs(slope));
      Vector change = body.unbalanced(down);
      change -= body.unbalanced(up);
      change *= 1. / (2. * step);
      EXPECT_LT(relative_difference(change, of_bumpy), accuracy_of_tangent);
      const DenseProperties dense(op);
      EXPECT_LT(dense.asymmetry, 1e-13);
      const Spectrum spectrum = op.spectrum();
      EXPECT_LE(dense.largest, spectrum.safe * (1. + 1e-12));
      EXPECT_LE(dense.largest, spectrum.sharp * 1.02);
    }


#define INSTANTIATE(dim)                                \
  template struct Body<dim>;                            \
  template double difference(const Body<dim> &,         \
                             const Vector &,            \
                             const Body<dim> &,         \
                             const Vector &,            \
                             const double);             \
  template void   expect_derivatives(const Body<dim> &, \
                                     const Vector &,    \
                                     const Vector &,    \
                                     const double,      \
                                     const double,      \
                                     const double);

    INSTANTIATE(1)
    INSTANTIATE(2)
    INSTANTIATE(3)
  } // namespace OperatorTests
} // namespace PeriDeal
