// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/operators/solid/fictitious_bonds.h>
#include <perideal/operators/solid/fictitious_cuts.h>

#include <algorithm>
#include <cmath>
#include <vector>

// What the bonds beyond the sides bear: which of them cracks cut, springs, thermal strains.

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  FictitiousBonds<dim>::FictitiousBonds(const Families<dim>                   &families,
                                        const std::array<BeyondSide, 2 * dim> &beyond,
                                        const bool                             completes,
                                        const bool                             may_pack)
    : families(families)
    , fictitious(families.nodes())
  {
    take(FictitiousBondSearch<dim>(families, fictitious).on_lattice(beyond, completes), may_pack);
  }


  template <int dim>
  FictitiousBonds<dim>::FictitiousBonds(const Families<dim>                   &families,
                                        const std::vector<BoundaryImage<dim>> &beyond,
                                        const std::vector<BoundaryImage<dim>> &everywhere)
    : families(families)
    , fictitious(families.nodes())
  {
    take(FictitiousBondSearch<dim>(families, fictitious).on_mesh(beyond, everywhere), false);
  }


  template <int dim>
  void FictitiousBonds<dim>::take(FictitiousBondList<dim> &&found, const bool may_pack)
  {
    list          = std::move(found.nodes);
    starts        = std::move(found.starts);
    image_of_bond = std::move(found.images);
    moments       = std::move(found.moments);
    springs       = std::move(found.squares);
    list.shrink_to_fit();
    starts.shrink_to_fit();
    image_of_bond.shrink_to_fit();
    moments.shrink_to_fit();
    springs.shrink_to_fit();
    if (!found.cut.empty())
      state.resize(image_of_bond.size());
    for (const std::size_t number : found.cut)
      state.mark(number, BondState::parted, 0.);
    const auto is_gone = [](const unsigned int unit) {
      return unit == FictitiousBondList<dim>::gone;
    };
    packs = may_pack && found.units.size() < BondCode::gone;
    if (packs)
      {
        codes.reserve(found.unit_of.size());
        for (const unsigned int unit : found.unit_of)
          codes.push_back(is_gone(unit) ? BondCode::gone : static_cast<BondCode::Code>(unit));
        units = std::move(found.units);
      }
    else if (!found.units.empty())
      {
        moments.reserve(found.unit_of.size());
        springs.reserve(found.unit_of.size());
        for (std::size_t place = 0; place < list.size(); ++place)
          for (std::size_t k = starts[place]; k < starts[place + 1]; ++k)
            {
              const bool           none = is_gone(found.unit_of[k]);
              const UnitBond<dim> &unit = found.units[none ? 0 : found.unit_of[k]];
              const double         w =
                none ? 0. :
                               families.nodes().volume(list[place]) * fictitious[image_of_bond[k]].volume;
              moments.push_back(w * unit.moment);
              springs.push_back(w * unit.weight);
            }
      }
  }


  template <int dim>
  Tensor<1, dim> FictitiousBonds<dim>::change(const Bond &bond, const double *u) const
  {
    Tensor<1, dim> eta;
    for (unsigned int d = 0; d < dim; ++d)
      eta[d] = fictitious.value(bond.image)[d] - u[dim * bond.node + d];
    return eta;
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
  void FictitiousBonds<dim>::add_forces(Vector &y, const Vector &x, const double *tau) const
  {
    const double *const u = x.begin();
    fictitious.begin_forces();
    for (std::size_t place = 0; place < list.size(); ++place)
      {
        const unsigned int i = list[place];
        const double tension = tau != nullptr ? tau[i] : 0., own = packs ? laws->stiffness(i) : 0.;
        const double volume = families.nodes().volume(i);
        Tensor<1, dim> force;
        const auto     product = [&](const Tensor<1, dim> &p, const std::size_t k) {
          const double *const v   = fictitious.value(image_of_bond[k]);
          double              sum = 0.;
          for (unsigned int d = 0; d < dim; ++d)
            sum += p[d] * (v[d] - u[dim * i + d]);
          return sum;
        };
        const auto add = [&](const std::size_t k, const Tensor<1, dim> &of_bond) {
          force += of_bond;
          fictitious.pull(image_of_bond[k], of_bond);
        };
        for (std::size_t k = starts[place]; k < starts[place + 1]; ++k)
          if (!packs)
            add(k, (springs[k] * product(moments[k], k) + tension) * moments[k]);
          else if (codes[k] != BondCode::gone)
            {
              // Of spring and W x e volumes drop out.
              const UnitBond<dim> &unit = units[codes[k]];
              const double         size = own / unit.weight * product(unit.moment, k) + tension;
              add(k, size * volume * fictitious[image_of_bond[k]].volume * unit.moment);
            }
        for (unsigned int d = 0; d < dim; ++d)
          y.local_element(dim * i + d) -= force[d];
      }
    fictitious.pass_on(y);
  }


  template <int dim>
  typename FictitiousBonds<dim>::Bond FictitiousBonds<dim>::bond_at(const std::size_t  number,
                                                                    const unsigned int node) const
  {
    const unsigned int image = image_of_bond[number];
    const bool         whole = state.is_whole(number);
    if (!packs)
      return {number, node, image, moments[number], springs[number], whole};
    if (codes[number] == BondCode::gone)
      return {number, node, image, Tensor<1, dim>(), 0., whole};
    const UnitBond<dim> &unit   = units[codes[number]];
    const double         w      = families.nodes().volume(node) * fictitious[image].volume;
    const double         square = w * unit.weight;
    return {number,
            node,
            image,
            w * unit.moment,
            laws != nullptr ? laws->stiffness(node) / square : square,
            whole};
  }


  template <int dim>
  void FictitiousBonds<dim>::add_tensions(Vector              &tau,
                                          const Vector        &u,
                                          const NodeLaws<dim> &of_nodes,
                                          const bool           strained) const
  {
    fictitious.find(u.begin());
    for (const unsigned int i : list)
      {
        double sum = 0.;
        for_each_of(i, [&](const Bond &bond) {
          sum += strained ? extension_moment(bond, u.begin()) :
                            bond.moment * change(bond, u.begin());
        });
        tau.local_element(i) += of_nodes.tension(i, sum);
      }
  }


  template <int dim>
  void FictitiousBonds<dim>::subtract_force(Vector               &y,
                                            const Bond           &bond,
                                            const Tensor<1, dim> &force) const
  {
    for (unsigned int d = 0; d < dim; ++d)
      y.local_element(dim * bond.node + d) -= force[d];
    fictitious.pull(bond.image, force);
  }


  template <int dim>
  void FictitiousBonds<dim>::add_strained_forces(Vector       &y,
                                                 const Vector &u,
                                                 const Vector &tau) const
  {
    fictitious.find(u.begin());
    fictitious.begin_forces();
    for_each([&](const Bond &bond) {
      const double size =
        bond.spring * extension_moment(bond, u.begin()) + tau.local_element(bond.node);
      subtract_force(y, bond, size * direction(bond, u.begin()));
    });
    fictitious.pass_on(y);
  }


  template <int dim>
  void FictitiousBonds<dim>::linearize(const Vector &u, const Vector &tau)
  {
    fictitious.find(u.begin());
    for_each([&](const Bond &bond) {
      const double size =
        bond.spring * extension_moment(bond, u.begin()) + tau.local_element(bond.node);
      const Tensor<1, dim> y = bond_vector(bond) + change(bond, u.begin());
      moments[bond.number]   = direction(bond, u.begin());
      across[bond.number]    = size * length(bond) / y.norm();
    });
  }


  template <int dim>
  void FictitiousBonds<dim>::add_geometric_forces(Vector &y, const Vector &x) const
  {
    fictitious.begin_forces();
    for_each([&](const Bond &bond) {
      if (!bond.whole)
        return;
      Tensor<1, dim> force = change(bond, x.begin());
      force -= (bond.moment * force) / (length(bond) * length(bond)) * bond.moment;
      force *= stiffness_across(bond);
      subtract_force(y, bond, force);
    });
    fictitious.pass_on(y);
  }


  template <int dim>
  double FictitiousBonds<dim>::energy(const Vector &u) const
  {
    double sum = 0.;
    fictitious.find(u.begin());
    for_each([&](const Bond &bond) {
      const double product = extension_moment(bond, u.begin());
      sum += 0.5 * bond.spring * product * product;
    });
    return sum;
  }


  template <int dim>
  void FictitiousBonds<dim>::add_to_diagonal(Vector                    &diagonal,
                                             const SolidRows<dim>      &rows,
                                             const std::vector<double> &factor) const
  {
    // theta_i is a sum over coefficients of displacements. What images change of these, and what
    // was counted without them:
    Vector                      sum(diagonal.get_partitioner());
    std::vector<Tensor<1, dim>> own(families.nodes().n_local()), change(own.size());
    std::vector<unsigned int>   touched;
    std::vector<bool>           is_touched(own.size(), false);
    const auto                  touch = [&](const unsigned int node) {
      if (!is_touched[node])
        touched.push_back(node);
      is_touched[node] = true;
    };
    for (const unsigned int i : list)
      {
        touched.clear();
        for_each_of(i, [&](const Bond &bond) {
          Tensor<1, dim> of_node = bond.moment;
          touch(i);
          change[i] -= bond.moment;
          fictitious.for_each_term(bond.image, [&](const Term &term) {
            Tensor<1, dim> p;
            for (unsigned int d = 0; d < dim; ++d)
              p[d] = term.of_component(d) * bond.moment[d];
            if (term.node == i)
              of_node -= p;
            else
              for (unsigned int d = 0; d < dim; ++d)
                sum.local_element(dim * term.node + d) += bond.spring * p[d] * p[d];
            touch(term.node);
            change[term.node] += p;
          });
          for (unsigned int d = 0; d < dim; ++d)
            sum.local_element(dim * i + d) += bond.spring * of_node[d] * of_node[d];
        });
        own[i] = Tensor<1, dim>();
        rows.for_each(i, [&](const auto &bond) {
          own[bond.neighbor] = bond.moment;
          own[i] -= bond.moment;
        });
        for (const unsigned int node : touched)
          {
            for (unsigned int d = 0; d < dim; ++d)
              sum.local_element(dim * node + d) +=
                factor[i] * change[node][d] * (change[node][d] + 2. * own[node][d]);
            change[node]     = Tensor<1, dim>();
            is_touched[node] = false;
          }
        rows.for_each(i, [&](const auto &bond) { own[bond.neighbor] = Tensor<1, dim>(); });
        own[i] = Tensor<1, dim>();
      }
    sum.compress(VectorOperation::add);
    diagonal += sum;
  }


  template <int dim>
  Vector FictitiousBonds<dim>::row_sums(const Vector &of_dilatations) const
  {
    Vector rows(families.nodes().partitioner());
    for_each([&](const Bond &bond) {
      const double p     = bond.moment.norm();
      const double all   = 1. + fictitious.sum_of_factors(bond.image);
      const double size  = bond.spring * p * all + of_dilatations.local_element(bond.node);
      const double aside = std::abs(stiffness_across(bond));
      rows.local_element(bond.node) += size * p;
      fictitious.for_each_term(bond.image, [&](const Term &term) {
        double largest = 0.;
        for (unsigned int d = 0; d < dim; ++d)
          largest = std::max(largest, std::abs(term.of_component(d)));
        rows.local_element(term.node) += size * largest * p;
        rows.local_element(term.node) += largest * aside * all;
      });
      rows.local_element(bond.node) += aside * all;
    });
    rows.compress(VectorOperation::add);
    return rows;
  }


  template <int dim>
  double FictitiousBonds<dim>::sum_of_lengths(const unsigned int i) const
  {
    double sum = 0.;
    for_each_of(i, [&](const Bond &bond) {
      sum += bond.moment.norm() * (1. + fictitious.sum_of_factors(bond.image));
    });
    return sum;
  }


  template <int dim>
  bool FictitiousBonds<dim>::is_own_image(const Bond &bond) const
  {
    const Term &term = fictitious.first_term(bond.image);
    return may_break(bond) && term.mirrored != 0 && term.node == bond.node;
  }


  template <int dim>
  unsigned int FictitiousBonds<dim>::n_ends(const Bond &bond) const
  {
    const Term      &term = fictitious.first_term(bond.image);
    const Point<dim> far  = fictitious[bond.image].place;
    const Point<dim> p    = families.nodes().position(term.node),
                     i    = families.nodes().position(bond.node);
    const double slack    = 1e-6 * families.nodes().smallest_spacing();
    for (unsigned int d = 0; d < dim; ++d)
      if (((term.mirrored >> d) & 1) && std::abs(far[d] + p[d] - 2. * i[d]) > slack)
        return 1;
    return 0;
  }


  template <int dim>
  Overstretched FictitiousBonds<dim>::find_overstretched(const double             *u,
                                                         const BondStrengths<dim> &critical) const
  {
    Overstretched result;
    if (!fictitious.any_mirrored_alone())
      return result;
    fictitious.find(u);
    for_each([&](const Bond &bond) {
      if (!may_break(bond))
        return;
      const Tensor<1, dim> xi    = bond_vector(bond);
      const double         all   = lengths.empty() ? bond.moment * xi : length(bond) * xi.norm();
      const double         limit = all * critical.of_bond(bond.node, fictitious[bond.image].origin);
      const double         found = extension_moment(bond, u);
      if (found > limit)
        result.emplace_back(bond.number, found / limit);
    });
    return result;
  }


  template <int dim>
  void FictitiousBonds<dim>::break_bond(const std::size_t     number,
                                        const BondState::Mark mark,
                                        const double          t)
  {
    if (state.size() == 0)
      state.resize(image_of_bond.size());
    state.mark(number, mark, t);
    release(number);
  }


  template <int dim>
  void FictitiousBonds<dim>::release(const std::size_t number)
  {
    if (packs)
      {
        codes[number] = BondCode::gone;
        return;
      }
    springs[number] = 0.;
    moments[number] = Tensor<1, dim>();
    if (!lengths.empty())
      lengths[number] = across[number] = 0.;
  }


  template <int dim>
  std::vector<BondState::Kept> FictitiousBonds<dim>::exchange(Archive          &archive,
                                                              const NodeKeys   &keys,
                                                              const std::size_t n_first)
  {
    const Archive::Part        part(archive, "fictitious nodes");
    const BondState::Numbering numbering{
      [this](const std::size_t number) -> std::size_t {
        return list[std::upper_bound(starts.begin(), starts.end(), number) - starts.begin() - 1];
      },
      [this](const std::size_t node) { return starts[place_of(node)]; },
      [this]() { return image_of_bond.size(); }};
    return state.exchange(archive, numbering, keys, n_first);
  }


  template <int dim>
  void FictitiousBonds<dim>::break_dependent(const unsigned int               node,
                                             const std::vector<unsigned int> &lost,
                                             const double                     t)
  {
    if (place_of(node) == list.size())
      return;
    // Images of other nodes that are gone: what is continued from them is, too.
    std::vector<unsigned int> lost_images;
    for_each_of(node, [&](const Bond &bond) {
      if (may_break(bond) && !bond.whole)
        lost_images.push_back(bond.image);
    });
    for_each_of(node, [&](const Bond &bond) {
      if (!bond.whole)
        return;
      bool any_gone = false;
      fictitious.for_each_term(bond.image, [&](const Term &term) {
        any_gone =
          any_gone ||
          (term.mirrored == 0 ?
             std::find(lost.begin(), lost.end(), term.node) != lost.end() :
             std::any_of(lost_images.begin(), lost_images.end(), [&](const unsigned int image) {
               return fictitious.are_images_of_one(image, bond.image, term);
             }));
      });
      if (any_gone)
        break_bond(bond.number, BondState::dependent, t);
    });
  }


  template <int dim>
  std::size_t FictitiousBonds<dim>::memory_consumption() const
  {
    return state.memory_consumption() + fictitious.memory_consumption() +
           (image_of_bond.capacity() + list.capacity()) * sizeof(unsigned int) +
           moments.capacity() * sizeof(Tensor<1, dim>) + codes.capacity() * sizeof(BondCode::Code) +
           units.capacity() * sizeof(UnitBond<dim>) +
           (springs.capacity() + lengths.capacity() + across.capacity() + strains.capacity() +
            squares.capacity()) *
             sizeof(double) +
           starts.capacity() * sizeof(std::size_t);
  }


  template <int dim>
  void FictitiousBonds<dim>::part(const unsigned int node, const double t)
  {
    std::vector<Term> terms;
    for_each_of(node, [&](const Bond &bond) {
      if (!bond.whole)
        return;
      terms.clear();
      fictitious.for_each_term(bond.image, [&](const Term &term) { terms.push_back(term); });
      const Point<dim> &mirror = families.nodes().lattice() ? fictitious[bond.image].place :
                                                              fictitious.twice_planes(bond.image);
      if (is_cut<dim>(families, node, terms, mirror))
        break_bond(bond.number, BondState::parted, t);
    });
  }


  template <int dim>
  bool FictitiousBonds<dim>::is_parted(const unsigned int node) const
  {
    bool any = false;
    for_each_of(node, [&](const Bond &bond) {
      // What was cut from the start has never had a weight.
      any = any || (state.is_parted(bond.number) && squares[bond.number] > 0.);
    });
    return any;
  }


  template <int dim>
  double FictitiousBonds<dim>::weight_left(const unsigned int node) const
  {
    double sum = 0.;
    for_each_of(node, [&](const Bond &bond) {
      if (!state.is_parted(bond.number))
        sum += squares[bond.number] / families.nodes().volume(node);
    });
    return sum;
  }


  template <int dim>
  void FictitiousBonds<dim>::renew_springs(const unsigned int node, const NodeLaws<dim> &of_nodes)
  {
    for_each_of(node, [&](const Bond &bond) {
      if (bond.whole)
        springs[bond.number] = of_nodes.stiffness(node) / squares[bond.number];
    });
  }


  template <int dim>
  void FictitiousBonds<dim>::add_weights(Vector &q) const
  {
    for_each([&](const Bond &bond) {
      q.local_element(bond.node) += bond.spring / families.nodes().volume(bond.node); // W x^2
    });
  }


  template <int dim>
  void FictitiousBonds<dim>::find_springs(const NodeLaws<dim> &of_nodes, const bool full)
  {
    laws = &of_nodes;
    if (packs)
      return;
    if (families.cracks().history().changes_ever())
      squares = springs;
    for_each([&](const Bond &bond) {
      springs[bond.number] = bond.whole ? laws->stiffness(bond.node) / bond.spring : 0.;
    });
    if (!full)
      return;
    across.resize(springs.size(), 0.);
    for (const Tensor<1, dim> &p : moments)
      lengths.push_back(p.norm());
  }


  template <int dim>
  void FictitiousBonds<dim>::set_thermal_strains(const ThermalStrains &strain)
  {
    strains.resize(image_of_bond.size());
    for_each([&](const Bond &bond) {
      // What a temperature linear in space does to a free body is no linear displacement. The bond
      // has no force then if its extension is that of what the image follows from, at r_k from the
      // node: e = sum f_k (s_k M.r_k - r_k^2/2 ds/dM), the mean of both ends for a mirror image.
      const Point<dim>     at  = families.nodes().position(bond.node);
      const Tensor<1, dim> xi  = bond_vector(bond);
      double               own = strain[bond.node], other = 0., mean = 0., half = 0., rest = 1.;
      fictitious.for_each_term(bond.image, [&](const Term &term) {
        Tensor<1, dim> r = families.nodes().position(term.node) - at;
        for (unsigned int d = 0; d < dim; ++d)
          r[d] = (term.mirrored >> d) & 1 ? xi[d] : r[d];
        const double f = term.factor / xi.norm_square(), s = strain[term.node];
        other += term.factor * s;
        mean += f * s * (r * xi);
        half += 0.5 * f * r.norm_square();
        rest -= f * (r * xi);
      });
      // A body narrower than a family mirrors and continues along one axis: no such sum.
      mean -= half * (other - own);
      strains[bond.number] = std::abs(rest) > 1e-6 ? 0.5 * (own + other) : mean;
    });
  }


  template class FictitiousBonds<1>;
  template class FictitiousBonds<2>;
  template class FictitiousBonds<3>;
} // namespace PeriDeal
