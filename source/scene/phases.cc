// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/orthotropy.h>
#include <perideal/scene/phases.h>
#include <perideal/scene/vector_conditions.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  namespace
  {
    /** The arguments of `name(...)`, or nothing if the text is something else. */
    std::optional<std::vector<std::string>> arguments_of(const std::string &text,
                                                         const std::string &name)
    {
      if (text.compare(0, name.size(), name) != 0 || text.empty() || text.back() != ')')
        return {};
      const std::string rest = trimmed(text.substr(name.size()));
      if (rest.empty() || rest.front() != '(')
        return {};
      // The first parenthesis has to close at the end: not `circle(...) - box(...)`.
      int depth = 0;
      for (std::size_t i = 0; i < rest.size(); ++i)
        {
          depth += rest[i] == '(' ? 1 : rest[i] == ')' ? -1 : 0;
          if (depth == 0 && i + 1 < rest.size())
            return {};
        }
      return split_list(rest.substr(1, rest.size() - 2), ',');
    }


    std::vector<double> numbers_of(const std::vector<std::string> &texts, const std::string &where)
    {
      std::vector<double> numbers;
      for (const std::string &text : texts)
        {
          const Expression number(text, where);
          if (!number.is_constant())
            entry_error(where, "'" + text + "' depends on x, y, z or t; shapes need numbers.");
          numbers.push_back(number.value(dealii::Point<1>()));
        }
      return numbers;
    }
  } // namespace


  Region::Region(const std::string                          &text,
                 const std::string                          &where,
                 const std::shared_ptr<const MeshMaterials> &mesh)
    : mesh(mesh)
  {
    struct Shape
    {
      const char  *name;
      Kind         kind;
      unsigned int n_coordinates, n_numbers; // polygon: at least
      const char  *form;
    };
    static const Shape shapes[] = {
      {"circle", Kind::ball, 2, 3, "circle(x, y, radius)"},
      {"sphere", Kind::ball, 3, 4, "sphere(x, y, z, radius)"},
      {"rectangle", Kind::box, 2, 4, "rectangle(x0, y0, x1, y1)"},
      {"box", Kind::box, 3, 6, "box(x0, y0, z0, x1, y1, z1)"},
      {"polygon", Kind::polygon, 2, 6, "polygon(x0, y0, x1, y1, x2, y2, ...)"},
      {"mesh", Kind::mesh, 0, 1, "mesh(material id)"}};
    for (const Shape &shape : shapes)
      {
        const auto arguments = arguments_of(text, shape.name);
        if (!arguments)
          continue;
        const std::size_t n = arguments->size();
        if (shape.kind == Kind::polygon ? n < 6 || n % 2 != 0 : n != shape.n_numbers)
          entry_error(where, "'" + text + "' needs the form " + shape.form + ".");
        kind          = shape.kind;
        n_coordinates = shape.n_coordinates;
        numbers       = numbers_of(*arguments, where);
        if (kind == Kind::mesh)
          {
            if (numbers[0] < 0. || numbers[0] != std::floor(numbers[0]))
              entry_error(where,
                          "'" + text + "' needs the form mesh(material id), a whole number.");
            return;
          }
        double size = kind == Kind::ball ? numbers.back() : 0.;
        if (kind == Kind::box)
          {
            size = numbers[n_coordinates] - numbers[0];
            for (unsigned int d = 0; d < n_coordinates; ++d)
              size = std::min(size, numbers[n_coordinates + d] - numbers[d]);
          }
        else if (kind == Kind::polygon)
          for (std::size_t i = 2; i < n; ++i)
            size = std::max(size, std::abs(numbers[i] - numbers[i % 2]));
        if (!(size > 0.))
          entry_error(where,
                      "'" + text + "' has no size; it needs the form " + shape.form +
                        (kind == Kind::box ? " with the lower corner first." : "."));
        slack = 1e-10 * size;
        return;
      }
    formula = Expression(text, where, "x, y, z");
    if (formula.depends_on_time())
      entry_error(where, "'" + text + "' depends on t; known variables here: x, y, z.");
  }


  int Region::mesh_id() const
  {
    return kind == Kind::mesh ? static_cast<int>(numbers[0]) : -1;
  }


  bool Region::in_polygon(const double x, const double y) const
  {
    const std::size_t n      = numbers.size() / 2;
    bool              inside = false;
    for (std::size_t i = 0; i < n; ++i)
      {
        const double ax = numbers[2 * i], ay = numbers[2 * i + 1];
        const double bx = numbers[2 * ((i + 1) % n)], by = numbers[2 * ((i + 1) % n) + 1];
        const double ex = bx - ax, ey = by - ay, length_square = ex * ex + ey * ey;
        const double along = length_square > 0. ?
                               std::clamp(((x - ax) * ex + (y - ay) * ey) / length_square, 0., 1.) :
                               0.;
        if (std::hypot(ax + along * ex - x, ay + along * ey - y) <= slack)
          return true;
        if ((ay > y) != (by > y) && x < ax + (y - ay) / ey * ex)
          inside = !inside;
      }
    return inside;
  }


  template <int dim>
  bool Region::contains(const dealii::Point<dim> &p) const
  {
    if (kind == Kind::formula)
      return formula.value(p) > 0.;
    double x[3] = {0., 0., 0.};
    for (unsigned int d = 0; d < dim; ++d)
      x[d] = p[d];
    if (kind == Kind::mesh)
      {
        Assert(mesh && mesh->id_at, dealii::ExcMessage("The mesh is not known yet."));
        return mesh->id_at(x) == mesh_id();
      }
    if (kind == Kind::polygon)
      return in_polygon(x[0], x[1]);
    double square = 0.;
    for (unsigned int d = 0; d < n_coordinates; ++d)
      if (kind == Kind::ball)
        square += (x[d] - numbers[d]) * (x[d] - numbers[d]);
      else if (x[d] < numbers[d] - slack || x[d] > numbers[n_coordinates + d] + slack)
        return false;
    return kind == Kind::box || std::sqrt(square) <= numbers.back() + slack;
  }


  bool Regions::need_mesh() const
  {
    return std::any_of(regions.begin(), regions.end(), [](const Region &region) {
      return region.mesh_id() >= 0;
    });
  }


  template <int dim>
  int Regions::at(const dealii::Point<dim> &p) const
  {
    int found = -1;
    for (unsigned int k = 0; k < regions.size(); ++k)
      {
        if (!regions[k].contains(p))
          continue;
        if (found < 0)
          {
            found = static_cast<int>(k);
            continue;
          }
        report_formula_error("Entry " + where + ": the phases '" + names[found] + "' and '" +
                             names[k] + "' overlap at " + point_text(p) +
                             ". Change a region so that every point belongs to one phase at most.");
      }
    if constexpr (dim == 2)
      if (found < 0 && image)
        {
          const int phase = image->at(p[0], p[1]);
          return phase < 0 ? -1 : static_cast<int>(regions.size()) + phase;
        }
    return found;
  }


  MaterialProperty::MaterialProperty(const Expression &everywhere)
    : elsewhere(everywhere)
  {}


  MaterialProperty::MaterialProperty(const double everywhere)
    : elsewhere(everywhere)
  {}


  MaterialProperty::MaterialProperty(const Expression                             &elsewhere,
                                     const std::shared_ptr<const Regions>         &regions,
                                     const std::vector<std::optional<Expression>> &of_regions)
    : elsewhere(elsewhere)
    , of_regions(of_regions)
  {
    // Where no phase has its own value, there is nothing to look up.
    if (std::any_of(of_regions.begin(), of_regions.end(), [](const auto &formula) {
          return formula.has_value();
        }))
      this->regions = regions;
  }


  bool MaterialProperty::is_constant() const
  {
    return regions == nullptr && elsewhere.is_constant();
  }


  bool MaterialProperty::depends_on_temperature() const
  {
    return elsewhere.depends_on_temperature() ||
           std::any_of(of_regions.begin(), of_regions.end(), [](const auto &formula) {
             return formula && formula->depends_on_temperature();
           });
  }


  bool MaterialProperty::depends_on_time() const
  {
    return elsewhere.depends_on_time() ||
           std::any_of(of_regions.begin(), of_regions.end(), [](const auto &formula) {
             return formula && formula->depends_on_time();
           });
  }


  const Expression &MaterialProperty::formula(const int region) const
  {
    return region >= 0 && of_regions[region] ? *of_regions[region] : elsewhere;
  }


  const std::vector<MaterialEntry> &material_entries()
  {
    static const std::vector<MaterialEntry> entries = {
      {"Conductivity", "power/(length temperature)", true, false, true, true},
      {"Diffusivity", "length^2/time", true, false, true, true},
      {"Density", "mass/length^3", true, true, true, true},
      {"Heat capacity", "energy/(mass temperature)", true, false, true, true},
      {"Saturated concentration", "mass/length^3", true, false, false, true},
      {"Bulk modulus", "force/length^2", false, true, true, true},
      {"Shear modulus", "force/length^2", false, true, true, true},
      {"Young modulus", "force/length^2", false, true, true, true},
      {"Poisson ratio", "1", false, true, true, false},
      {"Thermal expansion", "1/temperature", false, true, true, false},
      {"Fracture energy", "energy/length^2", false, true, false, true, true},
      {"Critical stretch", "1", false, true, false, true, true},
      {"Critical stress", "force/length^2", false, true, false, true, true},
      {"Unbreakable", "1", false, true, false, false},
      {"Tensile strength", "force/length^2", false, true, false, true},
      {"Yield stress", "force/length^2", false, true, true, true},
      {"Hardening modulus", "force/length^2", false, true, true, false}};
    return entries;
  }


  const MaterialEntry &material_entry(const std::string &name)
  {
    const auto found = std::find_if(material_entries().begin(),
                                    material_entries().end(),
                                    [&](const MaterialEntry &entry) { return entry.name == name; });
    Assert(found != material_entries().end(),
           dealii::ExcMessage("There is no such entry of a material."));
    return *found;
  }


  Expression material_formula(const std::string   &text,
                              const MaterialEntry &entry,
                              const bool           elastic,
                              const bool           may_vanish,
                              const std::string   &where)
  {
    // A solid has it in what diffusion has not.
    const bool        is_unknown        = elastic && entry.elasticity && entry.diffusion;
    const bool        knows_temperature = entry.with_temperature && !is_unknown;
    const std::string variables         = entry.changes     ? "x, y, z, t, T" :
                                          knows_temperature ? "x, y, z, T" :
                                                              "x, y, z";
    const Expression  formula(text, where, variables, true);
    if (formula.depends_on_time() && !entry.changes)
      entry_error(where, "'" + text + "' depends on t; known variables here: " + variables + ".");
    if (formula.depends_on_temperature() && !entry.with_temperature && !entry.changes)
      entry_error(where, "'" + text + "' depends on T; known variables here: x, y, z.");
    if (formula.depends_on_temperature() && is_unknown && !entry.changes)
      entry_error(
        where,
        "'" + text +
          "' depends on T, which is no unknown of 'Physics = elasticity'; known variables here: x, y, z.");
    if (entry.positive && formula.is_constant() &&
        !(formula.value(dealii::Point<1>()) > 0. || (may_vanish && is_zero(formula))))
      entry_error(where, "found " + text + ", needs a value greater than 0.");
    return formula;
  }


  Phases::Phases()
    : SceneSection("Material/Phases")
  {
    declare("Regions", EntryType::list) =
      "Parts of the body with a material of their own: `name: region`, several separated by `;`. A region is where a formula of x, y, "
      "z is greater than 0, or `circle(x, y, r)`, `rectangle(x0, y0, x1, y1)`, `polygon(x0, y0, x1, y1, ...)`, `sphere(x, y, z, r)`, "
      "`box(x0, y0, z0, x1, y1, z1)`, their rims included, or with a mesh file `mesh(name)` or `mesh(id)`, the cells of that physical surface (in 3D "
      "volume). Regions must not overlap; outside them the entries of section `Material` "
      "hold. The phases of an image (section `Domain`) are phases, too; a region holds before them.";
    for (const MaterialEntry &entry : material_entries())
      declare(entry.name, EntryType::list, "", entry.unit) =
        (entry.name == "Conductivity" ? "Thermal conductivity" : entry.name) +
        " of each phase: `name: formula of x, y, z" +
        (entry.changes          ? ", t, T" :
         entry.with_temperature ? ", T" :
                                  "") +
        "`, several separated by `;`. A phase that is not named here has the value of section `Material`.";
    for (const OrthotropicEntry &entry : orthotropic_entries())
      declare(entry.name, EntryType::list, "", entry.unit) =
        entry.name +
        " of each phase: `name: list of numbers or formulas of x, y, z`, several separated by `;`, as many numbers as section `Material` has. A phase that is not named here has those of section `Material`.";
    declare("User properties", EntryType::list, "", "of the law") =
      "With `Law = user`: the numbers PROPS of each phase, `name: numbers`, several separated by `;`. The law gets the name of the phase as CMNAME, too. A phase that is not named here has those of section `Material`.";
    parse();
  }


  std::vector<std::optional<Expression>> Phases::read(const std::string &entry) const
  {
    const MaterialEntry                   &kind = material_entry(entry);
    std::vector<std::optional<Expression>> list(regions->names.size());
    for (const std::string &piece : split_list(text(entry), ';'))
      {
        const auto [name, text_of_phase] = name_and_value(piece, where(entry));
        const std::string at             = where(entry) + ", phase '" + name + "'";
        const auto        found = std::find(regions->names.begin(), regions->names.end(), name);
        if (found == regions->names.end())
          error(entry,
                "there is no phase '" + name + "' in 'Regions'" +
                  (regions->image ? " or 'Image colors' (section 'Domain')" : "") +
                  (regions->names.empty() ?
                     "." :
                     "; the phases are: " + join_names(regions->names) + ".") +
                  did_you_mean(name, regions->names));
        std::optional<Expression> &value = list[found - regions->names.begin()];
        if (value)
          error(entry, "the phase '" + name + "' is named twice.");
        const bool capacity   = entry == "Heat capacity",
                   may_vanish = (!needs_storage && (capacity || entry == "Density")) ||
                                (elastic && capacity);
        value = material_formula(text_of_phase, kind, elastic, may_vanish, at);
      }
    return list;
  }


  void Phases::parse(const Physics                          physics,
                     const std::shared_ptr<const PhaseMap> &image,
                     const bool                             storage_needed)
  {
    needs_storage = storage_needed;
    elastic       = physics == Physics::elasticity;
    auto list     = std::make_shared<Regions>();
    list->where   = where("Regions");
    list->mesh    = std::make_shared<MeshMaterials>();
    for (const std::string &piece : split_list(text("Regions"), ';'))
      {
        const auto [name, region] = name_and_value(piece, where("Regions"));
        if (has(list->names, name))
          error("Regions", "the phase '" + name + "' is named twice.");
        if (name.find_first_of(",\"") != std::string::npos)
          error("Regions", "the name of the phase '" + name + "' has a comma or a quotation mark.");
        list->names.push_back(name);
        list->regions.emplace_back(region, where("Regions") + ", phase '" + name + "'", list->mesh);
      }
    if (image)
      for (const std::string &name : image->names)
        {
          if (has(list->names, name))
            error("Regions",
                  "the phase '" + name + "' is one of 'Image colors' in section 'Domain', too.");
          list->names.push_back(name);
        }
    list->image = image;
    regions     = list;
    std::vector<bool> has_material(regions->names.size(), false);
    for (const MaterialEntry &entry : material_entries())
      {
        const auto values = read(entry.name);
        for (std::size_t k = 0; k < values.size(); ++k)
          has_material[k] = has_material[k] || (values[k].has_value() &&
                                                (elastic ? entry.elasticity : entry.diffusion));
      }
    std::vector<std::string> lists{"User properties"};
    for (const OrthotropicEntry &entry : orthotropic_entries())
      lists.push_back(entry.name);
    for (const std::string &entry : lists)
      for (const std::string &piece : split_list(text(entry), ';'))
        {
          const auto found = std::find(regions->names.begin(),
                                       regions->names.end(),
                                       name_and_value(piece, where(entry)).first);
          if (elastic && found != regions->names.end())
            has_material[found - regions->names.begin()] = true;
        }
    // What an image shows need not have a material of its own.
    for (std::size_t k = 0; k < regions->regions.size(); ++k)
      if (!has_material[k])
        error("Regions",
              "the phase '" + regions->names[k] + "' has no material: name it in '" +
                (elastic ? "Young modulus" : "Conductivity") +
                "' or another entry of this section" +
                (elastic ? " that 'Physics = elasticity' takes." : "."));
  }


  MaterialProperty Phases::property(const std::string &entry, const Expression &elsewhere) const
  {
    return MaterialProperty(elsewhere, regions, read(entry));
  }


  bool Phases::gives(const std::string &entry) const
  {
    const auto values = read(entry);
    return std::any_of(values.begin(), values.end(), [](const auto &value) {
      return value.has_value();
    });
  }


#define PERIDEAL_TEMPLATES(dim)                                          \
  template bool Region::contains<dim>(const dealii::Point<dim> &) const; \
  template int  Regions::at<dim>(const dealii::Point<dim> &) const;
  PERIDEAL_FOR_EACH_DIM(PERIDEAL_TEMPLATES)
#undef PERIDEAL_TEMPLATES
} // namespace PeriDeal
