// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "attempts.h"

#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "roughness.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    bool moves(const Scene<dim> &scene)
    {
      return scene.deforms && !scene.elasticity.is_static();
    }
  } // namespace


  template <int dim>
  Attempts<dim>::Attempts(const BodyOfChoice<dim> &body, const LimitOfAttempts limit)
    : body(body)
    , scene(*body.scene)
    , box(cracked_box(scene))
    , points(box)
  {
    points.cracks.clear();
    for (const Part &part : scene.boundary_conditions.parts)
      if (part.kind == Part::point)
        {
          const Point<dim> p = part.position<dim>();
          points.cracks.push_back({std::vector<double>(p.begin_raw(), p.end_raw())});
        }
    for (unsigned int d = 0; d < dim; ++d)
      longest = std::max(longest, box.upper[d] - box.lower[d]);
    const bool cracked = !scene.cracks.cracks.empty();
    family =
      family_for(body, limit, cracked && !body.given && (on_faces(1.) || lines_for_cracks()));
    if (!is_given() && family != Family::bonds)
      planes = material_planes(scene);
    const double rough = order_of_rough_places(scene, box, planes);
    for (unsigned int d = 0; planes && d < dim; ++d)
      if (!planes_on_lines(d, with_points_on_planes(d, 2)))
        planes.reset();
    if (family != Family::bonds)
      needs = needs_of_formulas(body, planes.has_value());
    needs.rough_order = rough;
    if (family == Family::whole)
      first = first_counts();
    if (is_given())
      return;
    if (family == Family::faces)
      lines = lines_for_cracks();
    if (lines)
      {
        first_fineness = coarsest();
        return;
      }
    if (family == Family::faces)
      faces_unit = fineness_of(*on_faces(1.));
    const double     wanted = coarsest();
    const CellCounts cells  = family == Family::faces ? *on_faces(wanted) : counts(wanted);
    // All directions get finer from the first mesh on, however cracks or points fit into it.
    if (family != Family::whole && family != Family::bonds)
      first.assign(cells.begin(), cells.end());
    first_fineness = fineness_of(cells);
  }


  template <int dim>
  typename Attempts<dim>::Family Attempts<dim>::family_for(const BodyOfChoice<dim> &body,
                                                           const LimitOfAttempts    limit,
                                                           const bool               on_faces)
  {
    const Scene<dim> &scene = *body.scene;
    if (limit == LimitOfAttempts::nonlocal)
      return Family::bonds;
    const bool whole = scene.cracks.cracks.empty() || dim == 1;
    if (body.given)
      return whole || (body.given->cracks_on_faces && !scene.cracks.conduct()) ?
               Family::given :
               Family::given_pairs;
    if (whole)
      return Family::whole;
    if (on_faces && !scene.cracks.conduct() && !scene.cracks.change())
      return Family::faces;
    return scene.deforms ? Family::zone : Family::pairs;
  }


  namespace
  {
    template <int dim>
    constexpr double fewest_cells = dim == 1 ? 4. : 3.; // along the longest edge

    /** More cells than wanted, along an edge, are not taken to have cracks on their faces. */
    template <int dim>
    constexpr int most_to_fit = dim == 3 ? 12 : 48;


    double product(const std::vector<double> &numbers)
    {
      return std::accumulate(numbers.begin(), numbers.end(), 1., std::multiplies<double>());
    }
  } // namespace


  template <int dim>
  std::vector<double> Attempts<dim>::first_counts() const
  {
    constexpr double    most = dim == 3 ? 1e4 : 1e5, longest_cell = 32.; // times as long as wide
    std::vector<double> shares(dim), n(dim);
    for (unsigned int d = 0; d < dim; ++d)
      {
        shares[d] = (box.upper[d] - box.lower[d]) / longest;
        n[d]      = std::max(2., std::max(fewest_cells<dim>, 0.25 * needs.fineness) * shares[d]);
      }
    if (product(n) <= most)
      return n;
    // What varies across a thin body does not need short cells along it.
    const std::vector<double> along    = needs_along_edges(body);
    double                    shortest = 1.;
    for (unsigned int d = 0; d < dim; ++d)
      {
        n[d]     = std::max(2., std::max(fewest_cells<dim>, 0.25 * along[d]) * shares[d]);
        shortest = std::min(shortest, shares[d] / n[d]);
      }
    for (unsigned int d = 0; d < dim; ++d)
      n[d] = std::max(n[d], shares[d] / (longest_cell * shortest));
    const double shrink = std::pow(std::min(1., most / product(n)), 1. / dim);
    for (double &one : n)
      one = std::max(2., shrink * one);
    return n;
  }


  namespace
  {
    /**
     * At least so many cells along each edge, about as long as wide as those, since families need
     * that, with lines where @p fits wants them; none if there are no such with less than three
     * times as many.
     */
    template <typename Fits>
    std::optional<CellCounts> fitting_cells(const CellCounts &wanted, const Fits &fits)
    {
      constexpr double most = 3., more = 1.02, longer = 1.2;
      for (double times = 1.; times < most; times *= more)
        {
          CellCounts cells;
          for (unsigned int d = 0; d < wanted.size() && cells.size() == d; ++d)
            {
              const auto least = static_cast<unsigned int>(std::lround(times * wanted[d]));
              for (unsigned int n = least; cells.size() == d && n <= longer * least; ++n)
                if (fits(d, n))
                  cells.push_back(n);
            }
          if (cells.size() == wanted.size())
            return cells;
        }
      return {};
    }
  } // namespace


  template <int dim>
  CellCounts Attempts<dim>::counts(const double fineness) const
  {
    // All edges get finer, or nothing is seen of what varies along one.
    const bool   grows = family != Family::bonds;
    const double ratio = grows && first_fineness > 0. ? fineness / first_fineness : 1.;
    CellCounts   cells;
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double n = std::max(fineness * (box.upper[d] - box.lower[d]) / longest,
                                  (first.empty() ? 2. : first[d]) * std::max(1., ratio));
        // Few cells get more with the others, or nothing is seen of them.
        constexpr double few = 8., part = 1e-9;
        const bool       grows_few = ratio > 1. && n < few;
        cells.push_back(
          std::max<unsigned int>(2, std::lround(grows_few ? std::ceil(n - part) : n)));
        if (grows_few && !first.empty()) // barely finer along one edge, finer along all
          cells.back() =
            std::max(cells.back(), static_cast<unsigned int>(std::lround(first[d])) + 1);
        if (family != Family::faces && family != Family::bonds && family != Family::zone)
          cells.back() = with_points_on_planes(d, cells.back());
      }
    if (family != Family::zone)
      return cells;
    const std::optional<CellCounts> fitting =
      fitting_cells(cells, [&](unsigned int d, unsigned int n) {
        return planes_on_lines(d, n) && corners_on_planes(points, d, n);
      });
    if (fitting)
      return *fitting;
    for (unsigned int d = 0; d < dim && planes; ++d)
      cells[d] = with_points_on_planes(d, cells[d]);
    return cells;
  }


  template <int dim>
  unsigned int Attempts<dim>::with_points_on_planes(const unsigned int direction,
                                                    const unsigned int n) const
  {
    const unsigned int most = (dim == 3 ? n + n / 2 + 4 : 2 * n + 8) + (planes ? 16 : 0);
    for (const bool with_points : {true, false})
      for (unsigned int k = n; k <= most; ++k)
        if (planes_on_lines(direction, k) &&
            (!with_points || corners_on_planes(points, direction, k)))
          return k;
    return n;
  }


  template <int dim>
  bool Attempts<dim>::planes_on_lines(const unsigned int direction, const unsigned int n) const
  {
    constexpr double slack = 1e-6; // of a cell
    if (!planes)
      return true;
    const double lower = box.lower[direction], cell = (box.upper[direction] - lower) / n;
    return std::all_of((*planes)[direction].begin(), (*planes)[direction].end(), [&](double x) {
      return std::abs(std::remainder(x - lower, cell)) < slack * cell;
    });
  }


  template <int dim>
  std::optional<CellCounts> Attempts<dim>::on_faces(const double fineness) const
  {
    if (!along_axes(box))
      return {};
    CellCounts cells;
    for (unsigned int d = 0; d < dim; ++d)
      {
        const int wanted = counts(fineness)[d];
        int       found  = 0;
        for (const bool with_points : {true, false})
          for (int k = 0; k <= wanted + most_to_fit<dim> && found == 0; ++k)
            for (const int n : {wanted - k, wanted + k})
              if (found == 0 && n > 1 && corners_on_planes(box, d, n) && planes_on_lines(d, n) &&
                  (!with_points || corners_on_planes(points, d, n)))
                found = n;
        if (found == 0)
          return {};
        cells.push_back(found);
      }
    return cells;
  }


  template <int dim>
  std::optional<CellLines> Attempts<dim>::lines_for_cracks() const
  {
    constexpr double clearly = 1.5; // more cells
    // In blocks without bonds pairs of nodes cost less: 0.2 s where this takes 4.7 s.
    if (!along_axes(box) || (dim == 3 && !scene.deforms))
      return {};
    const double wanted  = std::max(fewest_cells<dim>, 0.25 * needs.fineness);
    const auto   through = [&](const CrackedBox &nodes) {
      return lines_through(box, nodes, planes ? *planes : CellLines(), longest / wanted);
    };
    auto between = through(points);
    if (!between && !points.cracks.empty() && !on_faces(1.))
      { // a point that is nearer to an end than cells can be acts on the nearest node
        CrackedBox none = points;
        none.cracks.clear();
        between = through(none);
      }
    if (!between || !on_faces(1.))
      return between;
    const CellCounts lattice = *on_faces(wanted);
    return product({lattice.begin(), lattice.end()}) > clearly * n_cells(*between) ?
             between :
             std::optional<CellLines>();
  }


  template <int dim>
  double Attempts<dim>::fineness_of(const CellCounts &cells) const
  {
    double coarsest = std::numeric_limits<double>::max(); // errors are made there
    for (unsigned int d = 0; d < dim; ++d)
      coarsest = std::min(coarsest, cells[d] / (box.upper[d] - box.lower[d]) * longest);
    return coarsest;
  }


  namespace
  {
    /** At most so many halvings that the nodes of the finest lattice can still be numbered. */
    unsigned int possible_halvings(const CellCounts &cells, unsigned int levels)
    {
      const auto nodes = [&] {
        double product = 1.;
        for (const unsigned int n : cells)
          product *= n * std::exp2(levels) + 1.;
        return product;
      };
      while (levels > 0 && nodes() > 0.9 * std::numeric_limits<types::global_dof_index>::max())
        --levels;
      return levels;
    }


    /**
     * How often cells of the size h = 1/(2 refinement) are halved to get to those of the size
     * h^power.
     */
    unsigned int halvings(const double refinement, const double power)
    {
      return static_cast<unsigned int>(
        std::clamp<long>(std::lround((power - 1.) * std::log2(2. * refinement)), 1, 12));
    }
  } // namespace


  namespace
  {
    /**
     * Of a mesh whose cells are halved so often at cracks across them: most of the error comes from
     * there, and halvings cannot follow the square of the cells exactly.
     */
    double fineness_at_cracks(const double far, const unsigned int levels)
    {
      return std::sqrt(2. * far * std::exp2(levels));
    }
  } // namespace


  namespace
  {
    /** Of a point and a segment. */
    double distance(const std::vector<double>              &point,
                    const std::vector<std::vector<double>> &segment)
    {
      double length = 0., along = 0., square = 0.;
      for (std::size_t d = 0; d < point.size(); ++d)
        {
          const double edge = segment[1][d] - segment[0][d];
          length += edge * edge;
          along += edge * (point[d] - segment[0][d]);
        }
      const double share = length > 0. ? std::clamp(along / length, 0., 1.) : 0.;
      for (std::size_t d = 0; d < point.size(); ++d)
        square += std::pow(point[d] - segment[0][d] - share * (segment[1][d] - segment[0][d]), 2);
      return std::sqrt(square);
    }


    bool is_inside(const CrackedBox &box, const std::vector<double> &point)
    {
      for (unsigned int d = 0; d < box.dim(); ++d)
        if (point[d] < box.lower[d] || point[d] > box.upper[d])
          return false;
      return true;
    }
  } // namespace


  namespace
  {
    /** How often cells are halved at ends of cracks and at corners. */
    struct GradingAtEnds
    {
      /** Of a mesh so many times as fine as the coarsest one that could be. */
      unsigned int halvings(const double refinement) const
      {
        const int full = PeriDeal::halvings(refinement, power),
                  most = PeriDeal::halvings(first, power);
        // The first mesh need not be finer there than the tolerance asks; others follow it.
        return std::max(least, full - std::max(0, most - std::max(least, enough)));
      }

      double power = 3., first = 1.; // refinement of the first mesh
      int    least = 0, enough = 0;  // halvings of the first mesh, for the tolerance
    };


    /**
     * Where u goes with the root of r, or jumps, fields are wrong by about a fifth of the cells
     * there; where with r^(2/3), by a tenth of their power 4/3; stress intensities by about a half
     * of them, over the crack.
     *
     * @param first refinement of the first mesh
     * @param size  of its cells far away
     */
    template <int dim>
    GradingAtEnds grading_at_ends(const Scene<dim> &scene,
                                  const CrackedBox &box,
                                  const bool        disagree,
                                  const double      first,
                                  const double      size)
    {
      const double tolerance = scene.accuracy.tolerance;
      double       length    = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        length = std::max(length, box.upper[d] - box.lower[d]);
      double wanted = 4. * tolerance * length;
      if (scene.accuracy.measure == AccuracyMeasure::stress_intensity)
        for (const auto &crack : box.cracks)
          length = std::min(length, distance(crack[0], {crack[1], crack[1]}));
      if (scene.accuracy.measure != AccuracyMeasure::field)
        wanted = tolerance * length;
      else if (box.cracks.empty() && !disagree && !scene.deforms)
        wanted = std::pow(8. * tolerance, 0.75) * length;
      GradingAtEnds grading;
      grading.power  = dim == 3 ? 2. : 3.;
      grading.first  = first;
      grading.least  = box.cracks.empty() ? 0 : 1;
      grading.enough = static_cast<int>(std::ceil(std::log2(size / wanted) - 1e-9));
      return grading;
    }
  } // namespace


  template <int dim>
  unsigned int Attempts<dim>::refinements(const double fineness) const
  {
    constexpr double most = 11.;
    return std::lround(std::clamp(std::log2(fineness * body.given->spacing / longest), 0., most));
  }


  template <int dim>
  void Attempts<dim>::refine_given(const double fineness, Attempt &attempt) const
  {
    constexpr unsigned int most = 12;
    if (grows_by_cells())
      {
        const double unit         = longest / body.given->spacing;
        const auto [cells, times] = body.finer_plate(std::max(1., fineness / unit));
        attempt.fineness          = times * unit;
        attempt.settings.insert(attempt.settings.end(), body.settings.begin(), body.settings.end());
        for (Setting &setting : attempt.settings)
          if (setting.first == "Domain/Cells")
            setting.second = to_text(cells);
        for (const char *const entry : {"Domain/Refinements", "Domain/Coarsening"})
          attempt.settings.emplace_back(entry, "0");
        attempt.settings.emplace_back("Domain/Fine where", "auto");
        return;
      }
    const unsigned int n        = refinements(fineness);
    const bool         is_rough = body.given->has_corners || family == Family::given_pairs ||
                          !scene.cracks.cracks.empty();
    unsigned int levels = 0;
    const double times  = std::exp2(n - refinements(coarsest()));
    if (is_rough && family == Family::given_pairs)
      levels = halvings(times, 2.);
    else if (is_rough)
      levels = grading_at_ends(scene,
                               box,
                               needs.disagree,
                               1.,
                               body.given->spacing / std::exp2(refinements(coarsest())))
                 .halvings(times);
    levels           = std::min(levels, most - n);
    attempt.fineness = std::exp2(n) * longest / body.given->spacing;
    if (family == Family::given_pairs)
      attempt.fineness = fineness_at_cracks(attempt.fineness, levels);
    attempt.settings.insert(attempt.settings.end(), body.settings.begin(), body.settings.end());
    attempt.settings.emplace_back("Domain/Refinements", std::to_string(n + levels));
    attempt.settings.emplace_back("Domain/Coarsening", std::to_string(levels));
    attempt.settings.emplace_back("Domain/Fine where",
                                  family == Family::given && levels > 0 ? "corners" : "auto");
  }


  template <int dim>
  void Attempts<dim>::set_lines(const double fineness, Attempt &attempt) const
  {
    const auto n = static_cast<unsigned int>(std::max(1l, std::lround(fineness / first_fineness)));
    const auto levels = std::to_string(
      grading_at_ends(scene, box, needs.disagree, 1., longest / first_fineness).halvings(n));
    attempt.fineness = n * first_fineness;
    attempt.settings.emplace_back("Domain/Cell lines", to_text(divided(*lines, n)));
    attempt.settings.emplace_back("Domain/Refinements", levels);
    attempt.settings.emplace_back("Domain/Coarsening", levels);
    attempt.settings.emplace_back("Domain/Fine where", "crack ends");
  }


  template <int dim>
  void Attempts<dim>::set_mesh(const double fineness, Attempt &attempt) const
  {
    if (is_given())
      return refine_given(fineness, attempt);
    if (lines)
      return set_lines(fineness, attempt);
    unsigned int levels = 0;
    CellCounts   cells  = counts(fineness);
    if (family == Family::faces)
      {
        cells  = *on_faces(fineness);
        levels = grading_at_ends(scene,
                                 box,
                                 needs.disagree,
                                 first_fineness / faces_unit,
                                 longest / first_fineness)
                   .halvings(fineness_of(cells) / faces_unit);
        attempt.settings.emplace_back("Domain/Fine where", "crack ends");
      }
    else if (family != Family::whole)
      {
        levels = halvings(fineness / 4., 2.);
        attempt.settings.emplace_back("Domain/Fine where", "auto");
      }
    levels           = possible_halvings(cells, levels);
    attempt.fineness = fineness_of(cells);
    if (family == Family::pairs || family == Family::zone)
      attempt.fineness = fineness_at_cracks(attempt.fineness, levels);
    for (unsigned int &n : cells)
      n <<= levels;
    attempt.settings.emplace_back("Domain/Cells", to_text(cells));
    attempt.settings.emplace_back("Domain/Coarsening", std::to_string(levels));
  }


  template <int dim>
  Attempt Attempts<dim>::at(const double fineness) const
  {
    Attempt    attempt;
    const auto set = [&](const std::string &entry, const std::string &text) {
      attempt.settings.emplace_back(entry, text);
    };
    if (!body.given)
      set("Domain/Node spacing", "");
    if (family == Family::bonds)
      {
        attempt.model = ModelKind::peridynamics;
        const double nodes =
          std::max(2., std::round(fineness / longest * scene.peridynamics.horizon));
        CellCounts cells = counts(nodes * longest / scene.peridynamics.horizon);
        attempt.fineness = fineness_of(cells);
        set("Domain/Cells", to_text(cells));
        set("Domain/Coarsening", "0");
        set("Models", to_string(attempt.model));
        return attempt;
      }
    set_mesh(fineness, attempt);
    const bool on_cells = family == Family::whole || family == Family::faces ||
                          family == Family::given;
    const bool cut = family == Family::faces || family == Family::given;
    set("Cracks/Nodes on cracks", "left");
    set("Finite elements/Degree", on_cells ? "2" : "1");
    if (!scene.cracks.cracks.empty())
      {
        set("Cracks/Mesh", cut ? "faces" : "auto");
        set("Cracks/Bonds through tips", "auto");
      }
    if (family == Family::zone)
      attempt.model = ModelKind::coupled;
    set("Coupling/Zone", "cracks: 1");
    set("Coupling/Scheme", "exchange");
    set("Coupling/Overlap", "0");
    set("Coupling/Certificate", "false");
    set("Peridynamics/Horizon ratio", "3");
    set("Peridynamics/Horizon", "");
    set("Peridynamics/Surface correction", on_cells ? "auto" : "crack scaling");
    // In the plane factors have few entries; cells that are as small at ends of cracks as the
    // tolerance asks cost multigrid 65 to 103 iterations, six times the time.
    constexpr unsigned int many = 30000;
    if (dim == 2 && on_cells)
      set("Solver/Direct solver up to", std::to_string(std::max(many, scene.solver.direct_up_to)));
    set("Models", to_string(attempt.model));
    return attempt;
  }


  template <int dim>
  bool Attempts<dim>::probes_at_ends() const
  {
    if (scene.accuracy.measure != AccuracyMeasure::probes || box.dim() == 1)
      return false;
    for (const auto &crack : box.cracks)
      for (const std::vector<double> &end : crack)
        for (const std::vector<double> &probe : scene.output.probes)
          if (is_inside(box, end) && distance(probe, {end, end}) < 0.05 * longest)
            return true;
    return false;
  }


  template <int dim>
  double Attempts<dim>::best_order() const
  {
    return std::min(needs.rough_order, order_of_elements());
  }


  template <int dim>
  double Attempts<dim>::order_of_elements() const
  {
    if (needs.jumps || (needs.disagree && family != Family::given))
      return 1.;
    // A force at a point acts on the nearest node.
    if (!points.cracks.empty() && scene.accuracy.measure != AccuracyMeasure::field)
      return 1.;
    if (probes_at_ends())
      return family == Family::faces && dim < 3 ? 1.5 : 1.;
    switch (family)
      {
        case Family::whole:
          return moves(scene) ? 2. : 3.; // steps as long as cells allow are of second order
        case Family::faces:
          return dim == 3 ? 2. : 3.;
        case Family::given:
          return body.given->is_round || moves(scene) || (dim == 3 && body.given->has_corners) ?
                   2. :
                   3.;
        case Family::zone:
          return 1.75; // sequences of turned cracks have that on average
        default:
          return 2.;
      }
  }


  template <int dim>
  double Attempts<dim>::lowest_order() const
  {
    // Where a crack's ends lie in their cells changes the error by factors of two, so that two
    // differences do not show an order. (In a zone the cells far from it may decide, too.)
    return family == Family::pairs || family == Family::given_pairs ? best_order() :
                                                                      std::min(1., best_order());
  }


  template <int dim>
  double Attempts<dim>::first_ratio() const
  {
    // In 3D a mesh that is half as fine again has 3.4 times as many unknowns.
    if (family == Family::whole || grows_by_cells())
      return dim == 3 ? 1.3 : 1.5;
    return family == Family::bonds ? 1.5 : 2.;
  }


  template <int dim>
  double Attempts<dim>::growth_of_cost() const
  {
    switch (family)
      {
        case Family::pairs:
        case Family::given_pairs:
        case Family::zone:
          return 2. * (dim - 1);
        case Family::bonds:
          return 2. * dim;
        default:
          return dim;
      }
  }


  template <int dim>
  std::string Attempts<dim>::reason() const
  {
    switch (family)
      {
        case Family::whole:
          return scene.peridynamics.horizon > 0. ?
                   "No crack: quadratic finite elements for the classical solution." :
                   "No crack and no horizon of its own: quadratic finite elements.";
        case Family::faces:
          return "The cracks run along the axes: quadratic finite elements with the cracks on faces "
                 "of cells, fine at their ends.";
        case Family::given:
          return std::string("The body is no box: quadratic finite elements on ") +
                 (body.settings.empty() ? "its mesh, whose cells are halved" :
                                          "a mesh that follows the rims of its holes") +
                 (body.given->has_corners || !scene.cracks.cracks.empty() ?
                    ", fine at corners and ends of cracks." :
                    ".");
        case Family::given_pairs:
        case Family::pairs:
          return std::string(scene.cracks.change() ? "The cracks grow" :
                                                     "The cracks lie across cells") +
                 ": finite elements, fine along the cracks, with the pairs of nodes that they do not "
                 "part in the cells that they cut.";
        case Family::zone:
          return "The cracks lie across cells of an elastic body: bonds around them, finite elements "
                 "elsewhere.";
        default:
          return "The horizon is a length: peridynamics for the nonlocal solution.";
      }
  }


  namespace
  {
    /**
     * The smallest distance of an end of a crack in the box to a side or, in two dimensions, to
     * another crack, that it does not touch; infinite if there is none.
     */
    double narrowest_gap(const CrackedBox &box, const double longest)
    {
      double     narrowest = std::numeric_limits<double>::infinity();
      const auto see       = [&](const double distance) {
        if (distance > 1e-6 * longest) // else it touches
          narrowest = std::min(narrowest, distance);
      };
      for (const auto &crack : box.cracks)
        for (const std::vector<double> &end : crack)
          {
            if (!is_inside(box, end))
              continue;
            for (unsigned int d = 0; d < box.dim(); ++d)
              for (const double side : {box.lower[d], box.upper[d]})
                see(std::abs(end[d] - side));
            if (box.dim() == 2)
              for (const auto &other : box.cracks)
                if (&other != &crack)
                  see(distance(end, other));
          }
      return narrowest;
    }


    /**
     * Cells at cracks are about the square of those far away, and one at least has to fit into a
     * gap. Wide ones are seen by any mesh, and very narrow ones are as good as closed.
     */
    double fineness_at_gaps(const double gap)
    {
      constexpr double wide = 0.1, most = 40.;
      return gap < wide ? std::min(most, 2. / std::sqrt(gap)) : 1.;
    }
  } // namespace


  template <int dim>
  double Attempts<dim>::coarsest() const
  {
    if (family == Family::bonds)
      return 2. * longest / scene.peridynamics.horizon;
    if (family == Family::whole)
      {
        double least = std::numeric_limits<double>::max();
        for (unsigned int d = 0; d < dim; ++d)
          least = std::min(least, first[d] / (box.upper[d] - box.lower[d]) * longest);
        return least;
      }
    double least = std::max(fewest_cells<dim>, 0.25 * needs.fineness);
    if (is_given())
      least = std::max(least, longest / body.given->spacing);
    // Not all lattices have the cracks on faces: the nearest one is taken, once and for all.
    constexpr double near = 0.6;
    if (family == Family::faces && !lines && first_fineness > near * least)
      return first_fineness;
    if (family == Family::zone) // families need cells about as long as wide
      for (unsigned int d = 0; d < dim; ++d)
        least = std::max(least, 2. * longest / (box.upper[d] - box.lower[d]));
    if (family == Family::pairs || family == Family::zone)
      least = std::max(least, fineness_at_gaps(narrowest_gap(box, longest) / longest));
    return least;
  }


  PERIDEAL_INSTANTIATE_CLASS(class Attempts);
} // namespace PeriDeal
