// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/bonds/process_boxes.h>
#include <perideal/laws/interface.h>
#include <perideal/operators/coupling/mesh_exchange.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

// The cells around this process's own, copies of those of other processes included.

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    constexpr double part_to_take = 0.9; // of what a distorted cell has
    constexpr double least_kept   = 0.2; // of all bonds' strength


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
    Zone<dim> zone_at_end(Zone<dim> zone, const BodyParameters<dim> &body)
    {
      zone.set_cracks(body.crack_history().pieces(body.cracks.end_time));
      return zone;
    }
  } // namespace


  template <int dim, typename Law>
  MeshExchange<dim, Law>::MeshExchange(Nodes<dim>                &nodes,
                                       const BodyParameters<dim> &body,
                                       const Zone<dim>           &zone)
    : Coupling<dim>(
        nodes,
        body,
        zone,
        [at_end = zone_at_end(zone, body)](const Point<dim> &p) { return at_end.contains(p); })
    , law(own_families, body)
    , stiffness(Law::stiffness(body))
  {
    const Zone<dim>         at_end    = this->zone_at(body.cracks.end_time);
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
    find_cells();
    send_cells();
    find_paths(hanging);
    find_bonds();
    const double kept = kept_share();
    AssertThrow(
      kept > least_kept,
      UserError(
        "'Zone' in section 'Coupling': the cells of the zone are so distorted that only " +
        std::to_string(100. * kept) +
        " % of the bonds' strength can be exchanged. Use a mesh with better cells there, or a smaller zone."));
  }


  template <int dim, typename Law>
  MeshExchange<dim, Law>::~MeshExchange() = default;


  template <int dim, typename Law>
  void MeshExchange<dim, Law>::find_paths(const std::vector<bool> &hanging)
  {
    const Nodes<dim>       &nodes = own_families.nodes();
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
    paths = std::make_unique<CellPaths<dim>>(cells,
                                             ends,
                                             own_families.weights().reach() * (1. + 1e-6),
                                             regular);
  }


  template <int dim, typename Law>
  bool MeshExchange<dim, Law>::follow(const ZoneBond &bond, std::vector<PathPiece<dim>> &way)
  {
    const Nodes<dim> &nodes = own_families.nodes();
    const auto        end   = [&](const unsigned int i) {
      return PathEnd<dim>{nodes.partitioner()->local_to_global(i),
                          nodes.position(i),
                          nodes.crack_point(i)};
    };
    return paths->follow(end(bond.nodes[0]), end(bond.nodes[1]), way);
  }


  template <int dim, typename Law>
  Tensor<1, dim> MeshExchange<dim, Law>::vector_of(const ZoneBond &bond) const
  {
    return own_families.nodes().position(bond.nodes[1]) -
           own_families.nodes().position(bond.nodes[0]);
  }


  template <int dim, typename Law>
  bool MeshExchange<dim, Law>::starts_at(const unsigned int one, const unsigned int other) const
  {
    const Point<dim> &p = own_families.nodes().position(one),
                     &q = own_families.nodes().position(other);
    for (unsigned int d = dim; d-- > 0;)
      if (p[d] != q[d])
        return p[d] < q[d];
    return one < other; // twins across a crack, which have no bond
  }


  template <int dim, typename Law>
  void MeshExchange<dim, Law>::find_bonds()
  {
    const Nodes<dim>                           &nodes = own_families.nodes();
    std::vector<typename Families<dim>::Member> family;
    std::vector<PathPiece<dim>>                 way;
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
        own_families.members_of(i, family);
        for (const auto &bond : family)
          {
            if (!joined[bond.neighbor] || !starts_at(i, bond.neighbor) ||
                own_families.is_parted(i, bond.neighbor))
              continue;
            ZoneBond zone_bond{{i, bond.neighbor}, bond.weight};
            if (!follow(zone_bond, way))
              continue;
            typename CellStiffness<dim>::Range on_way;
            for (const PathPiece<dim> &piece : way)
              {
                const auto &in_cell = states[piece.cell].of_stiffness;
                on_way.lowest       = std::min(on_way.lowest, in_cell.lowest);
                on_way.highest      = std::max(on_way.highest, in_cell.highest);
              }
            if (on_way.highest > largest_contrast * on_way.lowest)
              continue;
            if (stiffness.depends_on_temperature())
              zone_bond.intact *= kept_at_contrast(on_way.highest / on_way.lowest);
            zone_bond.intact *= on_way.lowest * Law::scale_of(vector_of(zone_bond));
            const unsigned int number = zone_bonds.size();
            take(zone_bond, zone_bond.intact, way);
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
    share_states();
    scale_bonds(way_cells, way_ends);
  }


  template <int dim, typename Law>
  void MeshExchange<dim, Law>::scale_bonds(const std::vector<unsigned int> &way_cells,
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
          take(bond, (bond.scale - 1.) * bond.intact, way);
      }
  }


  template <int dim, typename Law>
  void MeshExchange<dim, Law>::take(const ZoneBond                    &bond,
                                    const double                       weight,
                                    const std::vector<PathPiece<dim>> &way)
  {
    const auto direction = Law::direction(vector_of(bond));
    for (const PathPiece<dim> &piece : way)
      {
        if (piece.cell >= taken.size())
          continue; // of another process
        taken[piece.cell].resize(n_values * n_values, 0.);
        const auto    change = corner_values<Law::n_components>(piece.change, direction);
        double *const matrix = taken[piece.cell].data();
        for (unsigned int a = 0; a < n_values; ++a)
          {
            const double factor = weight * change[a];
            for (unsigned int b = 0; b < n_values; ++b)
              matrix[a * n_values + b] += factor * change[b];
          }
      }
  }


  template <int dim, typename Law>
  void MeshExchange<dim, Law>::find_strains()
  {
    static const std::vector<Tensor<2, dim>> fields = Law::unit_fields();
    Eigen::MatrixXd                          values(n_values, fields.size());
    for (unsigned int c = 0; c < taken.size(); ++c)
      {
        states[c].strain = 0.;
        if (taken[c].empty())
          continue;
        for (unsigned int k = 0; k < fields.size(); ++k)
          for (unsigned int a = 0; a < n_values; ++a)
            values(a, k) =
              fields[k][a % Law::n_components] * cells[c].corners[a / Law::n_components];
        const Eigen::Map<const Eigen::MatrixXd> bonds(taken[c].data(), n_values, n_values);
        const Eigen::MatrixXd                   linear = values.transpose() * bonds * values;
        const double                            largest =
          Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(linear).eigenvalues().maxCoeff();
        states[c].strain = largest / (states[c].of_stiffness.lowest * volume_of(cells[c].corners));
      }
  }


  template <int dim, typename Law>
  void MeshExchange<dim, Law>::bonds_of(const unsigned int node, std::vector<Bond> &list) const
  {
    list.clear();
    const bool near_crack = own_families.near_crack(node);
    for (const unsigned int number : bonds_of_node[node])
      {
        const ZoneBond    &zone_bond = zone_bonds[number];
        const unsigned int neighbor  = zone_bond.nodes[zone_bond.nodes[0] == node ? 1 : 0];
        const double       strength  = zone_bond.intact * zone_bond.scale;
        Bond               bond{neighbor, strength, strength, false};
        if (near_crack)
          bond.weight *= law.kept_fraction(node, neighbor, bond.cut);
        list.push_back(bond);
      }
  }


  template <int dim, typename Law>
  void MeshExchange<dim, Law>::possible_neighbors_of(const unsigned int         node,
                                                     std::vector<unsigned int> &neighbors) const
  {
    neighbors.clear();
    if (!may_join[node])
      return;
    if (stays && !stiffness.depends_on_temperature())
      {
        for (const unsigned int number : bonds_of_node[node])
          neighbors.push_back(
            zone_bonds[number].nodes[zone_bonds[number].nodes[0] == node ? 1 : 0]);
        return;
      }
    std::vector<typename Families<dim>::Member> family;
    own_families.members_of(node, family);
    for (const auto &bond : family)
      if (may_join[bond.neighbor])
        neighbors.push_back(bond.neighbor);
  }


  template <int dim, typename Law>
  bool MeshExchange<dim, Law>::change_cell(const Cell &cell, FullMatrix<double> &stiffness) const
  {
    const unsigned int c = cell_of_index[cell->active_cell_index()];
    if (c >= taken.size() || taken[c].empty())
      return false;
    using Matrix                    = Eigen::MatrixXd;
    constexpr unsigned int n_fields = dim + 1; // of each component: constant and linear
    constexpr unsigned int n_linear = Law::n_components * dim;
    constexpr unsigned int n_smooth = Law::n_components * n_fields;
    Matrix                 rest(n_values, n_values);
    for (unsigned int a = 0; a < n_values; ++a)
      for (unsigned int b = 0; b < n_values; ++b)
        rest(a, b) = stiffness(a, b) - taken[c][a * n_values + b];
    // Columns: constant, linear fields, and anything else to complete an orthonormal basis.
    Matrix start = Matrix::Zero(n_values, n_smooth);
    for (unsigned int a = 0; a < n_corners; ++a)
      for (unsigned int k = 0; k < Law::n_components; ++k)
        {
          const unsigned int row = Law::n_components * a + k;
          start(row, k)          = 1.;
          for (unsigned int d = 0; d < dim; ++d)
            start(row, Law::n_components + k * dim + d) =
              (cells[c].corners[a] - cells[c].corners[0])[d];
        }
    const Matrix fields =
      Eigen::HouseholderQR<Matrix>(start).householderQ() * Matrix::Identity(n_values, n_values);
    const auto   X = fields.middleCols(Law::n_components, n_linear);
    const auto   H = fields.rightCols(n_values - n_smooth);
    const Matrix A = X.transpose() * rest * X, B = X.transpose() * rest * H,
                 C = H.transpose() * rest * H;
    const Eigen::SelfAdjointEigenSolver<Matrix> linear(A);
    Matrix                                      inverse = Matrix::Zero(n_linear, n_linear);
    const double                                size    = rest.cwiseAbs().maxCoeff();
    for (unsigned int d = 0; d < n_linear; ++d) // a solid's rotations have none
      if (linear.eigenvalues()[d] > 1e-12 * size)
        inverse += linear.eigenvectors().col(d) * linear.eigenvectors().col(d).transpose() /
                   linear.eigenvalues()[d];
    const Eigen::SelfAdjointEigenSolver<Matrix> lack(B.transpose() * inverse * B - C);
    const Matrix E = lack.eigenvectors() * lack.eigenvalues().cwiseMax(0.).asDiagonal() *
                     lack.eigenvectors().transpose();
    rest += H * E * H.transpose();
    for (unsigned int a = 0; a < n_values; ++a)
      for (unsigned int b = 0; b < n_values; ++b)
        stiffness(a, b) = 0.5 * (rest(a, b) + rest(b, a));
    return true;
  }


  template <int dim, typename Law>
  std::vector<BoundingBox<dim>> MeshExchange<dim, Law>::joining_by(const double time) const
  {
    std::vector<BoundingBox<dim>> boxes;
    if (!zone.follows_cracks())
      return boxes;
    const Zone<dim> then = this->zone_at(time);
    for (unsigned int i = 0; i < joined.size(); ++i)
      if (may_join[i] && !joined[i] && then.contains(own_families.nodes().position(i)))
        {
          // New bonds may change the scaling of all that pass the cells on their way.
          boxes.push_back({{own_families.nodes().position(i), own_families.nodes().position(i)}});
          boxes.back().extend(2. * own_families.weights().reach());
        }
    return boxes;
  }


  template <int dim, typename Law>
  void MeshExchange<dim, Law>::join(const double time)
  {
    bool any = false;
    zone     = this->zone_at(time);
    for (unsigned int i = 0; i < joined.size() && zone.follows_cracks(); ++i)
      if (may_join[i] && !joined[i] && zone.contains(own_families.nodes().position(i)))
        {
          joined[i] = true;
          any       = true;
        }
    if (Utilities::MPI::max(any ? 1 : 0, own_families.nodes().communicator()) > 0)
      find_bonds();
  }


  template <int dim, typename Law>
  double MeshExchange<dim, Law>::kept_share() const
  {
    double all  = 0.,
           kept = 0.; // each bond once at each of its ends, by the process that has the end
    for (const auto &numbers : bonds_of_node)
      for (const unsigned int number : numbers)
        {
          all += zone_bonds[number].intact;
          kept += zone_bonds[number].intact * zone_bonds[number].scale;
        }
    all  = Utilities::MPI::sum(all, own_families.nodes().communicator());
    kept = Utilities::MPI::sum(kept, own_families.nodes().communicator());
    return all > 0. ? kept / all : 1.;
  }


  template <int dim, typename Law>
  void MeshExchange<dim, Law>::take_conductivities_at(const Vector &u)
  {
    law.take_conductivities_at(u);
    typename CellStiffness<dim>::CornerValues temperatures;
    for (unsigned int c = 0; c < taken.size(); ++c)
      {
        for (unsigned int v = 0; v < n_corners; ++v)
          temperatures[v] = u(cells[c].nodes[v]);
        states[c].of_stiffness = stiffness.range(cells[c].corners, &temperatures);
      }
    share_states();
    find_bonds();
  }

  template <int dim, typename Law>
  bool MeshExchange<dim, Law>::in_zone(const unsigned int node) const
  {
    return joined[node];
  }

  template <int dim, typename Law>
  std::size_t MeshExchange<dim, Law>::memory_consumption() const
  {
    std::size_t memory =
      own_families.memory_consumption() + law.memory_consumption() + paths->memory_consumption() +
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


  template <int dim, typename Law>
  void MeshExchange<dim, Law>::find_cells()
  {
    const DoFHandler<dim> &dofs = own_families.nodes().dof_handler();
    cell_of_index.assign(dofs.get_triangulation().n_active_cells(), numbers::invalid_unsigned_int);
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          PathCell<dim> shape;
          for (unsigned int v = 0; v < n_corners; ++v)
            {
              shape.corners[v] = cell->vertex(v);
              shape.nodes[v]   = cell->vertex_dof_index(v, 0);
            }
          cell_of_index[cell->active_cell_index()] = cells.size();
          cells.push_back(shape);
          states.push_back({stiffness.range(shape.corners, nullptr)});
        }
    taken.resize(cells.size());
  }


  template <int dim, typename Law>
  void MeshExchange<dim, Law>::send_cells()
  {
    const Nodes<dim>  &nodes        = own_families.nodes();
    const MPI_Comm     communicator = nodes.communicator();
    const unsigned int me           = Utilities::MPI::this_mpi_process(communicator);
    if (Utilities::MPI::n_mpi_processes(communicator) == 1)
      return;
    // A bond through a cell of another process may pass any cell within its reach of that one.
    std::vector<Point<dim>> own_corners;
    double                  size = 0.;
    for (const PathCell<dim> &cell : cells)
      {
        own_corners.insert(own_corners.end(), cell.corners.begin(), cell.corners.end());
        for (unsigned int v = 1; v < n_corners; ++v)
          size = std::max(size, cell.corners[v].distance(cell.corners[0]));
      }
    const ProcessBoxes<dim> boxes(own_corners, communicator);
    const double            distance =
      own_families.weights().reach() + Utilities::MPI::max(size, communicator);
    std::map<unsigned int, std::vector<double>> to_send;
    for (unsigned int rank = 0; rank < boxes.n_processes(); ++rank)
      for (unsigned int c = 0; c < cells.size() && rank != me; ++c)
        if (std::any_of(cells[c].corners.begin(), cells[c].corners.end(), [&](const auto &p) {
              return boxes.reach(rank, p, distance);
            }))
          {
            sent[rank].push_back(c);
            auto &numbers = to_send[rank];
            for (const Point<dim> &p : cells[c].corners)
              for (unsigned int d = 0; d < dim; ++d)
                numbers.push_back(p[d]);
            for (const auto node : cells[c].nodes)
              numbers.push_back(static_cast<double>(node)); // exact up to 2^53
          }
    constexpr unsigned int record_size = n_corners * (dim + 1);
    for (const auto &[rank, numbers] : Utilities::MPI::some_to_some(communicator, to_send))
      for (std::size_t k = 0; k < numbers.size(); k += record_size)
        {
          PathCell<dim> shape;
          for (unsigned int v = 0; v < n_corners; ++v)
            {
              for (unsigned int d = 0; d < dim; ++d)
                shape.corners[v][d] = numbers[k + v * dim + d];
              shape.nodes[v] =
                static_cast<types::global_dof_index>(numbers[k + n_corners * dim + v]);
            }
          received[rank].push_back(cells.size());
          cells.push_back(shape);
          states.emplace_back();
        }
    share_states();
  }


  template <int dim, typename Law>
  void MeshExchange<dim, Law>::share_states()
  {
    const MPI_Comm communicator = own_families.nodes().communicator();
    if (Utilities::MPI::n_mpi_processes(communicator) == 1)
      return;
    std::map<unsigned int, std::vector<double>> to_send;
    for (const auto &[rank, list] : sent)
      for (const unsigned int c : list)
        {
          const auto &[of_stiffness, strain] = states[c];
          to_send[rank].insert(to_send[rank].end(),
                               {of_stiffness.lowest, of_stiffness.highest, strain});
        }
    for (const auto &[rank, numbers] : Utilities::MPI::some_to_some(communicator, to_send))
      for (std::size_t k = 0; k < numbers.size() / 3; ++k)
        states[received.at(rank)[k]] = {{numbers[3 * k], numbers[3 * k + 1]}, numbers[3 * k + 2]};
  }


#define PERIDEAL_TEMPLATES(dim)                           \
  template class MeshExchange<dim, ConductingBonds<dim>>; \
  template class MeshExchange<dim, ElasticBonds<dim>>;
  PERIDEAL_FOR_EACH_DIM(PERIDEAL_TEMPLATES)
#undef PERIDEAL_TEMPLATES
} // namespace PeriDeal
