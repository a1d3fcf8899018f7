// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Which cells of the lattice there are: those of an image, and extra layers around the body.

#include <deal.II/base/mpi.h>

#include <perideal/base/memory.h>
#include <perideal/base/text_file.h>
#include <perideal/base/user_error.h>
#include <perideal/scene/boundary_conditions.h>
#include <perideal/scene/domain.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <vector>

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
  void Domain<dim>::declare_image()
  {
    declare(
      "Image",
      EntryType::text,
      "",
      "",
      "With `Shape = image`: a PNG, PGM or PPM file, relative to the working directory or else to the folder of the scene file. "
      "Its top row is the largest y.");
    declare(
      "Image colors",
      EntryType::list,
      "",
      "",
      "What the pixels are: `name: colour`, several separated by `;`. A colour is `rgb(255,0,0)`, one grey `128`, or a range of "
      "greys `40..140` (0.299 red + 0.587 green + 0.114 blue), which counts where no colour is near. A name may come several times. Names are "
      "phases of the material, as in section `Material/Phases`; the name `void` is where there is none, and so are transparent pixels.");
    declare(
      "Color tolerance",
      EntryType::number,
      "30",
      "1",
      "How far a pixel may be from the nearest colour of `Image colors`, as a distance in (red, green, blue) from 0 to 441.");
    declare(
      "Pixels per cell",
      EntryType::whole_number,
      "1",
      "1",
      "Edge of the block of pixels that is one cell, of the phase of its middle pixel (of an even number, that right of and below the "
      "middle). Incomplete blocks at the right and lower edge are left out.");
    declare("Cells per pixel",
            EntryType::whole_number,
            "1",
            "1",
            "Edge of the block of cells that one pixel, or one block of pixels, is divided into.");
    declare(
      "Pixel size",
      EntryType::text,
      "",
      "length",
      "Edge of a pixel; the image then begins at `Lower corner`. Empty: it fills the box between `Lower corner` and `Upper corner`.");
    declare(
      "Islands",
      EntryType::choice,
      "error",
      "",
      "What to do with parts of an image that no side holds, where the solution would not be determined: an error that names them; "
      "`remove` them; or `pin` each at two of its points (elasticity).",
      {"error", "remove", "pin"});
  }


  template <int dim>
  void Domain<dim>::refuse_image_entries() const
  {
    for (const std::string entry : {"Image",
                                    "Image colors",
                                    "Color tolerance",
                                    "Pixels per cell",
                                    "Cells per pixel",
                                    "Pixel size",
                                    "Islands"})
      if (is_given(entry))
        error(entry, "is given, but 'Shape' is '" + text("Shape") + "', not 'image'.");
  }


  template <int dim>
  void Domain<dim>::set_size_of_image()
  {
    if (text("Pixel size").empty())
      return;
    const double size = parse_number(text("Pixel size"), where("Pixel size"));
    if (!(size > 0.))
      error("Pixel size", "found " + text("Pixel size") + ", needs a length greater than 0.");
    if (is_given("Upper corner"))
      error("Pixel size", "'Upper corner' is given, too: give one of the two.");
    const double cell = size * whole_number("Pixels per cell") / whole_number("Cells per pixel");
    for (unsigned int d = 0; d < dim; ++d)
      upper[d] = lower[d] + cell * cells[d];
  }


  template <int dim>
  void Domain<dim>::parse_image()
  {
    refuse(dim != 2, "Shape", "'image' needs 'Dimension' 2.");
    for (const std::string entry : {"Cells", "Node spacing"})
      if (is_given(entry))
        error(
          entry,
          "is given, but with 'Shape = image' the pixels are the cells; use 'Pixels per cell' or 'Cells per pixel'.");
    refuse(text("Image").empty(), "Image", "is empty, but 'Shape' is 'image'.");
    const double tolerance = number("Color tolerance");
    if (tolerance < 0.)
      error("Color tolerance", "found " + text("Color tolerance") + ", needs 0 or more.");
    for (const std::string entry : {"Pixels per cell", "Cells per pixel"})
      if (whole_number(entry) < 1 || whole_number(entry) > 1000)
        error(entry, "found " + text(entry) + ", needs a number from 1 to 1000.");

    const std::filesystem::path beside = std::filesystem::path(files.folder) / text("Image");
    image_file = std::filesystem::exists(text("Image")) || !std::filesystem::exists(beside) ?
                   text("Image") :
                   beside.string();
    if (!std::filesystem::exists(image_file))
      error("Image",
            "there is no file '" + text("Image") + "'" +
              places_looked_at(text("Image"), files.folder));
    Picture picture;
    try
      {
        picture = read_picture(image_file, files.communicator);
      }
    catch (const UserError &fault)
      {
        error("Image", fault.message());
      }
    if (text("Image colors").empty())
      error("Image colors",
            "is empty; it says which colour is which phase. The colours of the image are: " +
              frequent_colors(picture, 6) + ".");
    const unsigned int block = whole_number("Pixels per cell");
    if (picture.n_columns < block || picture.n_rows < block)
      error("Pixels per cell",
            "found " + text("Pixels per cell") + ", more than the image has: " +
              std::to_string(picture.n_columns) + " x " + std::to_string(picture.n_rows) + ".");
    constexpr double   bytes_of_cell = 16.; // of what every process knows of the image
    const unsigned int n_parts       = whole_number("Cells per pixel");
    const double       n_cells =
      std::pow(n_parts, 2.) * (picture.n_columns / block) * (picture.n_rows / block);
    const double room =
      available_memory(files.communicator) / Utilities::MPI::n_mpi_processes(files.communicator);
    if (n_cells * bytes_of_cell > room || n_cells > std::numeric_limits<unsigned int>::max())
      error(n_parts > 1 ? "Cells per pixel" : "Pixels per cell",
            "found " + text(n_parts > 1 ? "Cells per pixel" : "Pixels per cell") +
              ", which makes " + number_text(n_cells) + " cells of the " +
              std::to_string(picture.n_columns) + " x " + std::to_string(picture.n_rows) +
              " pixels, more than memory can hold.");
    const ImageColors colors(text("Image colors"), tolerance, where("Image colors"));
    image = std::make_shared<PhaseMap>(make_phase_map(picture,
                                                      colors,
                                                      block,
                                                      whole_number("Cells per pixel"),
                                                      where("Image colors")));
    for (unsigned int d = 0; d < dim; ++d)
      cells[d] = image->n_cells[std::min(d, 1u)];
    require_countable("Image");
    set_size_of_image();
    for (unsigned int d = 0; d < dim && d < 2; ++d)
      {
        image->lower[d]   = lower[d];
        image->spacing[d] = (upper[d] - lower[d]) / cells[d];
      }
    islands.rule = choice<IslandRule>("Islands");
    if (picture.n_columns % block != 0 || picture.n_rows % block != 0)
      notes.push_back("'Pixels per cell' leaves out " + std::to_string(picture.n_columns % block) +
                      " columns of pixels at the right and " +
                      std::to_string(picture.n_rows % block) + " rows at the lower edge.");
  }


  template <int dim>
  bool Domain<dim>::has_cell_at(const Point<dim> &center) const
  {
    if constexpr (dim == 2)
      if (image)
        return image->at(center[0], center[1]) != PhaseMap::empty;
    return !holes.contains(center);
  }


  template <int dim>
  bool Domain<dim>::has_voids() const
  {
    return shape == Shape::plate_with_hole || (image && image->has_voids());
  }


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
    extra.body_lower = lower;
    extra.body_upper = upper;
    extra.layers     = parse_layers<dim>(text("Extra layers"), where("Extra layers"));
    const bool any =
      std::any_of(extra.layers.begin(), extra.layers.end(), [](const auto n) { return n > 0; });
    const std::string phase = text("Extra layers phase");
    if (!phase.empty() && (!any || !image))
      error("Extra layers phase",
            any ? "has no effect: 'Shape' is not 'image'." : "has no effect: 'Extra layers' is 0.");
    if (!any)
      return;
    if (shape == Shape::mesh_file)
      error("Extra layers",
            "found " + text("Extra layers") + ", but a mesh file has no rows of cells. Use 0.");
    refuse(whole_number("Coarsening") > 0, "Extra layers", "goes with 'Coarsening = 0' only.");
    const Tensor<1, dim> h = spacing();
    for (unsigned int d = 0; d < dim; ++d)
      {
        lower[d] -= h[d] * extra.layers[2 * d];
        upper[d] += h[d] * extra.layers[2 * d + 1];
        cells[d] += extra.layers[2 * d] + extra.layers[2 * d + 1];
      }
    require_countable("Extra layers");
    if constexpr (dim == 2)
      if (image)
        *image = image->surrounded(
          extra.layers,
          phase.empty() ?
            PhaseMap::nearest :
            static_cast<int>(choice_of(phase, image->names, where("Extra layers phase"))));
  }


  template <int dim>
  bool Domain<dim>::has_extra_layers() const
  {
    return std::any_of(extra.layers.begin(), extra.layers.end(), [](const auto n) {
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
      return image->without(extra.layers);
    return *image;
  }


#define PERIDEAL_INSTANTIATE(dim)                                       \
  template void     Domain<dim>::declare_image();                       \
  template void     Domain<dim>::refuse_image_entries() const;          \
  template void     Domain<dim>::set_size_of_image();                   \
  template void     Domain<dim>::parse_image();                         \
  template bool     Domain<dim>::has_voids() const;                     \
  template bool     Domain<dim>::has_cell_at(const Point<dim> &) const; \
  template void     Domain<dim>::declare_extra_layers();                \
  template void     Domain<dim>::parse_extra_layers();                  \
  template bool     Domain<dim>::has_extra_layers() const;              \
  template bool     Domain<dim>::shows(const Point<dim> &) const;       \
  template PhaseMap Domain<dim>::image_of_body() const;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
