// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>

#include <perideal/base/user_error.h>
#include <perideal/laws/interface.h>
#include <perideal/operators/mesh_exchange.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    constexpr double part_to_take = 0.9; // of what a distorted cell has
    constexpr double least_kept   = 0.2; // of all bonds' conductance


    template <int dim>
    double volume_of(const CellCorners<dim> &corners)
    {
      static const QGauss<dim> points(2); // exact for the determinant of the mapping
      double                   volume = 0.;
      for (unsigned int q = 0; q < points.size(); ++q)
        volume += points.weight(q) * volume_element(corners, points.point(q));
      return volume;
    }


    /** The zone when all cracks have grown. */
    template <int dim>
    Zone<dim> zone_at_end(Zone<dim> zone, const Scene<dim> &scene)
    {
      zone.set_cracks(scene.crack_history().pieces(scene.cracks.end_time));
      return zone;
    }
  } // namespace


  template <int dim>
  MeshExchange<dim>::MeshExchange(Nodes<dim> &nodes, const Scene<dim> &scene, const Zone<dim> &zone)
    : own_families(
        nodes,
        scene,
        HaloAround::cells,
        [at_end = zone_at_end(zone, scene)](const Point<dim> &p) { return at_end.contains(p); })
    , bonds(own_families, scene)
    , zone(zone)
  {
    const CrackHistory<dim> &history = bonds.cracks().history();
    const Zone<dim>          at_end  = zone_at_end(zone, scene);
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
    stays = joined == may_join;
    throw_if_zone_empty(n_in_zone, nodes.communicator());
    find_cells(scene);
    send_cells();
    find_paths(hanging);
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
  void MeshExchange<dim>::find_paths(const std::vector<bool> &hanging)
  {
    const Nodes<dim>       &nodes = bonds.nodes();
    std::vector<Point<dim>> ends; // all that may ever join
    for (unsigned int i = 0; i < nodes.n_local(); ++i)
      if (may_join[i])
        ends.push_back(nodes.position(i));
    const bool regular =
      Utilities::MPI::min(
        nodes.has_doubled_nodes() ||
            std::any_of(hanging.begin(), hanging.end(), [](const bool h) { return h; }) ?
          0 :
          1,
        nodes.communicator()) > 0;
    paths =
      std::make_unique<CellPaths<dim>>(cells, ends, bonds.weights().reach() * (1. + 1e-6), regular);
  }


  template <int dim>
  bool MeshExchange<dim>::follow(const ZoneBond &bond, std::vector<PathPiece<dim>> &way)
  {
    const Nodes<dim> &nodes = bonds.nodes();
    const auto        end   = [&](const unsigned int i) {
      return PathEnd<dim>{nodes.partitioner()->local_to_global(i),
                          nodes.position(i),
                          nodes.crack_point(i)};
    };
    return paths->follow(end(bond.nodes[0]), end(bond.nodes[1]), way);
  }


  template <int dim>
  bool MeshExchange<dim>::starts_at(const unsigned int one, const unsigned int other) const
  {
    const Point<dim> &p = bonds.nodes().position(one), &q = bonds.nodes().position(other);
    for (unsigned int d = dim; d-- > 0;)
      if (p[d] != q[d])
        return p[d] < q[d];
    return one < other; // twins across a crack, which have no bond
  }


  template <int dim>
  void MeshExchange<dim>::find_bonds()
  {
    const Nodes<dim>           &nodes = bonds.nodes();
    std::vector<Bond>           family;
    std::vector<PathPiece<dim>> way;
    zone_bonds.clear();
    for (auto &matrix : taken)
      matrix.clear();
    bonds_of_node.assign(nodes.n_owned(), {});
    std::vector<unsigned int> way_cells; // of each bond in turn, those of other processes too
    std::vector<std::size_t>  way_ends;
    for (unsigned int i = 0; i < nodes.n_local(); ++i)
      {
        if (!joined[i])
          continue;
        bonds.known_bonds_of(i, family);
        for (const Bond &bond : family)
          {
            if (!joined[bond.neighbor] || !starts_at(i, bond.neighbor) ||
                own_families.is_parted(i, bond.neighbor))
              continue;
            ZoneBond zone_bond{{i, bond.neighbor}, bond.intact};
            if (!follow(zone_bond, way))
              continue;
            double lowest = std::numeric_limits<double>::max(), highest = 0.;
            for (const PathPiece<dim> &piece : way)
              {
                lowest  = std::min(lowest, states[piece.cell].lowest);
                highest = std::max(highest, states[piece.cell].highest);
              }
            if (highest > largest_contrast * lowest)
              continue;
            zone_bond.intact *= lowest / bonds.conductivities().of_bond(i, bond.neighbor);
            const unsigned int number = zone_bonds.size();
            take(zone_bond.intact, way);
            for (const PathPiece<dim> &piece : way)
              way_cells.push_back(piece.cell);
            way_ends.push_back(way_cells.size());
            for (const unsigned int node : zone_bond.nodes)
              if (node < nodes.n_owned())
                bonds_of_node[node].push_back(number);
            zone_bonds.push_back(zone_bond);
          }
      }
    find_strains();
    share_strains();
    scale_bonds(way_cells, way_ends);
  }


  template <int dim>
  void MeshExchange<dim>::scale_bonds(const std::vector<unsigned int> &way_cells,
                                      const std::vector<std::size_t>  &way_ends)
  {
    std::vector<PathPiece<dim>> way;
    for (std::size_t k = 0, w = 0; k < zone_bonds.size(); ++k)
      {
        ZoneBond &bond = zone_bonds[k];
        for (; w < way_ends[k]; ++w)
          if (const double strain = states[way_cells[w]].strain; strain > part_to_take)
            bond.scale = std::min(bond.scale, part_to_take / strain);
        // Following it again is cheaper than the memory for all ways.
        if (bond.scale < 1. && follow(bond, way))
          take((bond.scale - 1.) * bond.intact, way);
      }
  }


  template <int dim>
  void MeshExchange<dim>::take(const double weight, const std::vector<PathPiece<dim>> &way)
  {
    for (const PathPiece<dim> &piece : way)
      {
        if (piece.cell >= taken.size())
          continue; // of another process
        taken[piece.cell].resize(n_corners * n_corners, 0.);
        const auto    change = piece.change;
        double *const matrix = taken[piece.cell].data();
        for (unsigned int a = 0; a < n_corners; ++a)
          {
            const double factor = weight * change[a];
            for (unsigned int b = 0; b < n_corners; ++b)
              matrix[a * n_corners + b] += factor * change[b];
          }
      }
  }


  template <int dim>
  void MeshExchange<dim>::find_strains()
  {
    for (unsigned int c = 0; c < taken.size(); ++c)
      {
        states[c].strain = 0.;
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
        states[c].strain = largest / (states[c].lowest * volume_of(cells[c].corners));
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
    if (stays)
      {
        for (const unsigned int number : bonds_of_node[node])
          neighbors.push_back(
            zone_bonds[number].nodes[zone_bonds[number].nodes[0] == node ? 1 : 0]);
        return;
      }
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
    then.set_cracks(bonds.cracks().history().pieces(time));
    for (unsigned int i = 0; i < joined.size(); ++i)
      if (may_join[i] && !joined[i] && then.contains(bonds.nodes().position(i)))
        {
          // New bonds may change the scaling of all that pass the cells on their way.
          boxes.push_back({{bonds.nodes().position(i), bonds.nodes().position(i)}});
          boxes.back().extend(2. * bonds.weights().reach());
        }
    return boxes;
  }


  template <int dim>
  void MeshExchange<dim>::set_cracks_of(const double time)
  {
    bool any = false;
    bonds.cracks().set_time(time);
    zone.set_cracks(bonds.cracks().history().pieces(time));
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
    double all  = 0.,
           kept = 0.; // each bond once at each of its ends, by the process that has the end
    for (const auto &numbers : bonds_of_node)
      for (const unsigned int number : numbers)
        {
          all += zone_bonds[number].intact;
          kept += zone_bonds[number].intact * zone_bonds[number].scale;
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
    return own_families;
  }

  template <int dim>
  std::size_t MeshExchange<dim>::memory_consumption() const
  {
    std::size_t memory =
      own_families.memory_consumption() + bonds.memory_consumption() + paths->memory_consumption() +
      cells.capacity() * (sizeof(PathCell<dim>) + sizeof(CellState)) +
      zone_bonds.capacity() * sizeof(ZoneBond) + taken.capacity() * sizeof(taken[0]) +
      bonds_of_node.capacity() * sizeof(bonds_of_node[0]) +
      cell_of_index.capacity() * sizeof(cell_of_index[0]);
    for (const auto &matrix : taken)
      memory += matrix.capacity() * sizeof(double);
    for (const auto &numbers : bonds_of_node)
      memory += numbers.capacity() * sizeof(unsigned int);
    for (const auto *const lists : {&sent, &received})
      for (const auto &[rank, list] : *lists)
        memory += list.capacity() * sizeof(unsigned int);
    return memory;
  }


  template class MeshExchange<1>;
  template class MeshExchange<2>;
  template class MeshExchange<3>;
} // namespace PeriDeal
