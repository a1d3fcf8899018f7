// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/gathered_lists.h>
#include <perideal/base/instantiate.h>
#include <perideal/base/interleaved.h>
#include <perideal/mesh/points_within.h>
#include <perideal/operators/solid/short_range_contact.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    constexpr double share_of_bond = 0.9, share_of_spacing = 1.35, share_of_skin = 0.5,
                     // Ends of a bond that has broken are a tenth of it farther apart than d.
      safe_after_loss = 0.04, round_off = 1. + 1e-8;


    template <int dim>
    bool is_before(const Point<dim> &a, const Point<dim> &b)
    {
      for (unsigned int d = 0; d < dim; ++d)
        if (a[d] != b[d])
          return a[d] < b[d];
      return false;
    }
  } // namespace


  template <int dim>
  ShortRangeContact<dim>::ShortRangeContact(const Nodes<dim>          &nodes,
                                            const double               horizon,
                                            const BondsOf             &bonds_of,
                                            const std::vector<double> &stiffnesses)
    : nodes(nodes)
    , horizon(horizon)
    , bonds_of(bonds_of)
    , finest(horizon)
  {
    std::vector<unsigned int> others;
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        double shortest = horizon;
        bonds_of(i, others);
        for (const unsigned int j : others)
          shortest = std::min(shortest, nodes.position(i).distance(nodes.position(j)));
        own.push_back({stiffnesses[i], shortest});
        finest = std::min(finest, shortest);
      }
    finest = Utilities::MPI::min(finest, nodes.communicator());
  }


  template <int dim>
  void ShortRangeContact<dim>::find_asked()
  {
    std::vector<unsigned int> others;
    asked.clear();
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        own[i].is_whole = bonds_of(i, others);
        own[i].is_asked = !own[i].is_whole;
      }
    for (const BoundaryShare &share : nodes.boundary_shares())
      own[share.node].is_asked = true;
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      if (own[i].is_asked)
        asked.push_back(i);
  }


  template <int dim>
  std::vector<double> ShortRangeContact<dim>::values_of_asked(const Vector &u) const
  {
    std::vector<double> values;
    values.reserve(dim * asked.size());
    for (const unsigned int i : asked)
      for (unsigned int d = 0; d < dim; ++d)
        values.push_back(u.local_element(dim * i + d));
    return values;
  }


  template <int dim>
  double ShortRangeContact<dim>::farthest_move(const Vector              &u,
                                               const std::vector<double> &since) const
  {
    double farthest = 0.;
    for (std::size_t k = 0; dim * k < since.size(); ++k)
      {
        double square = 0.;
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double move = u.local_element(dim * asked[k] + d) - since[dim * k + d];
            square += move * move;
          }
        farthest = std::max(farthest, square);
      }
    return std::sqrt(farthest);
  }


  template <int dim>
  bool ShortRangeContact<dim>::update(const Vector &u, double &gained)
  {
    const MPI_Comm all = nodes.communicator();
    gained             = 0.;
    if (!is_found)
      {
        find_asked();
        search(u);
        return false;
      }
    double moves[3] = {farthest_move(u, at_search),
                       farthest_move(u, at_loss),
                       touch_here ? 1. : 0.};
    Utilities::MPI::max(moves, all, moves);
    const bool late = moves[1] > safe_after_loss * finest, touch = moves[2] > 0.;
    if (moves[0] <= 0.5 * skin && !late)
      return touch;
    gained -= late ? energy(u) : 0.;
    search(u);
    gained += late ? energy(u) : 0.;
    return touch;
  }


  template <int dim>
  double ShortRangeContact<dim>::change(const std::vector<unsigned int> &of_nodes, const Vector &u)
  {
    if (!is_found)
      return 0.;
    for (const unsigned int i : of_nodes)
      {
        own[i].is_whole = false;
        if (own[i].is_asked)
          continue;
        own[i].is_asked = true;
        asked.push_back(i);
        for (unsigned int d = 0; d < dim; ++d)
          at_search.push_back(u.local_element(dim * i + d));
      }
    const std::size_t n_known = at_loss.size();
    if (n_known < dim * asked.size())
      {
        const std::vector<double> now = values_of_asked(u);
        at_loss.insert(at_loss.end(), now.begin() + n_known, now.end());
      }
    return 0.; // what has changed is found, and told, once they have moved
  }


  template <int dim>
  auto ShortRangeContact<dim>::gathered(const Vector &u) const -> std::vector<Place>
  {
    std::vector<double> numbers;
    for (const unsigned int i : asked)
      {
        numbers.insert(numbers.end(),
                       {1. * (nodes.first_owned() + i),
                        own[i].spacing,
                        own[i].stiffness,
                        own[i].is_whole ? 1. : 0.});
        for (unsigned int d = 0; d < dim; ++d)
          numbers.insert(
            numbers.end(),
            {nodes.position(i)[d], nodes.position(i)[d] + u.local_element(dim * i + d)});
      }
    std::vector<Place> list;
    for (const std::vector<double> &some : gathered_lists(nodes.communicator(), numbers))
      for (auto from = some.begin(); from != some.end();)
        {
          Place place;
          place.number    = static_cast<types::global_dof_index>(*from++);
          place.spacing   = *from++;
          place.stiffness = *from++;
          place.is_whole  = *from++ > 0.;
          for (unsigned int d = 0; d < dim; ++d)
            {
              place.undeformed[d] = *from++;
              place.now[d]        = *from++;
            }
          list.push_back(place);
        }
    return list;
  }


  template <int dim>
  double ShortRangeContact<dim>::distance_of(const Place &a, const Place &b) const
  {
    return std::min(share_of_bond * a.undeformed.distance(b.undeformed),
                    0.5 * share_of_spacing * (a.spacing + b.spacing));
  }


  template <int dim>
  bool ShortRangeContact<dim>::may_touch(const Place                     &a,
                                         const Place                     &b,
                                         const std::vector<unsigned int> &bonds_of_a) const
  {
    const auto are_near = [&](const Point<dim> &p, const Point<dim> &q) {
      return p.distance(q) <= round_off * horizon;
    };
    const bool are_whole = a.is_whole && b.is_whole;
    for (const unsigned int k : bonds_of_a)
      {
        if (nodes.partitioner()->local_to_global(k) == b.number)
          return false;
        const Point<dim> &between = nodes.position(k);
        if (are_whole && are_near(a.undeformed, between) && are_near(between, b.undeformed))
          return false;
      }
    return true;
  }


  template <int dim>
  std::vector<std::vector<unsigned int>> ShortRangeContact<dim>::pairs(
    const std::vector<Place> &list,
    const std::size_t         first) const
  {
    const auto now = [&](const std::size_t k) -> const Point<dim> & { return list[k].now; };
    const PointTree<dim, decltype(now)> tree(list.size(), now);
    // Half of the skin over that share is the largest spacing.
    const double reach = share_of_spacing / share_of_skin * skin + skin;

    std::vector<std::pair<unsigned int, double>> found;
    std::vector<unsigned int>                    bonds;
    std::vector<std::vector<unsigned int>>       result(asked.size());
    for (std::size_t k = 0; k < asked.size(); ++k)
      {
        const Place &self  = list[first + k];
        bool         known = false;
        found.clear();
        tree.find(self.now, reach, found);
        for (const auto &[j, square] : found)
          {
            if (j == first + k || std::sqrt(square) > distance_of(self, list[j]) + skin)
              continue;
            if (!known)
              bonds_of(asked[k], bonds);
            known = true;
            if (may_touch(self, list[j], bonds))
              result[k].push_back(j);
          }
        std::sort(result[k].begin(), result[k].end(), [&](const auto a, const auto b) {
          return is_before(list[a].undeformed, list[b].undeformed);
        });
      }
    return result;
  }


  template <int dim>
  void ShortRangeContact<dim>::search(const Vector &u)
  {
    const MPI_Comm all = nodes.communicator();
    std::sort(asked.begin(), asked.end());
    at_search = values_of_asked(u);
    at_loss.clear();
    is_found                      = true;
    const std::vector<Place> list = gathered(u);
    double                   most = 0.;
    for (const Place &place : list)
      most = std::max(most, place.spacing);
    skin = share_of_skin * most;
    // Those of this process follow each other.
    const std::size_t first = std::find_if(list.begin(),
                                           list.end(),
                                           [&](const Place &place) {
                                             return !asked.empty() &&
                                                    place.number == nodes.first_owned() + asked[0];
                                           }) -
                              list.begin();
    const auto others = pairs(list, first);

    const IndexSet &owned = nodes.partitioner()->locally_owned_range();
    IndexSet        ghosts(owned.size());
    double          n_pairs = 0.;
    for (const auto &some : others)
      for (const unsigned int j : some)
        {
          ++n_pairs;
          if (!owned.is_element(list[j].number))
            ghosts.add_index(list[j].number);
        }
    rows.clear();
    this->forces.clear();
    any_pairs = Utilities::MPI::sum(n_pairs, all) > 0.;
    if (!any_pairs)
      return;
    ghosts.compress();
    const Utilities::MPI::Partitioner layout(owned, ghosts, all);
    places.reinit(interleaved(layout, dim));
    for (std::size_t k = 0; k < others.size(); ++k)
      {
        Row row{asked[k], {}};
        for (const unsigned int j : others[k])
          row.partners.push_back({layout.global_to_local(list[j].number),
                                  std::min(list[first + k].stiffness, list[j].stiffness),
                                  distance_of(list[first + k], list[j]),
                                  Tensor<1, dim>()});
        if (!row.partners.empty())
          rows.push_back(row);
      }
  }


  template <int dim>
  template <typename Rows, typename Visit>
  void ShortRangeContact<dim>::for_each_pair(Rows         &of,
                                             const Vector &values,
                                             const bool    deformed,
                                             const Visit  &visit) const
  {
    if (!any_pairs)
      return;
    for (const unsigned int i : asked)
      for (unsigned int d = 0; d < dim; ++d)
        places.local_element(dim * i + d) =
          values.local_element(dim * i + d) + (deformed ? nodes.position(i)[d] : 0.);
    places.update_ghost_values();
    for (auto &row : of)
      for (auto &partner : row.partners)
        {
          Tensor<1, dim> difference;
          for (unsigned int d = 0; d < dim; ++d)
            difference[d] = places.local_element(dim * row.node + d) -
                            places.local_element(dim * partner.node + d);
          visit(row, partner, difference);
        }
  }


  template <int dim>
  void ShortRangeContact<dim>::find_forces(const Vector &u) const
  {
    this->forces.clear();
    for_each_pair(rows, u, true, [&](const Row &row, const Partner &partner, const auto &apart) {
      const double r = apart.norm();
      if (r >= partner.distance || r == 0.)
        return;
      if (this->forces.empty() || this->forces.back().first / dim != row.node)
        for (unsigned int d = 0; d < dim; ++d)
          this->forces.emplace_back(dim * row.node + d, 0.);
      const double force = partner.stiffness * (partner.distance - r) / r;
      for (unsigned int d = 0; d < dim; ++d)
        this->forces[this->forces.size() - dim + d].second -= force * apart[d];
    });
    touch_here = !this->forces.empty();
  }


  template <int dim>
  double ShortRangeContact<dim>::energy(const Vector &u) const
  {
    if (!any_pairs)
      return 0.;
    double sum = 0.;
    for_each_pair(rows, u, true, [&](const Row &, const Partner &partner, const auto &apart) {
      const double overlap = partner.distance - apart.norm();
      if (overlap > 0.) // half of it, the other half is the partner's
        sum += 0.25 * partner.stiffness * overlap * overlap;
    });
    return Utilities::MPI::sum(sum, nodes.communicator());
  }


  template <int dim>
  void ShortRangeContact<dim>::linearize(const Vector &u)
  {
    for_each_pair(rows, u, true, [&](Row &, Partner &partner, const auto &apart) {
      const double r       = apart.norm();
      const bool   touches = r < partner.distance && r > 0.;
      partner.direction    = touches ? apart / r : Tensor<1, dim>();
      partner.across       = touches ? partner.stiffness * (partner.distance - r) / r : 0.;
    });
  }


  template <int dim>
  void ShortRangeContact<dim>::add_tangent(Vector &y, const Vector &x) const
  {
    for_each_pair(rows, x, false, [&](const Row &row, const Partner &partner, const auto &change) {
      if (partner.across == 0.)
        return;
      const Tensor<1, dim> force =
        (partner.stiffness + partner.across) * (partner.direction * change) * partner.direction -
        partner.across * change;
      for (unsigned int d = 0; d < dim; ++d)
        y.local_element(dim * row.node + d) += force[d];
    });
  }


  template <int dim>
  double ShortRangeContact<dim>::row_bound(const unsigned int node) const
  {
    const auto row =
      std::lower_bound(rows.begin(), rows.end(), node, [](const Row &a, const unsigned int b) {
        return a.node < b;
      });
    double sum = 0.;
    if (any_pairs && row != rows.end() && row->node == node)
      for (const Partner &partner : row->partners)
        if (partner.across > 0.)
          sum += 2. * (partner.stiffness + partner.across);
    return sum;
  }


  template <int dim>
  std::size_t ShortRangeContact<dim>::memory_consumption() const
  {
    std::size_t sum = own.capacity() * sizeof(Own) +
                      (at_search.capacity() + at_loss.capacity()) * sizeof(double) +
                      asked.capacity() * sizeof(unsigned int) + rows.capacity() * sizeof(Row) +
                      places.locally_owned_size() * sizeof(double);
    for (const Row &row : rows)
      sum += row.partners.capacity() * sizeof(Partner);
    return sum;
  }


  PERIDEAL_INSTANTIATE_CLASS(class ShortRangeContact);
} // namespace PeriDeal
