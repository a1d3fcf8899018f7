// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Displacements and tractions of section `Boundary conditions`.

#include <perideal/scene/boundary_conditions.h>
#include <perideal/scene/lists.h>

#include <algorithm>

namespace PeriDeal
{
  namespace
  {
    const std::string free_word = "free";

    std::string component_name(const unsigned int c)
    {
      return std::string(1, "xyz"[c]);
    }
  } // namespace


  bool VectorCondition::depends_on_time() const
  {
    return std::any_of(values.begin(), values.end(), [](const auto &value) {
      return value && value->depends_on_time();
    });
  }


  const VectorCondition *find_condition(const std::vector<VectorCondition> &list,
                                        const dealii::types::boundary_id    id)
  {
    for (const VectorCondition &condition : list)
      if (condition.id == id)
        return &condition;
    return nullptr;
  }


  bool is_zero(const Expression &formula)
  {
    return formula.is_constant() && formula.value(dealii::Point<1>()) == 0.;
  }


  std::vector<std::optional<Expression>> parse_components(const std::string &text,
                                                          const unsigned int dim,
                                                          const bool         may_be_free,
                                                          const std::string &where)
  {
    const std::vector<std::string> pieces = split_list(text, ',');
    if (pieces.size() != dim)
      entry_error(where,
                  "found '" + text + "', needs " + std::to_string(dim) +
                    (dim == 1 ? " component" : " components separated by commas") +
                    (may_be_free ? ", a formula or 'free' each." :
                                   ", a formula" + std::string(dim == 1 ? "." : " each.")));
    std::vector<std::optional<Expression>> values(dim);
    for (unsigned int c = 0; c < dim; ++c)
      {
        const bool free = pieces[c] == free_word;
        if (free && !may_be_free)
          entry_error(
            where,
            "'free' stands for displacements that nothing holds; give 0 for the component in " +
              component_name(c) + ".");
        if (!free)
          values[c] = Expression(pieces[c], where + ", component in " + component_name(c));
      }
    if (std::none_of(values.begin(), values.end(), [](const auto &value) {
          return value.has_value();
        }))
      entry_error(
        where,
        dim == 1 ?
          "is free, which is an empty grip: leave the side out, or give its displacement." :
          "all components are free, which is an empty grip: leave the side out, or give a component its displacement.");
    return values;
  }


  template <int dim>
  std::vector<VectorCondition> BoundaryConditions<dim>::parse_vectors(const std::string &entry,
                                                                      const bool         box_sides,
                                                                      const bool         hole) const
  {
    std::vector<VectorCondition> list;
    for (const std::string &piece : split_list(text(entry), ';'))
      {
        const auto      name_value = name_and_value(piece, where(entry));
        VectorCondition condition;
        condition.name = name_value.first;
        condition.id   = side_id(condition.name, entry, box_sides, hole);
        if (find_condition(list, condition.id) != nullptr)
          error(entry, "the side '" + condition.name + "' is named twice.");
        condition.values = parse_components(name_value.second,
                                            dim,
                                            entry == "Displacement",
                                            where(entry) + ", side '" + condition.name + "'");
        list.push_back(condition);
      }
    return list;
  }


  template <int dim>
  void BoundaryConditions<dim>::refuse_other_physics(const Physics physics,
                                                     const bool    with_heat) const
  {
    const bool elastic = physics == Physics::elasticity;
    const auto refuse  = [&](const std::string &entry, const std::string &remedy) {
      if (is_given(entry))
        error(entry,
              elastic ? "is for what diffuses; 'Physics' is 'elasticity'. Use " + remedy +
                          ", or 'Temperature change = computed' in section 'Elasticity'." :
                         "is for 'Physics = elasticity'; 'Physics' is '" +
                          names_of(physics).physics + "'. Use " + remedy + ".");
    };
    if (elastic && with_heat)
      return;
    if (elastic)
      {
        refuse("Dirichlet", "'Displacement'");
        refuse("Flux", "'Traction'");
        refuse("Convection", "'Displacement' or 'Traction'");
        return;
      }
    refuse("Displacement", "'Dirichlet'");
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
        const VectorCondition *const grip = find_condition(displacement, load.id);
        for (unsigned int c = 0; grip != nullptr && c < dim; ++c)
          if (grip->values[c] && !is_zero(*load.values[c]))
            error(
              "Traction",
              "the side '" + load.name + "' has a displacement in " + component_name(c) +
                " by 'Displacement'; a traction in the same direction contradicts it. Give 0 for that component, or make the "
                "displacement 'free' there.");
        if (std::find(symmetry.begin(), symmetry.end(), load.id) != symmetry.end() &&
            !std::all_of(load.values.begin(), load.values.end(), [](const auto &value) {
              return is_zero(*value);
            }))
          error(
            "Traction",
            "the side '" + load.name +
              "' is also named in 'Symmetry', which contradicts it: a symmetry plane carries no load of its own.");
      }
    for (const VectorCondition &grip : displacement)
      if (std::find(symmetry.begin(), symmetry.end(), grip.id) != symmetry.end())
        error(
          "Displacement",
          "the side '" + grip.name +
            "' is also named in 'Symmetry', which holds its normal displacement and leaves the others free. Name it in one of the two.");
  }


#define PERIDEAL_INSTANTIATE(dim)                                                               \
  template std::vector<VectorCondition> BoundaryConditions<dim>::parse_vectors(                 \
    const std::string &,                                                                        \
    const bool,                                                                                 \
    const bool) const;                                                                          \
  template void BoundaryConditions<dim>::refuse_other_physics(const Physics, const bool) const; \
  template void BoundaryConditions<dim>::check_vector_conditions() const;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
