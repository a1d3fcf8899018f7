// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/operators/lattice_exchange.h>

namespace PeriDeal
{
  template <int dim>
  std::unique_ptr<Coupling<dim>> make_coupling(Nodes<dim>       &nodes,
                                               const Scene<dim> &scene,
                                               const Zone<dim>  &zone)
  {
    return std::make_unique<LatticeExchange<dim>>(nodes, scene, zone, std::vector<bool>());
  }


  template std::unique_ptr<Coupling<1>> make_coupling(Nodes<1> &,
                                                      const Scene<1> &,
                                                      const Zone<1> &);
  template std::unique_ptr<Coupling<2>> make_coupling(Nodes<2> &,
                                                      const Scene<2> &,
                                                      const Zone<2> &);
  template std::unique_ptr<Coupling<3>> make_coupling(Nodes<3> &,
                                                      const Scene<3> &,
                                                      const Zone<3> &);
} // namespace PeriDeal
