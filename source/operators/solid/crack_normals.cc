// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/operators/solid/crack_normals.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <utility>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    Tensor<1, dim> value_at(const Vector &v, const unsigned int place)
    {
      Tensor<1, dim> value;
      for (unsigned int d = 0; d < dim; ++d)
        value[d] = v.local_element(dim * place + d);
      return value;
    }


    template <int dim>
    void set_value(Vector &v, const unsigned int place, const Tensor<1, dim> &value)
    {
      for (unsigned int d = 0; d < dim; ++d)
        v.local_element(dim * place + d) = value[d];
    }


    /** p/|p|; zero where bonds are lost in many directions. */
    template <int dim>
    Tensor<1, dim> direction_of(const std::vector<FacingBond<dim>> &family)
    {
      constexpr double some = 0.6; // of the sum of lengths
      // Less the same share of all bonds: families may end at a side.
      Tensor<1, dim> lost, all;
      double         lengths = 0., stiff = 0., stiff_of_all = 0.;
      for (const FacingBond<dim> &bond : family)
        {
          all += bond.stiffness * bond.xi;
          stiff_of_all += bond.stiffness;
          if (!bond.is_lost)
            continue;
          lost += bond.stiffness * bond.xi;
          lengths += bond.stiffness * bond.xi.norm();
          stiff += bond.stiffness;
        }
      if (stiff == 0.)
        return Tensor<1, dim>();
      lost -= stiff / stiff_of_all * all;
      const double size = lost.norm();
      return size > some * lengths ? lost / size : Tensor<1, dim>();
    }
  } // namespace


  template <int dim>
  CrackNormals<dim>::CrackNormals(const FamilyOf &family_of, const Layout &nodes)
    : family_of(family_of)
    , nodes(nodes, dim)
  {}


  /** Owned nodes that have lost bonds and are among these, or have one of them in their family. */
  template <int dim>
  std::vector<unsigned int> CrackNormals<dim>::beside(
    const std::vector<unsigned int> &of_nodes) const
  {
    Vector marks;
    nodes.fit_scalars(marks);
    const auto mark = [&](const unsigned int i) {
      if (const unsigned int place = nodes.place(i); place != numbers::invalid_unsigned_int)
        marks.local_element(place) += 1.;
    };
    for (const unsigned int i : of_nodes)
      if (const unsigned int place = nodes.place(i);
          place != numbers::invalid_unsigned_int && !neighbors[place].empty())
        {
          mark(i);
          std::for_each(neighbors[place].begin(), neighbors[place].end(), mark);
        }
    marks.compress(VectorOperation::add);
    std::vector<unsigned int> list;
    for (unsigned int place = 0; place < nodes.n_owned(); ++place)
      if (marks.local_element(place) > 0. && !neighbors[place].empty())
        list.push_back(nodes.node(place));
    std::sort(list.begin(), list.end());
    return list;
  }


  template <int dim>
  Tensor<1, dim> CrackNormals<dim>::smoothed(const unsigned int place) const
  {
    constexpr double     most = 0.75; // of all, about the normal
    const Tensor<1, dim> own  = value_at<dim>(directions, place);
    if (own == Tensor<1, dim>())
      return own;
    using Matrix   = Eigen::Matrix<double, dim, dim>;
    using Column   = Eigen::Matrix<double, dim, 1>;
    Matrix     sum = Matrix::Zero();
    const auto add = [&](const Tensor<1, dim> &p) {
      const Eigen::Map<const Column> column(p.begin_raw());
      sum += column * column.transpose();
    };
    add(own);
    for (const unsigned int j : neighbors[place])
      if (const unsigned int other = nodes.place(j); other != numbers::invalid_unsigned_int)
        add(value_at<dim>(directions, other));
    const Eigen::SelfAdjointEigenSolver<Matrix> solver(sum); // values ascend
    if (solver.eigenvalues()(dim - 1) < most * sum.trace())
      return Tensor<1, dim>();
    Tensor<1, dim> direction;
    for (unsigned int d = 0; d < dim; ++d)
      direction[d] = solver.eigenvectors()(d, dim - 1);
    return direction * own < 0. ? -1. * direction : direction;
  }


  /** Find the directions of owned nodes, whose ghosts are set. */
  template <int dim>
  void CrackNormals<dim>::find_lost(const std::vector<unsigned int> &of_nodes)
  {
    struct Lost
    {
      unsigned int              node;
      Tensor<1, dim>            direction;
      std::vector<unsigned int> neighbors;
    };
    std::vector<Lost>         all;
    std::vector<unsigned int> lacking;
    for (const unsigned int i : of_nodes)
      {
        family_of(i, family);
        if (family.empty() && nodes.place(i) == numbers::invalid_unsigned_int)
          continue;
        lacking.push_back(i);
        all.push_back({i, direction_of(family), {}});
        all.back().neighbors.reserve(family.size());
        for (const FacingBond<dim> &bond : family)
          all.back().neighbors.push_back(bond.neighbor);
      }
    nodes.add(lacking);
    if (nodes.empty())
      return;
    neighbors.resize(nodes.n_owned());
    nodes.fit_vectors(directions);
    nodes.fit_vectors(normals);
    for (Lost &lost : all)
      {
        const unsigned int place = nodes.place(lost.node);
        neighbors[place]         = std::move(lost.neighbors);
        set_value(directions, place, lost.direction);
      }
    directions.update_ghost_values();
  }


  template <int dim>
  std::vector<unsigned int> CrackNormals<dim>::renew(const std::vector<unsigned int> &of_nodes)
  {
    find_lost(of_nodes);
    if (nodes.empty())
      return {};
    const std::vector<unsigned int> changed = beside(of_nodes);
    for (const unsigned int i : of_nodes) // those that are whole again
      if (const unsigned int place = nodes.place(i); place != numbers::invalid_unsigned_int)
        set_value(normals, place, Tensor<1, dim>());
    for (const unsigned int i : changed)
      set_value(normals, nodes.place(i), smoothed(nodes.place(i)));
    normals.update_ghost_values();
    return changed;
  }


  template <int dim>
  Tensor<1, dim> CrackNormals<dim>::normal(const unsigned int place) const
  {
    return value_at<dim>(normals, place);
  }


  template <int dim>
  std::size_t CrackNormals<dim>::memory_consumption() const
  {
    std::size_t lists = neighbors.capacity() * sizeof(neighbors[0]);
    for (const std::vector<unsigned int> &list : neighbors)
      lists += list.capacity() * sizeof(unsigned int);
    return lists + nodes.memory_consumption() + directions.memory_consumption() +
           normals.memory_consumption();
  }


  PERIDEAL_INSTANTIATE_CLASS(class CrackNormals);
} // namespace PeriDeal
