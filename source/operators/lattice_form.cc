// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/bonds/stencil_kernel.h>
#include <perideal/operators/bond_form.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** Consecutive local nodes on consecutive sites of one lattice row. */
    struct NodeRun
    {
      std::size_t   first_slot; // in the padded grid
      std::uint32_t first_node, n;
    };


    /** A stored difference to the template: adds coefficient * (u_row - u_column). */
    struct Correction
    {
      std::uint32_t column;
      double        coefficient;
    };


    struct OutsideNode
    {
      std::size_t   slot;
      std::uint32_t number;
      double        volume;
    };


    template <int dim>
    class LatticeForm : public BondForm
    {
    public:
      explicit LatticeForm(const Families<dim> &families)
        : kernel(make_kernel(families))
        , n_owned(families.nodes().n_owned())
        , n_local(families.nodes().n_local())
      {
        lay_out_grid(families);
        find_runs(families);
        find_fictitious_slots(families);
        volumes.resize(n_local);
        for (unsigned int i = 0; i < n_local; ++i)
          volumes[i] = families.nodes().volume(i);
        find_family_sums(families);
        find_corrections(families);
      }

      void apply(double *y, const double *values, const double *outside) const override
      {
        fill_grid(values, outside);
        convolve(y);
        for (unsigned int i = 0; i < n_owned; ++i)
          y[i] = volumes[i] * (family_sums[i] * values[i] - y[i]);
        for (std::size_t k = 0; k < corrected_rows.size(); ++k)
          {
            const unsigned int i   = corrected_rows[k];
            double             sum = 0.;
            for (std::size_t c = correction_starts[k]; c < correction_starts[k + 1]; ++c)
              {
                const std::uint32_t j     = corrections[c].column;
                const double        other = j < n_local ? values[j] : outside[j - n_local];
                sum += corrections[c].coefficient * (values[i] - other);
              }
            y[i] += sum;
          }
      }

      std::size_t memory_consumption() const override
      {
        return sizeof(double) * (grid.capacity() + volumes.capacity() + family_sums.capacity()) +
               runs.capacity() * sizeof(NodeRun) +
               stencil_runs.capacity() * sizeof(StencilKernel::Run) +
               corrections.capacity() * sizeof(Correction) +
               corrected_rows.capacity() * sizeof(std::uint32_t) +
               correction_starts.capacity() * sizeof(std::size_t);
      }

      unsigned long long n_stored() const override
      {
        return corrections.size();
      }

      std::string name() const override
      {
        return "lattice";
      }

    private:
      using Index = typename Lattice<dim>::Index;

      /** The stencil w kappa on the nonnegative offsets, with the self term as it is inside the body. */
      static StencilKernel make_kernel(const Families<dim> &families)
      {
        std::vector<std::array<int, 3>> offsets;
        std::vector<double>             weights;
        const double                    kappa = families.conductivity(0);
        for (const FamilyMember<dim> &member : families.lattice_members())
          {
            std::array<int, 3> offset{{0, 0, 0}};
            std::copy(member.offset.begin(), member.offset.end(), offset.begin());
            if (*std::min_element(offset.begin(), offset.end()) < 0)
              continue;
            double weight = member.weight;
            for (const FamilyMember<dim> &self : families.self_members())
              if (self.offset == member.offset)
                weight += self.weight;
            offsets.push_back(offset);
            weights.push_back(kappa * weight);
          }
        return StencilKernel(dim, offsets, weights);
      }


      std::size_t slot(const Index &site) const
      {
        std::size_t s = 0;
        for (unsigned int d = dim; d-- > 0;)
          s = s * extent[d] + (site[d] - corner[d]);
        return s;
      }


      void lay_out_grid(const Families<dim> &families)
      {
        const Nodes<dim> &nodes = families.nodes();
        Index             low{}, high{};
        for (unsigned int i = 0; i < n_owned; ++i)
          {
            const Index site = nodes.lattice()->index(nodes.position(i));
            for (unsigned int d = 0; d < dim; ++d)
              {
                low[d]  = i == 0 ? site[d] : std::min(low[d], site[d]);
                high[d] = i == 0 ? site[d] : std::max(high[d], site[d]);
              }
          }
        std::size_t n = 1;
        for (unsigned int d = 0; d < dim; ++d)
          {
            corner[d] = low[d] - kernel.halo()[d];
            extent[d] = high[d] + kernel.halo()[d] + 1 - corner[d];
            n *= extent[d];
          }
        grid.assign(n, 0.);
      }


      bool in_grid(const Index &site) const
      {
        for (unsigned int d = 0; d < dim; ++d)
          if (site[d] < corner[d] || site[d] >= corner[d] + extent[d])
            return false;
        return true;
      }


      void find_runs(const Families<dim> &families)
      {
        const Nodes<dim> &nodes = families.nodes();
        std::size_t       next  = 0;
        for (unsigned int i = 0; i < n_local; ++i)
          {
            const Index site = nodes.lattice()->index(nodes.position(i));
            if (!in_grid(site))
              continue;
            const std::size_t s         = slot(site);
            const bool        continues = !runs.empty() && s == next && i != n_owned &&
                                   runs.back().first_node + runs.back().n == i &&
                                   (s % extent[0]) != 0;
            if (continues)
              ++runs.back().n;
            else
              runs.push_back({s, i, 1});
            next = s + 1;
          }
        for (const NodeRun &run : runs)
          if (run.first_node < n_owned)
            {
              StencilKernel::Run stencil_run;
              std::size_t        s = run.first_slot;
              stencil_run.x        = s % extent[0];
              s /= extent[0];
              if constexpr (dim > 1)
                {
                  stencil_run.y = s % extent[1];
                  s /= extent[1];
                }
              if constexpr (dim > 2)
                stencil_run.z = s;
              stencil_run.n = run.n;
              stencil_runs.push_back(stencil_run);
              first_nodes.push_back(run.first_node);
            }
        StencilKernel::sort_for_reuse(stencil_runs);
        for (const StencilKernel::Run &run : stencil_runs)
          {
            Index site;
            site[0] = corner[0] + static_cast<int>(run.x);
            if constexpr (dim > 1)
              site[1] = corner[1] + static_cast<int>(run.y);
            if constexpr (dim > 2)
              site[2] = corner[2] + static_cast<int>(run.z);
            first_nodes.push_back(families.node_at(site));
          }
      }


      /** Where the fictitious nodes go in the grid, and which of these sites no real node fills. */
      void find_fictitious_slots(const Families<dim> &families)
      {
        for (std::uint32_t f = 0; f < families.fictitious().size(); ++f)
          {
            const FictitiousNode<dim> &node = families.fictitious()[f];
            if (!in_grid(node.site))
              continue;
            outside_nodes.push_back({slot(node.site), f, node.volume});
            if (families.node_at(node.site) == numbers::invalid_unsigned_int)
              emptied_slots.push_back(slot(node.site));
          }
      }


      /** The template's sum of coefficients at each node: its convolution of a field of ones. */
      void find_family_sums(const Families<dim> &families)
      {
        const std::vector<double> ones(n_local, 1.), ones_outside(families.fictitious().size(), 1.);
        family_sums.resize(n_owned);
        fill_grid(ones.data(), ones_outside.data());
        convolve(family_sums.data());
      }


      /** The template's conductance of a bond. */
      double template_weight(const Families<dim>                &families,
                             const unsigned int                  i,
                             const typename Families<dim>::Bond &bond) const
      {
        if (families.self_members().empty())
          return bond.intact;
        const std::uint32_t j = bond.neighbor;
        const double volume = j < n_local ? volumes[j] : families.fictitious()[j - n_local].volume;
        const Tensor<1, dim> xi     = families.bond_vector(i, j);
        double               weight = 0.;
        for (const auto *list : {&families.lattice_members(), &families.self_members()})
          for (const FamilyMember<dim> &member : *list)
            if (families.is_offset(xi, member))
              weight += member.weight;
        return volumes[i] * volume * weight * families.conductivity(i);
      }


      void find_corrections(const Families<dim> &families)
      {
        std::vector<typename Families<dim>::Bond> bonds;
        correction_starts.push_back(0);
        for (unsigned int i = 0; i < n_owned; ++i)
          {
            if (!families.near_crack(i) && families.self_members().empty())
              continue;
            families.bonds_of(i, bonds);
            for (const auto &bond : bonds)
              {
                const double expected   = template_weight(families, i, bond);
                const double difference = bond.weight - expected;
                if (std::abs(difference) > 1e-14 * expected)
                  corrections.push_back({bond.neighbor, difference});
              }
            if (corrections.size() > correction_starts.back())
              {
                corrected_rows.push_back(i);
                correction_starts.push_back(corrections.size());
              }
          }
      }


      void fill_grid(const double *values, const double *outside) const
      {
        for (const NodeRun &run : runs)
          {
            double       *to     = grid.data() + run.first_slot;
            const double *from   = values + run.first_node;
            const double *volume = volumes.data() + run.first_node;
            for (std::uint32_t k = 0; k < run.n; ++k)
              to[k] = volume[k] * from[k];
          }
        for (const std::size_t s : emptied_slots)
          grid[s] = 0.;
        for (const OutsideNode &node : outside_nodes)
          grid[node.slot] += node.volume * outside[node.number];
      }


      void convolve(double *y) const
      {
        for (std::size_t k = 0; k < stencil_runs.size(); ++k)
          stencil_runs[k].out = y + first_nodes[k];
        StencilKernel::Grid padded;
        padded.data = grid.data();
        if constexpr (dim > 1)
          padded.row_stride = extent[0];
        if constexpr (dim > 2)
          padded.plane_stride = static_cast<std::ptrdiff_t>(extent[0]) * extent[1];
        kernel.apply(padded, stencil_runs);
      }

      StencilKernel                           kernel;
      unsigned int                            n_owned, n_local;
      Index                                   corner, extent;
      mutable std::vector<double>             grid;
      std::vector<NodeRun>                    runs;
      mutable std::vector<StencilKernel::Run> stencil_runs;
      std::vector<std::uint32_t>              first_nodes;
      std::vector<OutsideNode>                outside_nodes;
      std::vector<std::size_t>                emptied_slots;
      std::vector<double>                     volumes, family_sums;
      std::vector<std::uint32_t>              corrected_rows;
      std::vector<std::size_t>                correction_starts;
      std::vector<Correction>                 corrections;
    };
  } // namespace


  template <int dim>
  std::unique_ptr<BondForm> make_lattice_form(const Families<dim> &families)
  {
    return std::make_unique<LatticeForm<dim>>(families);
  }


  template <int dim>
  bool lattice_form_suits(const Families<dim> &families, std::string &reason)
  {
    if (!families.has_unique_sites())
      reason = "the nodes are not on a lattice with one node per site";
    else if (!families.uniform_conductivity())
      reason = "the conductivity varies";
    else
      return true;
    return false;
  }


#define PERIDEAL_INSTANTIATE(dim)                                              \
  template std::unique_ptr<BondForm> make_lattice_form(const Families<dim> &); \
  template bool                      lattice_form_suits(const Families<dim> &, std::string &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
