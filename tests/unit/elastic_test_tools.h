// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/solid/elastic_elements.h>
#include <perideal/operators/solid/state_operator.h>

#include "operator_test_tools.h"

namespace PeriDeal
{
  namespace OperatorTests
  {
    /** An elastic body with one of its models. */
    template <int dim>
    struct Body
    {
      Body(const Settings &settings,
           const ModelKind model,
           const MPI_Comm  communicator = MPI_COMM_WORLD);

      ~Body();

      ElasticOperator &op() const;

      const dealii::Point<dim> &position(const unsigned int node) const;

      unsigned int n_owned() const;

      Vector vector() const;

      /** K x, held unknowns too. */
      Vector product(const Vector &x) const;

      /** What acts on the nodes at u. */
      Vector unbalanced(const Vector &u) const;

      /** f - K u. */
      Vector residual(const Vector &u) const;

      /** The displacement at rest of a linear body. */
      Vector at_rest(const double tolerance = 1e-11) const;

      /** A vector with the values f(p)[component] at the owned nodes. */
      template <typename Function>
      Vector values(const Function &f) const
      {
        Vector v;
        op().initialize_vector(v);
        for (unsigned int i = 0; i < v.locally_owned_size() / dim; ++i)
          {
            const dealii::Tensor<1, dim> value = f(position(i));
            for (unsigned int d = 0; d < dim; ++d)
              v.local_element(dim * i + d) = value[d];
          }
        return v;
      }

      Scene<dim>                                  scene;
      std::unique_ptr<dealii::Triangulation<dim>> mesh;
      dealii::DoFHandler<dim>                     handler;
      std::unique_ptr<Nodes<dim>>                 nodes;
      std::unique_ptr<ElasticElements<dim>>       elements;
      std::unique_ptr<StateOperator<dim>>         states;
    };


    /**
     * visit(i, k): owned nodes at one place of a body and of one that each process has whole. Every
     * node of the first has to be there, but for those below a plane across the first axis.
     */
    template <int dim, typename Visit>
    void for_each_pair(const Body<dim> &body,
                       const Body<dim> &whole,
                       const Visit     &visit,
                       const double     above = -1e300)
    {
      std::map<std::array<long, dim>, unsigned int> nodes;
      for (unsigned int k = 0; k < whole.n_owned(); ++k)
        nodes[place<dim>(whole.position(k))] = k;
      for (unsigned int i = 0; i < body.n_owned(); ++i)
        if (body.position(i)[0] > above)
          {
            const auto found = nodes.find(place<dim>(body.position(i)));
            ASSERT_TRUE(found != nodes.end()) << "no node at " << body.position(i);
            visit(i, found->second);
          }
    }


    /** Largest difference of vectors of such bodies on this process. */
    template <int dim>
    double difference(const Body<dim> &body,
                      const Vector    &x,
                      const Body<dim> &whole,
                      const Vector    &y,
                      const double     above = -1e300);


    /**
     * Forces at u are the slope of the energy, and the tangent there, whose product with
     * bumpy_vector is given, that of the forces; it is symmetric, and its bounds hold.
     */
    template <int dim>
    void expect_derivatives(const Body<dim> &body,
                            const Vector    &u,
                            const Vector    &of_bumpy,
                            const double     step,
                            const double     accuracy_of_forces,
                            const double     accuracy_of_tangent);


    inline const char *const lists[] = {"", "1", "1, 0.75", "1, 0.75, 0.5"};
    inline const char *const cells[] = {"", "24", "16, 12", "8, 6, 4"};
    inline const char *const zeros[] = {"", "0", "0, 0", "0, 0, 0"};


    /** A box with cubic cells, held on its left side. Families of its nodes end at the sides. */
    template <int dim>
    Settings box()
    {
      return {{"Domain/Lower corner", zeros[dim]},
              {"Domain/Upper corner", lists[dim]},
              {"Domain/Cells", cells[dim]},
              {"Peridynamics/Horizon ratio", dim == 3 ? "2" : "3"},
              {"Peridynamics/Surface correction", "none"},
              {"Material/Young modulus", "3"},
              {"Material/Poisson ratio", "0.2"},
              {"Boundary conditions/Displacement", std::string("left: ") + zeros[dim]}};
    }


    /** u = G x with some gradient. */
    template <int dim>
    dealii::Tensor<2, dim> some_gradient()
    {
      const double           g[9] = {0.3, -0.2, 0.15, 0.45, -0.1, 0.25, -0.35, 0.2, 0.4};
      dealii::Tensor<2, dim> gradient;
      for (unsigned int a = 0; a < dim; ++a)
        for (unsigned int b = 0; b < dim; ++b)
          gradient[a][b] = g[3 * a + b];
      return gradient;
    }


    template <int dim>
    dealii::Tensor<1, dim> linear_field(const dealii::Point<dim> &p)
    {
      return some_gradient<dim>() * p;
    }


    /** Some vector that depends on places only. */
    template <int dim>
    dealii::Tensor<1, dim> bumpy_vector(const dealii::Point<dim> &p)
    {
      dealii::Tensor<1, dim> value;
      for (unsigned int d = 0; d < dim; ++d)
        {
          double phase = d + 1.;
          for (unsigned int e = 0; e < dim; ++e)
            phase += (3. + 2. * e + d) * p[e];
          value[d] = std::sin(phase);
        }
      return value;
    }
  } // namespace OperatorTests
} // namespace PeriDeal
