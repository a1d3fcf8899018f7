// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
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
  unsigned int FictitiousImages<dim>::add(const Image             &image,
                                          const std::vector<Term> &of_image,
                                          const Point<dim>        *twice_planes)
  {
    images.push_back(image);
    if (twice_planes != nullptr)
      planes_of_mesh.push_back(*twice_planes);
    terms.insert(terms.end(), of_image.begin(), of_image.end());
    starts.push_back(terms.size());
    return images.size() - 1;
  }


  template <int dim>
  void FictitiousImages<dim>::make_room()
  {
    images.shrink_to_fit();
    planes_of_mesh.shrink_to_fit();
    starts.shrink_to_fit();
    terms.shrink_to_fit();
    values.resize(dim * images.size());
    forces.resize(values.size());
    pulled.reserve(terms.size());
    for (const Term &term : terms)
      pulled.push_back(term.node);
    std::sort(pulled.begin(), pulled.end());
    pulled.erase(std::unique(pulled.begin(), pulled.end()), pulled.end());
    pulled.shrink_to_fit();
    sums.resize(dim * pulled.size());
    places.reserve(terms.size());
    for (const Term &term : terms)
      places.push_back(std::lower_bound(pulled.begin(), pulled.end(), term.node) - pulled.begin());
    if (nodes.partitioner()->n_mpi_processes() > 1)
      passed.reinit(interleaved(*nodes.partitioner(), dim));
    Vector n_images(nodes.partitioner());
    for (const unsigned int node : pulled)
      n_images.local_element(node) = 1.;
    n_images.compress(VectorOperation::add);
    followed.assign(nodes.n_owned(), false);
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      followed[i] = n_images.local_element(i) > 0.;
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
        largest = std::max(largest, std::abs(term.of_component(d)));
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
            value += terms[k].of_component(d) * u[dim * terms[k].node + d];
          values[dim * g + d] = value;
        }
  }


  template <int dim>
  void FictitiousImages<dim>::pass_on(Vector &y) const
  {
    std::fill(sums.begin(), sums.end(), 0.);
    for (unsigned int g = 0; g < images.size(); ++g)
      for (std::size_t k = starts[g]; k < starts[g + 1]; ++k)
        for (unsigned int d = 0; d < dim; ++d)
          sums[dim * places[k] + d] += terms[k].of_component(d) * forces[dim * g + d];
    const bool alone = nodes.partitioner()->n_mpi_processes() == 1;
    if (!alone)
      {
        passed = 0.;
        passed.zero_out_ghost_values();
      }
    Vector &to = alone ? y : passed;
    for (std::size_t p = 0; p < pulled.size(); ++p)
      for (unsigned int d = 0; d < dim; ++d)
        to.local_element(dim * pulled[p] + d) += sums[dim * p + d];
    if (alone)
      return;
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
          for_each_term(g, [&](const Term &term) { all += term.of_component(d); });
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
           planes_of_mesh.capacity() * sizeof(Point<dim>) +
           starts.capacity() * sizeof(std::size_t) +
           (pulled.capacity() + places.capacity()) * sizeof(unsigned int) +
           (values.capacity() + forces.capacity() + sums.capacity() + kept_forces.capacity()) *
             sizeof(double) +
           (passed.size() > 0 ? passed.memory_consumption() : 0);
  }


  PERIDEAL_INSTANTIATE_CLASS(class FictitiousImages);
} // namespace PeriDeal
