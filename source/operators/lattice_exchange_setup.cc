// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// What an exchange on a lattice has to know before it can begin.

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>

#include <perideal/base/user_error.h>
#include <perideal/mesh/lattice_sites.h>
#include <perideal/operators/lattice_exchange.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** The matrix of a brick cell with a conductivity tensor that is diagonal. */
    template <int dim>
    FullMatrix<double> brick_matrix(const Tensor<1, dim>          &spacing,
                                    const std::array<double, dim> &conductivities)
    {
      constexpr unsigned int n = GeometryInfo<dim>::vertices_per_cell;
      FullMatrix<double>     matrix(n, n);
      for (unsigned int a = 0; a < n; ++a)
        for (unsigned int b = 0; b < n; ++b)
          for (unsigned int d = 0; d < dim; ++d)
            {
              double term = conductivities[d];
              for (unsigned int e = 0; e < dim; ++e)
                {
                  const bool same = ((a >> e) & 1) == ((b >> e) & 1);
                  term *= e == d ? (same ? 1. : -1.) / spacing[e] :
                                   (same ? 1. / 3. : 1. / 6.) * spacing[e];
                }
              matrix(a, b) += term;
            }
      return matrix;
    }
  } // namespace


  template <int dim>
  LatticeExchange<dim>::LatticeExchange(Nodes<dim>       &nodes,
                                        const Scene<dim> &scene,
                                        const Zone<dim>  &zone)
    : bonds(nodes, scene, HaloAround::cells)
    , zone(zone)
    , last(scene.cracks.end_time)
  {
    plain = bonds.uniform_conductivity() && scene.domain.shape == Shape::box && !nodes.is_graded();
    form  = scene.peridynamics.form;
    AssertThrow(
      plain || form != OperatorForm::lattice || !zone.is_everywhere(),
      UserError(
        "'Operator form = lattice' in section 'Peridynamics' is not possible here: the conductivity varies or "
        "the body has voids. Use 'auto'."));
    find_offsets();
    find_sites(scene);
    find_cells(scene);
    find_full_matrix();
  }


  template <int dim>
  void LatticeExchange<dim>::find_offsets()
  {
    for (const FamilyMember<dim> &member : bonds.lattice_members())
      {
        for (unsigned int d = 0; d < dim; ++d)
          reach[d] = std::max(reach[d], member.offset[d]);
        // One of each pair of opposite offsets.
        unsigned int last = dim;
        while (last > 0 && member.offset[last - 1] == 0)
          --last;
        if (member.offset[last - 1] > 0)
          offsets.push_back({member.offset, member.weight, bond_pieces<dim>(member.offset)});
      }
    for (unsigned int k = 0; k < offsets.size(); ++k)
      for (unsigned int p = 0; p < offsets[k].pieces.size(); ++p)
        {
          const BondPiece<dim> &piece = offsets[k].pieces[p];
          for (unsigned int c = 0; c < piece.cells.size(); ++c)
            {
              Passage passage{k, p, piece.cells[c], piece.change[c]};
              for (int &x : passage.start)
                x = -x;
              for (double &x : passage.change)
                x /= std::sqrt(piece.length);
              passages.push_back(passage);
            }
        }
  }


  template <int dim>
  void LatticeExchange<dim>::set_table_around(const std::vector<bool> &candidates)
  {
    Site low{}, high{};
    bool any = false;
    for (unsigned int i = 0; i < candidates.size(); ++i)
      if (candidates[i])
        {
          const Site site = site_of(i);
          for (unsigned int d = 0; d < dim; ++d)
            {
              low[d]  = any ? std::min(low[d], site[d]) : site[d];
              high[d] = any ? std::max(high[d], site[d]) : site[d];
            }
          any = true;
        }
    if (!any)
      return;
    // One more site on each side: cells around the outermost bonds.
    std::size_t n_sites = 1;
    for (unsigned int d = 0; d < dim; ++d)
      {
        corner[d] = low[d] - 1;
        extent[d] = high[d] - low[d] + 3;
        n_sites *= extent[d];
      }
    sites.resize(n_sites);
  }


  template <int dim>
  void LatticeExchange<dim>::find_sites(const Scene<dim> &scene)
  {
    const Nodes<dim>        &nodes   = bonds.nodes();
    const Lattice<dim>      &lattice = *nodes.lattice();
    const CrackHistory<dim> &history = bonds.crack_history();
    Zone<dim>                at_end  = zone;
    at_end.set_cracks(history.pieces(last));
    zone.set_cracks(history.pieces(history.representative(0.)));
    const std::vector<bool> hanging = hanging_nodes(nodes);
    std::vector<bool>       candidates(nodes.n_local());
    double                  n_in_zone = 0.;
    for (unsigned int i = 0; i < nodes.n_local(); ++i)
      {
        // Beside larger cells a node has more volume than a cell of the lattice.
        candidates[i] = !hanging[i] && nodes.volume(i) < lattice.cell_volume() * (1. + 1e-9) &&
                        at_end.contains(nodes.position(i));
        n_in_zone += i < nodes.n_owned() && candidates[i];
      }
    // A mesh that follows the cracks may have no fine cell before the first of them.
    if (scene.coupling.zone != ZoneKind::adaptive)
      throw_if_zone_empty(n_in_zone, nodes.communicator());
    set_table_around(candidates);
    for (unsigned int i = 0; i < nodes.n_local(); ++i)
      if (at(site_of(i)) != nullptr)
        {
          SiteData &site = own(site_of(i));
          site.node      = i;
          site.volume    = nodes.volume(i);
          site.may_join  = candidates[i];
          site.in_zone   = site.may_join && zone.contains(nodes.position(i));
        }
  }


  template <int dim>
  void LatticeExchange<dim>::find_cells(const Scene<dim> &scene)
  {
    if (sites.empty())
      return;
    const Lattice<dim> &lattice = *bonds.nodes().lattice();
    const QGauss<dim>   points(2);
    Site                last = corner;
    for (unsigned int d = 0; d < dim; ++d)
      last[d] += extent[d] - 2;
    for_each_site(corner, last, [&](const Site &site) {
      SiteData &data = own(site);
      data.cell      = true;
      for (unsigned int v = 0; v < GeometryInfo<dim>::vertices_per_cell; ++v)
        {
          Site other = site;
          for (unsigned int d = 0; d < dim; ++d)
            other[d] += (v >> d) & 1;
          data.cell = data.cell && at(other)->node != numbers::invalid_unsigned_int;
        }
      const Point<dim> low = lattice.position(site);
      data.cell            = data.cell && !scene.domain.in_hole(low + 0.5 * lattice.spacing);
      if (!data.cell)
        return;
      if (bonds.uniform_conductivity())
        {
          data.lowest = data.highest = bonds.conductivity(0);
          return;
        }
      data.lowest = std::numeric_limits<double>::max();
      for (const Point<dim> &q : points.get_points())
        {
          Point<dim> p = low;
          for (unsigned int d = 0; d < dim; ++d)
            p[d] += q[d] * lattice.spacing[d];
          const double kappa = scene.material.conductivity.value(p);
          data.lowest        = std::min(data.lowest, kappa);
          data.highest       = std::max(data.highest, kappa);
        }
    });
  }


  template <int dim>
  void LatticeExchange<dim>::find_full_matrix()
  {
    const Lattice<dim>     &lattice = *bonds.nodes().lattice();
    const double            volume  = lattice.cell_volume();
    std::array<double, dim> A{};
    constexpr unsigned int  n = GeometryInfo<dim>::vertices_per_cell;
    surplus.reinit(n, n);
    for (const Offset &offset : offsets)
      for (unsigned int d = 0; d < dim; ++d)
        A[d] += offset.weight * volume * std::pow(offset.site[d] * lattice.spacing[d], 2);
    for (const Passage &passage : passages)
      {
        const Offset &offset = offsets[passage.offset];
        const double  share =
          offset.weight * volume * volume / offset.pieces[passage.piece].cells.size();
        for (unsigned int a = 0; a < n; ++a)
          for (unsigned int b = 0; b < n; ++b)
            surplus(a, b) += share * passage.change[a] * passage.change[b];
      }
    surplus.add(-1., brick_matrix<dim>(lattice.spacing, A));
    calibrated =
      std::all_of(A.begin(), A.end(), [](const double a) { return std::abs(a - 1.) < 1e-12; });
  }


#define PERIDEAL_INSTANTIATE(dim)                                                  \
  template LatticeExchange<dim>::LatticeExchange(Nodes<dim> &,                     \
                                                 const Scene<dim> &,               \
                                                 const Zone<dim> &);               \
  template void LatticeExchange<dim>::find_offsets();                              \
  template void LatticeExchange<dim>::find_sites(const Scene<dim> &);              \
  template void LatticeExchange<dim>::set_table_around(const std::vector<bool> &); \
  template void LatticeExchange<dim>::find_cells(const Scene<dim> &);              \
  template void LatticeExchange<dim>::find_full_matrix();
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
