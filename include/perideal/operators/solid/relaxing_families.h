// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/solid/bond_forces.h>
#include <perideal/operators/solid/correspondence.h>
#include <perideal/operators/solid/relaxing_forces.h>
#include <perideal/operators/solid/solid_sums.h>

#include <memory>
#include <vector>

namespace PeriDeal
{
  /** A linear body, what its shear modulus does and what its bulk modulus does apart. */
  template <int dim>
  class ShearAndBulk
  {
  public:
    virtual ~ShearAndBulk() = default;

    /** K_s x and K_b x. Ghosts of x need not be up to date. Collective. */
    virtual void multiply(Vector &of_shear, Vector &of_bulk, const Vector &x) const = 0;

    /** Leave with fictitious nodes the forces of K_s relaxed + K_b u. Collective. */
    virtual void pull_images(const Vector &u, const Vector &relaxed) const = 0;

    /** What these owned nodes have of what is stored at u, if nothing relaxes. Collective. */
    virtual double energy_of(const std::vector<unsigned int> &nodes, const Vector &u) const = 0;

    /** What shear stores in it. Collective. */
    virtual double shear_energy_of(const std::vector<unsigned int> &nodes,
                                   const Vector                    &u) const = 0;

    /** What it is, or null. */
    virtual Correspondence<dim> *correspondence() const
    {
      return nullptr;
    }

    virtual std::size_t memory_consumption() const = 0;
  };


  /** That of correspondence, which is linear. The ends of its bonds outlive it. */
  template <int dim>
  std::unique_ptr<ShearAndBulk<dim>> shear_and_bulk(std::unique_ptr<Correspondence<dim>> nodal,
                                                    const BondEnds<dim>                 &ends);

  /** That of the linear peridynamic solid with linear kinematics. All outlive it. */
  template <int dim>
  std::unique_ptr<ShearAndBulk<dim>> shear_and_bulk(const BondEnds<dim>   &ends,
                                                    const BondTable<dim>  &bonds,
                                                    const NodeLaws<dim>   &laws,
                                                    const SolidSums<dim>  &sums,
                                                    const BondForces<dim> &forces);


  /**
   * The viscoelastic law where forces are linear in displacements: what the body went through is
   * kept at nodes (RelaxingForces), for any bonds, which need not be stored.
   */
  template <int dim>
  class RelaxingFamilies : public FamilyForces<dim>
  {
  public:
    RelaxingFamilies(std::unique_ptr<ShearAndBulk<dim>> body,
                     const Material::Law               &law,
                     const Vector                      &layout);

    bool is_linear() const override
    {
      return true;
    }

    bool remembers() const override
    {
      return true;
    }

    /** The tangent of the step of the last find_forces(). */
    void   multiply(Vector &y, const Vector &x) const override;
    void   find_forces(Vector &y, const Vector &u, const double t) const override;
    void   take_temperatures(const Vector &) override {} // of a body that stays cold
    double energy(const Vector &u) const override;
    double accept(const Vector &u, const double t) override;
    void   exchange(Archive &archive, const NodeKeys &keys) override;
    void   linearize(const Vector &) override {}
    void   forget_tangent() override
    {
      slope = 1.;
    }

    /** What these owned nodes have of what is stored. Collective. */
    double energy_of(const std::vector<unsigned int> &nodes, const Vector &u) const;

    /** The displacements whose shear the stress follows; ghosts are up to date. Collective. */
    Vector effective(const Vector &u) const
    {
      return relaxing.effective(u);
    }

    /** Leave with fictitious nodes the forces at u, at the time of find_forces(). Collective. */
    void pull_images(const Vector &u) const
    {
      body->pull_images(u, effective(u));
    }

    /** Bonds bear nothing any more. Not collective. */
    void renew()
    {
      stale = true;
    }

    Correspondence<dim> *correspondence() const
    {
      return body->correspondence();
    }

    std::size_t memory_consumption() const override;

  private:
    /** K_s u, found or known; histories are those of the bonds as they are. Collective. */
    const Vector &shear_at(const Vector &u) const;

    std::unique_ptr<ShearAndBulk<dim>> body;
    mutable RelaxingForces             relaxing;
    mutable double                     slope = 1.;

    mutable bool stale = false, known = false;
    struct
    {
      Vector displacement, shear, bulk;
    } mutable last;
  };
} // namespace PeriDeal
