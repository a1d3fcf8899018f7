// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/scene/boundary_conditions.h>
#include <perideal/scene/lists.h>

#include <algorithm>

// Conditions of another physics, and those of solids that contradict each other.

namespace PeriDeal
{
  namespace
  {
    /** As many formulas as there are names, separated by commas. */
    std::vector<Expression> parse_formulas(const std::string              &text,
                                           const std::vector<std::string> &names,
                                           const std::string              &where,
                                           const bool                      with_temperature)
    {
      const std::vector<std::string> pieces = split_list(text, ',');
      if (const std::size_t n = names.size(); pieces.size() != n)
        entry_error(where,
                    "found '" + text + "', needs " +
                      (n == 1 ? "one formula." :
                                std::to_string(n) + " formulas: " + join_names(names) + "."));
      std::vector<Expression> formulas;
      for (std::size_t k = 0; k < pieces.size(); ++k)
        formulas.emplace_back(pieces[k],
                              where,
                              std::string(names[k] == "coefficient" ? "x, y, z" : "x, y, z, t") +
                                (with_temperature ? ", T" : ""),
                              with_temperature);
      return formulas;
    }


    std::string unknown_side(const std::string         &name,
                             std::vector<std::string>   known,
                             const MeshGroups::Numbers &of_mesh,
                             const std::vector<Part>   &parts)
    {
      std::string text = "unknown side '" + name + "'; the sides ";
      if (known.empty())
        text += "of this mesh are its boundary ids (numbers), it has no names.";
      else if (of_mesh.empty())
        text += "are: " + join_names(known) + ".";
      else
        text += "of this mesh, with their boundary ids, are: " + text_of_groups(of_mesh) + ".";
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
      " Sides: left, right (x), bottom, top (y), back, front (z), hole; of a mesh file its boundary ids and physical names (those with `:`, `;` or `,` in double quotation marks); "
      "or names of `Parts`.";
    declare("Parts", EntryType::list) =
      "Places for conditions that are no whole sides, several separated by `;`: `name: SIDE if FORMULA`, what of a side the formula (of x, y, z) is true or "
      "> 0 on; `name: region FORMULA`, the nodes where it is; `name: point X, Y[, Z]`, the node nearest to the point, which may lie outside the body by a cell at most. The names stand wherever those of sides "
      "do. `Flux` and `Traction` act on the area of a part of a side; on a region or a point they are the total power or force (in 2D per thickness), shared by its nodes in "
      "proportion to their volume.";
    declare("Dirichlet", EntryType::list, "", "temperature") =
      "Given temperatures: `side: formula of x, y, z, t`, several separated by `;`. Where two sides meet, the one named first holds." +
      sides;
    for (const TransferKind &kind : transfer_kinds())
      declare(kind.entry, EntryType::list, "", kind.unit) = kind.documentation;
    declare("Symmetry", EntryType::list) =
      "Sides that are symmetry planes, separated by `;` or `,`. Fictitious nodes beyond them mirror the temperature; on meshes from files leave it out for heat, where a side named nowhere is insulated. With elasticity such a side has no displacement normal to itself.";
    declare("Displacement", EntryType::list, "", "length") =
      "Elasticity: given displacements, `side: component, component`, several sides separated by `;`; one component per direction, a formula of "
      "x, y, z, t or the word `free` where nothing holds it, also as a branch, `if(y < 1, 0, free)`, whose condition may not depend on t. Where two sides meet, the one named first "
      "holds." +
      sides;
    declare("Velocity", EntryType::list, "", "length/time") =
      "Elasticity with `Solver = dynamics`: given velocities, written like `Displacement`. What is held so moves by the integral of the velocity from time 0 on. Comes after `Displacement` where sides meet.";
    declare_if_given(displacement_layer, "Displacement layer", "", "length", Bounds::length) =
      "Depth behind the sides in `Displacement` in which all nodes are held, each as the formula says at its own place, by all models; with two horizons no family of the nodes that are left is cut "
      "off there. Empty: the outermost row of nodes.";
    declare("Traction", EntryType::list, "", "force/area") =
      "Elasticity: given forces per area, `side: component, component`, several sides separated by `;`; one component per direction, a formula of x, y, z, t. A side named nowhere is free.";
    declare_if_given(traction_layer, "Traction layer", "", "length", Bounds::length) =
      "Depth over which peridynamics spreads tractions as body forces traction/depth, in each column of nodes behind the side; their sum stays that of the "
      "tractions. Empty: the outermost row of nodes.";
  }


  template <int dim>
  bool BoundaryConditions<dim>::depends_on_time() const
  {
    bool any = false;
    for_each([&](const auto &, const auto &condition) { any |= condition.depends_on_time(); });
    return any;
  }


  template <int dim>
  bool BoundaryConditions<dim>::transfers_depend_on_time() const
  {
    const auto varies = std::mem_fn(&SurfaceTransfer::depends_on_time);
    return std::any_of(transfers.begin(), transfers.end(), varies);
  }


  template <int dim>
  bool BoundaryConditions<dim>::transfers_fix_level() const
  {
    const auto fixes = std::mem_fn(&SurfaceTransfer::fixes_level);
    return std::any_of(transfers.begin(), transfers.end(), fixes);
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
                                                              const std::string &at,
                                                              const bool         or_part)
  {
    for (const Part &part : parts)
      if (or_part && part.name == name)
        return part.id;
    dealii::types::boundary_id id = 0;
    if (const auto of_mesh = number_of_group(physical_names, name))
      id = *of_mesh;
    else if (!box_sides && name.find_first_not_of("0123456789") == std::string::npos &&
             (physical_names.empty() || name == "0")) // a side without a group has the number 0
      id = parse_whole_number(name, at, first_part_id - 1);
    else
      {
        const std::vector<std::string> names = side_names();
        const auto                     found = std::find(names.begin(), names.end(), name);
        if (found == names.end() || !box_sides)
          entry_error(
            at,
            unknown_side(name, names, physical_names, or_part ? parts : std::vector<Part>()));
        id = name == "hole" ? hole_boundary_id : static_cast<unsigned int>(found - names.begin());
      }
    used_names.try_emplace(id, name);
    return id;
  }


  template <int dim>
  void BoundaryConditions<dim>::parse_parts()
  {
    const std::string entry = "Parts";
    // Those of the mesh file are there already, and have no id yet.
    parts.erase(
      std::remove_if(parts.begin(), parts.end(), [](const Part &part) { return part.id != 0; }),
      parts.end());
    for (std::size_t k = 0; k < parts.size(); ++k)
      parts[k].id = first_part_id + k;
    for (const std::string &piece : split_list(text(entry), ';'))
      {
        const auto [name, value] = name_and_value(piece, where(entry));
        const std::string at     = where(entry) + ", part '" + name + "'";
        const auto        known  = side_names();
        if (has(known, name) || name.find_first_not_of("0123456789") == std::string::npos)
          entry_error(at, "is the name of a side. Give the part another one.");
        if (std::any_of(parts.begin(), parts.end(), [part_name = name](const Part &p) {
              return p.name == part_name;
            }))
          error(entry, "the part '" + name + "' is named twice.");
        std::string side;
        Part        part = parse_part(value, dim, at, side);
        part.name        = name;
        part.id          = first_part_id + parts.size();
        if (part.kind == Part::of_side)
          part.side = side_id(side, where(entry), false);
        parts.push_back(part);
      }
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
  template <typename Condition, typename Read>
  std::vector<Condition> BoundaryConditions<dim>::parse_list(const std::string &entry,
                                                             const Read        &read)
  {
    std::vector<Condition> list;
    for (const std::string &piece : split_list(text(entry), ';'))
      {
        const auto [name, value] = name_and_value(piece, where(entry));
        Condition condition;
        condition.id   = side_id(name, where(entry));
        condition.name = name_of(condition.id);
        if (find_condition(list, condition.id) != nullptr)
          error(entry, "the side '" + condition.name + "' is named twice.");
        read(condition, value, where(entry) + ", side '" + condition.name + "'");
        list.push_back(condition);
      }
    return list;
  }


  template <int dim>
  void BoundaryConditions<dim>::parse_symmetry()
  {
    symmetry.clear();
    for (const std::string &piece : split_list(text("Symmetry"), ';'))
      for (const std::string &given : split_list(piece, ','))
        {
          const std::string                name = unquoted(given);
          const dealii::types::boundary_id id   = side_id(name, where("Symmetry"));
          if (part(id) != nullptr)
            error(
              "Symmetry",
              "'" + name +
                "' is a part; only whole sides can be symmetry planes. With elasticity hold the part by 'Displacement', "
                "0 normal to it and 'free' along it.");
          if (name == "hole")
            error("Symmetry", "'hole' is not flat: only flat sides can be symmetry planes.");
          if (has(symmetry, id))
            error("Symmetry", "the side '" + name + "' is named twice.");
          symmetry.push_back(id);
        }
  }


  template <int dim>
  void BoundaryConditions<dim>::check_scalar_conditions() const
  {
    const auto refuse_both =
      [&](const std::string &entry, const auto &condition, const std::string &other_entry) {
        error(entry,
              (part(condition.id) != nullptr ? "the part '" : "the side '") + condition.name +
                "' is also named in '" + other_entry + "', which contradicts it.");
      };
    for (const SideCondition &condition : dirichlet)
      for (const SurfaceTransfer &transfer : transfers)
        if (transfer.id == condition.id)
          refuse_both(transfer.kind->entry, transfer, "Dirichlet");
    for (const dealii::types::boundary_id id : symmetry)
      {
        if (const SideCondition *const condition = find_condition(dirichlet, id))
          refuse_both("Dirichlet", *condition, "Symmetry");
        for (const SurfaceTransfer &transfer : transfers)
          if (transfer.id == id && !transfer.insulates())
            refuse_both(transfer.kind->entry, transfer, "Symmetry");
      }
  }


  template <int dim>
  void BoundaryConditions<dim>::check_parts() const
  {
    const auto check_symmetry = [&](const std::string &entry, const auto &condition) {
      if (part(condition.id) != nullptr && has(symmetry, side_of(condition.id)))
        error(entry,
              "the part '" + condition.name + "' lies on the side '" +
                name_of(side_of(condition.id)) +
                "', which is also named in 'Symmetry', which contradicts it.");
    };
    for (const SideCondition &condition : dirichlet)
      check_symmetry("Dirichlet", condition);
    for (const SurfaceTransfer &transfer : transfers)
      check_symmetry(transfer.kind->entry, transfer);
    for (const SurfaceTransfer &transfer : transfers)
      if (const Part *const of = part(transfer.id);
          of != nullptr && of->kind != Part::of_side && transfer.fixes_level())
        error(transfer.kind->entry,
              "the part '" + transfer.name +
                (transfer.kind->fixes_level ?
                   "' is no part of a side and has no area that a coefficient could refer to. Use "
                   "'Flux' (the power that enters there in all), or a part 'SIDE if FORMULA'." :
                   "' is no part of a side, and what enters there may not depend on T. Use a part "
                   "'SIDE if FORMULA', or 'Source' in section 'Initial and source'."));
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
    dirichlet = parse_list<SideCondition>(
      "Dirichlet",
      [](SideCondition &condition, const std::string &text, const std::string &at) {
        condition.value = parse_formulas(text, {"value"}, at, false)[0];
      });
    transfers.clear();
    for (const TransferKind &kind : transfer_kinds())
      for (const SurfaceTransfer &transfer : parse_list<SurfaceTransfer>(
             kind.entry,
             [&](SurfaceTransfer &read, const std::string &text, const std::string &at) {
               read.absolute_zero = absolute_zero;
               read.set(kind, parse_formulas(text, kind.formulas, at, true), at);
             }))
        transfers.push_back(transfer);
    displacement.clear();
    traction.clear();
    for (const std::string entry : {"Displacement", "Velocity", "Traction"})
      for (const VectorCondition &condition : parse_list<VectorCondition>(
             entry,
             [&](VectorCondition &read, const std::string &text, const std::string &at) {
               read.rate = entry == "Velocity";
               parse_components(text, dim, entry != "Traction", at, read);
             }))
        (entry == "Traction" ? traction : displacement).push_back(condition);
    parse_symmetry();
    SceneSection::parse();
    check_scalar_conditions();
    check_vector_conditions();
    check_parts();
  }


  template <int dim>
  void BoundaryConditions<dim>::refuse_other_physics(const Physics physics,
                                                     const bool    with_heat) const
  {
    const auto only_diffusion = [&](const std::string &entry, const std::string &remedy) {
      refuse(physics == Physics::elasticity && !with_heat && is_given(entry),
             entry,
             "is for diffusion; 'Physics' is 'elasticity'. Use " + remedy +
               ", or 'Temperature change = computed' in section 'Elasticity'.");
    };
    only_diffusion("Dirichlet", "'Displacement'");
    for (const TransferKind &kind : transfer_kinds())
      {
        only_diffusion(kind.entry,
                       kind.fixes_level ? "'Displacement' or 'Traction'" : "'Traction'");
        refuse(kind.only_of_heat && physics != Physics::heat && physics != Physics::elasticity &&
                 is_given(kind.entry),
               kind.entry,
               "is for 'Physics = heat'; 'Physics' is '" + names_of(physics).physics +
                 "'. Use 'Flux', whose formula may depend on the unknown as T.");
      }
    for (const auto &[entry, remedy] :
         {std::make_pair("Displacement", "'Dirichlet'"),
          std::make_pair("Velocity", "'Dirichlet'"),
          std::make_pair("Traction", "'Flux'"),
          std::make_pair("Displacement layer", "'Boundary treatment' in section 'Peridynamics'"),
          std::make_pair("Traction layer", "'Flux treatment' in section 'Peridynamics'")})
      refuse_unless_elastic(entry, physics, std::string(" Use ") + remedy + ".");
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
        if (has(symmetry, side_of(load.id)) &&
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
      if (has(symmetry, side_of(grip.id)))
        error(
          "Displacement",
          "the side '" + name_of(side_of(grip.id)) +
            "' is also named in 'Symmetry', which holds its normal displacement and leaves the others free. Name it in one of the two.");
  }


  PERIDEAL_INSTANTIATE_CLASS(class BoundaryConditions);
} // namespace PeriDeal
