// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

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
  const std::vector<bool> &CutCells<dim>::flags() const
  {
    return cut;
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
                                      const std::function<double()>             &conductivity,
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
            const double kappa = conductivity();
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
  void CutCells<dim>::cut_matrix(const Cell                    &cell,
                                 const std::function<double()> &conductivity,
                                 FullMatrix<double>            &stiffness,
                                 std::vector<SeparatedPair>    *separated) const
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


  template <int dim>
  bool CutCells<dim>::pairs_are_stiffer() const
  {
    return stiffer;
  }


  template class CutCells<1>;
  template class CutCells<2>;
  template class CutCells<3>;
} // namespace PeriDeal
