// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Conditions of another physics, and those of solids that contradict each other.

#include <perideal/scene/boundary_conditions.h>
#include <perideal/scene/lists.h>

#include <algorithm>

namespace PeriDeal
{
  template <int dim>
  void BoundaryConditions<dim>::refuse_other_physics(const Physics physics,
                                                     const bool    with_heat) const
  {
    const bool elastic = physics == Physics::elasticity;
    const auto refuse  = [&](const std::string &entry, const std::string &remedy) {
      if (is_given(entry))
        error(entry,
              elastic ? "is for diffusion; 'Physics' is 'elasticity'. Use " + remedy +
                          ", or 'Temperature change = computed' in section 'Elasticity'." :
                         "is for 'Physics = elasticity'; 'Physics' is '" +
                          names_of(physics).physics + "'. Use " + remedy + ".");
    };
    if (elastic && with_heat)
      return;
    if (elastic)
      {
        refuse("Dirichlet", "'Displacement'");
        for (const TransferKind &kind : transfer_kinds())
          refuse(kind.entry, kind.fixes_level ? "'Displacement' or 'Traction'" : "'Traction'");
        return;
      }
    refuse("Displacement", "'Dirichlet'");
    refuse("Velocity", "'Dirichlet'");
    refuse("Traction", "'Flux'");
    refuse("Displacement layer", "'Boundary treatment' in section 'Peridynamics'");
    refuse("Traction layer", "'Flux treatment' in section 'Peridynamics'");
  }


  template <int dim>
  void BoundaryConditions<dim>::check_vector_conditions() const
  {
    if (displacement_layer > 0. && displacement.empty())
      error("Displacement layer", "has no effect: no side is named in 'Displacement'.");
    if (traction_layer > 0. && traction.empty())
      error("Traction layer", "has no effect: no side is named in 'Traction'.");
    for (const VectorCondition &load : traction)
      {
        for (const VectorCondition &grip : displacement)
          for (unsigned int c = 0; grip.id == load.id && c < dim; ++c)
            if (grip.values[c] && !grip.held[c] && !is_zero(*load.values[c]))
              error(
                "Traction",
                "the side '" + load.name + "' has a displacement in " + "xyz"[c] + " by '" +
                  (grip.rate ? "Velocity" : "Displacement") +
                  "'; a traction in the same direction contradicts it. Give 0 for that component, or make the "
                  "displacement 'free' there.");
        if (std::find(symmetry.begin(), symmetry.end(), side_of(load.id)) != symmetry.end() &&
            !std::all_of(load.values.begin(), load.values.end(), [](const auto &value) {
              return is_zero(*value);
            }))
          error(
            "Traction",
            "the side '" + name_of(side_of(load.id)) +
              "' is also named in 'Symmetry', which contradicts it: a symmetry plane carries no load of its own.");
      }
    for (const VectorCondition &rate : displacement)
      for (const VectorCondition &grip : displacement)
        for (unsigned int c = 0; rate.rate && !grip.rate && grip.id == rate.id && c < dim; ++c)
          if (rate.values[c] && grip.values[c] && !rate.held[c] && !grip.held[c])
            error("Velocity",
                  "the side '" + rate.name + "' has a displacement in " + "xyz"[c] +
                    " by 'Displacement', which contradicts it. Make one of the two 'free' there.");
    for (const VectorCondition &grip : displacement)
      if (std::find(symmetry.begin(), symmetry.end(), side_of(grip.id)) != symmetry.end())
        error(
          "Displacement",
          "the side '" + name_of(side_of(grip.id)) +
            "' is also named in 'Symmetry', which holds its normal displacement and leaves the others free. Name it in one of the two.");
  }


#define PERIDEAL_INSTANTIATE(dim)                                                               \
  template void BoundaryConditions<dim>::refuse_other_physics(const Physics, const bool) const; \
  template void BoundaryConditions<dim>::check_vector_conditions() const;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
