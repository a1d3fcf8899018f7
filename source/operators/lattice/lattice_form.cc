// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/base/node_loops.h>
#include <perideal/operators/lattice/bond_form.h>

#include <algorithm>
#include <cmath>

#include "lattice_layout.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /**
     * The stencil w kappa on the nonnegative offsets, with the self term as it is inside the body;
     * or ones, which count bonds.
     */
    template <int dim>
    StencilKernel make_kernel(const DiffusionBonds<dim> &bonds, const bool ones)
    {
      std::vector<std::array<int, 3>> offsets;
      std::vector<double>             weights;
      const double                    kappa = bonds.conductivities().of_node(0);
      for (const FamilyMember<dim> &member : bonds.weights().members())
        {
          std::array<int, 3> offset{{0, 0, 0}};
          std::copy(member.offset.begin(), member.offset.end(), offset.begin());
          if (*std::min_element(offset.begin(), offset.end()) < 0)
            continue;
          double weight = member.weight;
          for (const FamilyMember<dim> &self : bonds.weights().self_members())
            if (self.offset == member.offset)
              weight += self.weight;
          offsets.push_back(offset);
          weights.push_back(ones ? 1. : kappa * weight);
        }
      return StencilKernel(dim, offsets, weights);
    }


    template <int dim>
    class LatticeForm : public BondForm
    {
    public:
      explicit LatticeForm(const DiffusionBonds<dim> &bonds)
        : bonds(bonds)
        , kernel(make_kernel(bonds, false))
        , layout(bonds.families(), kernel.halo())
        , n_local(bonds.nodes().n_local())
        , grid(layout.n_slots(), 0.)
        , runs(layout.runs)
      {
        find_fictitious_slots();
        find_family_sums();
        find_corrections();
      }

      void apply(double            *y,
                 const double      *values,
                 const double      *outside,
                 const NodesAction &finish) const override
      {
        const bool fill_first = !outside_nodes.empty();
        if (fill_first)
          fill_grid(values, outside);
        typename LatticeLayout<dim>::Group at;
        std::size_t                        row = 0;
        for (std::size_t g = 0; g < layout.groups.size(); ++g)
          {
            const auto &end = layout.groups[g];
            for (std::size_t k = at.fills; k < end.fills && !fill_first; ++k)
              fill(layout.fills[k], values);
            convolve(kernel, at.runs, end.runs, y);
            for (std::size_t k = at.pieces; k < end.pieces; ++k)
              combine(layout.pieces[k], values, y);
            for (; row < corrections.ends[g]; ++row)
              y[corrections.rows[row]] += correction(row, values, outside);
            if (finish)
              for (std::size_t k = at.ranges; k < end.ranges; ++k)
                finish(layout.ranges[k].first, layout.ranges[k].second);
            at = end;
          }
      }

      double row_sums(double *sums) const override
      {
        const unsigned int n_owned = bonds.nodes().n_owned();
        for (const LatticePiece &piece : layout.pieces)
          for (std::uint32_t k = 0; k < piece.n; ++k)
            sums[piece.node + k] = layout.volume(piece, k) * layout.family_sum(piece, k);
        // The number of bonds is a convolution of ones with ones. Half a bond is the other node's,
        // but a fictitious one has no own.
        std::vector<double> count(n_owned);
        fill_grid_directly(std::vector<double>(n_local, 0.5),
                           std::vector<double>(bonds.neighbors().outside().size(), 1.));
        convolve(make_kernel(bonds, true), 0, runs.size(), count.data());
        std::vector<typename DiffusionBonds<dim>::Bond> family;
        for (const std::uint32_t i : corrections.rows) // the plain way
          {
            bonds.bonds_of(i, family);
            sums[i] = count[i] = 0.;
            for (const auto &bond : family)
              {
                sums[i] += bond.weight;
                if (bond.weight > 0.)
                  count[i] += bond.neighbor < n_local ? 0.5 : 1.;
              }
          }
        double n_bonds = 0.;
        for (const double c : count)
          n_bonds += c;
        return n_bonds;
      }

      void update_rows(const std::vector<unsigned int> &rows, double *sums) override
      {
        if (ranks.empty())
          rank_nodes();
        std::vector<std::uint32_t> changed(rows.begin(), rows.end());
        const auto                 comes_first = [&](const std::uint32_t a, const std::uint32_t b) {
          return ranks[a] < ranks[b];
        };
        std::sort(changed.begin(), changed.end(), comes_first);
        // Merge the changed rows with those that stay, in the order of the layout.
        spare.clear();
        spare.starts.push_back(0);
        std::size_t old = 0, fresh = 0;
        for (const std::uint32_t end : group_ends())
          {
            for (;;)
              {
                const bool any_old = old < corrections.rows.size() &&
                                     ranks[corrections.rows[old]] < end,
                           any_new = fresh < changed.size() && ranks[changed[fresh]] < end;
                if (!any_old && !any_new)
                  break;
                if (any_new && (!any_old || !comes_first(corrections.rows[old], changed[fresh])))
                  {
                    const std::uint32_t i = changed[fresh++];
                    if (any_old && corrections.rows[old] == i)
                      ++old;
                    sums[i] = correct(i, spare);
                  }
                else
                  spare.copy_row(corrections, old++);
              }
            spare.ends.push_back(spare.rows.size());
          }
        std::swap(corrections, spare);
      }

      void update_conductivities(double *) override
      {
        Assert(false, ExcMessage("one conductivity everywhere"));
      }

      std::size_t memory_consumption() const override
      {
        return sizeof(double) * grid.capacity() + layout.memory_consumption() +
               runs.capacity() * sizeof(StencilKernel::Run) + corrections.memory() +
               spare.memory() + ranks.capacity() * sizeof(std::uint32_t) +
               outside_nodes.capacity() * sizeof(OutsideNode);
      }

      unsigned long long n_stored() const override
      {
        return corrections.list.size();
      }

      std::string name() const override
      {
        return "lattice";
      }

    private:
      /** A stored difference to the template: adds coefficient * (u_row - u_column). */
      struct Correction
      {
        std::uint32_t column;
        double        coefficient;
      };

      /** The corrected rows in the order of the layout. */
      struct Corrections
      {
        void clear()
        {
          rows.clear();
          starts.clear();
          ends.clear();
          list.clear();
        }

        void copy_row(const Corrections &from, const std::size_t row)
        {
          rows.push_back(from.rows[row]);
          list.insert(list.end(),
                      from.list.begin() + from.starts[row],
                      from.list.begin() + from.starts[row + 1]);
          starts.push_back(list.size());
        }

        std::size_t memory() const
        {
          return list.capacity() * sizeof(Correction) + rows.capacity() * sizeof(std::uint32_t) +
                 (starts.capacity() + ends.capacity()) * sizeof(std::size_t);
        }

        std::vector<std::uint32_t> rows;
        std::vector<std::size_t>   starts, ends; // of rows in the list; of groups in the rows
        std::vector<Correction>    list;
      };

      struct OutsideNode
      {
        std::size_t   slot;
        std::uint32_t number;
        double        volume;
      };


      /** Where the fictitious nodes go in the grid, and which of these sites no real node fills. */
      void find_fictitious_slots()
      {
        for (std::uint32_t f = 0; f < bonds.neighbors().outside().size(); ++f)
          {
            const FictitiousNode<dim> &node = bonds.neighbors().outside()[f];
            if (!layout.in_grid(node.site))
              continue;
            outside_nodes.push_back({layout.slot(node.site), f, node.volume});
            if (bonds.neighbors().node_at(node.site) == numbers::invalid_unsigned_int)
              emptied_slots.push_back(layout.slot(node.site));
          }
      }


      /** The template's sum of coefficients at each node: its convolution of the volumes. */
      void find_family_sums()
      {
        std::vector<double> volumes(n_local), outside, sums(bonds.nodes().n_owned());
        for (unsigned int i = 0; i < n_local; ++i)
          volumes[i] = bonds.nodes().volume(i);
        for (const FictitiousNode<dim> &node : bonds.neighbors().outside())
          outside.push_back(node.volume);
        fill_grid_directly(volumes, outside);
        convolve(kernel, 0, runs.size(), sums.data());
        layout.set_values(volumes, sums);
      }


      /**
       * Whether all touching neighbours are there with the node's own volume: then its self term is
       * the template's.
       */
      bool self_term_is_regular(const std::uint32_t i) const
      {
        const Nodes<dim> &nodes = bonds.nodes();
        const auto        site  = nodes.lattice()->index(nodes.position(i));
        for (const FamilyMember<dim> &self : bonds.weights().self_members())
          {
            auto other = site;
            for (unsigned int d = 0; d < dim; ++d)
              other[d] += self.offset[d];
            const unsigned int j = bonds.neighbors().node_at(other);
            if (j == numbers::invalid_unsigned_int || nodes.volume(j) != nodes.volume(i))
              return false;
          }
        return true;
      }


      /** The template's conductance of a bond. */
      double template_weight(const unsigned int                        i,
                             const typename DiffusionBonds<dim>::Bond &bond) const
      {
        if (bonds.weights().self_members().empty())
          return bond.intact;
        const std::uint32_t  j      = bond.neighbor;
        const double         volume = bonds.neighbors().volume(j);
        const Tensor<1, dim> xi     = bonds.neighbors().bond_vector(i, j);
        double               weight = 0.;
        for (const auto *list : {&bonds.weights().members(), &bonds.weights().self_members()})
          for (const FamilyMember<dim> &member : *list)
            if (bonds.weights().is_offset(xi, member))
              weight += member.weight;
        return bonds.nodes().volume(i) * volume * weight * bonds.conductivities().of_node(i);
      }


      void find_corrections()
      {
        corrections.starts.push_back(0);
        std::size_t p = 0;
        for (const auto &group : layout.groups)
          {
            for (; p < group.pieces; ++p)
              for (std::uint32_t k = 0; k < layout.pieces[p].n; ++k)
                {
                  const std::uint32_t i = layout.pieces[p].node + k;
                  if (bonds.near_crack(i) || !self_term_is_regular(i))
                    correct(i, corrections);
                }
            corrections.ends.push_back(corrections.rows.size());
          }
        corrections.list.shrink_to_fit();
      }


      /** Adds the row's corrections, if it has any. Returns the sum of its conductances. */
      double correct(const std::uint32_t i, Corrections &to)
      {
        double sum = 0.;
        bonds.bonds_of(i, family);
        for (const auto &bond : family)
          {
            const double expected   = template_weight(i, bond);
            const double difference = bond.weight - expected;
            sum += bond.weight;
            if (std::abs(difference) > 1e-14 * expected)
              to.list.push_back({bond.neighbor, difference});
          }
        if (to.list.size() > to.starts.back())
          {
            to.rows.push_back(i);
            to.starts.push_back(to.list.size());
          }
        return sum;
      }


      /** Where each node comes in the order of the layout. */
      void rank_nodes()
      {
        ranks.resize(bonds.nodes().n_owned());
        std::uint32_t rank = 0;
        for (const LatticePiece &piece : layout.pieces)
          for (std::uint32_t k = 0; k < piece.n; ++k)
            ranks[piece.node + k] = rank++;
      }


      /** Nodes of all groups up to each one. */
      std::vector<std::uint32_t> group_ends() const
      {
        std::vector<std::uint32_t> ends;
        std::uint32_t              n = 0;
        std::size_t                p = 0;
        for (const auto &group : layout.groups)
          {
            for (; p < group.pieces; ++p)
              n += layout.pieces[p].n;
            ends.push_back(n);
          }
        return ends;
      }


      double correction(const std::size_t row, const double *values, const double *outside) const
      {
        const double u   = values[corrections.rows[row]];
        double       sum = 0.;
        for (std::size_t c = corrections.starts[row]; c < corrections.starts[row + 1]; ++c)
          {
            const auto &[j, coefficient] = corrections.list[c];
            sum += coefficient * (u - (j < n_local ? values[j] : outside[j - n_local]));
          }
        return sum;
      }


      void fill(const LatticePiece &piece, const double *values) const
      {
        double *to = grid.data() + piece.slot;
        if (!piece.varies())
          NodeLoops::scale(to, values + piece.node, piece.volume, piece.n);
        else
          NodeLoops::scale(to,
                           values + piece.node,
                           layout.varying_volumes.data() + piece.varying,
                           piece.n);
      }


      void combine(const LatticePiece &piece, const double *values, double *y) const
      {
        if (!piece.varies())
          NodeLoops::combine(y + piece.node,
                             values + piece.node,
                             piece.volume,
                             piece.family_sum,
                             piece.n);
        else
          NodeLoops::combine(y + piece.node,
                             values + piece.node,
                             layout.varying_volumes.data() + piece.varying,
                             layout.varying_sums.data() + piece.varying,
                             piece.n);
      }


      /** All values times volumes into the grid. */
      void fill_grid(const double *values, const double *outside) const
      {
        for (const LatticePiece &piece : layout.fills)
          fill(piece, values);
        for (const std::size_t s : emptied_slots)
          grid[s] = 0.;
        for (const OutsideNode &node : outside_nodes)
          grid[node.slot] += node.volume * outside[node.number];
      }


      /** Given values into the grid. */
      void fill_grid_directly(const std::vector<double> &values,
                              const std::vector<double> &outside) const
      {
        for (const LatticePiece &piece : layout.fills)
          std::copy_n(values.data() + piece.node, piece.n, grid.data() + piece.slot);
        for (const std::size_t s : emptied_slots)
          grid[s] = 0.;
        for (const OutsideNode &node : outside_nodes)
          grid[node.slot] += outside[node.number];
      }


      void convolve(const StencilKernel &stencil,
                    const std::size_t    begin,
                    const std::size_t    end,
                    double              *y) const
      {
        for (std::size_t k = begin; k < end; ++k)
          runs[k].out = y + layout.first_nodes[k];
        stencil.apply(layout.grid(grid.data()), runs.data() + begin, end - begin);
      }

      const DiffusionBonds<dim>              &bonds;
      const StencilKernel                     kernel;
      LatticeLayout<dim>                      layout;
      const unsigned int                      n_local;
      mutable std::vector<double>             grid;
      mutable std::vector<StencilKernel::Run> runs;
      std::vector<OutsideNode>                outside_nodes;
      std::vector<std::size_t>                emptied_slots;
      Corrections                             corrections, spare;
      std::vector<std::uint32_t> ranks; // of nodes in the order of the layout; once rows change

      std::vector<typename DiffusionBonds<dim>::Bond> family; // of the row at work
    };
  } // namespace


  template <int dim>
  std::unique_ptr<BondForm> make_lattice_form(const DiffusionBonds<dim> &bonds)
  {
    return std::make_unique<LatticeForm<dim>>(bonds);
  }


  template <int dim>
  bool lattice_form_suits(const DiffusionBonds<dim> &bonds, std::string &reason)
  {
    if (!bonds.neighbors().has_unique_sites())
      reason = "the nodes are not on a lattice with one node per site";
    else if (!bonds.conductivities().uniform())
      reason = "the conductivity varies";
    else if (bonds.corrects_every_bond())
      reason = "the energy correction gives each bond a factor of its own";
    else
      return true;
    return false;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(make_lattice_form);
  PERIDEAL_INSTANTIATE_FUNCTION(lattice_form_suits);
} // namespace PeriDeal
