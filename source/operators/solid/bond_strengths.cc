// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/place_text.h>
#include <perideal/base/point_order.h>
#include <perideal/base/types.h>
#include <perideal/base/user_error.h>
#include <perideal/operators/solid/bond_strengths.h>
#include <perideal/operators/solid/weibull_field.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** Round-off of formulas. */
    constexpr double weaker = 1. - 1e-9;


    template <int dim>
    std::string fault_at(const bool of_energy, const Point<dim> &p)
    {
      return std::string("'") + (of_energy ? "Fracture energy" : "Critical stretch") +
             "' in section 'Material' is not positive at " + place_text(p) + ".";
    }


    /** The least value at places between two points, and where. */
    template <int dim>
    std::pair<double, Point<dim>> least_between(const MaterialProperty &strength,
                                                const Point<dim>       &a,
                                                const Point<dim>       &b,
                                                const unsigned int      n_places)
    {
      std::pair<double, Point<dim>> found(std::numeric_limits<double>::max(), a);
      for (unsigned int k = 0; k < n_places; ++k)
        {
          const Point<dim> p = a + (k + 0.5) / n_places * (b - a);
          if (const double value = strength.value(p); value < found.first)
            found = {value, p};
        }
      return found;
    }
  } // namespace


  template <int dim>
  std::vector<bool> BondStrengths<dim>::beside_weaker(const Families<dim>    &families,
                                                      const MaterialProperty &strength) const
  {
    constexpr unsigned int n_places = 8;
    const Nodes<dim>      &places   = families.nodes();
    std::vector<bool>      result(places.n_local(), !places.lattice());
    if (!places.lattice())
      return result;
    // To the next node along each axis and across each cell at one end of it.
    std::vector<Tensor<1, dim>> ways;
    for (unsigned int d = 0; d < dim; ++d)
      {
        ways.emplace_back();
        ways.back()[d] = places.lattice()->spacing[d];
      }
    for (unsigned int k = 0; dim > 1 && k < 1u << (dim - 1); ++k)
      {
        ways.emplace_back(places.lattice()->spacing);
        for (unsigned int d = 0; d + 1 < dim; ++d)
          ways.back()[d] *= (k >> d) & 1 ? -1. : 1.;
      }
    for (unsigned int i = 0; i < places.n_local(); ++i)
      {
        const Point<dim> &p   = places.position(i);
        const double      own = strength.value(p);
        for (unsigned int k = 0; k < ways.size() && !result[i]; ++k)
          result[i] = least_between<dim>(strength, p, p + ways[k], n_places).first < weaker * own ||
                      least_between<dim>(strength, p, p - ways[k], n_places).first < weaker * own;
      }
    return result;
  }


  template <int dim>
  BondStrengths<dim>::BondStrengths(const BreakableBonds<dim> &bonds)
    : of_energy(!bonds.material.critical_stretch)
    , interfaces(bonds)
  {
    const Nodes<dim>       &places   = bonds.families.nodes();
    const Material         &material = bonds.material;
    const MaterialProperty &strength = of_energy ? *material.fracture_energy :
                                                   *material.critical_stretch;
    std::string             message;
    Vector                  stretches(places.partitioner()), stored(places.partitioner());
    for (unsigned int i = 0; i < places.n_owned(); ++i)
      {
        const Point<dim> &p     = places.position(i);
        const double      value = strength.changes() ? 1. : strength.value(p);
        double           &s     = stretches.local_element(i);
        const double energy = of_energy || interfaces.any() ? bonds.crossing_energy(i).total() : 0.;
        stored.local_element(i) = energy;
        s                       = of_energy ? std::sqrt(value / energy) : value;
        if (message.empty() && !(s > 0.))
          message = fault_at(of_energy, p);
      }
    throw_on_all_if_any(places.communicator(), message);
    if (material.scatter)
      {
        const WeibullField<dim> field(places, material.scatter->modulus, material.scatter->seed);
        for (unsigned int i = 0; i < places.n_owned(); ++i)
          {
            const double factor = field.factor(places.position(i));
            stretches.local_element(i) *= factor;
            stored.local_element(i) /= factor * factor;
          }
      }
    stretches.update_ghost_values();
    nodes.assign(stretches.begin(), stretches.begin() + places.n_local());
    if (strength.changes())
      {
        changing.emplace(bonds, nodes, of_energy); // which is what is not of the formula
        nodes = changing->values();
      }
    std::vector<double> lowest = nodes;
    if (changing)
      lowest.assign(nodes.size(), std::numeric_limits<double>::infinity());
    else if (!strength.is_constant())
      find_weak(bonds.families, strength, lowest);
    if (interfaces.any())
      {
        stored.update_ghost_values();
        crossing.assign(stored.begin(), stored.begin() + places.n_local());
        for (const Material::Law::Interface &face : material.law.interfaces)
          energies.push_back(face.fracture_energy);
        interfaces.lower(
          bonds.families,
          [&](const unsigned int i, const unsigned int j, const unsigned int k) {
            return across(i, j, k);
          },
          lowest);
      }
    if (begins.empty() && !interfaces.any())
      return;
    std::copy_n(lowest.begin(), places.n_owned(), stretches.begin());
    stretches.update_ghost_values();
    least.assign(stretches.begin(), stretches.begin() + places.n_local());
    least_across = least; // of changing ones
    std::transform(nodes.begin(), nodes.end(), least_across.begin(), least.begin(), least_of);
  }


  template <int dim>
  void BondStrengths<dim>::find_weak(const Families<dim>    &families,
                                     const MaterialProperty &strength,
                                     std::vector<double>    &lowest)
  {
    constexpr unsigned int                      n_places = 32;
    const Nodes<dim>                           &places   = families.nodes();
    const std::vector<bool>                     beside   = beside_weaker(families, strength);
    std::vector<typename Families<dim>::Member> family;
    std::string                                 message;
    begins.assign(1, 0);
    for (unsigned int i = 0; i < places.n_owned(); ++i)
      {
        families.members_of(i, family);
        bool any = beside[i];
        for (const auto &bond : family)
          any = any || beside[bond.neighbor];
        for (const auto &bond : family)
          {
            const unsigned int j = bond.neighbor;
            if (!any || j == i)
              continue;
            // The same digits at both ends of a bond.
            const bool         ahead = comes_first(places.position(i), places.position(j));
            const unsigned int first = ahead ? i : j, last = ahead ? j : i;
            const double       at_first = strength.value(places.position(first)),
                         at_last        = strength.value(places.position(last));
            const auto found =
              least_between<dim>(strength, places.position(first), places.position(last), n_places);
            const double value = found.first;
            if (!(value < weaker * std::min(at_first, at_last)))
              continue;
            if (!(value > 0.))
              {
                message = message.empty() ? fault_at(of_energy, found.second) : message;
                continue;
              }
            const auto of_weakest = [&](const double at_end) {
              return of_energy ? std::sqrt(value / at_end) : value / at_end;
            };
            const double stretch = std::min({nodes[first],
                                             nodes[last],
                                             nodes[first] * of_weakest(at_first),
                                             nodes[last] * of_weakest(at_last)});
            weak.push_back({j, stretch});
            lowest[i] = std::min(lowest[i], stretch);
          }
        begins.push_back(weak.size());
      }
    throw_on_all_if_any(places.communicator(), message);
    if (Utilities::MPI::sum(weak.size(), places.communicator()) == 0)
      begins.clear();
  }


  PERIDEAL_INSTANTIATE_CLASS(class BondStrengths);
} // namespace PeriDeal
