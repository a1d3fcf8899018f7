// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/scene/boundary_conditions.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cctype>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    const std::string forms =
      "'SIDE if FORMULA', 'region FORMULA' or 'point X, Y' (in three dimensions 'point X, Y, Z')";


    bool is_blank(const char c)
    {
      return std::isspace(static_cast<unsigned char>(c)) != 0;
    }


    /** Whether the text is the word, or begins with it and a blank (or a parenthesis). */
    bool begins_with_word(const std::string &text, const std::string &word)
    {
      return text.compare(0, word.size(), word) == 0 &&
             (text.size() == word.size() || is_blank(text[word.size()]) ||
              text[word.size()] == '(');
    }


    /** Where the word `if` stands between a side and a formula; npos without one. */
    std::size_t place_of_if(const std::string &text)
    {
      for (std::size_t i = 1; i < text.size(); ++i)
        if (is_blank(text[i - 1]) && begins_with_word(text.substr(i), "if"))
          return i;
      return std::string::npos;
    }
  } // namespace


  template <int dim>
  bool Part::holds(const Point<dim> &p) const
  {
    return inside.value(p) > 0.;
  }


  template <int dim>
  Point<dim> Part::position() const
  {
    Point<dim> p;
    for (unsigned int d = 0; d < dim; ++d)
      p[d] = place[d];
    return p;
  }


  PartText split_part(const std::string &text, const std::string &where)
  {
    PartText result{Part::of_side, "", ""};
    for (const Part::Kind kind : {Part::region, Part::point})
      if (const std::string word = kind == Part::region ? "region" : "point";
          begins_with_word(text, word))
        {
          result.kind = kind;
          result.rest = trimmed(text.substr(word.size()));
          if (result.rest.empty())
            entry_error(where, "'" + word + "' is all there is; needs " + forms + ".");
          return result;
        }
    const std::size_t at = place_of_if(text);
    if (at == std::string::npos)
      entry_error(where,
                  "found '" + text + "', needs " + forms +
                    ". Whole sides have a name already and need no part.");
    result.side = trimmed(text.substr(0, at));
    result.rest = trimmed(text.substr(at + 2));
    if (result.rest.empty())
      entry_error(where, "a formula is missing behind 'if'.");
    return result;
  }


  Expression part_formula(const std::string &text, const std::string &where)
  {
    Expression formula(text, where);
    if (formula.depends_on_time())
      entry_error(where,
                  "the formula '" + text +
                    "' depends on t; a part stays where it is. Let the values on it depend on t.");
    if (formula.is_constant() && !(formula.value(Point<1>()) > 0.))
      entry_error(where, "the formula '" + text + "' holds nowhere: the part is empty.");
    return formula;
  }


  template <int dim>
  void BoundaryConditions<dim>::parse_parts()
  {
    parts.clear();
    const std::string entry = "Parts";
    for (const std::string &piece : split_list(this->text(entry), ';'))
      {
        const auto [name, value] = name_and_value(piece, this->where(entry));
        const std::string at     = this->where(entry) + ", part '" + name + "'";
        const auto        known  = side_names();
        if (std::find(known.begin(), known.end(), name) != known.end() ||
            name.find_first_not_of("0123456789") == std::string::npos)
          entry_error(at, "is the name of a side. Give the part another one.");
        if (std::any_of(parts.begin(), parts.end(), [&](const Part &p) { return p.name == name; }))
          this->error(entry, "the part '" + name + "' is named twice.");
        const PartText text = split_part(value, at);
        Part           part;
        part.name = name;
        part.kind = text.kind;
        part.id   = first_part_id + parts.size();
        if (part.kind == Part::point)
          {
            const Point<dim> p = parse_point<dim>(text.rest, at);
            for (unsigned int d = 0; d < dim; ++d)
              part.place[d] = p[d];
          }
        else
          part.inside = part_formula(text.rest, at);
        if (part.kind == Part::of_side)
          part.side = side_id(text.side, entry, false);
        parts.push_back(part);
      }
  }


  template <int dim>
  const Part *BoundaryConditions<dim>::part(const types::boundary_id id) const
  {
    return id >= first_part_id && id - first_part_id < parts.size() ? &parts[id - first_part_id] :
                                                                      nullptr;
  }


  template <int dim>
  types::boundary_id BoundaryConditions<dim>::side_of(const types::boundary_id id) const
  {
    const Part *const of = part(id);
    return of != nullptr ? of->side : id;
  }


  template <int dim>
  bool BoundaryConditions<dim>::holds_at(const types::boundary_id id, const Point<dim> &p) const
  {
    const Part *const of = part(id);
    return of == nullptr || (of->kind != Part::point && of->holds(p));
  }


  template <int dim>
  const SideCondition *BoundaryConditions<dim>::first_at(const std::vector<SideCondition> &list,
                                                         const types::boundary_id          side,
                                                         const Point<dim>                 &p) const
  {
    for (const SideCondition &condition : list)
      if (side_of(condition.id) == side && holds_at(condition.id, p))
        return &condition;
    return nullptr;
  }


  template <int dim>
  void BoundaryConditions<dim>::check_parts() const
  {
    for (const auto &[list, entry] : {std::pair(&dirichlet, "Dirichlet"),
                                      std::pair(&flux, "Flux"),
                                      std::pair(&convection, "Convection")})
      for (const SideCondition &condition : *list)
        if (part(condition.id) != nullptr &&
            std::find(symmetry.begin(), symmetry.end(), side_of(condition.id)) != symmetry.end())
          this->error(entry,
                      "the part '" + condition.name + "' lies on the side '" +
                        name_of(side_of(condition.id)) +
                        "', which is also named in 'Symmetry', which contradicts it.");
    for (const SideCondition &condition : convection)
      if (part(condition.id) != nullptr && part(condition.id)->kind != Part::of_side)
        this->error(
          "Convection",
          "the part '" + condition.name +
            "' is no part of a side and has no area that a coefficient could refer to. Use "
            "'Flux' (the power that enters there in all), or a part 'SIDE if FORMULA'.");
  }


  template bool     Part::holds(const Point<1> &) const;
  template bool     Part::holds(const Point<2> &) const;
  template bool     Part::holds(const Point<3> &) const;
  template Point<1> Part::position() const;
  template Point<2> Part::position() const;
  template Point<3> Part::position() const;


  // Conditions that a program gives.

  template <int dim>
  void BoundaryConditions<dim>::prescribe(const types::boundary_id id, const Expression &value)
  {
    dirichlet.push_back({name_of(id), id, value, {}});
  }

  template <int dim>
  void BoundaryConditions<dim>::add_flux(const types::boundary_id id, const Expression &value)
  {
    flux.push_back({name_of(id), id, value, {}});
  }

  template <int dim>
  void BoundaryConditions<dim>::add_convection(const types::boundary_id id,
                                               const Expression        &coefficient,
                                               const Expression        &ambient)
  {
    convection.push_back({name_of(id), id, ambient, coefficient});
  }

  template <int dim>
  void BoundaryConditions<dim>::displace(const types::boundary_id                      id,
                                         const std::vector<std::optional<Expression>> &values)
  {
    AssertDimension(values.size(), dim);
    VectorCondition condition;
    condition.name   = name_of(id);
    condition.id     = id;
    condition.values = values;
    condition.held.assign(dim, {});
    for (const auto &value : values)
      condition.texts.push_back(value ? value->text() : "free");
    displacement.push_back(condition);
  }

  template <int dim>
  void BoundaryConditions<dim>::pull(const types::boundary_id       id,
                                     const std::vector<Expression> &values)
  {
    AssertDimension(values.size(), dim);
    VectorCondition condition;
    condition.name = name_of(id);
    condition.id   = id;
    condition.held.assign(dim, {});
    for (const Expression &value : values)
      {
        condition.values.emplace_back(value);
        condition.texts.push_back(value.text());
      }
    traction.push_back(condition);
  }

  template <int dim>
  void BoundaryConditions<dim>::name_sides_by_number()
  {
    box_sides = false;
  }


#define PERIDEAL_INSTANTIATE(dim)                                                                  \
  template void               BoundaryConditions<dim>::parse_parts();                              \
  template void               BoundaryConditions<dim>::check_parts() const;                        \
  template const Part        *BoundaryConditions<dim>::part(const types::boundary_id) const;       \
  template types::boundary_id BoundaryConditions<dim>::side_of(const types::boundary_id) const;    \
  template bool BoundaryConditions<dim>::holds_at(const types::boundary_id, const Point<dim> &)    \
    const;                                                                                         \
  template const SideCondition *BoundaryConditions<dim>::first_at(                                 \
    const std::vector<SideCondition> &,                                                            \
    const types::boundary_id,                                                                      \
    const Point<dim> &) const;                                                                     \
  template void BoundaryConditions<dim>::prescribe(const types::boundary_id, const Expression &);  \
  template void BoundaryConditions<dim>::add_flux(const types::boundary_id, const Expression &);   \
  template void BoundaryConditions<dim>::add_convection(const types::boundary_id,                  \
                                                        const Expression &,                        \
                                                        const Expression &);                       \
  template void BoundaryConditions<dim>::displace(const types::boundary_id,                        \
                                                  const std::vector<std::optional<Expression>> &); \
  template void BoundaryConditions<dim>::pull(const types::boundary_id,                            \
                                              const std::vector<Expression> &);                    \
  template void BoundaryConditions<dim>::name_sides_by_number();
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
