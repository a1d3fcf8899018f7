// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/distributed/tria_base.h>
#include <deal.II/grid/grid_tools.h>

#include <perideal/base/instantiate.h>
#include <perideal/mesh/body_corners.h>
#include <perideal/mesh/grading.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <sstream>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /**
     * Times at which a mesh follows cracks and solution: so often that no tip advances more than a
     * horizon in between, and at the start more often than later, since fields that begin with a
     * jump change fast at first.
     */
    template <int dim>
    std::vector<double> adaptation_times(const Scene<dim> &scene, const CrackHistory<dim> &history)
    {
      std::vector<double> times;
      const double        end = scene.time.end_time;
      if (!scene.coupling.is_adaptive() || scene.time.steady)
        return times;
      constexpr unsigned int n_even = 16, n_early = 6;
      for (unsigned int k = 1; k < n_even; ++k)
        times.push_back(end * k / n_even);
      for (unsigned int k = 1; k <= n_early; ++k)
        times.push_back(end / n_even / (1u << k));
      const double advance = history.longest_advance();
      if (advance > 0.) // else cracks open or close where they are
        {
          const auto stride = static_cast<unsigned int>(std::max(1., scene.horizon() / advance));
          for (std::size_t k = 0; k < history.events().size(); k += stride)
            times.push_back(history.events()[k]);
        }
      if (scene.time.time_step > 0.) // steps of fixed size are not divided
        for (double &t : times)
          t = scene.time.time_step * std::ceil(t / scene.time.time_step * (1. - 1e-12));
      const auto is_late = [&](const double t) { return t > (1. - 1e-9) * end; };
      times.erase(std::remove_if(times.begin(), times.end(), is_late), times.end());
      std::sort(times.begin(), times.end());
      times.erase(std::unique(times.begin(),
                              times.end(),
                              [&](const double a, const double b) { return b - a < 1e-9 * end; }),
                  times.end());
      return times;
    }
  } // namespace


  namespace
  {
    /** The ends of cracks as they are at last, in 3D their edges, and nothing around them. */
    template <int dim>
    Zone<dim> zone_of_ends(const CrackHistory<dim>                    &history,
                           const double                                end,
                           const std::vector<std::vector<Point<dim>>> &corners)
    {
      std::vector<CrackPiece<dim>> ends;
      for (const std::vector<Point<dim>> &corner : corners)
        {
          ends.emplace_back();
          ends.back().corners = {corner.front(), corner.back()};
        }
      for (const CrackPiece<dim> &piece : history.pieces(end))
        for (std::size_t k = 0; k < piece.corners.size(); ++k)
          {
            CrackPiece<dim> one = piece;
            one.corners         = {piece.corners[k],
                                   piece.corners[dim == 3 ? (k + 1) % piece.corners.size() : k]};
            ends.push_back(one);
          }
      Zone<dim> zone = Zone<dim>::near_cracks(0.);
      zone.set_cracks(ends);
      return zone;
    }
  } // namespace


  namespace
  {
    /** A mesh that is no lattice has a horizon only if it is given; without bonds it needs none. */
    template <int dim>
    double horizon_of_zone(const Scene<dim> &scene)
    {
      return scene.domain.has_lattice() || scene.peridynamics.horizon > 0. ? scene.horizon() : 0.;
    }


    template <int dim>
    unsigned int finest_level(const Domain<dim> &domain, const Triangulation<dim> &mesh)
    {
      if (!domain.has_lattice())
        return domain.coarsening.refinements;
      return std::lround(std::log2(mesh.begin(0)->extent_in_direction(0) / domain.spacing()[0]));
    }


    template <int dim>
    BoundingBox<dim> box_around(const Domain<dim> &domain, const Triangulation<dim> &mesh)
    {
      if (domain.has_lattice())
        return BoundingBox<dim>({domain.lower, domain.upper});
      std::vector<Point<dim>> corners; // of coarse cells, which all processes know
      for (const auto &cell : mesh.cell_iterators_on_level(0))
        for (const unsigned int v : cell->vertex_indices())
          corners.push_back(cell->vertex(v));
      return BoundingBox<dim>(corners);
    }
  } // namespace


  template <int dim>
  Grading<dim>::Grading(const Scene<dim> &scene, const Triangulation<dim> &mesh)
    : zone(scene.coupling, horizon_of_zone(scene))
    , by_zone(true)
    , by_name(scene.domain.coarsening.by_formula || scene.domain.coarsening.at_ends)
    , history(scene.crack_history())
    , adaptations(adaptation_times(scene, history))
    , finest(finest_level(scene.domain, mesh))
    , coarsest(finest - scene.domain.coarsening.times)
    , end(scene.cracks.end_time)
  {
    for (unsigned int d = 0; d < dim && scene.domain.has_lattice(); ++d)
      spacing = std::max(spacing, scene.domain.spacing()[d]);
    const auto            &models     = scene.general.models;
    const BoundingBox<dim> box        = box_around(scene.domain, mesh);
    const auto            &coarsening = scene.domain.coarsening;
    zone.stay_in(box);
    if (by_name)
      {
        named = coarsening.at_ends ?
                  zone_of_ends(history,
                               end,
                               coarsening.at_corners ? corners_of_body(scene, mesh) :
                                                       std::vector<std::vector<Point<dim>>>()) :
                  Zone<dim>(coarsening.fine);
        named.stay_in(box);
        by_zone = std::find(models.begin(), models.end(), ModelKind::coupled) != models.end();
      }
    set_time(0.);
  }


  template <int dim>
  double Grading<dim>::next_adaptation(const double t) const
  {
    const auto next = std::upper_bound(adaptations.begin(), adaptations.end(), t);
    return next == adaptations.end() ? std::numeric_limits<double>::infinity() : *next;
  }


  template <int dim>
  void Grading<dim>::set_time(const double t)
  {
    zone.set_cracks(history.pieces(adaptations.empty() ? end : std::min(end, next_adaptation(t))));
  }


  template <int dim>
  bool Grading<dim>::is_too_coarse(const Cell &cell) const
  {
    const unsigned int level = cell->level();
    if (level >= finest)
      return false;
    // Two cells of each finer size lie between this one and the fine part.
    constexpr double slack = 1e-6;
    const double     fine  = spacing > 0. ? spacing : cell->diameter() / (1u << (finest - level));
    const double     rim   = 2. * fine * ((1u << (finest - level)) - 1. + slack),
                 half      = 0.5 * cell->diameter();
    return distance(cell->center(), half + 2. * rim) < half + rim;
  }


  template <int dim>
  double Grading<dim>::distance(const Point<dim> &p, const double farthest) const
  {
    return std::min(by_zone ? zone.distance(p, farthest) : farthest,
                    by_name ? named.distance(p, farthest) : farthest);
  }


  template <int dim>
  void Grading<dim>::refine(Triangulation<dim> &mesh) const
  {
    // Where every process has all cells, each marks them all.
    const bool distributed =
      dynamic_cast<const parallel::DistributedTriangulationBase<dim> *>(&mesh) != nullptr;
    for (unsigned int pass = coarsest; pass < finest; ++pass)
      {
        for (const auto &cell : mesh.active_cell_iterators())
          if ((cell->is_locally_owned() || !distributed) && is_too_coarse(cell))
            cell->set_refine_flag();
        mesh.execute_coarsening_and_refinement();
      }
  }


  namespace
  {
    /**
     * Let all processes agree on the marks: those on copies of other processes' cells decide with
     * which of its neighbours a cell may be merged, and the mesh would depend on how it is dealt
     * out. Collective.
     */
    template <int dim>
    void agree_on_marks(Triangulation<dim> &mesh)
    {
      enum Mark
      {
        none,
        refine,
        merge
      };
      using Cell         = typename Triangulation<dim>::active_cell_iterator;
      const auto mark_of = [](const Cell &cell) {
        return cell->refine_flag_set() ? refine : cell->coarsen_flag_set() ? merge : none;
      };
      const auto own_marks = [&] {
        std::vector<Mark> marks;
        for (const auto &cell : mesh.active_cell_iterators())
          if (cell->is_locally_owned())
            marks.push_back(mark_of(cell));
        return marks;
      };
      // Preparation refines more cells and merges fewer ones, so this comes to an end.
      for (bool changed = true; Utilities::MPI::max(changed ? 1 : 0, mesh.get_communicator()) > 0;)
        {
          GridTools::exchange_cell_data_to_ghosts<int, Triangulation<dim>>(
            mesh,
            [&](const Cell &cell) { return std::optional<int>(mark_of(cell)); },
            [](const Cell &cell, const int mark) {
              cell->clear_refine_flag();
              cell->clear_coarsen_flag();
              if (mark == refine)
                cell->set_refine_flag();
              else if (mark == merge)
                cell->set_coarsen_flag();
            });
          // A family is merged as a whole; of one of another process not all cells may be known
          // here.
          for (const auto &cell : mesh.active_cell_iterators())
            if (cell->is_artificial())
              cell->clear_coarsen_flag();
          for (const auto &cell : mesh.active_cell_iterators())
            if (cell->is_ghost() && cell->coarsen_flag_set())
              for (unsigned int k = 0; k < cell->parent()->n_children(); ++k)
                if (const auto sibling = cell->parent()->child(k);
                    sibling->is_active() && sibling->is_artificial())
                  sibling->set_coarsen_flag();
          const std::vector<Mark> before = own_marks();
          mesh.prepare_coarsening_and_refinement();
          changed = own_marks() != before;
        }
    }
  } // namespace


  template <int dim>
  bool Grading<dim>::mark(Triangulation<dim>        &mesh,
                          const std::vector<double> &indicators,
                          const double               target) const
  {
    // Squared indicators of a smooth field grow by 4 x 2^dim where cells are merged.
    const double low = target / (8. * (1u << dim));
    bool         any = false;
    for (const auto &cell : mesh.active_cell_iterators())
      {
        if (!cell->is_locally_owned())
          continue;
        const unsigned int level = cell->level();
        const double       own   = indicators[cell->active_cell_index()];
        if (level < finest && (own > target || is_too_coarse(cell)))
          cell->set_refine_flag();
        else if (level > coarsest && own < low && !is_too_coarse(cell->parent()))
          cell->set_coarsen_flag();
        any = any || cell->refine_flag_set() || cell->coarsen_flag_set();
      }
    any = Utilities::MPI::max(any ? 1 : 0, mesh.get_communicator()) > 0;
    if (any)
      agree_on_marks(mesh);
    return any;
  }


  template <int dim>
  CellWork<dim> work_of_cells(const Scene<dim> &scene)
  {
    const auto &models = scene.general.models;
    if (std::find(models.begin(), models.end(), ModelKind::coupled) == models.end() ||
        scene.coupling.zone == ZoneKind::everywhere)
      return {};
    auto zone = std::make_shared<Zone<dim>>(scene.coupling, scene.horizon());
    zone->set_cracks(scene.crack_history().pieces(scene.cracks.end_time));
    unsigned int of_elements = models.size();
    for (unsigned int d = 0; d < dim; ++d)
      of_elements *= 3;
    const double horizon = scene.horizon();
    return [zone, of_elements, horizon](const typename Triangulation<dim>::cell_iterator &cell) {
      if (!zone->contains(cell->center()))
        return of_elements;
      const double ball[] = {2., std::acos(-1.), 4. / 3. * std::acos(-1.)};
      return of_elements +
             static_cast<unsigned int>(ball[dim - 1] * std::pow(horizon, dim) / cell->measure());
    };
  }


  template <int dim>
  void MeshHistory::record(const Triangulation<dim> &mesh)
  {
    std::string refined, coarsened, all;
    for (const auto &cell : mesh.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          if (cell->refine_flag_set())
            refined += cell->id().to_string() + " ";
          if (cell->coarsen_flag_set())
            coarsened += cell->id().to_string() + " ";
        }
    for (const std::string &part : Utilities::MPI::all_gather(mesh.get_communicator(), refined))
      all += part;
    all += "; ";
    for (const std::string &part : Utilities::MPI::all_gather(mesh.get_communicator(), coarsened))
      all += part;
    marks.push_back(all);
  }


  template <int dim>
  void MeshHistory::repeat(Triangulation<dim> &mesh) const
  {
    for (const std::string &of_one : marks)
      {
        std::set<std::string> refined, coarsened, *list = &refined;
        std::istringstream    words(of_one);
        for (std::string word; words >> word;)
          if (word == ";")
            list = &coarsened;
          else
            list->insert(word);
        for (const auto &cell : mesh.active_cell_iterators())
          if (cell->is_locally_owned())
            {
              const std::string id = cell->id().to_string();
              if (refined.count(id) > 0)
                cell->set_refine_flag();
              if (coarsened.count(id) > 0)
                cell->set_coarsen_flag();
            }
        mesh.execute_coarsening_and_refinement();
      }
  }


  void MeshHistory::exchange(Archive &archive)
  {
    unsigned int n = marks.size();
    archive.exchange("adaptations", n);
    marks.resize(n);
    for (unsigned int k = 0; k < n; ++k)
      archive.exchange("marks " + std::to_string(k), marks[k]);
  }


#define PERIDEAL_TEMPLATES(dim)                                  \
  template void MeshHistory::record(const Triangulation<dim> &); \
  template void MeshHistory::repeat(Triangulation<dim> &) const;
  PERIDEAL_FOR_EACH_DIM(PERIDEAL_TEMPLATES)
#undef PERIDEAL_TEMPLATES
  PERIDEAL_INSTANTIATE_CLASS(class Grading);
  PERIDEAL_INSTANTIATE_FUNCTION(work_of_cells);
} // namespace PeriDeal
