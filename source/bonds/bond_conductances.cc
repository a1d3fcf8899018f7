// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// The material and the cracks along a bond.

#include <deal.II/base/mpi.h>

#include <perideal/base/user_error.h>
#include <perideal/bonds/families.h>
#include <perideal/laws/crack_conductance.h>
#include <perideal/laws/interface.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  void Families<dim>::find_conductivities(const Scene<dim> &scene)
  {
    uniform              = scene.material.uniform_conductivity();
    const unsigned int n = uniform ? 1 : own_nodes->n_local();
    std::string        message;
    conductivities.resize(n);
    for (unsigned int i = 0; i < n && message.empty(); ++i)
      {
        const Point<dim> p = own_nodes->n_local() > 0 ? own_nodes->position(i) : Point<dim>();
        conductivities[i]  = scene.material.conductivity.value(p);
        if (!(conductivities[i] > 0.))
          message = "'Conductivity' in section 'Material' is " + std::to_string(conductivities[i]) +
                    " at a node; it must be positive everywhere in the body.";
      }
    throw_on_all_if_any(own_nodes->communicator(), message);
  }


  template <int dim>
  double Families<dim>::conductivity(const unsigned int node) const
  {
    if (uniform)
      return conductivities[0];
    return conductivities[node < own_nodes->n_local() ?
                            node :
                            outside[node - own_nodes->n_local()].mirror];
  }


  template <int dim>
  double Families<dim>::bond_conductivity(const unsigned int node,
                                          const unsigned int neighbor) const
  {
    if (uniform)
      return conductivities[0];
    const double a = conductivity(node), b = conductivity(neighbor);
    if (material.interface_rule != InterfaceRule::harmonic)
      return interface_conductivity(material.interface_rule, a, b);
    // From the end that comes first in space, so that both ends of a bond see the same value to the last bit.
    Point<dim> start = position(node), end = position(neighbor);
    for (unsigned int d = 0; d < dim; ++d)
      if (start[d] != end[d])
        {
          if (end[d] < start[d])
            std::swap(start, end);
          break;
        }
    const bool real = neighbor < own_nodes->n_local();
    return harmonic_conductivity([&](const double s) {
      Point<dim> p = start + s * (end - start);
      // Beyond a side the material is the mirror image of the body's.
      for (unsigned int d = 0; d < dim && !real; ++d)
        if (p[d] < own_nodes->lattice()->lower[d])
          p[d] = 2. * own_nodes->lattice()->lower[d] - p[d];
        else if (p[d] > own_nodes->lattice()->upper[d])
          p[d] = 2. * own_nodes->lattice()->upper[d] - p[d];
      return material.conductivity.value(p);
    });
  }


  template <int dim>
  double Families<dim>::kept_fraction(const unsigned int node,
                                      const unsigned int neighbor,
                                      bool              &cut) const
  {
    double kept = 1.;
    cut         = false;
    for (const CrackGeometry<dim> &crack : cracks)
      {
        if (!crack.is_near(own_nodes->position(node), farthest))
          continue;
        double     fraction = 1.;
        const auto test     = [&](const Point<dim> &a, const Point<dim> &b) {
          if (!crack.separates(a, b))
            return;
          cut = true;
          // A bond may meet a crack and its mirror image, most often where the crack ends on a side: that is one crossing.
          fraction = std::min(fraction,
                              contact_conductance < 0. ?
                                    transmission :
                                    contact_fraction(contact_conductance,
                                                 std::abs((b - a) * crack.normal()),
                                                 bond_conductivity(node, neighbor)));
        };
        if (neighbor < own_nodes->n_local())
          test(own_nodes->crack_point(node), own_nodes->crack_point(neighbor));
        else
          test_images(node, outside[neighbor - own_nodes->n_local()], test);
        kept *= fraction;
      }
    return kept;
  }


  template <int dim>
  template <typename Test>
  void Families<dim>::test_images(const unsigned int         node,
                                  const FictitiousNode<dim> &fictitious,
                                  const Test                &test) const
  {
    // The body and its cracks are mirrored to the outside. Instead of the cracks mirror the bond, about each set of the sides that it passes.
    const Lattice<dim> &lattice = *own_nodes->lattice();
    const auto          origin  = lattice.index(own_nodes->position(fictitious.mirror));
    for (unsigned int image = 0; image < (1u << dim); ++image)
      {
        auto a = lattice.index(own_nodes->position(node)), b = fictitious.site;
        bool mirrored = true;
        for (unsigned int d = 0; d < dim && mirrored; ++d)
          if ((image >> d) & 1)
            {
              // The sum of the sites of mirror images of each other is that of the mirror and the fictitious node.
              mirrored        = origin[d] != fictitious.site[d];
              const int twice = origin[d] + fictitious.site[d];
              a[d]            = twice - a[d];
              b[d]            = twice - b[d];
            }
        if (mirrored)
          test(lattice.position(a), lattice.position(b));
      }
  }


#define PERIDEAL_INSTANTIATE(dim)                                                                 \
  template void   Families<dim>::find_conductivities(const Scene<dim> &);                         \
  template double Families<dim>::conductivity(const unsigned int) const;                          \
  template double Families<dim>::bond_conductivity(const unsigned int, const unsigned int) const; \
  template double Families<dim>::kept_fraction(const unsigned int, const unsigned int, bool &)    \
    const;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
