// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/mesh/lattice_sites.h>
#include <perideal/operators/fictitious_bonds.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  void FictitiousBonds<dim>::add_weights(Vector &q) const
  {
    for_each([&](const Bond &bond) {
      q.local_element(bond.node) += bond.spring / families.nodes().volume(bond.node); // W x^2
    });
  }


  template <int dim>
  void FictitiousBonds<dim>::find_springs(
    const std::function<double(const unsigned int)> &stiffness,
    const bool                                       full)
  {
    for (const unsigned int i : list)
      for (std::size_t k = starts[i]; k < starts[i + 1]; ++k)
        springs[k] = state.is_whole(k) ? stiffness(i) / springs[k] : 0.;
    if (!full)
      return;
    across.resize(springs.size(), 0.);
    for (const Tensor<1, dim> &p : moments)
      lengths.push_back(p.norm());
  }


  template <int dim>
  const std::vector<unsigned int> &FictitiousBonds<dim>::nodes() const
  {
    return list;
  }


  template <int dim>
  void FictitiousBonds<dim>::find_images(const double *u) const
  {
    for (unsigned int g = 0; g < origins.size(); ++g)
      for (unsigned int d = 0; d < dim; ++d)
        {
          double value = 0.;
          for (std::size_t k = term_starts[g]; k < term_starts[g + 1]; ++k)
            value += terms[k].of_component[d] * u[dim * terms[k].node + d];
          values[dim * g + d] = value;
        }
  }


  template <int dim>
  Tensor<1, dim> FictitiousBonds<dim>::change(const Bond &bond, const double *u) const
  {
    Tensor<1, dim> eta;
    for (unsigned int d = 0; d < dim; ++d)
      eta[d] = values[dim * bond.image + d] - u[dim * bond.node + d];
    return eta;
  }


  template <int dim>
  Tensor<1, dim> FictitiousBonds<dim>::bond_vector(const Bond &bond) const
  {
    return places[bond.image] - families.nodes().position(bond.node);
  }


  template <int dim>
  double FictitiousBonds<dim>::length(const Bond &bond) const
  {
    return lengths.empty() ? bond.moment.norm() : lengths[bond.number];
  }


  template <int dim>
  double FictitiousBonds<dim>::extension_moment(const Bond &bond, const double *u) const
  {
    const Tensor<1, dim> eta     = change(bond, u);
    const double         thermal = strains.empty() ? 0. : strains[bond.number];
    if (lengths.empty() && thermal == 0.)
      return bond.moment * eta;
    const Tensor<1, dim> xi = bond_vector(bond);
    if (lengths.empty())
      return bond.moment * eta - thermal * (bond.moment * xi);
    const double x = xi.norm();
    return lengths[bond.number] * ((2. * xi + eta) * eta / ((xi + eta).norm() + x) - thermal * x);
  }


  template <int dim>
  Tensor<1, dim> FictitiousBonds<dim>::direction(const Bond &bond, const double *u) const
  {
    if (lengths.empty())
      return bond.moment;
    const Tensor<1, dim> y = bond_vector(bond) + change(bond, u);
    return lengths[bond.number] / y.norm() * y;
  }


  template <int dim>
  void FictitiousBonds<dim>::begin_forces() const
  {
    std::fill(image_forces.begin(), image_forces.end(), 0.);
  }


  template <int dim>
  void FictitiousBonds<dim>::pass_on(Vector &y) const
  {
    passed = 0.;
    passed.zero_out_ghost_values();
    for (unsigned int g = 0; g < origins.size(); ++g)
      for (std::size_t k = term_starts[g]; k < term_starts[g + 1]; ++k)
        for (unsigned int d = 0; d < dim; ++d)
          passed.local_element(dim * terms[k].node + d) +=
            terms[k].of_component[d] * image_forces[dim * g + d];
    passed.compress(VectorOperation::add);
    y += passed;
  }


  template <int dim>
  void FictitiousBonds<dim>::keep_forces()
  {
    kept_forces = image_forces;
  }


  template <int dim>
  bool FictitiousBonds<dim>::is_own_image(const Bond &bond) const
  {
    const Term &term = terms[term_starts[bond.image]];
    return may_break(bond) && term.mirrored != 0 && term.node == bond.node;
  }


  template <int dim>
  std::map<types::boundary_id, Tensor<1, dim>> FictitiousBonds<dim>::forces_of_planes() const
  {
    std::map<types::boundary_id, Tensor<1, dim>> sums;
    for (unsigned int g = 0; g < origins.size(); ++g)
      for (unsigned int d = 0; d < dim; ++d)
        {
          if (planes[g][d] == numbers::invalid_boundary_id)
            continue;
          double all = 0.; // 1 beyond continued sides, -1 beyond a plane
          for (std::size_t k = term_starts[g]; k < term_starts[g + 1]; ++k)
            all += terms[k].of_component[d];
          const double force =
            image_forces[dim * g + d] + (kept_forces.empty() ? 0. : kept_forces[dim * g + d]);
          sums[planes[g][d]][d] += (1. - all) * force;
        }
    return sums;
  }


  template <int dim>
  void FictitiousBonds<dim>::add_forces(Vector &y, const Vector &x, const double *tau) const
  {
    const double *const u = x.begin();
    begin_forces();
    for (const unsigned int i : list)
      {
        Tensor<1, dim> force;
        for (std::size_t k = starts[i]; k < starts[i + 1]; ++k)
          {
            const double *const   v       = values.data() + dim * images[k];
            const Tensor<1, dim> &p       = moments[k];
            double                product = 0.;
            for (unsigned int d = 0; d < dim; ++d)
              product += p[d] * (v[d] - u[dim * i + d]);
            const double size = springs[k] * product + (tau != nullptr ? tau[i] : 0.);
            for (unsigned int d = 0; d < dim; ++d)
              {
                force[d] += size * p[d];
                image_forces[dim * images[k] + d] += size * p[d];
              }
          }
        for (unsigned int d = 0; d < dim; ++d)
          y.local_element(dim * i + d) -= force[d];
      }
    pass_on(y);
  }


  template <int dim>
  double FictitiousBonds<dim>::sum_of_lengths(const unsigned int i) const
  {
    double sum = 0.;
    for_each_of(i, [&](const Bond &bond) {
      sum += bond.moment.norm() * (1. + sum_of_factors(bond.image));
    });
    return sum;
  }


  template <int dim>
  double FictitiousBonds<dim>::sum_of_factors(const unsigned int image) const
  {
    double sum = 0.;
    for_each_term(image, [&](const unsigned int, const Tensor<1, dim> &factors) {
      double largest = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        largest = std::max(largest, std::abs(factors[d]));
      sum += largest;
    });
    return sum;
  }


  template <int dim>
  void FictitiousBonds<dim>::set_tangent(const Bond           &bond,
                                         const Tensor<1, dim> &moment,
                                         const double          stiffness)
  {
    moments[bond.number] = moment;
    across[bond.number]  = stiffness;
  }


  template <int dim>
  double FictitiousBonds<dim>::stiffness_across(const Bond &bond) const
  {
    return across.empty() ? 0. : across[bond.number];
  }


  template <int dim>
  unsigned int FictitiousBonds<dim>::origin(const unsigned int image) const
  {
    return origins[image];
  }


  template <int dim>
  double FictitiousBonds<dim>::volume(const unsigned int image) const
  {
    return volumes[image];
  }


  template <int dim>
  bool FictitiousBonds<dim>::may_break(const Bond &bond) const
  {
    // Continued beyond no side: a mirror image alone.
    return term_starts[bond.image + 1] - term_starts[bond.image] == 1;
  }


  template <int dim>
  unsigned int FictitiousBonds<dim>::n_ends(const Bond &bond) const
  {
    const Term      &term = terms[term_starts[bond.image]];
    const Point<dim> far  = places[bond.image];
    const Point<dim> p    = families.nodes().position(term.node),
                     i    = families.nodes().position(bond.node);
    const double slack    = 1e-6 * families.nodes().smallest_spacing();
    for (unsigned int d = 0; d < dim; ++d)
      if (((term.mirrored >> d) & 1) && std::abs(far[d] + p[d] - 2. * i[d]) > slack)
        return 1;
    return 0;
  }


  template <int dim>
  void FictitiousBonds<dim>::break_bond(const std::size_t     number,
                                        const BondState::Mark mark,
                                        const double          t)
  {
    if (state.size() == 0)
      state.resize(images.size());
    state.mark(number, mark, t);
    springs[number] = 0.;
    moments[number] = Tensor<1, dim>();
    if (!lengths.empty())
      lengths[number] = across[number] = 0.;
  }


  template <int dim>
  bool FictitiousBonds<dim>::break_dependent(const unsigned int               node,
                                             const std::vector<unsigned int> &lost,
                                             const double                     t)
  {
    if (starts.empty() || starts[node] == starts[node + 1])
      return false;
    // Images of other nodes that are gone: what is continued from them is, too.
    std::vector<unsigned int> lost_images;
    for_each_of(node, [&](const Bond &bond) {
      if (may_break(bond) && !bond.whole)
        lost_images.push_back(bond.image);
    });
    bool any = false;
    for_each_of(node, [&](const Bond &bond) {
      if (!bond.whole)
        return;
      for (std::size_t k = term_starts[bond.image]; k < term_starts[bond.image + 1]; ++k)
        {
          const Term &term = terms[k];
          const bool  gone =
            term.mirrored == 0 ?
               std::find(lost.begin(), lost.end(), term.node) != lost.end() :
               std::any_of(lost_images.begin(), lost_images.end(), [&](const unsigned int image) {
                return are_images_of_one(image, bond.image, term);
              });
          if (gone)
            {
              break_bond(bond.number, BondState::dependent, t);
              any = true;
              return;
            }
        }
    });
    return any;
  }


  template <int dim>
  bool FictitiousBonds<dim>::are_images_of_one(const unsigned int lost,
                                               const unsigned int image,
                                               const Term        &term) const
  {
    if (sites.empty())
      {
        const Term &other = terms[term_starts[lost]];
        bool        same  = other.node == term.node && other.mirrored == term.mirrored;
        for (unsigned int d = 0; d < dim; ++d)
          same = same && (!((term.mirrored >> d) & 1) || planes[lost][d] == planes[image][d]);
        return same;
      }
    Index site = families.nodes().lattice()->index(families.nodes().position(term.node));
    for (unsigned int d = 0; d < dim; ++d)
      if ((term.mirrored >> d) & 1)
        site[d] = sites[image][d];
    return site == sites[lost];
  }


  template <int dim>
  std::size_t FictitiousBonds<dim>::size() const
  {
    return images.size();
  }


  template <int dim>
  std::size_t FictitiousBonds<dim>::memory_consumption() const
  {
    return state.memory_consumption() +
           images.capacity() * (sizeof(unsigned int) + sizeof(Tensor<1, dim>) + sizeof(double)) +
           (lengths.capacity() + across.capacity() + strains.capacity()) * sizeof(double) +
           starts.capacity() * sizeof(std::size_t) + terms.capacity() * sizeof(Term) +
           sites.capacity() * sizeof(Index) +
           places.capacity() * (sizeof(Point<dim>) + sizeof(planes[0]) + 2 * dim * sizeof(double));
  }


  template class FictitiousBonds<1>;
  template class FictitiousBonds<2>;
  template class FictitiousBonds<3>;
} // namespace PeriDeal
