// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/analysis/coupling_certificate.h>
#include <perideal/base/instantiate.h>
#include <perideal/base/matrix_product.h>
#include <perideal/base/user_error.h>
#include <perideal/operators/bounds/spectrum.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <type_traits>
#include <utility>

#include "held_system.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** Smooth fields of all coordinates, of a size near one. */
    template <int dim>
    class PatchFields
    {
    public:
      /** Collective. */
      explicit PatchFields(const Nodes<dim> &nodes)
      {
        Point<dim> low, high;
        for (unsigned int d = 0; d < dim; ++d)
          {
            low[d]  = std::numeric_limits<double>::max();
            high[d] = -std::numeric_limits<double>::max();
          }
        for (unsigned int i = 0; i < nodes.n_owned(); ++i)
          for (unsigned int d = 0; d < dim; ++d)
            {
              low[d]  = std::min(low[d], nodes.position(i)[d]);
              high[d] = std::max(high[d], nodes.position(i)[d]);
            }
        for (unsigned int d = 0; d < dim; ++d)
          {
            low[d]    = Utilities::MPI::min(low[d], nodes.communicator());
            high[d]   = Utilities::MPI::max(high[d], nodes.communicator());
            middle[d] = 0.5 * (low[d] + high[d]);
          }
        size = low.distance(high);
      }

      /** Of degree 1, 2 or 3, another one for each component. */
      double value(const Point<dim>  &p,
                   const unsigned int degree,
                   const unsigned int component) const
      {
        const double a = along(p, component), b = along(p, component + 1);
        return degree == 1 ? a : degree == 2 ? a * b + a * a : a * a * b + b * b * b;
      }

    private:
      /** From -1/2 to 1/2 along the body, in a direction that is not that of any side. */
      double along(const Point<dim> &p, const unsigned int k) const
      {
        constexpr double directions[3][3] = {{0.8, 0.5, -0.33},
                                             {-0.4, 0.7, 0.59},
                                             {0.3, -0.6, 0.74}};
        double           sum              = 0.;
        for (unsigned int d = 0; d < dim; ++d)
          sum += directions[k % 3][d] * (p[d] - middle[d]) / size;
        return sum;
      }

      Point<dim> middle;
      double     size;
    };


    /**
     * Nodes and bonds that the body would have with peridynamics everywhere; a graded mesh would
     * have to be uniform.
     */
    template <int dim>
    std::pair<unsigned long long, unsigned long long> count_all_bonds(const Families<dim> &families)
    {
      const Nodes<dim>                           &nodes = families.nodes();
      std::vector<typename Families<dim>::Member> members;
      unsigned long long                          n_ends = 0;
      unsigned long long n_sites = nodes.lattice() && families.neighbors().has_unique_sites() ? 1 :
                                                                                                0;
      for (unsigned int d = 0; d < dim && n_sites > 0; ++d)
        n_sites *= nodes.lattice()->n_sites[d];
      if (nodes.n_global() == n_sites || nodes.is_graded()) // no void
        {
          for (const FamilyMember<dim> &member : families.weights().members())
            {
              unsigned long long n_pairs = 1;
              for (unsigned int d = 0; d < dim; ++d)
                n_pairs *= std::max(0, nodes.lattice()->n_sites[d] - std::abs(member.offset[d]));
              n_ends += n_pairs;
            }
          return {n_sites, n_ends / 2};
        }
      for (unsigned int i = 0; i < nodes.n_owned(); ++i)
        {
          families.members_of(i, members);
          n_ends += members.size();
        }
      return {nodes.n_global(), Utilities::MPI::sum(n_ends, nodes.communicator()) / 2};
    }
  } // namespace


  std::string CouplingCertificate::fault() const
  {
    std::ostringstream text;
    text.precision(2);
    const auto add =
      [&](const bool wrong, const std::string &what, const double value, const std::string &of) {
        if (!wrong)
          return;
        text << (text.tellp() > 0 ? "; " : "") << what << value << of;
      };
    add(!(linear <= 1e-10), "a linear field comes out wrong by ", linear, " of its size");
    add(lowest_eigenvalue < 0., "the lowest eigenvalue is ", lowest_eigenvalue, ", below 0");
    add(lowest_remainder < -1e-12,
        "what is left of a cell has the eigenvalue ",
        lowest_remainder,
        " times its conductivity, or its shear modulus, below 0");
    add(unbalanced && *unbalanced > 1e-10,
        "forces do not balance, their sum or moment is up to ",
        unbalanced.value_or(0.),
        " of the sum of their sizes");
    return text.str();
  }


  void CouplingCertificate::require_sound() const
  {
    const std::string found = fault();
    AssertThrow(found.empty(),
                UserError("The coupling of section 'Coupling' is not sound: " + found +
                          ". Choose another 'Zone', or a mesh with less distorted cells."));
  }


  namespace
  {
    /**
     * What is asked of any body; its K with bonds and without are those of the intact one, of
     * n_components unknowns for each node.
     * @param cells what knows of elements and bonds: of solids the operator, of diffusion a term
     */
    template <int dim, typename OperatorType, typename CellsType>
    CouplingCertificate examine(const OperatorType &op,
                                const CellsType    &cells,
                                const Vector       &held,
                                const Vector       &noise,
                                const bool          symmetric,
                                const unsigned int  n_components)
    {
      CouplingCertificate            result;
      const Families<dim>           &families = cells.bonds().families();
      const Nodes<dim>              &nodes    = families.nodes();
      const PatchFields<dim>         fields(nodes);
      TrilinosWrappers::SparseMatrix matrix, elements;
      cells.assemble_intact(matrix, true);
      cells.assemble_intact(elements, false);
      const HeldSystem system(matrix, elements, held, symmetric, n_components);
      const auto       patch_error = [&](const unsigned int degree) {
        Vector u(held.get_partitioner());
        for (unsigned int i = 0; i < nodes.n_owned(); ++i)
          for (unsigned int c = 0; c < n_components; ++c)
            u.local_element(n_components * i + c) = fields.value(nodes.position(i), degree, c);
        return system.patch_error(u);
      };
      result.linear                 = patch_error(1);
      result.quadratic              = patch_error(2);
      result.cubic                  = patch_error(3);
      result.asymmetry              = system.asymmetry(noise);
      result.lowest_eigenvalue      = system.lowest_eigenvalue(noise, op.lumped_capacity());
      result.lowest_remainder       = symmetric ? cells.lowest_remainder() :
                                                  std::numeric_limits<double>::infinity();
      result.zone_share             = cells.bonds().zone_share();
      result.kept_share             = cells.bonds().kept_share();
      const auto [n_nodes, n_bonds] = count_all_bonds(families);
      result.n_bonds_of_full        = n_bonds;
      result.n_nonzeros_of_full     = 2 * n_bonds + n_nodes;
      if constexpr (std::is_same_v<OperatorType, ElasticElements<dim>>)
        {
          Vector y(noise);
          MatrixProduct(matrix).vmult(y, noise);
          double largest = 0.;
          for (const Vector &motion : op.near_null_space())
            largest =
              std::max(largest, std::abs(motion * y) / (motion.linfty_norm() * y.l1_norm()));
          result.unbalanced = largest;
        }
      return result;
    }
  } // namespace


  template <int dim>
  CouplingCertificate examine_coupling(const FieldOperator<dim> &op, const bool symmetric)
  {
    const CellTerm<dim> &cells = cells_of(op);
    Vector               held;
    op.initialize_vector(held);
    for (const BoundaryShare &share : cells.bonds().families().nodes().boundary_shares())
      held.local_element(share.node) = 1.;
    cells.hanging_nodes().set(held, 1.);
    return examine<dim>(op, cells, held, op.noise(), symmetric, 1);
  }


  template <int dim>
  CouplingCertificate examine_coupling(const ElasticElements<dim> &op)
  {
    Vector held, noise;
    op.initialize_vector(held);
    op.initialize_vector(noise);
    for (const BoundaryShare &share : op.bonds().families().nodes().boundary_shares())
      for (unsigned int d = 0; d < dim; ++d)
        held.local_element(dim * share.node + d) = 1.;
    op.fill_noise(noise);
    op.hanging_nodes().set(held, 1.);
    op.hanging_nodes().set(noise, 0.);
    CouplingCertificate result = examine<dim>(op, op, held, noise, op.symmetric(), dim);
    result.n_nonzeros_of_full  = 0; // depends on whether a dilatation joins bonds
    return result;
  }


#define PERIDEAL_TEMPLATES(dim)                                                          \
  template CouplingCertificate examine_coupling(const FieldOperator<dim> &, const bool); \
  template CouplingCertificate examine_coupling(const ElasticElements<dim> &);
  PERIDEAL_FOR_EACH_DIM(PERIDEAL_TEMPLATES)
#undef PERIDEAL_TEMPLATES
} // namespace PeriDeal
