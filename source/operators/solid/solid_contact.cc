// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// How a solid's faces of cracks bear pressure.

#include <perideal/operators/solid/solid_operator.h>

#include <numeric>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** Ghosts of a vector are up to date while this lives. */
    class WithGhosts
    {
    public:
      explicit WithGhosts(const Vector &vector)
        : vector(vector)
        , before(vector.has_ghost_elements())
      {
        vector.update_ghost_values();
      }

      ~WithGhosts()
      {
        vector.set_ghost_state(before);
      }

      WithGhosts(const WithGhosts &) = delete;

    private:
      const Vector &vector;
      const bool    before;
    };
  } // namespace


  template <int dim>
  std::vector<unsigned int> SolidOperator<dim>::owned_nodes() const
  {
    std::vector<unsigned int> owned(nodes->locally_owned_size());
    std::iota(owned.begin(), owned.end(), 0);
    return owned;
  }


  template <int dim>
  void SolidOperator<dim>::make_contact()
  {
    const bool may_part = !body.cracks.cracks.empty() || this->may_release_energy();
    if (!body.elasticity.contact || this->nonlinear() || !may_part)
      return;
    contact = std::make_unique<CrackContact<dim>>(
      [this](const unsigned int node, std::vector<typename CrackContact<dim>::Bond> &bonds) {
        bonds.clear();
        return contact_family(node, bonds);
      },
      nodes,
      unknowns);
    set_contact_strains();
    contact->set_rows(owned_nodes());
  }


  template <int dim>
  void SolidOperator<dim>::set_contact_strains()
  {
    if (!contact)
      return;
    const bool warm = this->temperature_change().size() > 0 ||
                      !is_zero(body.elasticity.temperature_change);
    contact->set_strains(warm ?
                           [this](const unsigned int node) { return thermal_strain_at(node); } :
                           std::function<double(const unsigned int)>());
  }


  template <int dim>
  bool SolidOperator<dim>::update_contact(const Vector &u)
  {
    if (!contact || !contact->any())
      return false;
    const WithGhosts ghosts(u);
    return contact->update(u);
  }


  template <int dim>
  void SolidOperator<dim>::add_contact(Vector       &y,
                                       const Vector &u,
                                       const bool    strained,
                                       const double  multiple) const
  {
    if (!contact || !contact->any())
      return;
    const WithGhosts ghosts(u);
    contact->add_forces(y, u, strained, multiple);
  }


  template <int dim>
  double SolidOperator<dim>::contact_energy(const Vector &u) const
  {
    if (!contact || !contact->any())
      return 0.;
    const WithGhosts ghosts(u);
    return contact->energy(u);
  }


  template <int dim>
  double SolidOperator<dim>::change_contact(const std::vector<unsigned int> &of_nodes,
                                            const Vector                    &u)
  {
    if (!contact)
      return 0.;
    const WithGhosts ghosts(u);
    const double     released = contact->set_rows(of_nodes, &u);
    return contact->any() ? Utilities::MPI::sum(released, mass.get_mpi_communicator()) : 0.;
  }


  template <int dim>
  void SolidOperator<dim>::leave_out_contact(Vector &r) const
  {
    if (contact)
      contact->add_last_forces(r, 1.);
  }


  template <int dim>
  void SolidOperator<dim>::exchange_contact(Archive &archive, const NodeKeys &keys)
  {
    if (!contact)
      return;
    if (archive.loads())
      contact->set_rows(owned_nodes());
    Vector nodal;
    initialize_nodal_vector(nodal);
    contact->exchange(archive, nodal, keys);
  }


#define PERIDEAL_INSTANTIATE(dim)                                                              \
  template std::vector<unsigned int> SolidOperator<dim>::owned_nodes() const;                  \
  template void                      SolidOperator<dim>::make_contact();                       \
  template void                      SolidOperator<dim>::set_contact_strains();                \
  template bool                      SolidOperator<dim>::update_contact(const Vector &);       \
  template void                      SolidOperator<dim>::add_contact(Vector &,                 \
                                                const Vector &,           \
                                                const bool,               \
                                                const double) const;      \
  template double                    SolidOperator<dim>::contact_energy(const Vector &) const; \
  template double SolidOperator<dim>::change_contact(const std::vector<unsigned int> &,        \
                                                     const Vector &);                          \
  template void   SolidOperator<dim>::leave_out_contact(Vector &) const;                       \
  template void   SolidOperator<dim>::exchange_contact(Archive &, const NodeKeys &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
