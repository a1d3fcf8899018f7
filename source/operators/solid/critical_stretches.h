// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/lac/la_parallel_vector.h>

#include <perideal/base/types.h>
#include <perideal/base/user_error.h>
#include <perideal/laws/elasticity.h>
#include <perideal/operators/solid/weibull_field.h>

#include <cmath>
#include <string>
#include <vector>

#include "crossing_sums.h"
#include "stretch_fault.h"

namespace PeriDeal
{
  /**
   * The critical stretches of state-based families, as BondBreaking says, of owned nodes and
   * ghosts. Collective. Throws UserError for those not above 0.
   *
   * @param law_of the StateLaw of an owned node
   * @param volumetric there are dilatations
   */
  template <int dim, typename LawOf>
  std::vector<double> critical_stretches_of_families(const Families<dim>       &families,
                                                     const BodyParameters<dim> &body,
                                                     const LawOf               &law_of,
                                                     const bool                 volumetric)
  {
    const Material    &material   = body.material;
    const Nodes<dim>  &nodes      = families.nodes();
    const bool         converts   = !material.critical_stretch;
    const CrossingSums of_lattice = converts && nodes.lattice() ? crossing_sums(families) :
                                                                  CrossingSums();
    std::vector<typename Families<dim>::Member> family;
    std::string                                 message;
    Vector                                      stretches(nodes.partitioner());
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        const dealii::Point<dim> &p   = nodes.position(i);
        const StateLaw           &law = law_of(i);
        double                   &s   = stretches.local_element(i);
        if (converts)
          {
            const CrossingSums sums = nodes.lattice() ? of_lattice :
                                                        own_crossing_sums(families, i, family);
            s                       = std::sqrt(material.fracture_energy->value(p) /
                          (law.extension * sums.bonds +
                           (volumetric ? law.volumetric * law.dilatation * sums.dilatations : 0.)));
          }
        else
          s = material.critical_stretch->value(p);
        if (message.empty() && !(s > 0.))
          message = stretch_fault(!converts, p);
      }
    throw_on_all_if_any(nodes.communicator(), message);
    if (material.scatter)
      {
        const WeibullField<dim> field(nodes, material.scatter->modulus, material.scatter->seed);
        for (unsigned int i = 0; i < nodes.n_owned(); ++i)
          stretches.local_element(i) *= field.factor(nodes.position(i));
      }
    stretches.update_ghost_values();
    return {stretches.begin(), stretches.begin() + nodes.n_local()};
  }
} // namespace PeriDeal
