// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/laws/crack_conductance.h>
#include <perideal/mesh/cut_cells.h>
#include <perideal/operators/parts/cut_cells.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  CutCells<dim>::CutCells(const DoFHandler<dim> &dofs, const Rule &rule)
    : dofs(dofs)
    , rule(rule)
    , cut(dofs.get_triangulation().n_active_cells(), false)
  {}


  template <int dim>
  void CutCells<dim>::set(const std::vector<CrackPiece<dim>> &pieces, const double transmission)
  {
    std::vector<Cell> cells;
    for (const auto &cell : dofs.active_cell_iterators())
      if (!rule.in_mesh && !cell->is_artificial())
        cells.push_back(cell);
    set(cells, pieces, transmission);
  }


  template <int dim>
  void CutCells<dim>::set(const std::vector<Cell>            &cells,
                          const std::vector<CrackPiece<dim>> &pieces,
                          const double                        new_transmission,
                          const BrokenBonds                  *broken_now)
  {
    broken       = broken_now != nullptr && !broken_now->empty() ? broken_now : nullptr;
    cracks       = rule.in_mesh ? std::vector<CrackGeometry<dim>>() : make_crack_geometries(pieces);
    transmission = new_transmission;
    const auto open = make_open_geometries(pieces);
    if (rule.in_part && !rule.in_mesh)
      {
        kept.resize(cut.size(), 1.);
        for (const Cell &cell : cells)
          kept[cell->active_cell_index()] = kept_of_cell(cell, cracks);
      }
    if (broken)
      damaged.resize(cut.size(), false);
    for (const Cell &cell : cells)
      {
        const unsigned int index = cell->active_cell_index();
        cut[index] = !rule.in_mesh && (rule.removes ? is_removed(cell, open, rule.mouths) :
                                                      PeriDeal::is_cut(cell, cracks));
        if (!damaged.empty())
          damaged[index] = false;
        if (!broken || (cut[index] && rule.removes))
          continue;
        for (const unsigned int a : cell->vertex_indices())
          for (unsigned int b = 0; b < a; ++b)
            damaged[index] = damaged[index] || kept_of_broken(cell, a, b) < 1.;
        cut[index] = cut[index] || damaged[index];
      }
  }


  template <int dim>
  double CutCells<dim>::kept_of_broken(const Cell        &cell,
                                       const unsigned int a,
                                       const unsigned int b) const
  {
    return broken ?
             broken->kept_fraction(cell->vertex_dof_index(a, 0), cell->vertex_dof_index(b, 0)) :
             1.;
  }


  template <int dim>
  bool CutCells<dim>::is_cut(const Cell &cell) const
  {
    return cut[cell->active_cell_index()];
  }


  template <int dim>
  double CutCells<dim>::kept_of_removed(const Cell &cell) const
  {
    return !kept.empty() ? kept[cell->active_cell_index()] : is_cut(cell) ? 0. : 1.;
  }


  template <int dim>
  bool CutCells<dim>::removes() const
  {
    return rule.removes;
  }


  template <int dim>
  bool CutCells<dim>::conducts() const
  {
    return rule.contact < 0. ? transmission > 0. : rule.contact > 0.;
  }


  template <int dim>
  double CutCells<dim>::kept_fraction(const Cell                                &cell,
                                      const unsigned int                         a,
                                      const unsigned int                         b,
                                      const PairConductivity                    &conductivity,
                                      std::vector<std::pair<unsigned int, int>> *crossed) const
  {
    const Tensor<1, dim> xi      = cell->vertex(b) - cell->vertex(a);
    const bool           contact = rule.contact >= 0.;
    double               kept    = 1.;
    for (std::size_t k = 0; k < cracks.size();)
      {
        double fraction = 1.; // several pieces of a crack between two vertices are one crossing
        const unsigned int crack = cracks[k].crack;
        bool               seen  = false;
        for (; k < cracks.size() && cracks[k].crack == crack; ++k)
          {
            if (!cracks[k].separates(cell->vertex(a), cell->vertex(b)))
              continue;
            if (crossed != nullptr && !seen)
              crossed->emplace_back(crack,
                                    cracks[k].signed_distance(cell->vertex(a)) > 0. ? 1 : -1);
            seen = true;
            if (!contact && (transmission == 0. || transmission >= 1.)) // needs no horizon
              {
                fraction = std::min(fraction, transmission);
                continue;
              }
            const double kappa = conductivity(a, b);
            const double H     = contact ? rule.contact :
                                           contact_conductance_of_transmission(
                                         transmission,
                                         kappa,
                                         rule.horizon(),
                                         rule.horizon() / cell->minimum_vertex_distance());
            fraction =
              std::min(fraction, contact_fraction(H, std::abs(xi * cracks[k].normal()), kappa));
          }
        kept *= fraction;
      }
    return kept * kept_of_broken(cell, a, b);
  }


  template <int dim>
  double CutCells<dim>::conductivity_between(const Cell         &cell,
                                             const unsigned int  a,
                                             const unsigned int  b,
                                             const Conductivity &conductivity) const
  {
    const Point<dim>   &start = cell->vertex(a), &end = cell->vertex(b);
    std::vector<double> crossings{0., 1.};
    const double        step = 1e-6 * cell->minimum_vertex_distance();
    Tensor<1, dim>      aside; // what lies on a crack belongs to its left
    for (const CrackGeometry<dim> &crack : cracks)
      {
        const double at_a = crack.signed_distance(start), at_b = crack.signed_distance(end);
        if (crack.separates(start, end))
          crossings.push_back(std::abs(at_a) / (std::abs(at_a) + std::abs(at_b)));
        else if (std::abs(at_a) < 1e-3 * step && std::abs(at_b) < 1e-3 * step)
          aside = step * crack.normal();
      }
    std::sort(crossings.begin(), crossings.end());
    double resistance = 0.;
    for (std::size_t k = 1; k < crossings.size(); ++k)
      {
        const double from = crossings[k - 1], part = crossings[k] - from;
        if (part < 1e-9)
          continue;
        for (const double s : {from + 0.25 * part, from + 0.75 * part})
          {
            const unsigned int vertex = k == 1 && crossings.size() > 2 ? a :
                                        crossings.size() > 2           ? b :
                                        s < 0.5                        ? a :
                                                                         b;
            resistance +=
              0.5 * part / conductivity(Point<dim>(start + s * (end - start) + aside), vertex);
          }
      }
    return 1. / resistance;
  }


  template <int dim>
  void CutCells<dim>::conduct_in_pairs(const Cell         &cell,
                                       const Conductivity &conductivity,
                                       FullMatrix<double> &stiffness) const
  {
    for (const unsigned int a : cell->vertex_indices())
      stiffness(a, a) = 0.;
    for (const unsigned int a : cell->vertex_indices())
      for (unsigned int b = 0; b < a; ++b)
        {
          const double w  = -stiffness(a, b) * conductivity_between(cell, a, b, conductivity);
          stiffness(a, b) = stiffness(b, a) = -w;
          stiffness(a, a) += w;
          stiffness(b, b) += w;
        }
  }


  template <int dim>
  void CutCells<dim>::cut_matrix(const Cell                 &cell,
                                 const PairConductivity     &conductivity,
                                 FullMatrix<double>         &stiffness,
                                 std::vector<SeparatedPair> *separated) const
  {
    const FullMatrix<double> original = stiffness;
    stiffness                         = 0.;
    if (rule.removes && !(broken && damaged[cell->active_cell_index()]))
      return;
    std::vector<std::pair<unsigned int, int>> crossed;
    bool                                      is_whole = true, has_positive = false;
    for (const unsigned int a : cell->vertex_indices())
      for (unsigned int b = 0; b < a; ++b)
        {
          crossed.clear();
          const double kept  = kept_fraction(cell, a, b, conductivity, &crossed),
                       whole = std::max(0., -original(a, b)), w = whole * kept;
          if (separated != nullptr && (!crossed.empty() || kept < 1.))
            separated->push_back({a, b, w, whole});
          is_whole     = is_whole && kept >= 1.;
          has_positive = has_positive || original(a, b) > 1e-12 * original(a, a);
          stiffness(a, b) -= w;
          stiffness(b, a) -= w;
          stiffness(a, a) += w;
          stiffness(b, b) += w;
        }
    if (is_whole) // with its positive entries
      stiffness = original;
    else
      stiffer = stiffer || has_positive;
  }


  PERIDEAL_INSTANTIATE_CLASS(class CutCells);
} // namespace PeriDeal
