// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/types.h>
#include <perideal/bonds/diffusion_bonds.h>
#include <perideal/operators/diffusion/prescribed_values.h>

#include <Eigen/SparseLU>
#include <cstdint>
#include <vector>

namespace PeriDeal
{
  /**
   * Which peridynamic nodes are not free: those that carry a Dirichlet value, and slaves whose
   * value follows from other nodes so that a given heat flux comes out (`Flux treatment =
   * extrapolation`, Bobaru 2012 section 3.2; `layer extrapolation`, Bobaru 2010 eq 22).
   *
   * Slaves near a corner depend on each other. Their small system is assembled and factored once on
   * every process, and solved at each distribution.
   */
  template <int dim>
  class NodeConstraints : public PrescribedValues<dim>
  {
  public:
    enum Kind : std::uint8_t
    {
      free,
      prescribed,
      slave
    };

    /** Throws UserError for treatments that need a box. Collective. */
    NodeConstraints(const DiffusionBonds<dim> &bonds, const BodyParameters<dim> &body);

    /** Of an owned node. */
    Kind kind(const unsigned int node) const
    {
      return kinds[node];
    }

    bool counts_in_bounds(const unsigned int row) const override
    {
      return kinds[row] == free;
    }

    bool any_slave() const override
    {
      return slaves_exist;
    }

    /** Ghosts are exchanged if there are slaves. Collective. */
    void distribute(Vector &u, const double t) const override;

    /** The same with zero values and fluxes. Collective. */
    void distribute_homogeneous(Vector &x) const override;

    /**
     * Bonds have changed: slaves follow from them anew, but are the same nodes. Throws UserError
     * where nothing is left of which they follow. Collective if there are slaves.
     */
    void update(const DiffusionBonds<dim> &bonds, const BodyParameters<dim> &body);

  private:
    struct SlaveFlux
    {
      const SurfaceTransfer *transfer;
      double                 coefficient; // multiplies the flux into the body
      dealii::Point<dim>     place;
    };

    struct Slave
    {
      unsigned int           node;
      double                 flux_coefficient; // of a flux into the body through all of its side
      int                    coupled = -1;     // number in the coupled system
      std::vector<SlaveFlux> fluxes;
      std::vector<std::pair<unsigned int, double>>
        masters; // local nodes that are not coupled slaves
    };

    void find_prescribed(const DiffusionBonds<dim> &bonds, const BodyParameters<dim> &body);
    void find_slaves(const DiffusionBonds<dim> &bonds, const BodyParameters<dim> &body);

    // These two return what is wrong, or nothing: only some processes may see it.
    std::string extrapolate(const DiffusionBonds<dim> &bonds,
                            const unsigned int         side,
                            const SurfaceTransfer     &transfer,
                            Slave                     &slave) const;

    /** The fluxes of the side and of its parts at a slave. */
    void        add_fluxes(const BoundaryConditions<dim> &conditions,
                           const unsigned int             side,
                           Slave                         &slave) const;
    std::string extrapolate_layer(const DiffusionBonds<dim> &bonds,
                                  const unsigned int         side,
                                  const int                  n_layers,
                                  const BodyParameters<dim> &body);
    void        couple_slaves(const Nodes<dim> &nodes);
    void        set_slaves(Vector &u, const double t, const bool homogeneous) const;

    const Nodes<dim>                            &nodes;
    std::vector<Kind>                            kinds; // owned and ghosts
    std::vector<Slave>                           slaves;
    bool                                         slaves_exist = false;
    unsigned int                                 n_coupled    = 0;
    Eigen::SparseLU<Eigen::SparseMatrix<double>> coupling;
    mutable Eigen::VectorXd                      coupled_loads, coupled_values;
  };
} // namespace PeriDeal
