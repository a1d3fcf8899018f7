// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/base/tensor.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/memory.h>
#include <perideal/base/text_file.h>
#include <perideal/base/user_error.h>
#include <perideal/scene/boundary_conditions.h>
#include <perideal/scene/cell_lines.h>
#include <perideal/scene/domain.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>
#include <vector>

// Which cells of the lattice there are: those of an image, and extra layers around the body.

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** "0.5, 0.5": the same number for each direction. */
    template <int dim>
    std::string repeated(const std::string &number)
    {
      std::string text = number;
      for (unsigned int d = 1; d < dim; ++d)
        text += ", " + number;
      return text;
    }


    /** Spacing nearest to the wanted one that divides all edges, or 0 if there is none with nearly
     * as many cells. */
    template <int dim>
    double nearest_fitting_spacing(const Tensor<1, dim> &edges, const double wanted)
    {
      double       best     = 0.;
      const double n_wanted = std::round(edges[0] / wanted);
      for (double n = std::max(1., n_wanted - 500.); n <= n_wanted + 500.; ++n)
        {
          const double spacing = edges[0] / n;
          bool         fits    = true;
          for (unsigned int d = 1; d < dim; ++d)
            {
              const double m = std::round(edges[d] / spacing);
              fits           = fits && m >= 1. && std::abs(edges[d] / spacing - m) < 1e-9 * m;
            }
          if (fits && std::abs(spacing - wanted) < std::abs(best - wanted))
            best = spacing;
        }
      return best;
    }
  } // namespace


  template <int dim>
  Domain<dim>::Domain()
    : SceneSection("Domain")
  {
    declare(shape, "Shape", "box", {"box", "plate with hole", "mesh file", "image", "generator"}) =
      "The body: a box of equal cells, such a box with a hole, a mesh read from a file, the pixels of an image (in two "
      "dimensions), or a mesh of one of deal.II's generators.";
    declare("Lower corner", EntryType::list, repeated<dim>("0"), "length") =
      "The corner of the box with the smallest coordinates, one number per direction.";
    declare("Upper corner", EntryType::list, repeated<dim>("1"), "length") =
      "The corner of the box with the largest coordinates, one number per direction.";
    declare("Cells", EntryType::list, repeated<dim>("20"), "1") =
      "Number of cells of the box, one number per direction.";
    declare("Node spacing", EntryType::text, "", "length") =
      "Edge length of the cells, instead of Cells. It must divide every edge of the box.";
    declare("Cell lines", EntryType::list, "", "length") =
      "Of a box, instead of both, where lines or planes between cells of unequal size lie: the coordinates for each direction, from one side to the other, directions separated by `;`, as `0, 0.3, 1 ; 0, 1`. "
      "`Refinements` halves these cells. It is a mesh that is no lattice.";
    declare("Nodes", EntryType::choice, "auto", "", {"vertices", "cell centers", "auto"}) =
      "Where the peridynamic nodes sit: `auto` is cell centers with `Shape = image`, else vertices. Finite elements use the vertices "
      "in any case.";
    declare("Hole center", EntryType::list, repeated<dim>("0.5"), "length") =
      "Plate with a hole: its centre. Lattice cells whose centre is nearer than the radius do "
      "not exist. In 3D the hole is a bore along z.";
    declare("Holes", EntryType::list, "", "length") =
      "Holes in a box or in a plate with a hole, several separated by `;`: `circle: x, y, radius`, `rectangle: x, y, x, y` (its lower left and its upper right corner) and "
      "`polygon: x, y, x, y, ...` (its corners). Lattice cells whose centre lies in one do not exist, nor those that a thin polygon needs to be open from end to end, a cell wide; all their rims are the side `hole`. In 3D they are bores along z.";
    declare(holes.radius, "Hole radius", "0.25", "length") =
      "Radius of a circular hole, half the edge of a square one.";
    declare(holes.shape, "Hole shape", "circle", {"circle", "square"}) = "Shape of the hole.";
    declare(holes.angle, "Hole angle", "0", "degrees") =
      "A square hole is turned by this angle, counterclockwise.";
    declare_mesh();
    declare("Image", EntryType::text) =
      "With `Shape = image`: a PNG, PGM or PPM file, relative to the working directory or else to the folder of the scene file. "
      "Its top row is the largest y.";
    declare("Image colors", EntryType::list) =
      "What the pixels are: `name: colour`, several separated by `;`. A colour is `rgb(255,0,0)`, one grey `128`, or a range of "
      "greys `40..140` (0.299 red + 0.587 green + 0.114 blue), which counts where no colour is near. A name may come several times. Names are "
      "phases of the material, as in section `Material/Phases`; the name `void` is where there is none, and so are transparent pixels.";
    declare("Color tolerance", EntryType::number, "30", "1") =
      "How far a pixel may be from the nearest colour of `Image colors`, as a distance in (red, green, blue) from 0 to 441.";
    declare("Pixels per cell", EntryType::whole_number, "1", "1") =
      "Edge of the block of pixels that is one cell, of the phase of its middle pixel (of an even number, that right of and below the "
      "middle). Incomplete blocks at the right and lower edge are left out.";
    declare("Cells per pixel", EntryType::whole_number, "1", "1") =
      "Edge of the block of cells that one pixel, or one block of pixels, is divided into.";
    declare("Pixel size", EntryType::text, "", "length") =
      "Edge of a pixel; the image then begins at `Lower corner`. Empty: it fills the box between `Lower corner` and `Upper corner`.";
    declare(islands.rule, "Islands", "error", {"error", "remove", "pin"}) =
      "What to do with parts of an image that no side holds, where the solution would not be determined: an error that names them; "
      "`remove` them; or `pin` each at two of its points (elasticity).";
    declare("Extra layers", EntryType::list, "0", "1") =
      "Rows of cells that are added outside the sides of the body and left out of the results (elasticity): a number for all sides, or "
      "`left: 10; right: 10`. Boundary conditions act on their outer sides; forces on sides and energies are those of the whole.";
    declare("Extra layers phase", EntryType::text) =
      "With `Shape = image`: the phase of the extra layers. Empty: that of the nearest cell of the image.";
    parse();
  }


  template <int dim>
  void Domain<dim>::declare_mesh()
  {
    declare(coarsening.times, "Coarsening", "0") =
      "How often cells may be merged, two in each direction, away from where they have to stay as fine as `Cells` says: a graded mesh "
      "with hanging nodes. `Cells` must allow as many halvings; of a mesh that is no lattice `Refinements` must. Only for a box and for such meshes, and not for peridynamics alone.";
    declare("Fine where", EntryType::text, "auto") =
      "With `Coarsening`: cells stay fine where this formula of x, y, z is greater than 0, and in the zone of section `Coupling` if "
      "the model `coupled` runs. `auto`: in that zone, thus around cracks, for all models. `crack ends`: at the ends of cracks, in three dimensions their "
      "edges, and in that zone likewise. `corners`: besides, at corners of the body that a mesh has, where its sides open to more than 200 degrees inside, and where on a smooth side given values end. "
      "Beyond, there are at least two cells of each size.";
    declare(coarsening.refinements, "Refinements", "0") =
      "How often the cells of a mesh file, of a generator, of a plate with fitted rims or between `Cell lines` are halved in each direction. Round sides of the latter two stay round.";
    declare(holes.rims, "Rims", "stairs", {"stairs", "fitted"}) =
      "Of holes in a box or a plate: `stairs` removes cells of the lattice; `fitted` lets the mesh follow their rims, a row of cells around each hole and `Refinements` halving them all. A mesh that is no lattice needs a `Horizon` that is a length for bonds.";
    declare(files.generator, "Generator", "") =
      "With `Shape = generator`: the name of one of deal.II's `GridGenerator`, such as hyper_shell, plate_with_a_hole, hyper_L. Sides have the numbers that it gives them.";
    declare(files.arguments, "Generator arguments", "") =
      "Its arguments as deal.II's `generate_from_name_and_arguments` reads them: separated by `:`, coordinates of a point by `,`.";
    declare(files.mesh, "Mesh file", "") =
      "The mesh, relative to the working directory or else to the folder of the scene file: of Gmsh (.msh), and by the Python package of Abaqus (.inp), Exodus (.e), "
      "UNV (.unv) and what meshio reads. Triangles, tetrahedra and wedges are divided. Its groups and sets name sides and regions, which `perideal check` tells; give `Horizon` as a length.";
  }


  template <int dim>
  Tensor<1, dim> Domain<dim>::spacing() const
  {
    Tensor<1, dim> h;
    for (unsigned int d = 0; d < dim; ++d)
      h[d] = (upper[d] - lower[d]) / cells[d] /
             (is_box() && !has_lattice() ? std::exp2(coarsening.refinements) : 1.);
    return h;
  }


  template <int dim>
  bool Domain<dim>::contains(const Point<dim> &p) const
  {
    bool inside = true;
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double slack = 1e-9 * (upper[d] - lower[d]);
        inside             = inside && p[d] >= extra.body_lower[d] - slack &&
                 p[d] <= extra.body_upper[d] + slack;
      }
    return inside;
  }


  template <int dim>
  void Domain<dim>::require_countable(const std::string &entry) const
  {
    double n_nodes = 1.;
    for (unsigned int d = 0; d < dim; ++d)
      n_nodes *= cells[d] + 1.;
    if (n_nodes > std::numeric_limits<types::global_dof_index>::max())
      error(entry,
            "gives " + number_text(n_nodes) + " nodes, more than the " +
              std::to_string(std::numeric_limits<types::global_dof_index>::max()) +
              " that this deal.II can number.");
  }


  template <int dim>
  unsigned int Domain<dim>::count(const std::string &entry) const
  {
    return parse_whole_number(text(entry), where(entry));
  }


  template <int dim>
  void Domain<dim>::parse_cells()
  {
    if (text("Node spacing").empty())
      {
        const std::vector<std::string> pieces = split_list(text("Cells"), ',');
        if (pieces.size() != dim)
          error("Cells",
                "needs " + std::to_string(dim) + " numbers, found " +
                  std::to_string(pieces.size()) + "." + hint_at_commas(text("Cells"), dim));
        for (unsigned int d = 0; d < dim; ++d)
          {
            cells[d] = parse_whole_number(pieces[d], where("Cells"), 1000000000u);
            refuse(cells[d] == 0, "Cells", "found 0, needs at least one cell in each direction.");
          }
        require_countable("Cells");
        return;
      }
    refuse(is_given("Cells"), "Node spacing", "'Cells' is given, too: give one of the two.");
    const double wanted = parse_number(text("Node spacing"), where("Node spacing"));
    if (!(wanted > 0.))
      error("Node spacing",
            "found " + text("Node spacing") + ", needs a length greater than 0 (or nothing).");
    bool fits = true;
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double n = (upper[d] - lower[d]) / wanted, n_cells = std::max(1., std::round(n));
        if (n_cells > 1e9)
          error("Node spacing",
                "found " + text("Node spacing") + ", more than 1e9 cells in a row.");
        fits     = fits && std::abs(n - n_cells) <= 1e-6 * n_cells;
        cells[d] = static_cast<unsigned int>(n_cells);
      }
    require_countable("Node spacing");
    if (fits)
      return;
    const double nearest = nearest_fitting_spacing<dim>(upper - lower, wanted);
    error("Node spacing",
          text("Node spacing") + " does not divide the edges of the box; " +
            (nearest > 0. ? "the nearest spacing that does is " + number_text(nearest) + "." :
                            "no spacing near it does, give 'Cells' instead."));
  }


  template <int dim>
  void Domain<dim>::parse_fine_part()
  {
    coarsening.at_corners = trimmed(text("Fine where")) == "corners";
    coarsening.at_ends    = trimmed(text("Fine where")) == "crack ends" || coarsening.at_corners;
    coarsening.by_formula = text("Fine where") != "auto" && !coarsening.at_ends;
    if ((coarsening.by_formula || coarsening.at_ends) && coarsening.times == 0)
      error("Fine where", "has no effect: 'Coarsening' is 0, so all cells are fine.");
    if (coarsening.times == 0)
      return;
    if (shape != Shape::box && has_lattice())
      error("Coarsening",
            "found " + text("Coarsening") + ", but 'Shape' is '" + text("Shape") +
              "': only the lattice of a box has cells to merge. Use 0.");
    refuse(!has_lattice() && coarsening.times > coarsening.refinements,
           "Coarsening",
           "found " + text("Coarsening") + ", but 'Refinements' is " + text("Refinements") +
             ": cells cannot be larger than those of the mesh.");
    for (unsigned int d = 0; has_lattice() && d < dim; ++d)
      if (coarsening.times > 20 || cells[d] % (1u << coarsening.times) != 0)
        {
          unsigned int possible = 0;
          while (possible < 20 && cells[d] % (2u << possible) == 0)
            ++possible;
          error("Coarsening",
                "found " + text("Coarsening") + ", but " + std::to_string(cells[d]) +
                  " cells in a row can be halved " + std::to_string(possible) +
                  (possible == 1 ? " time" : " times") +
                  " only. Choose 'Cells' divisible by a higher power of two, or at most " +
                  std::to_string(possible) + " here.");
        }
    if (!coarsening.by_formula)
      return;
    coarsening.fine = Expression(text("Fine where"), where("Fine where"), "x, y, z");
    if (coarsening.fine.depends_on_time())
      error("Fine where", "found '" + text("Fine where") + "'; the formula may not depend on t.");
  }


  template <int dim>
  void Domain<dim>::parse_hole()
  {
    const std::size_t n_holes =
      std::max(split_list(text("Hole center"), ';').size(),
               (split_list(text("Hole center"), ',').size() + dim - 1) / dim);
    if (n_holes > 1)
      error(
        "Hole center",
        "found '" + text("Hole center") + "', the centres of " + std::to_string(n_holes) +
          " holes: it is that of one. Several go into 'Holes', 'circle: x, y, radius ; circle: ...'.");
    holes.center = parse_point<dim>(text("Hole center"), where("Hole center"));
    if (shape != Shape::plate_with_hole)
      return;
    refuse(dim == 1, "Shape", "a plate with a hole needs 'Dimension' 2 or 3.");
    refuse(!(holes.radius > 0.),
           "Hole radius",
           "found " + text("Hole radius") + ", needs a number greater than 0.");
    if (!contains(holes.center))
      error("Hole center", "(" + text("Hole center") + ") lies outside the body.");
  }


  template <int dim>
  void Domain<dim>::parse_listed_holes()
  {
    holes.listed = parse_holes(text("Holes"), where("Holes"));
    if (holes.listed.empty())
      return;
    if (shape == Shape::mesh_file || shape == Shape::image || shape == Shape::generator)
      error("Holes",
            "is for 'Shape = box' and 'plate with hole'; this body has its holes in the " +
              std::string(shape == Shape::image     ? "image." :
                          shape == Shape::generator ? "mesh of its generator." :
                                                      "mesh file."));
    refuse(dim == 1, "Holes", "needs 'Dimension' 2 or 3.");
    holes.has_one = shape == Shape::plate_with_hole &&
                    (is_given("Hole center") || is_given("Hole radius"));
    shape = Shape::plate_with_hole;
    if (holes.fitted())
      return;
    const std::array<unsigned int, 2> n_cells{{cells[0], cells[dim > 1]}};
    std::vector<Hole>                 joints;
    for (const Hole &hole : holes.listed)
      {
        const HoleCells found = cells_of_hole(hole,
                                              holes.listed,
                                              Point<2>(lower[0], lower[dim > 1]),
                                              Point<2>(upper[0], upper[dim > 1]),
                                              n_cells);
        if (found.n_removed == 0)
          error(
            "Holes",
            "'" + hole.text +
              "' holds no centre of a cell: it lies outside the body, or is smaller than a cell. Move it, or take more 'Cells'.");
        if (found.joints.empty())
          continue;
        joints.insert(joints.end(), found.joints.begin(), found.joints.end());
        notes.push_back(
          "'" + hole.text + "' (entry 'Holes' in section 'Domain') is thin for the cells: of the " +
          std::to_string(found.n_removed) + " that are removed for it, " +
          std::to_string(found.joints.size()) +
          " have their centre beside it, so that it is open all along. It is a cell wide there. Thin holes that meet are better one polygon: where they do, cells may stay joined at a corner.");
      }
    std::sort(joints.begin(), joints.end(), [](const Hole &a, const Hole &b) {
      return std::make_pair(a.corners[0][1], a.corners[0][0]) <
             std::make_pair(b.corners[0][1], b.corners[0][0]);
    });
    holes.listed.insert(holes.listed.end(), joints.begin(), joints.end());
  }


  template <int dim>
  void Domain<dim>::use_own_mesh()
  {
    files.own_mesh = true;
    set("Shape", "mesh file");
  }


  namespace
  {
    /** `Cell lines`: the mesh is no lattice, as with rims that are fitted. */
    template <int dim>
    void take_lines(Domain<dim> &domain)
    {
      const std::string entry = "Cell lines";
      if (domain.text(entry).empty())
        return;
      domain.refuse(dim == 1 || !domain.is_box() || !domain.text("Holes").empty() ||
                      domain.has_extra_layers(),
                    entry,
                    "is for boxes in 2 and 3 dimensions, without 'Holes' and 'Extra layers'.");
      const auto lines = cell_lines(domain);
      for (unsigned int d = 0; d < dim; ++d)
        domain.cells[d] = lines[d].size() - 1;
      domain.holes.rims = Rims::fitted;
    }
  } // namespace


  template <int dim>
  void Domain<dim>::parse()
  {
    SceneSection::parse();
    nodes = text("Nodes") == "cell centers" || (text("Nodes") == "auto" && is_image()) ?
              NodePlacement::cell_centers :
              NodePlacement::vertices;
    lower = parse_point<dim>(text("Lower corner"), where("Lower corner"));
    upper = parse_point<dim>(text("Upper corner"), where("Upper corner"));
    image.reset();
    islands.pins.clear();
    notes.clear();
    if (shape == Shape::image)
      parse_image(); // the pixels may say where the upper corner is
    for (unsigned int d = 0; d < dim; ++d)
      if (!(lower[d] < upper[d]))
        error("Upper corner",
              "its coordinate " + std::to_string(d + 1) + " (" + number_text(upper[d]) +
                ") must be greater than that of 'Lower corner' (" + number_text(lower[d]) + ").");
    if (shape != Shape::image)
      {
        for (const std::string entry : {"Image",
                                        "Image colors",
                                        "Color tolerance",
                                        "Pixels per cell",
                                        "Cells per pixel",
                                        "Pixel size",
                                        "Islands"})
          refuse(is_given(entry),
                 entry,
                 "is given, but 'Shape' is '" + text("Shape") + "', not 'image'.");
        parse_cells();
      }
    parse_extra_layers();
    take_lines(*this);
    parse_hole();
    holes.has_one = shape == Shape::plate_with_hole;
    parse_listed_holes();
    parse_mesh();
    parse_fine_part();
  }


  namespace
  {
    /** Those of generate_from_name_and_arguments() that make quadrilaterals or hexahedra. */
    const std::vector<std::string> &generator_names()
    {
      static const std::vector<std::string> names = {"channel_with_cylinder",
                                                     "cheese",
                                                     "concentric_hyper_shells",
                                                     "cylinder",
                                                     "cylinder_shell",
                                                     "eccentric_hyper_shell",
                                                     "enclosed_hyper_cube",
                                                     "general_cell",
                                                     "half_hyper_ball",
                                                     "half_hyper_shell",
                                                     "hyper_L",
                                                     "hyper_ball",
                                                     "hyper_ball_balanced",
                                                     "hyper_cross",
                                                     "hyper_cube",
                                                     "hyper_cube_slit",
                                                     "hyper_cube_with_cylindrical_hole",
                                                     "hyper_rectangle",
                                                     "hyper_shell",
                                                     "moebius",
                                                     "pipe_junction",
                                                     "plate_with_a_hole",
                                                     "quarter_hyper_ball",
                                                     "quarter_hyper_shell",
                                                     "simplex",
                                                     "subdivided_cylinder",
                                                     "subdivided_hyper_cube",
                                                     "subdivided_hyper_rectangle",
                                                     "torus",
                                                     "truncated_cone"};
      return names;
    }
  } // namespace


  template <int dim>
  void Domain<dim>::parse_mesh()
  {
    constexpr unsigned int most = 12;
    if (shape == Shape::mesh_file && files.mesh.empty() && !files.own_mesh)
      error("Mesh file", "is empty, but 'Shape' is 'mesh file'.");
    if (shape != Shape::mesh_file && !files.mesh.empty())
      error("Mesh file", "is given, but 'Shape' is '" + text("Shape") + "', not 'mesh file'.");
    for (const std::string entry : {"Generator", "Generator arguments"})
      refuse(shape != Shape::generator && !text(entry).empty(),
             entry,
             "is given, but 'Shape' is '" + text("Shape") + "', not 'generator'.");
    if (shape == Shape::generator)
      choice_of(files.generator, generator_names(), where("Generator"));
    refuse(text("Rims") == "fitted" && shape != Shape::plate_with_hole,
           "Rims",
           "is 'fitted', but there is no hole: give 'Holes', or 'Shape = plate with hole'.");
    refuse(holes.fitted() && has_extra_layers(),
           "Rims",
           "is 'fitted', a mesh that 'Extra layers' cannot be added to. Use 'stairs'.");
    refuse(coarsening.refinements > 0 && has_lattice(),
           "Refinements",
           "found " + text("Refinements") + ", but the body is a lattice, as fine as " +
             (is_image() ? "'Cells per pixel'" : "'Cells'") + " says. Use 0" +
             (shape == Shape::plate_with_hole ? ", or 'Rims = fitted'." : "."));
    refuse(coarsening.refinements > most,
           "Refinements",
           "found " + text("Refinements") + ", needs at most " + std::to_string(most) + ".");
  }


  template <int dim>
  std::string Domain<dim>::mesh_text() const
  {
    return shape == Shape::mesh_file ? files.mesh :
           shape == Shape::generator ? "of " + files.generator :
                                       "of the plate";
  }


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
  void Domain<dim>::parse_image()
  {
    refuse(dim != 2, "Shape", "'image' needs 'Dimension' 2.");
    for (const std::string entry : {"Cells", "Node spacing"})
      if (is_given(entry))
        error(
          entry,
          "is given, but with 'Shape = image' the pixels are the cells; use 'Pixels per cell' or 'Cells per pixel'.");
    refuse(text("Image").empty(), "Image", "is empty, but 'Shape' is 'image'.");
    const double tolerance = parse_number(text("Color tolerance"), where("Color tolerance"));
    if (tolerance < 0.)
      error("Color tolerance", "found " + text("Color tolerance") + ", needs 0 or more.");
    for (const std::string entry : {"Pixels per cell", "Cells per pixel"})
      if (count(entry) < 1 || count(entry) > 1000)
        error(entry, "found " + text(entry) + ", needs a number from 1 to 1000.");

    const std::filesystem::path beside = std::filesystem::path(files.folder) / text("Image");
    files.image = std::filesystem::exists(text("Image")) || !std::filesystem::exists(beside) ?
                    text("Image") :
                    beside.string();
    if (!std::filesystem::exists(files.image))
      error("Image",
            "there is no file '" + text("Image") + "'" +
              places_looked_at(text("Image"), files.folder));
    Picture picture;
    try
      {
        picture = read_picture(files.image, files.communicator);
      }
    catch (const UserError &fault)
      {
        error("Image", fault.message());
      }
    if (text("Image colors").empty())
      error("Image colors",
            "is empty; it says which colour is which phase. The colours of the image are: " +
              frequent_colors(picture, 6) + ".");
    const unsigned int block = count("Pixels per cell");
    if (picture.n_columns < block || picture.n_rows < block)
      error("Pixels per cell",
            "found " + text("Pixels per cell") + ", more than the image has: " +
              std::to_string(picture.n_columns) + " x " + std::to_string(picture.n_rows) + ".");
    constexpr double   bytes_of_cell = 16.; // of what every process knows of the image
    const unsigned int n_parts       = count("Cells per pixel");
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
    image = std::make_shared<PhaseMap>(
      make_phase_map(picture, colors, block, n_parts, where("Image colors")));
    for (unsigned int d = 0; d < dim; ++d)
      cells[d] = image->n_cells[std::min(d, 1u)];
    require_countable("Image");
    if (!text("Pixel size").empty())
      {
        const double size = parse_number(text("Pixel size"), where("Pixel size"));
        refuse(!(size > 0.),
               "Pixel size",
               "found " + text("Pixel size") + ", needs a length greater than 0.");
        refuse(is_given("Upper corner"),
               "Pixel size",
               "'Upper corner' is given, too: give one of the two.");
        for (unsigned int d = 0; d < dim; ++d)
          upper[d] = lower[d] + size * block / n_parts * cells[d];
      }
    for (unsigned int d = 0; d < dim && d < 2; ++d)
      {
        image->lower[d]   = lower[d];
        image->spacing[d] = (upper[d] - lower[d]) / cells[d];
      }
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
    return (shape == Shape::plate_with_hole && !holes.fitted()) || (image && image->has_voids());
  }


  template <int dim>
  void Domain<dim>::parse_extra_layers()
  {
    extra.body_lower        = lower;
    extra.body_upper        = upper;
    extra.layers            = parse_layers<dim>(text("Extra layers"), where("Extra layers"));
    const bool        any   = has_extra_layers();
    const std::string phase = text("Extra layers phase");
    if (!phase.empty() && (!any || !image))
      error("Extra layers phase",
            any ? "has no effect: 'Shape' is not 'image'." : "has no effect: 'Extra layers' is 0.");
    if (!any)
      return;
    if (shape == Shape::mesh_file)
      error("Extra layers",
            "found " + text("Extra layers") + ", but a mesh file has no rows of cells. Use 0.");
    refuse(coarsening.times > 0, "Extra layers", "goes with 'Coarsening = 0' only.");
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
  PhaseMap Domain<dim>::image_of_body() const
  {
    if constexpr (dim == 2)
      return image->without(extra.layers);
    return *image;
  }


  PERIDEAL_INSTANTIATE_CLASS(class Domain);
} // namespace PeriDeal
