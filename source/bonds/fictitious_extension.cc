// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/bonds/fictitious_extension.h>

#include <algorithm>
#include <limits>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  FictitiousExtension<dim>::FictitiousExtension(const Families<dim>                   &families,
                                                const std::array<BeyondSide, 2 * dim> &beyond)
    : families(families)
    , beyond(beyond)
  {}


  template <int dim>
  bool FictitiousExtension<dim>::resolve(const unsigned int axis,
                                         int                k,
                                         std::vector<Step> &steps,
                                         int               &inner) const
  {
    const Lattice<dim> &lattice = *families.nodes().lattice();
    const int           last    = lattice.n_sites[axis] - 1;
    Step                left{k, 1., false}; // what is not resolved yet
    steps.clear();
    const auto add = [&](const Step &step) {
      for (Step &other : steps)
        if (other.site == step.site && other.even == step.even)
          {
            other.factor += step.factor;
            return;
          }
      steps.push_back(step);
    };
    while (left.site < 0 || left.site > last)
      {
        const bool below = left.site < 0;
        const int  plane = below ? 0 : last, second = below ? 1 : last - 1;
        const auto kind = beyond[2 * axis + (below ? 0 : 1)];
        if (kind == BeyondSide::nothing || last == 0)
          return false;
        if (kind == BeyondSide::mirrored)
          left.even = !left.even;
        else
          {
            add({plane, (lattice.at_centers ? 3. : 2.) * left.factor, left.even});
            if (lattice.at_centers)
              add({second, -left.factor, left.even});
            left.factor *= -1.;
          }
        left.site = 2 * plane - left.site;
        if (lattice.at_centers)
          left.site += below ? -1 : 1;
      }
    inner = left.site;
    add(left);
    return true;
  }


  template <int dim>
  bool FictitiousExtension<dim>::find(const Index &index, Site &site) const
  {
    using Term                  = typename Site::Term;
    const Lattice<dim> &lattice = *families.nodes().lattice();
    std::vector<Index>  places{index};
    std::vector<Step>   steps;
    Index               image = index;
    double              parts = 1., own_parts = 1.; // own: of the body and its mirror images
    site.terms.assign(1, Term{0, 0, 1.});
    for (unsigned int d = 0; d < dim; ++d)
      {
        const int last = lattice.n_sites[d] - 1;
        if (index[d] >= 0 && index[d] <= last)
          steps.assign(1, {index[d], 1., false});
        else if (!resolve(d, index[d], steps, image[d]))
          return false;
        if (steps.size() > 1)
          own_parts = 0.;
        for (const bool above : {false, true})
          if (const auto kind = beyond[2 * d + (above ? 1 : 0)];
              !lattice.at_centers && image[d] == (above ? last : 0) && kind != BeyondSide::nothing)
            {
              parts *= 2.;
              own_parts *= kind == BeyondSide::mirrored ? 2. : 1.;
            }
        const std::size_t n = places.size();
        for (std::size_t s = 1; s < steps.size(); ++s)
          for (std::size_t k = 0; k < n; ++k)
            {
              places.push_back(places[k]);
              site.terms.push_back(site.terms[k]);
            }
        for (std::size_t k = 0; k < places.size(); ++k)
          {
            const Step &step = steps[k / n];
            Term       &term = site.terms[k];
            places[k][d]     = step.site;
            term.factor *= step.factor;
            if (step.even)
              term.mirrored |= 1u << d;
          }
      }
    for (std::size_t k = 0; k < places.size(); ++k)
      {
        site.terms[k].node = families.neighbors().node_at(places[k]);
        if (site.terms[k].node == numbers::invalid_unsigned_int)
          return false;
      }
    site.origin = families.neighbors().node_at(image);
    if (site.origin == numbers::invalid_unsigned_int)
      return false;
    site.volume        = parts * families.nodes().volume(site.origin);
    const double share = share_of(index);
    const double own   = own_parts * families.nodes().volume(site.origin);
    site.volume        = own + share * (site.volume - own);
    return share > 0. || own > 0.;
  }


  template <int dim>
  double FictitiousExtension<dim>::share_of(const Index &index) const
  {
    const Lattice<dim> &lattice = *families.nodes().lattice();
    const int           on      = lattice.at_centers ? 0 : 1; // what counts as beyond a side
    unsigned int        n_free = 0, n_continued = 0;
    for (unsigned int d = 0; d < dim; ++d)
      {
        const int  last = lattice.n_sites[d] - 1;
        const auto kind = index[d] < on        ? beyond[2 * d] :
                          index[d] > last - on ? beyond[2 * d + 1] :
                                                 BeyondSide::nothing;
        n_free += kind == BeyondSide::in_part ? 1 : 0;
        n_continued += kind == BeyondSide::continued ? 1 : 0;
      }
    if (n_free == 0)
      return 1.;
    return n_free > 1 ? 0. : n_continued > 0 ? 0.25 : 0.5;
  }


  template <int dim>
  int FictitiousExtension<dim>::distance(const Index &index) const
  {
    const Lattice<dim> &lattice = *families.nodes().lattice();
    int                 nearest = std::numeric_limits<int>::max();
    for (unsigned int d = 0; d < dim; ++d)
      {
        if (beyond[2 * d] != BeyondSide::nothing)
          nearest = std::min(nearest, index[d]);
        if (beyond[2 * d + 1] != BeyondSide::nothing)
          nearest = std::min(nearest, lattice.n_sites[d] - 1 - index[d]);
      }
    return nearest;
  }


  template <int dim>
  bool FictitiousExtension<dim>::is_inside(const Index &index) const
  {
    const Lattice<dim> &lattice = *families.nodes().lattice();
    for (unsigned int d = 0; d < dim; ++d)
      if (index[d] < 0 || index[d] >= lattice.n_sites[d])
        return false;
    return distance(index) > (lattice.at_centers ? -1 : 0);
  }


  template <int dim>
  void throw_if_narrow(const Families<dim> &families)
  {
    const Lattice<dim> &lattice = *families.nodes().lattice();
    for (const FamilyMember<dim> &member : families.weights().members())
      for (unsigned int d = 0; d < dim; ++d)
        AssertThrow(
          member.offset[d] < lattice.n_sites[d],
          UserError(
            "'Surface correction = fictitious nodes' in section 'Peridynamics': the body is narrower than its families reach, " +
            std::to_string(member.offset[d]) + " cells, and 'Cells' in section 'Domain' has " +
            std::to_string(lattice.n_sites[d] - 1) +
            " across it. Use more cells, a smaller 'Horizon' or another correction."));
  }


  PERIDEAL_INSTANTIATE_CLASS(class FictitiousExtension);
  PERIDEAL_INSTANTIATE_FUNCTION(throw_if_narrow);
} // namespace PeriDeal
