// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/interleaved.h>
#include <perideal/mesh/lattice_sites.h>
#include <perideal/operators/solid/fictitious_images.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  FictitiousImages<dim>::FictitiousImages(const Nodes<dim> &nodes)
    : nodes(nodes)
  {}


  template <int dim>
  unsigned int FictitiousImages<dim>::add(const Image &image, const std::vector<Term> &of_image)
  {
    images.push_back(image);
    terms.insert(terms.end(), of_image.begin(), of_image.end());
    starts.push_back(terms.size());
    return images.size() - 1;
  }


  template <int dim>
  void FictitiousImages<dim>::make_room()
  {
    values.resize(dim * images.size());
    forces.resize(values.size());
    passed.reinit(interleaved(*nodes.partitioner(), dim));
    for (const Term &term : terms)
      for (unsigned int d = 0; d < dim; ++d)
        pulled.push_back(dim * term.node + d);
    std::sort(pulled.begin(), pulled.end());
    pulled.erase(std::unique(pulled.begin(), pulled.end()), pulled.end());
  }


  template <int dim>
  bool FictitiousImages<dim>::any_mirrored_alone() const
  {
    bool any = false;
    for (unsigned int image = 0; image < images.size() && !any; ++image)
      any = is_mirrored_alone(image);
    return any;
  }


  template <int dim>
  double FictitiousImages<dim>::sum_of_factors(const unsigned int image) const
  {
    double sum = 0.;
    for_each_term(image, [&](const Term &term) {
      double largest = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        largest = std::max(largest, std::abs(term.of_component[d]));
      sum += largest;
    });
    return sum;
  }


  template <int dim>
  bool FictitiousImages<dim>::are_images_of_one(const unsigned int lost,
                                                const unsigned int image,
                                                const Term        &term) const
  {
    if (!nodes.lattice())
      {
        const Term &other = first_term(lost);
        bool        same  = other.node == term.node && other.mirrored == term.mirrored;
        for (unsigned int d = 0; d < dim; ++d)
          same = same &&
                 (!((term.mirrored >> d) & 1) || images[lost].planes[d] == images[image].planes[d]);
        return same;
      }
    Index site = nodes.lattice()->index(nodes.position(term.node));
    for (unsigned int d = 0; d < dim; ++d)
      if ((term.mirrored >> d) & 1)
        site[d] = images[image].site[d];
    return site == images[lost].site;
  }


  template <int dim>
  void FictitiousImages<dim>::find(const double *u) const
  {
    for (unsigned int g = 0; g < images.size(); ++g)
      for (unsigned int d = 0; d < dim; ++d)
        {
          double value = 0.;
          for (std::size_t k = starts[g]; k < starts[g + 1]; ++k)
            value += terms[k].of_component[d] * u[dim * terms[k].node + d];
          values[dim * g + d] = value;
        }
  }


  template <int dim>
  void FictitiousImages<dim>::pass_on(Vector &y) const
  {
    const bool alone = passed.get_partitioner()->n_mpi_processes() == 1;
    if (alone) // few unknowns, and there is nothing to be exchanged
      for (const unsigned int i : pulled)
        passed.local_element(i) = 0.;
    else
      {
        passed = 0.;
        passed.zero_out_ghost_values();
      }
    for (unsigned int g = 0; g < images.size(); ++g)
      for (std::size_t k = starts[g]; k < starts[g + 1]; ++k)
        for (unsigned int d = 0; d < dim; ++d)
          passed.local_element(dim * terms[k].node + d) +=
            terms[k].of_component[d] * forces[dim * g + d];
    if (alone)
      {
        for (const unsigned int i : pulled)
          y.local_element(i) += passed.local_element(i);
        return;
      }
    passed.compress(VectorOperation::add);
    y += passed;
  }


  template <int dim>
  std::map<types::boundary_id, Tensor<1, dim>> FictitiousImages<dim>::forces_of_planes() const
  {
    std::map<types::boundary_id, Tensor<1, dim>> sums;
    for (unsigned int g = 0; g < images.size(); ++g)
      for (unsigned int d = 0; d < dim; ++d)
        {
          if (images[g].planes[d] == numbers::invalid_boundary_id)
            continue;
          double all = 0.; // 1 beyond continued sides, -1 beyond a plane
          for_each_term(g, [&](const Term &term) { all += term.of_component[d]; });
          const double force =
            forces[dim * g + d] + (kept_forces.empty() ? 0. : kept_forces[dim * g + d]);
          sums[images[g].planes[d]][d] += (1. - all) * force;
        }
    return sums;
  }


  template <int dim>
  std::size_t FictitiousImages<dim>::memory_consumption() const
  {
    return terms.capacity() * sizeof(Term) + images.capacity() * sizeof(Image) +
           2 * dim * images.size() * sizeof(double);
  }


  template class FictitiousImages<1>;
  template class FictitiousImages<2>;
  template class FictitiousImages<3>;
} // namespace PeriDeal
