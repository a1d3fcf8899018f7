// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/matrix_rows.h>
#include <perideal/operators/parts/event_work.h>
#include <perideal/operators/solid/elastic_elements.h>

#include <algorithm>

#include "with_ghosts.h"

// What finite elements do when bonds of a zone break, or nodes join it.

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  double ElasticElements<dim>::mend_zone(const Boxes                     &boxes,
                                         const double                     of_cells,
                                         const std::vector<unsigned int> &rows,
                                         const Vector                    &u,
                                         const std::function<void()>     &make_change)
  {
    const std::vector<Cell> near = cells.near(boxes, of_cells);
    changes.any                  = true;
    const double before          = law ? energy(u) : 0.;
    double       gained          = add_parts(near, rows, -1., &u);
    make_change();
    gained += add_parts(near, rows, 1., &u);
    stiffness.compress();
    if (cells.with_shear)
      law->shear.compress();
    if (this->is_warm())
      {
        thermal_loads.compress(VectorOperation::add);
        hanging.condense(thermal_loads);
        this->keep_constant_loads();
      }
    if (breaking->any_broken())
      cells.note_parted(&near);
    const auto mend_diagonal = [&]() {
      std::vector<unsigned int> touched = rows;
      for (const unsigned int i : owned_unknowns<dim>(near, *nodes))
        touched.push_back(i);
      std::sort(touched.begin(), touched.end());
      touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
      const Vector held    = this->held_unknowns();
      const double largest = stiffness_diagonal.linfty_norm();
      for (const unsigned int i : touched)
        {
          const Tensor<1, dim> of_bonds = breaking->bonds.diagonal_of(i);
          for (unsigned int d = 0; d < dim; ++d)
            {
              const double value  = stiffness.diagonal(i, d) + of_bonds[d];
              const bool   stands = value > 1e-13 * largest;
              stiffness_diagonal.local_element(dim * i + d) = held.local_element(dim * i + d) > 0. ?
                                                                1. :
                                                              stands ? value :
                                                                       largest;
            }
        }
    };
    if (!this->stepping.follow)
      mend_diagonal();
    if (law && law->nodal.steps->knows_damage())
      law->nodal.damage = breaking->damage_with_ghosts();
    const double by_contact = contact->change(rows, u);
    if (law) // forces and energies that were added are those of the linear one
      return before - energy(u);
    return by_contact - Utilities::MPI::sum(gained, nodes->get_mpi_communicator());
  }


  template <int dim>
  void ElasticElements<dim>::mend_unbalanced(Vector &r, const Vector &u, const double t) const
  {
    if (!breaking || this->is_warm() || law)
      return this->unbalanced(r, u, t);
    if (!changes.any)
      return;
    changes.forces.compress(VectorOperation::add);
    hanging.condense(changes.forces);
    hanging.set(changes.forces, 0.);
    r -= changes.forces;
    contact->add_last_forces(r, 1.);
    contact->add_forces(r, u, -1.);
    changes.forces = 0.;
    changes.any    = false;
  }


  template <int dim>
  bool ElasticElements<dim>::join_stretched(const Vector &u)
  {
    const std::vector<Point<dim>> places = breaking->find_places_to_join(u);
    if (places.empty())
      return false;
    const auto joining = breaking->joining(places);
    Boxes      boxes;
    for (const auto &[node, weight] : joining)
      boxes.emplace_back(std::vector<Point<dim>>{positions[node], positions[node]});
    if (Utilities::MPI::sum(1. * boxes.size(), nodes->get_mpi_communicator()) == 0.)
      return false;
    const std::vector<unsigned int> rows = zone_bonds->nodes_near(boxes);
    this->released_beside.by_joining += mend_zone(boxes, zone_bonds->reach(), rows, u, [&] {
      zone_bonds->coupling().breakable()->join_nodes(joining);
      breaking->bonds.set_rows(rows, cells.factors);
    });
    return true;
  }


  template <int dim>
  bool ElasticElements<dim>::widen_zone(const Vector &u)
  {
    if (changes.any)
      changes.forces = 0.;
    changes.any = false;
    if (!breaking || !body.coupling.follows_stretches())
      return false;
    const WithGhosts ghosts(u);
    return join_stretched(u);
  }


  template <int dim>
  void ElasticElements<dim>::break_bonds(const std::vector<DamagedBond> &list,
                                         const Vector                   &u,
                                         const double                    t)
  {
    const WithGhosts ghosts(u);
    breaking->add_released(
      mend_zone(breaking->parted_by(list), 0., breaking->rows_of(list), u, [&] {
        if (const auto softer = breaking->take(list, t); body.material.law.softens())
          breaking->bonds.set_rows(softer, cells.factors);
      }));
    join_stretched(u);
  }


  template <int dim>
  unsigned long long ElasticElements<dim>::break_bonds(const Vector &u,
                                                       const double  t,
                                                       const double  share)
  {
    if (!breaking)
      return 0;
    const WithGhosts ghosts(u);
    const auto       list = breaking->find_overstretched(u, t, share);
    if (!list.empty())
      break_bonds(list, u, t);
    return list.size();
  }


  PERIDEAL_INSTANTIATE_CLASS(class ElasticElements);
} // namespace PeriDeal
