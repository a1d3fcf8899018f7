// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/operators/solid/relaxing_families.h>

#include <algorithm>
#include <utility>

#include "with_ghosts.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    class NodalBody : public ShearAndBulk<dim>
    {
    public:
      NodalBody(std::unique_ptr<Correspondence<dim>> nodal, const BondEnds<dim> &ends)
        : nodal(std::move(nodal))
        , ends(ends)
      {}

      void multiply(Vector &of_shear, Vector &of_bulk, const Vector &x) const override
      {
        nodal->multiply_apart(of_shear, of_bulk, x);
      }

      void pull_images(const Vector &u, const Vector &relaxed) const override
      {
        if (!ends.images)
          return;
        // K relaxed - K_b (relaxed - u), whose forces are the last ones.
        Vector all(u.get_partitioner()), of_bulk(all), change(relaxed);
        nodal->multiply(all, relaxed);
        const std::vector<double> of_all = ends.images->sums_of_forces();
        change -= u;
        nodal->multiply_apart(all, of_bulk, change);
        std::vector<double> &forces = ends.images->sums_of_forces();
        for (std::size_t k = 0; k < forces.size(); ++k)
          forces[k] = of_all[k] - forces[k];
      }

      double energy_of(const std::vector<unsigned int> &nodes, const Vector &u) const override
      {
        return nodal->energy_of(nodes, u);
      }

      double shear_energy_of(const std::vector<unsigned int> &nodes, const Vector &u) const override
      {
        return nodal->energy_of(nodes, u, true);
      }

      Correspondence<dim> *correspondence() const override
      {
        return nodal.get();
      }

      std::size_t memory_consumption() const override
      {
        return nodal->memory_consumption();
      }

    private:
      const std::unique_ptr<Correspondence<dim>> nodal;
      const BondEnds<dim>                       &ends;
    };


    /** With the symbols of StateOperator: tau is that of shear and that of bulk; e has shear. */
    template <int dim>
    class BodyOfBonds : public ShearAndBulk<dim>
    {
    public:
      BodyOfBonds(const BondEnds<dim>   &ends,
                  const BondTable<dim>  &bonds,
                  const NodeLaws<dim>   &laws,
                  const SolidSums<dim>  &sums,
                  const BondForces<dim> &forces)
        : ends(ends)
        , bonds(bonds)
        , laws(laws)
        , sums(sums)
        , forces(forces)
        , of_one(laws.weighted.get_partitioner())
        , tau(of_one)
      {
        AssertThrow(laws.volumetric, ExcInternalError());
      }

      void multiply(Vector &of_shear, Vector &of_bulk, const Vector &x) const override
      {
        const WithGhosts ghosts(x);
        sums.find_tensions(of_one.begin(), x.begin());
        for (unsigned int i = 0; i < of_one.locally_owned_size(); ++i)
          tau.local_element(i) = shear_factor(i) * of_one.local_element(i);
        tau.update_ghost_values();
        sums.find_forces(of_shear, x.begin(), tau.begin());
        for (unsigned int i = 0; i < of_one.locally_owned_size(); ++i)
          tau.local_element(i) = bulk_factor(i) * of_one.local_element(i);
        tau.update_ghost_values();
        sums.find_forces_of_tensions(of_bulk, tau.begin());
      }

      void pull_images(const Vector &u, const Vector &relaxed) const override
      {
        const WithGhosts ghosts(u), ghosts_of_relaxed(relaxed);
        Vector           sum(tau), forces_of_all(u.get_partitioner());
        sums.find_tensions(of_one.begin(), u.begin());
        for (unsigned int i = 0; i < sum.locally_owned_size(); ++i)
          sum.local_element(i) = bulk_factor(i) * of_one.local_element(i);
        sums.find_tensions(of_one.begin(), relaxed.begin());
        for (unsigned int i = 0; i < sum.locally_owned_size(); ++i)
          sum.local_element(i) += shear_factor(i) * of_one.local_element(i);
        sum.update_ghost_values();
        sums.find_forces(forces_of_all, relaxed.begin(), sum.begin());
      }

      double energy_of(const std::vector<unsigned int> &nodes, const Vector &u) const override
      {
        return forces.energy_of(nodes, u);
      }

      double shear_energy_of(const std::vector<unsigned int> &nodes, const Vector &u) const override
      {
        const WithGhosts    ghosts(u);
        const double *const values = u.begin();
        ends.find(values);
        double sum = 0.;
        for (const unsigned int i : nodes)
          {
            double all = 0.;
            bonds.for_each(i, [&](const SolidBond<dim> &bond) {
              const double product = bond.moment * ends.change(values, i, bond.neighbor);
              all += product;
              sum += (ends.is_fictitious(bond.neighbor) ? 1. : 0.5) *
                     LinearPeridynamicSolid::bond_energy(bond.spring, product);
            });
            sum += LinearPeridynamicSolid::node_energy(laws.shear_tension(i, all), all);
          }
        return Utilities::MPI::sum(sum, u.get_mpi_communicator());
      }

      std::size_t memory_consumption() const override
      {
        return of_one.memory_consumption() + tau.memory_consumption();
      }

    private:
      double shear_factor(const unsigned int i) const
      {
        return LinearPeridynamicSolid::shear_factor(laws[i]);
      }

      double bulk_factor(const unsigned int i) const
      {
        return laws[i].volumetric - shear_factor(i);
      }

      const BondEnds<dim>   &ends;
      const BondTable<dim>  &bonds;
      const NodeLaws<dim>   &laws;
      const SolidSums<dim>  &sums;
      const BondForces<dim> &forces;
      mutable Vector         of_one, tau; // theta/q; what its factors make of it
    };
  } // namespace


  template <int dim>
  std::unique_ptr<ShearAndBulk<dim>> shear_and_bulk(std::unique_ptr<Correspondence<dim>> nodal,
                                                    const BondEnds<dim>                 &ends)
  {
    return std::make_unique<NodalBody<dim>>(std::move(nodal), ends);
  }


  template <int dim>
  std::unique_ptr<ShearAndBulk<dim>> shear_and_bulk(const BondEnds<dim>   &ends,
                                                    const BondTable<dim>  &bonds,
                                                    const NodeLaws<dim>   &laws,
                                                    const SolidSums<dim>  &sums,
                                                    const BondForces<dim> &forces)
  {
    return std::make_unique<BodyOfBonds<dim>>(ends, bonds, laws, sums, forces);
  }


  template <int dim>
  RelaxingFamilies<dim>::RelaxingFamilies(std::unique_ptr<ShearAndBulk<dim>> body,
                                          const Material::Law               &law,
                                          const Vector                      &layout)
    : body(std::move(body))
    , relaxing(law, layout)
    , last{layout, layout, layout}
  {}


  template <int dim>
  const Vector &RelaxingFamilies<dim>::shear_at(const Vector &u) const
  {
    const bool same =
      known && std::equal(u.begin(), u.begin() + u.locally_owned_size(), last.displacement.begin());
    const double found = Utilities::MPI::max(stale ? 2. : same ? 0. : 1., u.get_mpi_communicator());
    const auto   multiply = [&](Vector &shear, const Vector &of) {
      body->multiply(shear, last.bulk, of);
    };
    if (found > 1.)
      relaxing.renew(multiply);
    if (found > 0.)
      {
        multiply(last.shear, u);
        std::copy(u.begin(), u.begin() + u.locally_owned_size(), last.displacement.begin());
      }
    known = true;
    stale = false;
    return last.shear;
  }


  template <int dim>
  void RelaxingFamilies<dim>::multiply(Vector &y, const Vector &x) const
  {
    known = false;
    body->multiply(last.shear, y, x);
    y.add(slope, last.shear);
  }


  template <int dim>
  void RelaxingFamilies<dim>::find_forces(Vector &y, const Vector &u, const double t) const
  {
    relaxing.set_time(t);
    slope           = relaxing.slope();
    const Vector &s = shear_at(u);
    for (unsigned int k = 0; k < s.locally_owned_size(); ++k)
      y.local_element(k) = s.local_element(k) + last.bulk.local_element(k);
    relaxing.add_change(y, s);
  }


  template <int dim>
  double RelaxingFamilies<dim>::energy(const Vector &u) const
  {
    const Vector &s = shear_at(u); // and of bulk
    return 0.5 * (u * last.bulk) + relaxing.energy(u, s, false);
  }


  template <int dim>
  double RelaxingFamilies<dim>::energy_of(const std::vector<unsigned int> &nodes,
                                          const Vector                    &u) const
  {
    double sum = body->energy_of(nodes, u) - body->shear_energy_of(nodes, u);
    for (const Vector &part : relaxing.stored_parts(u))
      sum += body->shear_energy_of(nodes, part);
    return sum;
  }


  template <int dim>
  double RelaxingFamilies<dim>::accept(const Vector &u, const double t)
  {
    relaxing.set_time(t);
    const Vector &s          = shear_at(u);
    const double  dissipated = relaxing.energy(u, s, true);
    relaxing.accept(u, s, t);
    return dissipated;
  }


  template <int dim>
  void RelaxingFamilies<dim>::exchange(Archive &archive, const NodeKeys &keys)
  {
    if (!archive.loads())
      shear_at(last.displacement); // histories are those of the bonds as they are
    relaxing.exchange(archive, keys);
    if (archive.loads())
      known = stale = false;
  }


  template <int dim>
  std::size_t RelaxingFamilies<dim>::memory_consumption() const
  {
    return body->memory_consumption() + relaxing.memory_consumption() +
           last.displacement.memory_consumption() + last.shear.memory_consumption() +
           last.bulk.memory_consumption();
  }


#define INSTANTIATE_APART(dim)                                                            \
  template std::unique_ptr<ShearAndBulk<dim>> shear_and_bulk<dim>(                        \
    std::unique_ptr<Correspondence<dim>>,                                                 \
    const BondEnds<dim> &);                                                               \
  template std::unique_ptr<ShearAndBulk<dim>> shear_and_bulk<dim>(const BondEnds<dim> &,  \
                                                                  const BondTable<dim> &, \
                                                                  const NodeLaws<dim> &,  \
                                                                  const SolidSums<dim> &, \
                                                                  const BondForces<dim> &);
  PERIDEAL_FOR_EACH_DIM(INSTANTIATE_APART)
  PERIDEAL_INSTANTIATE_CLASS(class RelaxingFamilies);
} // namespace PeriDeal
