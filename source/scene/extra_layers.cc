// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// `Extra layers` of section `Domain`: material around the body that is in no result.

#include <perideal/scene/boundary_conditions.h>
#include <perideal/scene/domain.h>
#include <perideal/scene/lists.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int most_layers = 1000;


    /** A number for all sides, or `side: number` separated by `;`. */
    template <int dim>
    std::array<unsigned int, 2 * dim> parse_layers(const std::string &text,
                                                   const std::string &where)
    {
      std::array<unsigned int, 2 * dim> layers;
      layers.fill(0);
      if (text.find(':') == std::string::npos)
        {
          layers.fill(parse_whole_number(trimmed(text), where, most_layers));
          return layers;
        }
      const std::vector<std::string> sides(box_side_names().begin(),
                                           box_side_names().begin() + 2 * dim);
      for (const std::string &piece : split_list(text, ';'))
        {
          const auto [side, value]              = name_and_value(piece, where);
          layers[choice_of(side, sides, where)] = parse_whole_number(value, where, most_layers);
        }
      return layers;
    }
  } // namespace


  template <int dim>
  void Domain<dim>::declare_extra_layers()
  {
    declare(
      "Extra layers",
      EntryType::list,
      "0",
      "1",
      "Rows of cells that are added outside the sides of the body and left out of the results (elasticity): a number for all sides, or "
      "`left: 10; right: 10`. Boundary conditions act on their outer sides; forces on sides and energies are those of the whole.");
    declare(
      "Extra layers phase",
      EntryType::text,
      "",
      "",
      "With `Shape = image`: the phase of the extra layers. Empty: that of the nearest cell of the image.");
  }


  template <int dim>
  void Domain<dim>::parse_extra_layers()
  {
    body_lower   = lower;
    body_upper   = upper;
    extra_layers = parse_layers<dim>(text("Extra layers"), where("Extra layers"));
    const bool any =
      std::any_of(extra_layers.begin(), extra_layers.end(), [](const auto n) { return n > 0; });
    const std::string phase = text("Extra layers phase");
    if (!phase.empty() && (!any || !image))
      error("Extra layers phase",
            any ? "has no effect: 'Shape' is not 'image'." : "has no effect: 'Extra layers' is 0.");
    if (!any)
      return;
    if (shape == Shape::mesh_file)
      error("Extra layers",
            "found " + text("Extra layers") + ", but a mesh file has no rows of cells. Use 0.");
    if (whole_number("Coarsening") > 0)
      error("Extra layers", "goes with 'Coarsening = 0' only.");
    const Tensor<1, dim> h = spacing();
    for (unsigned int d = 0; d < dim; ++d)
      {
        lower[d] -= h[d] * extra_layers[2 * d];
        upper[d] += h[d] * extra_layers[2 * d + 1];
        cells[d] += extra_layers[2 * d] + extra_layers[2 * d + 1];
      }
    require_countable("Extra layers");
    if constexpr (dim == 2)
      if (image)
        *image = image->surrounded(
          extra_layers,
          phase.empty() ?
            PhaseMap::nearest :
            static_cast<int>(choice_of(phase, image->names, where("Extra layers phase"))));
  }


  template <int dim>
  bool Domain<dim>::has_extra_layers() const
  {
    return std::any_of(extra_layers.begin(), extra_layers.end(), [](const auto n) {
      return n > 0;
    });
  }


  template <int dim>
  bool Domain<dim>::shows(const Point<dim> &p) const
  {
    return !has_extra_layers() || contains(p);
  }


  template <int dim>
  PhaseMap Domain<dim>::image_of_body() const
  {
    if constexpr (dim == 2)
      return image->without(extra_layers);
    return *image;
  }


#define PERIDEAL_INSTANTIATE(dim)                                 \
  template void     Domain<dim>::declare_extra_layers();          \
  template void     Domain<dim>::parse_extra_layers();            \
  template bool     Domain<dim>::has_extra_layers() const;        \
  template bool     Domain<dim>::shows(const Point<dim> &) const; \
  template PhaseMap Domain<dim>::image_of_body() const;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
