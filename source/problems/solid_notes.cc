// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/geometry_info.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/tria.h>
#include <deal.II/numerics/rtree.h>

#include <perideal/base/connected_sets.h>
#include <perideal/base/gathered_lists.h>
#include <perideal/base/instantiate.h>
#include <perideal/base/place_text.h>
#include <perideal/base/point_order.h>
#include <perideal/base/user_error.h>
#include <perideal/scene/lists.h>
#include <perideal/solvers/static_solver.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>

#include "solid_parts.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    using Corners = std::array<Point<dim>, GeometryInfo<dim>::vertices_per_cell>;


    /** Whether p is in the cell with these corners: Newton's method for its unit coordinates. */
    template <int dim>
    bool is_in_cell(const Corners<dim> &corners, const Point<dim> &p)
    {
      constexpr unsigned int most  = 20;
      constexpr double       slack = 1e-10, far = 4.;
      Point<dim>             unit;
      for (unsigned int d = 0; d < dim; ++d)
        unit[d] = 0.5;
      for (unsigned int n = 0; n < most; ++n)
        {
          Tensor<1, dim> left = p - Point<dim>();
          Tensor<2, dim> slope;
          for (unsigned int v = 0; v < corners.size(); ++v)
            {
              left -=
                GeometryInfo<dim>::d_linear_shape_function(unit, v) * (corners[v] - Point<dim>());
              slope += outer_product(corners[v] - Point<dim>(),
                                     GeometryInfo<dim>::d_linear_shape_function_gradient(unit, v));
            }
          if (determinant(slope) == 0.)
            return false;
          const Tensor<1, dim> change = invert(slope) * left;
          unit += change;
          if (unit.norm() > far)
            return false;
          if (change.norm() < slack)
            break;
        }
      return GeometryInfo<dim>::is_inside_unit_cell(unit, slack);
    }


    /** How far p is from a face, which is taken for a disc in space. */
    template <int dim>
    double distance_from_face(const Corners<dim> &corners,
                              const unsigned int  f,
                              const Point<dim>   &p)
    {
      constexpr unsigned int    n = GeometryInfo<dim>::vertices_per_face;
      std::array<Point<dim>, n> at;
      Point<dim>                middle;
      for (unsigned int v = 0; v < n; ++v)
        {
          at[v] = corners[GeometryInfo<dim>::face_to_cell_vertices(f, v)];
          middle += (at[v] - Point<dim>()) / n;
        }
      const Tensor<1, dim> way = p - middle;
      if constexpr (dim == 1)
        return way.norm();
      else
        {
          Tensor<1, dim> normal;
          if constexpr (dim == 2)
            normal = cross_product_2d(at[1] - at[0]);
          else
            normal = cross_product_3d(at[3] - at[0], at[2] - at[1]);
          if (normal.norm() == 0.)
            return way.norm();
          const double across = way * normal / normal.norm();
          double       radius = 0.;
          for (const Point<dim> &corner : at)
            radius = std::max(radius, corner.distance(middle));
          const double along = std::sqrt(std::max(0., way.norm_square() - across * across));
          return std::hypot(across, std::max(0., along - radius));
        }
    }


    /**
     * The pieces of a body that no cells hold together, as blocks of a mesh file or phases apart by
     * voids, and whether a displacement lets them overlap: nothing is between them at rest, nor in
     * motion with small displacements.
     * What cracks cut is one piece; faces of cracks have a contact of their own (SolidContact).
     *
     * Looked for are corners of the surface of one piece that lie in cells of another one, both
     * deformed. With nodes at the centres of cells these move as they are: an overlap counts from
     * where it is larger than what neighbouring cells move against each other.
     */
    template <int dim>
    class BodyPieces
    {
    public:
      /** Collective. */
      explicit BodyPieces(const SolidProblem<dim> &run)
        : run(run)
      {
        // Coarse cells are known to all processes.
        const Triangulation<dim> &mesh = run.dofs().get_triangulation();
        ConnectedSets             vertices(mesh.n_vertices());
        for (const auto &cell : mesh.cell_iterators_on_level(0))
          for (const unsigned int v : cell->vertex_indices())
            vertices.join(cell->vertex_index(0), cell->vertex_index(v));
        if (run.scene.cracks.on_faces()) // nodes there are doubled
          {
            std::map<Point<dim>, unsigned int, bool (*)(const Point<dim> &, const Point<dim> &)>
              places(comes_first<dim>);
            for (const auto &cell : mesh.cell_iterators_on_level(0))
              for (const unsigned int v : cell->vertex_indices())
                vertices.join(places.emplace(cell->vertex(v), cell->vertex_index(v)).first->second,
                              cell->vertex_index(v));
          }
        std::map<unsigned int, unsigned int> numbers;
        std::vector<double>                  volumes;
        of_coarse.resize(mesh.n_cells(0));
        for (const auto &cell : mesh.cell_iterators_on_level(0))
          {
            const unsigned int root  = vertices.root(cell->vertex_index(0));
            const unsigned int piece = numbers.emplace(root, numbers.size()).first->second;
            of_coarse[cell->index()] = piece;
            volumes.resize(numbers.size());
            middles.resize(numbers.size());
            volumes[piece] += cell->measure();
            middles[piece] += cell->measure() * (cell->center() - Point<dim>());
          }
        n_pieces = numbers.size();
        for (unsigned int piece = 0; piece < n_pieces; ++piece)
          middles[piece] /= volumes[piece];
      }

      /**
       * Where pieces overlap at t, as the end of a note that begins with @p start; empty: nowhere.
       * Nothing is done if the body is one piece. Collective. Throws UserError, with that start, of
       * equilibria, unless `Contact = false` allows it.
       */
      std::string overlap(const double t, const std::string &start) const
      {
        const Overlap deep = n_pieces < 2 ? Overlap() : deepest(Displacement(run));
        if (deep.depth == 0.)
          return "";
        if (run.stepper)
          return text(deep, t) +
                 "nothing is between them here: they pass through each other. With 'Models = peridynamics', 'Kinematics = full' and 'Contact = true' in section 'Elasticity' and 'Stepper = verlet' in section 'Time' they press on each other.";
        const std::string at_rest = "at rest separate pieces do not press on each other; ";
        AssertThrow(
          run.scene.elasticity.text("Contact") == "false",
          UserError(
            start + text(deep, t) + at_rest +
            "in motion they do, by 'Models = peridynamics' with 'Solver = dynamics' and 'Kinematics = full' in section 'Elasticity'. Use that, load them so that they do not meet (with 'Kinematics = linear' all results go with the load, so that a small one will do), join them by cells, "
            "or let them pass through each other: 'Contact = false' in section 'Elasticity', which holds for the faces of cracks, too."));
        return text(deep, t) + at_rest +
               "'Contact = false' in section 'Elasticity' lets them pass through each other.";
      }

    private:
      using Cell = typename DoFHandler<dim>::active_cell_iterator;
      using Box  = BoundingBox<dim>;

      /** A corner of the surface of a piece. */
      struct Corner
      {
        unsigned int piece = 0;
        Point<dim>   at, now; // before and after the displacement
      };

      /** The deepest of those that have been found. */
      struct Overlap
      {
        double       depth = 0.;
        Corner       corner;
        unsigned int other = 0; // the piece that it is in
      };

      /** Displacements of corners of cells. */
      struct Displacement
      {
        explicit Displacement(const SolidProblem<dim> &run)
          : at_corners(run.dofs().get_fe().n_dofs_per_vertex() > 0)
          , unknowns(run.dofs().get_fe().n_dofs_per_cell())
        {
          components.reserve(dim); // a vector that is copied forgets its ghosts
          for (unsigned int d = 0; d < dim; ++d)
            components.push_back(component_of(run.dofs(), run.displacement, dim, d));
        }

        Corners<dim> corners(const Cell &cell) const
        {
          cell->get_dof_indices(unknowns);
          Corners<dim> result;
          for (unsigned int v = 0; v < result.size(); ++v)
            {
              result[v] = cell->vertex(v);
              for (unsigned int d = 0; d < dim; ++d)
                result[v][d] += components[d](unknowns[at_corners ? v : 0]);
            }
          return result;
        }

        const bool                                   at_corners;
        mutable std::vector<types::global_dof_index> unknowns;
        std::vector<Vector>                          components;
      };

      unsigned int piece_of(const Cell &cell) const
      {
        typename Triangulation<dim>::cell_iterator coarse = cell;
        while (coarse->level() > 0)
          coarse = coarse->parent();
        return of_coarse[coarse->index()];
      }

      template <typename Visit>
      void for_each_own_cell(const Visit &visit) const
      {
        for (const auto &cell : run.dofs().active_cell_iterators())
          if (cell->is_locally_owned())
            visit(cell);
      }

      std::vector<Box> boxes(const Displacement &u) const
      {
        // The highest of each coordinate and of minus it.
        std::vector<double> ends(2 * dim * n_pieces, std::numeric_limits<double>::lowest());
        for_each_own_cell([&](const Cell &cell) {
          double *const of_piece = &ends[2 * dim * piece_of(cell)];
          for (const Point<dim> &corner : u.corners(cell))
            for (unsigned int d = 0; d < dim; ++d)
              {
                of_piece[2 * d]     = std::max(of_piece[2 * d], corner[d]);
                of_piece[2 * d + 1] = std::max(of_piece[2 * d + 1], -corner[d]);
              }
        });
        Utilities::MPI::max(ends, run.dofs().get_communicator(), ends);
        std::vector<Box> result;
        for (unsigned int piece = 0; piece < n_pieces; ++piece)
          {
            Point<dim> lower, upper;
            for (unsigned int d = 0; d < dim; ++d)
              {
                upper[d] = ends[2 * (dim * piece + d)];
                lower[d] = -ends[2 * (dim * piece + d) + 1];
              }
            result.emplace_back(std::make_pair(lower, upper));
          }
        return result;
      }

      /** Of surfaces, in the box of another piece. */
      std::vector<Corner> corners_near(const Displacement &u, const std::vector<Box> &boxes) const
      {
        std::vector<double> own;
        for_each_own_cell([&](const Cell &cell) {
          if (!cell->at_boundary())
            return;
          const unsigned int piece   = piece_of(cell);
          const Corners<dim> corners = u.corners(cell);
          for (unsigned int v = 0; v < corners.size(); ++v)
            {
              bool is_near = false;
              for (unsigned int other = 0; other < n_pieces && !is_near; ++other)
                is_near = other != piece && boxes[other].point_inside(corners[v]);
              if (!is_near)
                continue;
              own.push_back(piece);
              for (unsigned int d = 0; d < dim; ++d)
                own.insert(own.end(), {cell->vertex(v)[d], corners[v][d]});
            }
        });
        std::vector<Corner> list;
        for (const std::vector<double> &some : gathered_lists(run.dofs().get_communicator(), own))
          for (auto from = some.begin(); from != some.end();)
            {
              Corner corner;
              corner.piece = static_cast<unsigned int>(*from++);
              for (unsigned int d = 0; d < dim; ++d)
                {
                  corner.at[d]  = *from++;
                  corner.now[d] = *from++;
                }
              list.push_back(corner);
            }
        return list;
      }

      /** Those in another piece, which is named, and farther than a slack from its surface. */
      std::vector<std::pair<unsigned int, Corner>> inside(const Displacement        &u,
                                                          const std::vector<Corner> &corners,
                                                          const double               slack) const
      {
        std::vector<std::pair<Point<dim>, unsigned int>> entries;
        for (unsigned int k = 0; k < corners.size(); ++k)
          entries.emplace_back(corners[k].now, k);
        const auto          tree = pack_rtree(entries);
        std::vector<double> own; // the piece that a corner is in, and the corner
        for_each_own_cell([&](const Cell &cell) {
          const unsigned int piece = piece_of(cell);
          const Corners<dim> now   = u.corners(cell);
          const Box          box(std::vector<Point<dim>>(now.begin(), now.end()));
          const auto         is_at_surface = [&](const Point<dim> &p) {
            for (const unsigned int f : cell->face_indices())
              if (cell->face(f)->at_boundary() && distance_from_face<dim>(now, f, p) <= slack)
                return true;
            return false;
          };
          for (auto entry = tree.qbegin(boost::geometry::index::intersects(box));
               entry != tree.qend();
               ++entry)
            {
              const Corner &corner = corners[entry->second];
              if (corner.piece == piece || is_at_surface(corner.now) ||
                  !is_in_cell(now, corner.now))
                continue;
              own.insert(own.end(), {1. * piece, 1. * entry->second});
            }
        });
        std::vector<std::pair<unsigned int, Corner>> result;
        for (const std::vector<double> &some : gathered_lists(run.dofs().get_communicator(), own))
          for (std::size_t k = 0; k < some.size(); k += 2)
            result.emplace_back(static_cast<unsigned int>(some[k]),
                                corners[static_cast<unsigned int>(some[k + 1])]);
        return result;
      }

      Overlap deepest(const Displacement &u) const
      {
        const MPI_Comm all = run.dofs().get_communicator();
        // Displacements are found to the tolerance of a solver; cells that move as they are overlap
        // by what they should have been strained.
        constexpr double       of_displacement = 1e-6, of_places = 1e-12, nearly = 1e-3;
        double                 largest = 0., farthest = 0., uneven = 0.;
        const std::vector<Box> of_pieces = boxes(u);
        for (const Box &box : of_pieces)
          for (const Point<dim> &end :
               {box.get_boundary_points().first, box.get_boundary_points().second})
            farthest = std::max(farthest, end.norm());
        largest = run.displacement.linfty_norm();
        if (!u.at_corners)
          for_each_own_cell([&](const Cell &cell) {
            for (const unsigned int f : cell->face_indices())
              if (!cell->face(f)->at_boundary() && cell->neighbor(f)->is_active() &&
                  !cell->neighbor(f)->is_artificial())
                {
                  const Cell neighbor(cell->neighbor(f));
                  uneven = std::max(uneven,
                                    ((u.corners(cell)[0] - cell->vertex(0)) -
                                     (u.corners(neighbor)[0] - neighbor->vertex(0)))
                                      .norm());
                }
          });
        const double slack =
          of_displacement * largest + of_places * farthest + Utilities::MPI::max(uneven, all);

        const auto          candidates = inside(u, corners_near(u, of_pieces), slack);
        std::vector<double> depths(candidates.size(), std::numeric_limits<double>::max());
        if (candidates.empty())
          return {};
        for_each_own_cell([&](const Cell &cell) {
          if (!cell->at_boundary())
            return;
          const unsigned int piece = piece_of(cell);
          const Corners<dim> now   = u.corners(cell);
          for (const unsigned int f : cell->face_indices())
            if (cell->face(f)->at_boundary())
              for (std::size_t k = 0; k < candidates.size(); ++k)
                if (candidates[k].first == piece)
                  depths[k] =
                    std::min(depths[k], distance_from_face<dim>(now, f, candidates[k].second.now));
        });
        Utilities::MPI::min(depths, all, depths);
        const double most = *std::max_element(depths.begin(), depths.end());
        if (most <= slack)
          return {};
        // Of many that are as deep the same one on any number of processes.
        const auto is_before = [&](const std::size_t a, const std::size_t b) {
          return comes_first(candidates[a].second.at, candidates[b].second.at);
        };
        std::size_t first = candidates.size();
        for (std::size_t k = 0; k < candidates.size(); ++k)
          if (depths[k] > (1. - nearly) * most &&
              (first == candidates.size() || is_before(k, first)))
            first = k;
        return {depths[first], candidates[first].second, candidates[first].first};
      }

      std::string text(const Overlap &deep, const double t) const
      {
        std::ostringstream message;
        if (!run.scene.time.steady)
          message << " at t = " << t;
        message << ": the one about " << place_text(middles[deep.corner.piece])
                << ", with its corner " << place_text(deep.corner.at) << " displaced to "
                << place_text(deep.corner.now) << ", is " << rounded_text(deep.depth)
                << " deep in the one about " << place_text(middles[deep.other])
                << ". No cells join them, and ";
        return message.str();
      }

      const SolidProblem<dim>  &run;
      unsigned int              n_pieces = 0;
      std::vector<unsigned int> of_coarse; // piece of each coarse cell
      std::vector<Point<dim>>   middles;   // of pieces
    };


    /** `side 'top'`, or `sides 'bottom' (3,340) and 'top' (3,340)`. */
    std::string list_of_sides(const std::map<std::string, unsigned long long> &n_bonds)
    {
      if (n_bonds.size() == 1)
        return "side '" + n_bonds.begin()->first + "'";
      std::string text = "sides ";
      std::size_t left = n_bonds.size();
      for (const auto &[side, n] : n_bonds)
        {
          text += "'" + side + "' (" + readable_count(n) + ")";
          --left;
          text += left == 0 ? "" : left == 1 ? " and " : ", ";
        }
      return text;
    }


    template <int dim>
    void note_torn_sides(const SolidProblem<dim> &run, const RunContext &context)
    {
      const auto &torn = run.op().break_places().beside_loads;
      if (torn.empty())
        return;
      unsigned long long n = 0;
      for (const auto &[side, n_bonds] : torn)
        n += n_bonds;
      context.record.extremes[run.name()]["broken beside loads"] = torn;
      const std::string layer    = "'Traction layer' in section 'Boundary conditions'",
                        tear_off = "They act on the outermost nodes, and tear them off: ";
      const bool  of_file        = !run.scene.domain.has_lattice();
      const auto &parts          = run.scene.boundary_conditions.parts;
      const bool  on_spot        = std::any_of(parts.begin(), parts.end(), [&](const Part &part) {
        return part.kind != Part::of_side && torn.count(part.name) > 0;
      });
      std::string remedy         = tear_off;
      if (on_spot)
        remedy += "spread them over a larger region, or a part of a side";
      else if (of_file)
        remedy += "move the side by 'Displacement' in their place";
      else if (run.scene.boundary_conditions.traction_layer > 0.)
        remedy = layer + " is too thin for them: make it deeper";
      else
        remedy += "spread them by " + layer + ", over a horizon or more";
      if (!on_spot && !of_file &&
          run.scene.peridynamics.surface_correction == SurfaceCorrection::none)
        remedy +=
          ", or let families go on beyond the sides by 'Surface correction = auto' in section 'Peridynamics'";
      context.record.notes.push_back(
        run.name() + ": " + readable_count(n) + (n == 1 ? " bond" : " bonds") +
        " broke beside the loaded " + list_of_sides(torn) +
        " before any did elsewhere. The tractions are more than what they act on bears. " + remedy +
        ". Tractions that come suddenly may be too much all the same.");
    }


    template <int dim>
    void note_steps(const SolidProblem<dim> &run, const RunContext &context)
    {
      const double first    = StepLimit::share * run.stable_step,
                   shortest = run.stepper->shortest_step();
      if (run.scene.time.time_step < 0. && run.stepper->name() == "verlet" && shortest < first)
        context.record.notes.push_back(
          run.name() + ": the automatic time step followed the body's deformation, from " +
          number_text(first) + " down to " + number_text(shortest) + ".");
    }


    template <int dim>
    void note_energy(const SolidProblem<dim> &run, const RunContext &context)
    {
      constexpr double tolerable = 0.01,
                       few       = 0.01; // where few bonds have broken it is not they that tell
      const auto note            = [&](const auto &energy, const double lost) {
        const double imbalance = energy.imbalance();
        const bool   of_bonds  = run.op().brittle() && lost > few * energy.exchanged;
        const double whole     = of_bonds ? lost : energy.exchanged;
        if (std::abs(imbalance) <= tolerable * whole)
          return;
        context.record.notes.push_back(
          run.name() + ": the energy balance does not close. What " +
          (imbalance < 0. ? "is missing" : "has come from nowhere") + " at the end, " +
          rounded_text(std::abs(imbalance)) + ", is " +
          rounded_text(100. * std::abs(imbalance) / whole) + " % of " +
          (of_bonds ? "what broken bonds have dissipated" :
                                 "what start and loads have brought in") +
          (run.stepper ?
                        ". A smaller 'Time step' in section 'Time' makes it less: half the step a quarter, where it is not the breaking of bonds that makes it." :
                        ". Smaller steps of the loading ('Time step' in section 'Time') make it less."));
      };
      if (run.stepper)
        {
          const MotionEnergy energy = run.stepper->energy(run.displacement, run.velocity);
          note(energy, energy.released);
        }
      else
        {
          const LoadingEnergy energy = run.loading->energy(run.displacement);
          note(energy, energy.dissipated);
        }
    }


    template <int dim>
    void note_inversion(const SolidProblem<dim> &run, const RunContext &context)
    {
      if (run.scene.elasticity.has_full_kinematics()) // such runs have ended
        return;
      const Inversion found = run.op().inverted(run.displacement);
      if (found.n_nodes > 0)
        context.record.notes.push_back(
          run.name() + ": the displacements turn cells inside out at " +
          std::to_string(found.n_nodes) + " nodes, worst at " + found.place +
          ". They are far beyond the small displacements that 'Kinematics = linear' in section 'Elasticity' is for: read them as those of a "
          "load of 1, in proportion to the load, or make the load smaller.");
    }


    /**
     * What has turned by large angles without being stretched, as fragments do: small strains do
     * not see that it grows.
     */
    template <int dim>
    void note_turning(const SolidProblem<dim> &run, const RunContext &context)
    {
      constexpr double   much = 0.1, little = 0.01; // of a radian, of the body
      const auto        &dofs = run.dofs();
      const unsigned int n    = dofs.get_fe().n_dofs_per_cell();
      if (dim == 1 || !run.stepper || run.scene.elasticity.has_full_kinematics() ||
          dofs.get_fe().n_dofs_per_vertex() == 0)
        return;
      FEValues<dim> values(dofs.get_fe(), QMidpoint<dim>(), update_gradients | update_JxW_values);
      std::vector<types::global_dof_index> indices(n);
      double                               turned = 0., whole = 0., largest = 0.;
      // Nodes of own cells need not be ghosts of bonds.
      std::vector<Vector> components;
      components.reserve(dim); // a vector that is copied forgets its ghosts
      for (unsigned int d = 0; d < dim; ++d)
        components.push_back(component_of(dofs, run.displacement, dim, d));
      for (const auto &cell : dofs.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            values.reinit(cell);
            cell->get_dof_indices(indices);
            Tensor<2, dim> gradient;
            for (unsigned int i = 0; i < n; ++i)
              for (unsigned int d = 0; d < dim; ++d)
                gradient[d] += components[d](indices[i]) * values.shape_grad(i, 0);
            const Tensor<2, dim> strain = 0.5 * (gradient + transpose(gradient));
            const double         angle  = (gradient - strain).norm() / std::sqrt(2.);
            whole += values.JxW(0);
            if (angle < much || strain.norm() > 0.5 * angle)
              continue;
            turned += values.JxW(0);
            largest = std::max(largest, angle);
          }
      const auto communicator = dofs.get_communicator();
      turned = Utilities::MPI::sum(turned, communicator) / Utilities::MPI::sum(whole, communicator);
      largest = Utilities::MPI::max(largest, communicator);
      if (turned < little)
        return;
      context.record.notes.push_back(
        run.name() + ": " + rounded_text(100. * turned) + " % of the body has turned by up to " +
        rounded_text(largest) +
        " (in radians). 'Kinematics = linear' in section 'Elasticity' is for small angles, and lets what turns so far grow by " +
        rounded_text(100. * (std::sqrt(1. + largest * largest) - 1.)) +
        " %. 'Kinematics = full', for peridynamics, and in finite elements with 'Law = hyperelastic' and 'user' (section 'Material'), turns it as it is.");
    }
    /** Cracks that have come to the end of their zone. */
    template <int dim>
    void note_end_of_zone(const SolidProblem<dim> &run, const RunContext &context)
    {
      const auto [n, place] = run.op().stretched_outside(run.displacement);
      if (n == 0)
        return;
      context.record.notes.push_back(
        run.name() + ": " + readable_count(n) +
        " cells are stretched beyond the critical stretch, the worst at " + place +
        (run.scene.coupling.exchanges() ?
           ", and have no bonds that could break: what breaks ends there. " :
           ", where elements still hold together what bonds would part: what breaks ends there. ") +
        (!run.scene.coupling.follows_stretches() ?
           "'Zone = follow' in section 'Coupling' goes with it." :
         run.scene.coupling.exchanges() ?
           "Keep cells of lattice size there: 'Fine where' or a smaller 'Coarsening' in section 'Domain'." :
           "A smaller 'Zone share' in section 'Coupling' lets the zone grow before that, and a smaller 'Time step' in section 'Time' more often."));
    }


    /** A note that begins so is there. */
    bool is_told(const std::string &start, const RunContext &context)
    {
      const std::vector<std::string> &notes = context.record.notes;
      return std::any_of(notes.begin(), notes.end(), [&](const std::string &note) {
        return note.compare(0, start.size(), start) == 0;
      });
    }


    /** A note, unless one begins so or there is nothing to say. */
    void tell(const std::string &start, const std::string &rest, const RunContext &context)
    {
      if (!rest.empty() && !is_told(start, context))
        context.record.notes.push_back(start + rest);
    }


    /** A negative K_I is that of faces that are pressed together. */
    template <int dim>
    void note_pressed_faces(const SolidProblem<dim> &run, const RunContext &context)
    {
      constexpr double some = 0.02; // of both intensities
      const auto      &kept = context.record.balances;
      if (!kept.contains(run.name()) || !kept[run.name()].contains("stress intensity"))
        return;
      for (const auto &[end, value] : kept[run.name()]["stress intensity"].items())
        {
          const double first = value["I"], second = value["II"];
          if (first > -some * std::hypot(first, second) || first == 0.)
            continue;
          const bool could = run.name() == to_string(ModelKind::peridynamics) ||
                             (run.name() == to_string(ModelKind::coupled) &&
                              run.scene.coupling.exchanges() && !run.scene.cracks.on_faces()),
                     knows = could && run.scene.elasticity.contact;
          context.record.notes.push_back(
            run.name() + ": K_I at " + end + " is negative: the faces of the crack " +
            (knows ?
               "press on each other there. It is found as if they bore nothing, and is none of an open crack; K_II is that of faces that slide." :
             could ?
               "pass through each other, since contact is off ('Contact = false' in section 'Elasticity', or 'Kinematics = full' there but in motion with 'Stepper = verlet')." :
               "pass through each other, since nothing is between them here. In 'peridynamics', and in 'coupled' with 'Scheme = exchange' where 'Mesh' in section 'Cracks' is not 'faces', they press on each other ('Contact' in section 'Elasticity')."));
          return;
        }
    }


    template <int dim>
    void note_loads_borne(const SolidProblem<dim> &run, const RunContext &context)
    {
      const double factor = run.op().stepping.load_factor;
      if (factor < 1.)
        context.record.notes.push_back(
          run.name() + ": at the end loads and prescribed displacements are " +
          rounded_text(factor) +
          " times those of the time ('load factor' in totals.csv), since bonds bear no more ('Breaking = controlled' in section 'Elasticity'). A later 'End time', with more load steps, goes on.");
    }
  } // namespace


  template <int dim>
  void tell_first_break(const SolidProblem<dim> &run, const double t, const RunContext &context)
  {
    const BreakPlaces &places = run.op().break_places();
    auto              &kept   = context.record.extremes[run.name()];
    if (places.first.empty() || kept.contains("first broken bond"))
      return;
    kept["first broken bond"]  = places.first;
    kept["first broken bonds"] = t;
    std::ostringstream line;
    line.precision(4);
    line << "  " << run.name() << ": the first bond "
         << (run.scene.material.law.softens() ? "began to soften" : "broke") << " at (";
    for (unsigned int d = 0; d < dim; ++d)
      line << (d > 0 ? ", " : "") << places.first[d];
    line << ")" << (run.stepper ? ", by t = " : " at t = ") << t;
    if (!places.beside_loads.empty())
      line << ", beside the loaded " << list_of_sides(places.beside_loads);
    context.progress.line(line.str());
  }


  template <int dim>
  void note_overlap(const SolidProblem<dim> &run, const double t, const RunContext &context)
  {
    if (run.scene.domain.has_lattice() && !run.scene.domain.has_voids())
      return;
    const std::string start =
      run.name() + ": pieces of the body overlap" + (run.stepper ? "" : " in the equilibrium");
    if (!is_told(start, context))
      tell(start, BodyPieces<dim>(run).overlap(t, start), context);
  }


  template <int dim>
  void note_equilibrium(const SolidProblem<dim> &run, const double t, const RunContext &context)
  {
    if (const double residual = take_accepted_residual(); residual > 0.)
      tell(
        run.name() + ": the residual of an equilibrium fell no further than to ",
        rounded_text(residual) +
          " of that of the loads, above 'Tolerance' = " + number_text(run.scene.solver.tolerance) +
          " in section 'Solver', and was accepted: round-off of the forces between nodes allows no less, since they move far more than they stretch what is between them. "
          "A larger 'Tolerance' takes fewer iterations; fewer cells, or a body that is held so that it moves less as a whole, leave less of it.",
        context);
    note_overlap(run, t, context);
  }


  template <int dim>
  void note_end_of_solid(const SolidProblem<dim> &run, const RunContext &context)
  {
    if (run.stepper)
      note_steps(run, context);
    // What warming does to the strain energy is not followed.
    if (run.stepper || (!run.scene.time.steady && !run.scene.warms_slowly()))
      note_energy(run, context);
    note_loads_borne(run, context);
    note_inversion(run, context);
    note_turning(run, context);
    note_torn_sides(run, context);
    note_end_of_zone(run, context);
    note_pressed_faces(run, context);
  }


  PERIDEAL_INSTANTIATE_FUNCTION(note_overlap);
  PERIDEAL_INSTANTIATE_FUNCTION(note_equilibrium);
  PERIDEAL_INSTANTIATE_FUNCTION(tell_first_break);
  PERIDEAL_INSTANTIATE_FUNCTION(note_end_of_solid);
} // namespace PeriDeal
