// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/tensor.h>

#include <perideal/base/archive.h>
#include <perideal/base/types.h>

#include <functional>
#include <map>
#include <vector>

namespace PeriDeal
{
  /**
   * Faces of cracks that are pressed together: contact without friction, of the bonds that are
   * gone. With xi a bond of node i that a crack of the scene has cut, x its length, e = xi/x
   * . (u_j - u_i) - s x its extension (s the mean thermal strain of both ends) and k e^2/2 the half
   * of its energy that it had at i,
   *
   *   g_i = sum_j k_j a_j e_j,   energy  g_i^2/(2 sum_j k_j a_j^2)  where g_i < 0,
   *
   * a_j = (n . xi/x)^2 (1 + l . xi/x), n along the sum of k_j xi over the lost bonds less their
   * share of that over all, which is normal to a plane crack, and l tangential such that
   * sum_j k_j a_j xi/x has the direction of n: faces that slide along each other or turn together
   * feel nothing. What is lost stored at least as much at any u.
   *
   * Nodes at which whole bonds go on across the crack, as beside its end, have no contact.
   *
   * Which nodes touch is found by update() and stays until the next one, so that forces are linear
   * between. Ghosts of displacements are up to date where they are read.
   */
  template <int dim>
  class CrackContact
  {
  public:
    /** A bond of a family. */
    struct Bond
    {
      unsigned int           neighbor; // local number
      dealii::Tensor<1, dim> xi;
      double                 stiffness; // k, of the whole bond
      bool                   is_lost;
    };

    /** The bonds of an owned node, whole ones included; none at all if none is lost. */
    using FamilyOf = std::function<void(const unsigned int, std::vector<Bond> &)>;

    CrackContact(const FamilyOf &family_of, const MPI_Comm communicator);

    /** Find what is lost at some owned nodes. Those that are new do not touch. Collective. */
    void set_rows(const std::vector<unsigned int> &of_nodes);

    /**
     * The same at u, at which update() has been called. Returns the energy that contact has
     * released there, of all processes. Collective.
     * @param change K u with thermal loads is added to this, not compressed, if it may be any: then
     *               @p changes is set, on all processes alike
     */
    double set_rows(const std::vector<unsigned int> &of_nodes,
                    const Vector                    &u,
                    Vector                          &change,
                    bool                            &changes);

    /** Extensions are those beyond thermal strains s at nodes; empty: there are none. */
    void set_strains(const std::function<double(const unsigned int)> &strain_at);

    /** Some node of some process has lost bonds. */
    bool any() const
    {
      return any_rows;
    }

    /** Some node of some process touches. */
    bool touches() const
    {
      return any_closed;
    }

    /** Find which nodes touch at u. Returns whether that changes anywhere. Collective. */
    bool update(const Vector &u);

    /**
     * Add a multiple of K u of what touches to a vector of unknowns, with thermal strains minus
     * their load. Collective.
     */
    void add_forces(Vector &y, const Vector &u, const bool strained, const double multiple) const;

    /** The energy of all nodes that touch at u, found or not. Collective. */
    double energy(const Vector &u) const;

    /** Owned nodes that touch. */
    unsigned int n_touching() const;

    /** Set which nodes touch to those of a mark at nodes, or mark them. */
    void exchange(Archive &archive, Vector nodal, const NodeKeys &keys);

    std::size_t memory_consumption() const;

  private:
    struct End
    {
      unsigned int           neighbor;
      dealii::Tensor<1, dim> factor; // k a xi/x
      double                 length; // k a x
    };

    struct Row
    {
      std::vector<End> ends;
      double           weight   = 0.; // 1/sum of k a^2
      double           strained = 0.; // what thermal strains have of g
      bool             touches  = false;
    };

    bool   make_row(const std::vector<Bond> &family, Row &row) const;
    void   find_strained(const unsigned int node, Row &row) const;
    double gap(const unsigned int node, const Row &row, const double *u) const;
    double size_of_terms(const unsigned int node, const Row &row, const double *u) const;
    bool   is_closed(const unsigned int node, const Row &row, const double *u) const;
    double energy_of(const std::vector<unsigned int> &of_nodes, const double *u) const;
    void   add_force(const unsigned int node, const Row &row, const double size, double *y) const;
    void   add_forces_of(const std::vector<unsigned int> &of_nodes,
                         const double                     multiple,
                         double                          *y,
                         const double                    *u) const;
    void   find_any();

    const FamilyOf                            family_of;
    const MPI_Comm                            communicator;
    std::function<double(const unsigned int)> strain_at;
    std::map<unsigned int, Row>               rows; // by the owned node
    bool                                      any_rows = false, any_closed = false;
    std::vector<Bond>                         family; // of the node that is looked at
  };
} // namespace PeriDeal
