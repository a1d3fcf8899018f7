// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/scene/body_parameters.h>
#include <perideal/scene/lists.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    double smallest_spacing(const Domain<dim> &domain)
    {
      const Tensor<1, dim> h = domain.spacing();
      return *std::min_element(h.begin_raw(), h.end_raw());
    }
  } // namespace


  template <int dim>
  double BodyParameters<dim>::horizon() const
  {
    if (peridynamics.horizon > 0.)
      return peridynamics.horizon;
    if (!domain.has_lattice())
      entry_error(peridynamics.where("Horizon"), "is empty, but a mesh file needs it.");
    return peridynamics.horizon_ratio * smallest_spacing(domain);
  }


  template <int dim>
  Moduli BodyParameters<dim>::moduli(const Point<dim> &p, const double temperature_change) const
  {
    return material.moduli(p, elasticity.reference_temperature + temperature_change);
  }


  template <int dim>
  Moduli BodyParameters<dim>::moduli(const Point<dim> &p) const
  {
    return moduli(p,
                  material.given.depend_on_temperature() ? elasticity.temperature_change.value(p) :
                                                           0.);
  }


  template <int dim>
  double BodyParameters<dim>::free_expansion(const Point<dim> &p,
                                             const double      temperature_change) const
  {
    return material.thermal_expansion.value(p,
                                            elasticity.reference_temperature + temperature_change) *
           temperature_change;
  }


  template <int dim>
  std::pair<std::string, std::string> BodyParameters<dim>::obstacle_to_bonds_on_elements() const
  {
    if (domain.has_nodes_at_centers())
      return {domain.where("Nodes"),
              std::string(domain.is_image() ?
                            "is 'cell centers', which is what 'auto' means with 'Shape = image'" :
                            "is 'cell centers'") +
                "; bonds and elements share the nodes on the vertices: set 'Nodes = vertices'"};
    if (!peridynamics.natural_fluxes())
      return {peridynamics.where("Flux treatment"), "makes slaves of nodes; use 'natural'"};
    if (peridynamics.sampling.self_term != SelfTerm::none)
      return {peridynamics.where("Self term"), "is not 'none'; use that"};
    if (peridynamics.corrects_elastic_bonds())
      return {peridynamics.where("Surface correction"),
              "is for bonds without finite elements; use 'none' or 'crack scaling'"};
    if (peridynamics.sampling.nodal_volume != NodalVolume::partial)
      return {peridynamics.where("Nodal volume"), "is 'full'; use 'partial'"};
    return {};
  }


  template <int dim>
  bool BodyParameters<dim>::cuts_in_part_at_tips() const
  {
    return dim == 2 && deforms && cracks.through_tips == ThroughTips::in_part;
  }


  template <int dim>
  CrackHistory<dim> BodyParameters<dim>::crack_history() const
  {
    double step = cracks.growth_step;
    if (step < 0. && !cracks.tips.empty())
      {
        if (!domain.has_lattice())
          entry_error(cracks.where("Growth step"),
                      "is empty, but a mesh file has no node spacing: give a length.");
        step = 0.25 * smallest_spacing(domain);
      }
    // Elastic bodies change between any two steps; diffusion stops at each event.
    const double whole_steps = deforms ? -1. : run.time_step;
    return CrackHistory<dim>(cracks, step, run.steady ? 1. : cracks.end_time, whole_steps);
  }


  template <int dim>
  void BodyParameters<dim>::set_box(const Point<dim>                    &lower,
                                    const Point<dim>                    &upper,
                                    const std::array<unsigned int, dim> &cells)
  {
    for (unsigned int d = 0; d < dim; ++d)
      Assert(lower[d] < upper[d] && cells[d] > 0, ExcMessage("A box needs cells."));
    domain.shape            = Shape::box;
    domain.lower            = lower;
    domain.upper            = upper;
    domain.extra.body_lower = lower;
    domain.extra.body_upper = upper;
    domain.cells            = cells;
    cracks.set_box(lower, upper);
  }


  template <int dim>
  void BodyParameters<dim>::set_own_mesh(const double horizon)
  {
    domain.use_own_mesh();
    domain.shape         = Shape::mesh_file;
    peridynamics.horizon = horizon;
    boundary_conditions.name_sides_by_number();
  }


  namespace
  {
    /** What the defaults of a scene mean for this physics where they leave it open. */
    template <int dim>
    void take_defaults(BodyParameters<dim> &body, const Physics physics)
    {
      body.peridynamics.parse(physics);
      body.peridynamics.treatment = BoundaryTreatment::none;
      if (physics == Physics::elasticity)
        body.cracks.mesh = CrackMesh::removed;
      else
        body.peridynamics.surface_correction = SurfaceCorrection::none;
    }
  } // namespace


  template <int dim>
  HeatParameters<dim>::HeatParameters()
  {
    take_defaults(*this, Physics::heat);
  }


  template <int dim>
  SolidParameters<dim>::SolidParameters()
  {
    this->deforms = true;
    take_defaults(*this, Physics::elasticity);
  }


  PERIDEAL_INSTANTIATE_CLASS(struct BodyParameters);
  PERIDEAL_INSTANTIATE_CLASS(struct HeatParameters);
  PERIDEAL_INSTANTIATE_CLASS(struct SolidParameters);
} // namespace PeriDeal
