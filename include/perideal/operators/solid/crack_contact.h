// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/tensor.h>

#include <perideal/mesh/nodes.h>
#include <perideal/operators/solid/crack_normals.h>
#include <perideal/operators/solid/solid_contact.h>

#include <functional>
#include <vector>

namespace PeriDeal
{
  /**
   * Faces of cracks that are pressed together: contact without friction, of the bonds that are
   * gone. With xi a lost bond of node i, x its length, d = xi/x, e = d . (u_j - u_i) - s x its
   * extension (s the mean thermal strain of both ends), k e^2/2 the half of its energy that it had
   * at i and n the normal there (CrackNormals),
   *
   *   g_i = sum_j k_j a_j e_j,   energy  c_i g_i^2/(2 sum_j k_j a_j^2)  where g_i < 0,
   *
   * a_j = (n . d)^2 (1 - l . d) where n . d > 0, l tangential such that sum_j k_j a_j d has the
   * direction of n: faces that slide along each other or turn together feel nothing. c_i <= 1 is a
   * factor of the node. What is lost stored at least as much at any u.
   *
   * Nodes at which enough whole bonds go on across the crack, as beside its end, have no contact.
   *
   * Forces are linear from one update() to the next. They are sums in the order of families: the
   * same digits on any number of processes.
   *
   * Only nodes that have lost bonds take room, and of a lost bond no more than where it leads and
   * its stiffness: bodies have far more nodes than crack faces, and those of a running crack are in
   * every step.
   */
  template <int dim>
  class CrackContact : public SolidContact
  {
  public:
    using Bond   = FacingBond<dim>;
    using Layout = typename CrackNormals<dim>::Layout;

    /**
     * As CrackNormals::FamilyOf; returns c. A pair has the same stiffness at both ends, and is lost
     * at both or at none.
     */
    using FamilyOf = std::function<double(const unsigned int, std::vector<Bond> &)>;

    /**
     * @param nodes to which bonds lead; they have to outlive this object
     * @param layout of these nodes; ghosts are all neighbours
     */
    CrackContact(const FamilyOf &family_of, const Nodes<dim> &nodes, const Layout &layout);

    bool   update(const Vector &u, double &gained) override;
    double change(const std::vector<unsigned int> &of_nodes, const Vector &u) override;
    void   renew() override;
    void   set_strains(const std::function<double(const unsigned int)> &strain_at) override;
    void   add_tangent(Vector &y, const Vector &x) const override;
    void   add_to_surrogate(const SolidContact::EntryAction &add, const bool anew) override;

    /** The energy of all nodes that touch at u, found or not. */
    double energy(const Vector &u) const override;

    /** Which nodes touch, and which did so when the surrogate was made. */
    void        exchange(Archive &archive, const NodeKeys &keys) override;
    std::size_t memory_consumption() const override;

  protected:
    void find_forces(const Vector &u) const override;

  private:
    /** Of a bond that is lost. */
    struct End
    {
      unsigned int neighbor;
      double       stiffness; // k
    };

    /** Of an owned node that has lost bonds, or had. */
    struct Row
    {
      std::vector<End> ends;
      double           weight   = 0.; // c/sum of k a^2; 0: no contact
      double           strained = 0.; // what thermal strains have of g
      bool             touches = false, in_surrogate = false;
    };

    /** What the faces of a node have for directions, by its place. */
    struct Face
    {
      dealii::Tensor<1, dim> normal, lean;
    };

    /**
     * Find what is lost at some owned nodes. What is new does not touch, without u; else it does
     * where it is closed there, ghosts up to date. Returns the energy that is released so at u by
     * nodes of this process.
     */
    double set_rows(const std::vector<unsigned int> &of_nodes, const Vector *u = nullptr);
    void   make_row(const unsigned int place);
    void   find_strained(const unsigned int place);
    Face   face(const unsigned int place) const;
    /** g at u. @param size if given, what its terms have for a size is added */
    double gap(const unsigned int place, const double *u, double *size = nullptr) const;
    bool   is_closed(const unsigned int place, const double *u) const;
    double energy_of(const unsigned int place, const double *u) const;
    /** add(unknown, value) for K x where nodes touch, thermal strains apart or not. */
    template <typename Add>
    void visit_forces(const Vector &x, const bool strained, const Add &add) const;
    void find_any();

    template <typename Visit>
    void for_each_end(const unsigned int place, const Visit &visit) const;

    const FamilyOf                            family_of;
    const Nodes<dim>                         &nodes;
    const Layout                              layout;
    CrackNormals<dim>                         normals;
    const NodeSubset                         &parted; // that have rows
    std::function<double(const unsigned int)> strain_at;
    Vector                                    leans;     // l
    mutable Vector                            pressures; // c g/sum of k a^2 where nodes touch
    std::vector<Row>                          rows;      // by place
    bool                                      any_closed = false;
    std::vector<Bond>                         family; // of the node that is looked at
  };
} // namespace PeriDeal
