// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/user_error.h>
#include <perideal/operators/mesh_exchange.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh_exchange_tree.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    constexpr double largest_contrast = 1.5; // of conductivity on an active bond's way
    constexpr double part_to_take     = 0.9; // of what a distorted cell has
    constexpr double least_kept       = 0.2; // of all bonds' conductance
  }                                          // namespace


  template <int dim>
  MeshExchange<dim>::MeshExchange(Nodes<dim> &nodes, const Scene<dim> &scene, const Zone<dim> &zone)
    : bonds(nodes, scene, HaloAround::cells)
    , zone(zone)
    , last(scene.cracks.end_time)
  {
    const CrackHistory<dim> &history = bonds.crack_history();
    Zone<dim>                at_end  = zone;
    at_end.set_cracks(history.pieces(last));
    this->zone.set_cracks(history.pieces(history.representative(0.)));
    const std::vector<bool> hanging   = hanging_nodes(nodes);
    double                  n_in_zone = 0.;
    joined.resize(nodes.n_local());
    may_join.resize(nodes.n_local());
    for (unsigned int i = 0; i < nodes.n_local(); ++i)
      {
        may_join[i] = !hanging[i] && at_end.contains(nodes.position(i));
        joined[i]   = may_join[i] && this->zone.contains(nodes.position(i));
        n_in_zone += i < nodes.n_owned() && may_join[i];
      }
    throw_if_zone_empty(n_in_zone, nodes.communicator());
    find_cells(scene);
    send_cells();
    tree = std::make_unique<Tree>(cells);
    find_bonds();
    const double kept = kept_share();
    AssertThrow(
      kept > least_kept,
      UserError(
        "'Zone' in section 'Coupling': the cells of the zone are so distorted that only " +
        std::to_string(100. * kept) +
        " % of the bonds' conductance can be exchanged. Use a mesh with better cells there, or a smaller zone."));
  }


  template <int dim>
  MeshExchange<dim>::~MeshExchange() = default;


  template <int dim>
  bool MeshExchange<dim>::follow(const ZoneBond &bond, std::vector<Passage> &way) const
  {
    const Nodes<dim>         &nodes = bonds.nodes();
    const Point<dim>         &a = nodes.position(bond.nodes[0]), &b = nodes.position(bond.nodes[1]);
    std::vector<unsigned int> near;
    tree->find(a, b, near);
    std::vector<double> places{0., 1.};
    for (const unsigned int c : near)
      add_face_crossings(cells[c].corners, a, b, places);
    std::sort(places.begin(), places.end());
    constexpr double    apart = 1e-9;
    std::vector<double> cuts{0.};
    for (const double s : places)
      if (s > cuts.back() + apart && s < 1. - apart)
        cuts.push_back(s);
    cuts.push_back(1.);
    // Which side of a crack cut into the mesh a bond runs along is told by the crack points of its nodes.
    const Point<dim> aside_a = nodes.crack_point(bond.nodes[0]),
                     aside_b = nodes.crack_point(bond.nodes[1]);
    way.clear();
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k)
      {
        const double      middle = 0.5 * (cuts[k] + cuts[k + 1]);
        const Point<dim>  p      = aside_a + middle * (aside_b - aside_a);
        const std::size_t first  = way.size();
        Point<dim>        unit;
        for (const unsigned int c : near)
          {
            if (!tree->box_holds(c, p) || !unit_point(cells[c].corners, p, unit))
              continue;
            constexpr double slack =
              1e-9; // less than the crack points of a bond lie beside its nodes
            bool in = true;
            for (unsigned int d = 0; d < dim; ++d)
              in = in && unit[d] > -slack && unit[d] < 1. + slack;
            if (!in)
              continue;
            Point<dim> from, to;
            if (!unit_point(cells[c].corners, a + cuts[k] * (b - a), from) ||
                !unit_point(cells[c].corners, a + cuts[k + 1] * (b - a), to))
              return false;
            Passage    passage;
            const auto before = shape_values(from);
            passage.change    = shape_values(to);
            passage.cell      = c;
            for (unsigned int v = 0; v < n_corners; ++v)
              passage.change[v] -= before[v];
            way.push_back(passage);
          }
        const std::size_t n_around = way.size() - first;
        if (n_around == 0)
          return false; // leaves the body
        const double factor = 1. / std::sqrt((cuts[k + 1] - cuts[k]) * n_around);
        for (std::size_t w = first; w < way.size(); ++w)
          for (double &x : way[w].change)
            x *= factor;
      }
    return true;
  }


  template <int dim>
  void MeshExchange<dim>::find_bonds()
  {
    const Nodes<dim>    &nodes = bonds.nodes();
    std::vector<Bond>    family;
    std::vector<Passage> way;
    zone_bonds.clear();
    passages.clear();
    bonds_of_node.assign(nodes.n_owned(), {});
    const unsigned int                     n_own_cells = taken.size();
    std::vector<std::vector<unsigned int>> ways; // cells of each bond, those of other processes too
    for (unsigned int i = 0; i < nodes.n_local(); ++i)
      {
        if (!joined[i])
          continue;
        bonds.known_bonds_of(i, family);
        for (const Bond &bond : family)
          {
            if (bond.neighbor < i || !joined[bond.neighbor] || bonds.is_parted(i, bond.neighbor))
              continue;
            ZoneBond zone_bond{{i, bond.neighbor}, bond.intact};
            if (!follow(zone_bond, way))
              continue;
            double lowest = std::numeric_limits<double>::max(), highest = 0.;
            for (const Passage &passage : way)
              {
                lowest  = std::min(lowest, cells[passage.cell].lowest);
                highest = std::max(highest, cells[passage.cell].highest);
              }
            if (highest > largest_contrast * lowest)
              continue;
            zone_bond.intact *= lowest / bonds.bond_conductivity(i, bond.neighbor);
            const unsigned int number = zone_bonds.size();
            ways.emplace_back();
            for (Passage &passage : way)
              {
                passage.bond = number;
                ways.back().push_back(passage.cell);
                if (passage.cell < n_own_cells)
                  passages.push_back(passage);
              }
            for (const unsigned int node : zone_bond.nodes)
              if (node < nodes.n_owned())
                bonds_of_node[node].push_back(number);
            zone_bonds.push_back(zone_bond);
          }
      }
    sum_up();
    find_strains();
    share_strains();
    for (std::size_t k = 0; k < zone_bonds.size(); ++k)
      for (const unsigned int c : ways[k])
        if (cells[c].strain > part_to_take)
          zone_bonds[k].scale = std::min(zone_bonds[k].scale, part_to_take / cells[c].strain);
    sum_up();
  }


  template <int dim>
  void MeshExchange<dim>::sum_up()
  {
    for (auto &matrix : taken)
      matrix.clear();
    for (const Passage &passage : passages)
      {
        auto        &matrix = taken[passage.cell];
        const double weight = zone_bonds[passage.bond].intact * zone_bonds[passage.bond].scale;
        matrix.resize(n_corners * n_corners, 0.);
        for (unsigned int a = 0; a < n_corners; ++a)
          for (unsigned int b = 0; b < n_corners; ++b)
            matrix[a * n_corners + b] += weight * passage.change[a] * passage.change[b];
      }
  }


  template <int dim>
  void MeshExchange<dim>::find_strains()
  {
    for (unsigned int c = 0; c < taken.size(); ++c)
      {
        cells[c].strain = 0.;
        if (taken[c].empty())
          continue;
        // sum W L on the linear fields x_a; K_c is kappa times the volume there.
        Eigen::Matrix<double, dim, dim> linear = Eigen::Matrix<double, dim, dim>::Zero();
        for (unsigned int a = 0; a < n_corners; ++a)
          for (unsigned int b = 0; b < n_corners; ++b)
            for (unsigned int d = 0; d < dim; ++d)
              for (unsigned int e = 0; e < dim; ++e)
                linear(d, e) +=
                  cells[c].corners[a][d] * taken[c][a * n_corners + b] * cells[c].corners[b][e];
        const double largest =
          Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, dim, dim>>(linear)
            .eigenvalues()
            .maxCoeff();
        cells[c].strain = largest / (cells[c].lowest * tree->volume(c));
      }
  }


  template <int dim>
  void MeshExchange<dim>::bonds_of(const unsigned int node, std::vector<Bond> &list) const
  {
    list.clear();
    for (const unsigned int number : bonds_of_node[node])
      {
        const ZoneBond &zone_bond = zone_bonds[number];
        Bond            bond;
        bond.neighbor = zone_bond.nodes[zone_bond.nodes[0] == node ? 1 : 0];
        bond.intact   = zone_bond.intact * zone_bond.scale;
        bond.weight   = bond.intact * bonds.kept_fraction(node, bond.neighbor, bond.cut);
        list.push_back(bond);
      }
  }


  template <int dim>
  void MeshExchange<dim>::possible_neighbors_of(const unsigned int         node,
                                                std::vector<unsigned int> &neighbors) const
  {
    neighbors.clear();
    if (!may_join[node])
      return;
    std::vector<Bond> family;
    bonds.known_bonds_of(node, family);
    for (const Bond &bond : family)
      if (may_join[bond.neighbor])
        neighbors.push_back(bond.neighbor);
  }


  template <int dim>
  bool MeshExchange<dim>::change_cell(const Cell &cell, FullMatrix<double> &stiffness) const
  {
    const unsigned int c = cell_of_index[cell->active_cell_index()];
    if (c >= taken.size() || taken[c].empty())
      return false;
    using Matrix = Eigen::MatrixXd;
    Matrix rest(n_corners, n_corners), fields(n_corners, n_corners);
    for (unsigned int a = 0; a < n_corners; ++a)
      for (unsigned int b = 0; b < n_corners; ++b)
        rest(a, b) = stiffness(a, b) - taken[c][a * n_corners + b];
    // Columns: constant, linear fields, and anything else to complete an orthonormal basis.
    const Matrix start = [&] {
      Matrix columns(n_corners, dim + 1);
      for (unsigned int a = 0; a < n_corners; ++a)
        {
          columns(a, 0) = 1.;
          for (unsigned int d = 0; d < dim; ++d)
            columns(a, d + 1) = (cells[c].corners[a] - cells[c].corners[0])[d];
        }
      return columns;
    }();
    fields =
      Eigen::HouseholderQR<Matrix>(start).householderQ() * Matrix::Identity(n_corners, n_corners);
    const auto   X = fields.middleCols(1, dim);
    const auto   H = fields.rightCols(n_corners - dim - 1);
    const Matrix A = X.transpose() * rest * X, B = X.transpose() * rest * H,
                 C = H.transpose() * rest * H;
    const Eigen::SelfAdjointEigenSolver<Matrix> linear(A);
    Matrix                                      inverse = Matrix::Zero(dim, dim);
    const double                                size    = rest.cwiseAbs().maxCoeff();
    for (unsigned int d = 0; d < dim; ++d)
      if (linear.eigenvalues()[d] > 1e-12 * size)
        inverse += linear.eigenvectors().col(d) * linear.eigenvectors().col(d).transpose() /
                   linear.eigenvalues()[d];
    const Eigen::SelfAdjointEigenSolver<Matrix> lack(B.transpose() * inverse * B - C);
    const Matrix E = lack.eigenvectors() * lack.eigenvalues().cwiseMax(0.).asDiagonal() *
                     lack.eigenvectors().transpose();
    rest += H * E * H.transpose();
    for (unsigned int a = 0; a < n_corners; ++a)
      for (unsigned int b = 0; b < n_corners; ++b)
        stiffness(a, b) = 0.5 * (rest(a, b) + rest(b, a));
    return true;
  }


  template <int dim>
  bool MeshExchange<dim>::symmetric() const
  {
    return true;
  }


  template <int dim>
  std::vector<BoundingBox<dim>> MeshExchange<dim>::joining_by(const double time) const
  {
    std::vector<BoundingBox<dim>> boxes;
    if (!zone.follows_cracks())
      return boxes;
    Zone<dim> then = zone;
    then.set_cracks(bonds.crack_history().pieces(time));
    for (unsigned int i = 0; i < joined.size(); ++i)
      if (may_join[i] && !joined[i] && then.contains(bonds.nodes().position(i)))
        {
          // New bonds may change the scaling of all that pass the cells on their way.
          boxes.push_back({{bonds.nodes().position(i), bonds.nodes().position(i)}});
          boxes.back().extend(2. * bonds.reach());
        }
    return boxes;
  }


  template <int dim>
  void MeshExchange<dim>::set_cracks_of(const double time)
  {
    bool any = false;
    bonds.set_cracks_of(time);
    zone.set_cracks(bonds.crack_history().pieces(time));
    for (unsigned int i = 0; i < joined.size() && zone.follows_cracks(); ++i)
      if (may_join[i] && !joined[i] && zone.contains(bonds.nodes().position(i)))
        {
          joined[i] = true;
          any       = true;
        }
    if (Utilities::MPI::max(any ? 1 : 0, bonds.nodes().communicator()) > 0)
      find_bonds();
  }


  template <int dim>
  double MeshExchange<dim>::kept_share() const
  {
    double all = 0., kept = 0.;
    for (const ZoneBond &bond : zone_bonds)
      {
        all += bond.intact;
        kept += bond.intact * bond.scale;
      }
    all  = Utilities::MPI::sum(all, bonds.nodes().communicator());
    kept = Utilities::MPI::sum(kept, bonds.nodes().communicator());
    return all > 0. ? kept / all : 1.;
  }


  template <int dim>
  bool MeshExchange<dim>::in_zone(const unsigned int node) const
  {
    return joined[node];
  }

  template <int dim>
  const Families<dim> &MeshExchange<dim>::families() const
  {
    return bonds;
  }

  template <int dim>
  std::size_t MeshExchange<dim>::memory_consumption() const
  {
    return bonds.memory_consumption() + cells.capacity() * sizeof(NearCell) +
           zone_bonds.capacity() * sizeof(ZoneBond) + passages.capacity() * sizeof(Passage);
  }


  template class MeshExchange<1>;
  template class MeshExchange<2>;
  template class MeshExchange<3>;
} // namespace PeriDeal
