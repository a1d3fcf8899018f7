// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/scene/boundary_conditions.h>
#include <perideal/scene/lists.h>

#include <algorithm>

namespace PeriDeal
{
  namespace
  {
    bool depends_on_time(const SideCondition &condition)
    {
      return condition.value.depends_on_time();
    }


    bool depends_on_time(const VectorCondition &condition)
    {
      return condition.depends_on_time();
    }


    template <typename Condition>
    bool any_depends_on_time(const std::vector<Condition> &list)
    {
      return std::any_of(list.begin(), list.end(), [](const Condition &condition) {
        return PeriDeal::depends_on_time(condition);
      });
    }


    std::string unknown_side(const std::string       &name,
                             std::vector<std::string> known,
                             const std::vector<Part> &parts,
                             const bool               box_sides)
    {
      std::string text = "unknown side '" + name + "'; the sides ";
      if (known.empty())
        text += "of this mesh file are its boundary ids (numbers), it has no physical names.";
      else
        text += "are: " + join_names(known) + (box_sides ? "." : ", or boundary ids (numbers).");
      if (parts.empty())
        return text + did_you_mean(name, known);
      std::vector<std::string> of_parts;
      for (const Part &part : parts)
        of_parts.push_back(part.name);
      known.insert(known.end(), of_parts.begin(), of_parts.end());
      return text + " Parts: " + join_names(of_parts) + "." + did_you_mean(name, known);
    }
  } // namespace


  const std::vector<std::string> &box_side_names()
  {
    static const std::vector<std::string> names =
      {"left", "right", "bottom", "top", "back", "front"};
    return names;
  }


  std::string name_of_side(const dealii::types::boundary_id id, const bool box_sides)
  {
    if (!box_sides)
      return std::to_string(id);
    return id < box_side_names().size() ? box_side_names()[id] : "hole";
  }


  template <int dim>
  BoundaryConditions<dim>::BoundaryConditions()
    : SceneSection("Boundary conditions")
  {
    const std::string sides =
      " Sides: left, right (x), bottom, top (y), back, front (z), hole; of a mesh file its boundary ids and physical names; "
      "or names of `Parts`.";
    declare(
      "Parts",
      EntryType::list,
      "",
      "",
      "Places for conditions that are no whole sides, several separated by `;`: `name: SIDE if FORMULA`, what of a side the formula (of x, y, z) is true or "
      "> 0 on; `name: region FORMULA`, the nodes where it is; `name: point X, Y[, Z]`, the node nearest to the point, which may lie outside the body by a cell at most. The names stand wherever those of sides "
      "do. `Flux` and `Traction` act on the area of a part of a side; on a region or a point they are the total power or force (in 2D per thickness), shared by its nodes in "
      "proportion to their volume.");
    declare(
      "Dirichlet",
      EntryType::list,
      "",
      "temperature",
      "Given temperatures: `side: formula of x, y, z, t`, several separated by `;`. Where two "
      "sides meet, the one named first holds." +
        sides);
    declare("Flux",
            EntryType::list,
            "",
            "power/area",
            "Given heat fluxes, positive into the body: `side: formula of x, y, z, t`, several "
            "separated by `;`. A side named nowhere is insulated.");
    declare(
      "Convection",
      EntryType::list,
      "",
      "power/(area temperature), temperature",
      "`side: coefficient, ambient temperature`, several separated by `;`: the flux "
      "coefficient x (ambient - T) enters. The coefficient may depend on x, y, z, the ambient temperature on t, too. "
      "Adds to a Flux on the same side.");
    declare(
      "Symmetry",
      EntryType::list,
      "",
      "",
      "Sides that are symmetry planes, separated by `;` or `,`. Fictitious nodes beyond them "
      "mirror the "
      "temperature; on meshes from files leave it out for heat, where a side named nowhere is insulated. With elasticity such a side has no displacement normal to itself.");
    declare(
      "Displacement",
      EntryType::list,
      "",
      "length",
      "Elasticity: given displacements, `side: component, component`, several sides separated by `;`; one component per direction, a formula of "
      "x, y, z, t or the word `free` where nothing holds it, also as a branch, `if(y < 1, 0, free)`, whose condition may not depend on t. Where two sides meet, the one named first "
      "holds." +
        sides);
    declare(
      "Velocity",
      EntryType::list,
      "",
      "length/time",
      "Elasticity with `Solver = dynamics`: given velocities, written like `Displacement`. What is held so moves by the integral of the "
      "velocity from time 0 on. Comes after `Displacement` where sides meet.");
    declare(
      "Displacement layer",
      EntryType::text,
      "",
      "length",
      "Depth behind the sides in `Displacement` in which all nodes are held, each as the formula says at its own place, by all models; with two horizons no family of the nodes that are left is cut "
      "off there. Empty: the outermost row of nodes.");
    declare(
      "Traction",
      EntryType::list,
      "",
      "force/area",
      "Elasticity: given forces per area, `side: component, component`, several sides separated by `;`; one component per direction, a "
      "formula of x, y, z, t. A side named nowhere is free.");
    declare(
      "Traction layer",
      EntryType::text,
      "",
      "length",
      "Depth over which peridynamics spreads tractions as body forces traction/depth, in each column of nodes behind the side; their sum stays that of the "
      "tractions. Empty: the outermost row of nodes.");
  }


  template <int dim>
  const SideCondition *BoundaryConditions<dim>::find(const std::vector<SideCondition> &list,
                                                     const dealii::types::boundary_id  id)
  {
    for (const SideCondition &condition : list)
      if (condition.id == id)
        return &condition;
    return nullptr;
  }


  template <int dim>
  bool BoundaryConditions<dim>::depends_on_time() const
  {
    return any_depends_on_time(dirichlet) || any_depends_on_time(flux) ||
           any_depends_on_time(convection) || any_depends_on_time(displacement) ||
           any_depends_on_time(traction);
  }


  template <int dim>
  std::vector<std::string> BoundaryConditions<dim>::side_names() const
  {
    std::vector<std::string> names;
    if (box_sides)
      names.assign(box_side_names().begin(), box_side_names().begin() + 2 * dim);
    if (has_hole)
      names.emplace_back("hole");
    for (const auto &[name, id] : physical_names)
      names.push_back(name);
    return names;
  }


  template <int dim>
  dealii::types::boundary_id BoundaryConditions<dim>::side_id(const std::string &name,
                                                              const std::string &entry,
                                                              const bool         or_part)
  {
    for (const Part &part : parts)
      if (or_part && part.name == name)
        return part.id;
    dealii::types::boundary_id id = 0;
    if (const auto physical = physical_names.find(name); physical != physical_names.end())
      id = physical->second;
    else if (!box_sides && name.find_first_not_of("0123456789") == std::string::npos)
      id = parse_whole_number(name, where(entry), first_part_id - 1);
    else
      {
        const std::vector<std::string> names = side_names();
        const auto                     found = std::find(names.begin(), names.end(), name);
        if (found == names.end() || !box_sides)
          error(entry, unknown_side(name, names, or_part ? parts : std::vector<Part>(), box_sides));
        id = name == "hole" ? hole_boundary_id : static_cast<unsigned int>(found - names.begin());
      }
    used_names.try_emplace(id, name);
    return id;
  }


  template <int dim>
  std::string BoundaryConditions<dim>::name_of(const dealii::types::boundary_id id) const
  {
    if (const Part *const of = part(id))
      return of->name;
    if (const auto used = used_names.find(id); used != used_names.end())
      return used->second;
    for (const auto &[name, physical] : physical_names)
      if (physical == id)
        return name;
    return name_of_side(id, box_sides);
  }


  template <int dim>
  std::vector<SideCondition> BoundaryConditions<dim>::parse_list(const std::string &entry)
  {
    std::vector<SideCondition> list;
    for (const std::string &piece : split_list(text(entry), ';'))
      {
        const auto    name_value = name_and_value(piece, where(entry));
        SideCondition condition;
        condition.id         = side_id(name_value.first, entry);
        condition.name       = name_of(condition.id);
        const std::string at = where(entry) + ", side '" + condition.name + "'";
        if (find(list, condition.id) != nullptr)
          error(entry, "the side '" + condition.name + "' is named twice.");
        const std::vector<std::string> formulas = split_list(name_value.second, ',');
        const unsigned int             n_values = entry == "Convection" ? 2 : 1;
        if (formulas.size() != n_values)
          entry_error(
            at,
            "found '" + name_value.second + "', needs " +
              (n_values == 2 ? "two formulas: coefficient, ambient value." : "one formula."));
        condition.value = Expression(formulas.back(), at);
        if (n_values == 2)
          {
            condition.coefficient = Expression(formulas.front(), at);
            if (condition.coefficient.depends_on_time())
              entry_error(
                at,
                "the coefficient " + formulas.front() +
                  " depends on t; it may vary in space only. The ambient temperature may depend on t.");
            if (condition.coefficient.is_constant() &&
                condition.coefficient.value(dealii::Point<dim>()) < 0.)
              entry_error(at, "the coefficient " + formulas.front() + " is negative.");
          }
        list.push_back(condition);
      }
    return list;
  }


  template <int dim>
  void BoundaryConditions<dim>::refuse_both(const std::string                &entry,
                                            const std::vector<SideCondition> &list,
                                            const std::string                &other_entry,
                                            const dealii::types::boundary_id  id) const
  {
    if (const SideCondition *const condition = find(list, id))
      error(entry,
            (part(id) != nullptr ? "the part '" : "the side '") + condition->name +
              "' is also named in '" + other_entry + "', which contradicts it.");
  }


  template <int dim>
  void BoundaryConditions<dim>::parse_symmetry()
  {
    symmetry.clear();
    std::string names = text("Symmetry");
    std::replace(names.begin(), names.end(), ';', ',');
    for (const std::string &name : split_list(names, ','))
      {
        const dealii::types::boundary_id id = side_id(name, "Symmetry");
        if (part(id) != nullptr)
          error(
            "Symmetry",
            "'" + name +
              "' is a part; only whole sides can be symmetry planes. With elasticity hold the part by 'Displacement', "
              "0 normal to it and 'free' along it.");
        if (name == "hole")
          error("Symmetry", "'hole' is not flat: only flat sides can be symmetry planes.");
        if (std::find(symmetry.begin(), symmetry.end(), id) != symmetry.end())
          error("Symmetry", "the side '" + name + "' is named twice.");
        symmetry.push_back(id);
      }
  }


  template <int dim>
  void BoundaryConditions<dim>::check_scalar_conditions() const
  {
    for (const SideCondition &condition : dirichlet)
      {
        refuse_both("Flux", flux, "Dirichlet", condition.id);
        refuse_both("Convection", convection, "Dirichlet", condition.id);
      }
    for (const dealii::types::boundary_id id : symmetry)
      {
        refuse_both("Dirichlet", dirichlet, "Symmetry", id);
        refuse_both("Convection", convection, "Symmetry", id);
        const SideCondition *const given = find(flux, id);
        if (given != nullptr && !is_zero(given->value))
          refuse_both("Flux", flux, "Symmetry", id);
      }
  }


  template <int dim>
  void BoundaryConditions<dim>::parse(const bool    given_box_sides,
                                      const bool    hole,
                                      const Physics physics,
                                      const bool    with_heat)
  {
    box_sides = given_box_sides;
    has_hole  = hole;
    used_names.clear();
    refuse_other_physics(physics, with_heat);
    parse_parts();
    dirichlet    = parse_list("Dirichlet");
    flux         = parse_list("Flux");
    convection   = parse_list("Convection");
    displacement = parse_vectors("Displacement");
    for (const VectorCondition &rate : parse_vectors("Velocity"))
      displacement.push_back(rate);
    traction = parse_vectors("Traction");
    parse_symmetry();
    displacement_layer = parse_layer("Displacement layer");
    traction_layer     = parse_layer("Traction layer");
    check_scalar_conditions();
    check_vector_conditions();
    check_parts();
  }


  template <int dim>
  double BoundaryConditions<dim>::parse_layer(const std::string &entry) const
  {
    if (this->text(entry).empty())
      return -1.;
    const double depth = parse_number(this->text(entry), this->where(entry));
    if (!(depth > 0.))
      this->error(entry,
                  "found " + this->text(entry) + ", needs a length greater than 0 (or nothing).");
    return depth;
  }


  template <int dim>
  std::vector<VectorCondition> BoundaryConditions<dim>::parse_vectors(const std::string &entry)
  {
    std::vector<VectorCondition> list;
    for (const std::string &piece : split_list(text(entry), ';'))
      {
        const auto      name_value = name_and_value(piece, where(entry));
        VectorCondition condition;
        condition.id   = side_id(name_value.first, entry);
        condition.name = name_of(condition.id);
        condition.rate = entry == "Velocity";
        if (find_condition(list, condition.id) != nullptr)
          error(entry, "the side '" + condition.name + "' is named twice.");
        parse_components(name_value.second,
                         dim,
                         entry != "Traction",
                         where(entry) + ", side '" + condition.name + "'",
                         condition);
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


  template class BoundaryConditions<1>;
  template class BoundaryConditions<2>;
  template class BoundaryConditions<3>;
} // namespace PeriDeal
