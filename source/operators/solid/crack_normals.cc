// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/base/symmetric_tensor.h>

#include <perideal/operators/solid/crack_normals.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    Tensor<1, dim> value_at(const Vector &v, const unsigned int node)
    {
      Tensor<1, dim> value;
      for (unsigned int d = 0; d < dim; ++d)
        value[d] = v.local_element(dim * node + d);
      return value;
    }


    template <int dim>
    void set_value(Vector &v, const unsigned int node, const Tensor<1, dim> &value)
    {
      for (unsigned int d = 0; d < dim; ++d)
        v.local_element(dim * node + d) = value[d];
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
  CrackNormals<dim>::CrackNormals(const FamilyOf &family_of,
                                  const Layout   &nodes,
                                  const Layout   &unknowns)
    : family_of(family_of)
    , nodes(nodes)
    , unknowns(unknowns)
  {}


  /** Once bonds are lost; returns whether they are. */
  template <int dim>
  bool CrackNormals<dim>::allocate(const std::vector<unsigned int> &of_nodes)
  {
    if (marks.size() > 0)
      return true;
    const bool any = std::any_of(of_nodes.begin(), of_nodes.end(), [&](const unsigned int i) {
      family_of(i, family);
      return !family.empty();
    });
    if (Utilities::MPI::max(any ? 1 : 0, nodes->get_mpi_communicator()) == 0)
      return false;
    directions.reinit(unknowns);
    normals.reinit(unknowns);
    marks.reinit(nodes);
    return true;
  }


  /** Owned nodes that have lost bonds and are among these, or have one of them in their family. */
  template <int dim>
  std::vector<unsigned int> CrackNormals<dim>::beside(const std::vector<unsigned int> &of_nodes)
  {
    marks = 0.;
    marks.zero_out_ghost_values();
    for (const unsigned int i : of_nodes)
      if (const auto found = parted.find(i); found != parted.end())
        {
          marks.local_element(i) += 1.;
          for (const unsigned int j : found->second)
            marks.local_element(j) += 1.;
        }
    marks.compress(VectorOperation::add);
    std::vector<unsigned int> list;
    for (const auto &[i, neighbors] : parted)
      if (marks.local_element(i) > 0.)
        list.push_back(i);
    return list;
  }


  template <int dim>
  Tensor<1, dim> CrackNormals<dim>::smoothed(const unsigned int node) const
  {
    constexpr double     most = 0.75; // of all, about the normal
    const Tensor<1, dim> own  = value_at<dim>(directions, node);
    if (own == Tensor<1, dim>())
      return own;
    SymmetricTensor<2, dim> sum = symmetrize(outer_product(own, own));
    for (const unsigned int j : parted.at(node))
      {
        const Tensor<1, dim> p = value_at<dim>(directions, j);
        sum += symmetrize(outer_product(p, p));
      }
    const auto [value, direction] = eigenvectors(sum, SymmetricTensorEigenvectorMethod::jacobi)[0];
    if (value < most * trace(sum))
      return Tensor<1, dim>();
    return direction * own < 0. ? -1. * direction : direction;
  }


  template <int dim>
  std::vector<unsigned int> CrackNormals<dim>::renew(const std::vector<unsigned int> &of_nodes)
  {
    if (!allocate(of_nodes))
      return {};
    for (const unsigned int i : of_nodes)
      {
        family_of(i, family);
        if (family.empty())
          parted.erase(i);
        else
          {
            std::vector<unsigned int> &neighbors = parted[i];
            neighbors.clear();
            for (const FacingBond<dim> &bond : family)
              neighbors.push_back(bond.neighbor);
          }
        set_value(directions, i, direction_of(family));
      }
    directions.update_ghost_values();
    const std::vector<unsigned int> changed = beside(of_nodes);
    for (const unsigned int i : of_nodes) // those that are whole again
      set_value(normals, i, Tensor<1, dim>());
    for (const unsigned int i : changed)
      set_value(normals, i, smoothed(i));
    normals.update_ghost_values();
    return changed;
  }


  template <int dim>
  Tensor<1, dim> CrackNormals<dim>::normal(const unsigned int node) const
  {
    return value_at<dim>(normals, node);
  }


  template <int dim>
  std::size_t CrackNormals<dim>::memory_consumption() const
  {
    std::size_t lists = 0;
    for (const auto &entry : parted)
      lists += sizeof(entry) + entry.second.capacity() * sizeof(unsigned int);
    return lists + directions.memory_consumption() + normals.memory_consumption() +
           marks.memory_consumption();
  }


  template class CrackNormals<1>;
  template class CrackNormals<2>;
  template class CrackNormals<3>;
} // namespace PeriDeal
