// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/user_error.h>
#include <perideal/bonds/fictitious_extension.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  FictitiousExtension<dim>::FictitiousExtension(const Families<dim>                   &families,
                                                const std::vector<types::boundary_id> &symmetry)
    : families(families)
  {
    for (const types::boundary_id side : symmetry)
      symmetric[side] = true;
    const Lattice<dim> &lattice = *families.nodes().lattice();
    for (const FamilyMember<dim> &member : families.lattice_members())
      for (unsigned int d = 0; d < dim; ++d)
        AssertThrow(
          member.offset[d] < lattice.n_sites[d],
          UserError(
            "'Surface correction = fictitious nodes' in section 'Peridynamics': the body is narrower than its families reach, " +
            std::to_string(member.offset[d]) + " cells, and 'Cells' in section 'Domain' has " +
            std::to_string(lattice.n_sites[d] - 1) +
            " across it. Use more cells, a smaller 'Horizon' or another correction."));
  }


  template <int dim>
  bool FictitiousExtension<dim>::find(const Index &index, Site &site) const
  {
    using Term                            = typename Site::Term;
    const Lattice<dim>           &lattice = *families.nodes().lattice();
    std::array<Index, (1 << dim)> places;
    places[0]     = index;
    site.n_terms  = 1;
    site.terms[0] = Term{0, 1., Tensor<1, dim>()};
    for (unsigned int d = 0; d < dim; ++d)
      site.terms[0].of_component[d] = 1.;
    for (unsigned int d = 0; d < dim; ++d)
      {
        const int  last  = lattice.n_sites[d] - 1;
        const bool below = index[d]<0, above = index[d]> last;
        if (!below && !above)
          continue;
        const int          plane = below ? 0 : last;
        const bool         even  = symmetric[2 * d + (above ? 1 : 0)];
        const unsigned int n     = site.n_terms;
        for (unsigned int k = 0; k < n; ++k)
          {
            if (!even)
              {
                places[site.n_terms]    = places[k];
                places[site.n_terms][d] = plane;
                Term &on_side           = site.terms[site.n_terms++];
                on_side                 = site.terms[k];
                on_side.factor *= 2.;
                on_side.of_component *= 2.;
              }
            Term &mirrored = site.terms[k];
            places[k][d]   = 2 * plane - index[d];
            if (even)
              mirrored.of_component[d] *= -1.;
            else
              {
                mirrored.factor *= -1.;
                mirrored.of_component *= -1.;
              }
          }
      }
    for (unsigned int k = 0; k < site.n_terms; ++k)
      {
        site.terms[k].node = families.node_at(places[k]);
        if (site.terms[k].node == numbers::invalid_unsigned_int)
          return false;
      }
    // The first place is the mirror of all sides.
    site.volume = families.nodes().volume(site.terms[0].node);
    for (unsigned int d = 0; d < dim; ++d)
      if (places[0][d] == 0 || places[0][d] == lattice.n_sites[d] - 1)
        site.volume *= 2.;
    return true;
  }


  template class FictitiousExtension<1>;
  template class FictitiousExtension<2>;
  template class FictitiousExtension<3>;
} // namespace PeriDeal
