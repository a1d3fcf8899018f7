// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "msh_touching.h"

#include <deal.II/base/tensor.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    using Bin = std::array<std::int64_t, 3>;

    struct HashOfBin
    {
      std::size_t operator()(const Bin &bin) const
      {
        std::uint64_t hash = 0;
        for (const std::int64_t number : bin)
          hash = (hash ^ static_cast<std::uint64_t>(number)) * 0x9E3779B97F4A7C15u;
        return hash ^ (hash >> 32);
      }
    };


    /** What is nearer to an edge than this, in terms of its length, lies on it. */
    constexpr double near = 1e-6;


    class Surface
    {
    public:
      Surface(const MshMesh &mesh, const std::vector<MshEdge> &edges, const unsigned int dim)
        : mesh(mesh)
        , dim(dim)
      {
        for (const auto &[a, b] : edges)
          {
            width += (point(b) - point(a)).norm() / edges.size();
            nodes.push_back(a);
            nodes.push_back(b);
          }
        std::sort(nodes.begin(), nodes.end());
        nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
        for (const unsigned int node : nodes)
          bins[bin_of(point(node))].push_back(node);
      }

      /** Add the nodes on an edge that are none of its ends. */
      void find_on(const MshEdge &edge, std::vector<unsigned int> &found) const
      {
        const Tensor<1, 3> a = point(edge.first), along = point(edge.second) - a;
        const double       slack = near * along.norm();
        const auto         look  = [&](const unsigned int node) {
          const Tensor<1, 3> way = point(node) - a;
          const double       s = std::min(1., std::max(0., (way * along) / along.norm_square()));
          if (node != edge.first && node != edge.second && (way - s * along).norm() < slack)
            found.push_back(node);
        };
        Tensor<1, 3> low, high;
        for (unsigned int d = 0; d < 3; ++d)
          {
            low[d]  = a[d] + std::min(0., along[d]) - slack;
            high[d] = a[d] + std::max(0., along[d]) + slack;
          }
        const Bin first = bin_of(low), last = bin_of(high);
        double    n_bins = 1.;
        for (unsigned int d = 0; d < 3; ++d)
          n_bins *= static_cast<double>(last[d] - first[d] + 1);
        if (n_bins > static_cast<double>(nodes.size()))
          {
            std::for_each(nodes.begin(), nodes.end(), look);
            return;
          }
        Bin bin = first;
        for (bin[2] = first[2]; bin[2] <= last[2]; ++bin[2])
          for (bin[1] = first[1]; bin[1] <= last[1]; ++bin[1])
            for (bin[0] = first[0]; bin[0] <= last[0]; ++bin[0])
              if (const auto here = bins.find(bin); here != bins.end())
                std::for_each(here->second.begin(), here->second.end(), look);
      }

    private:
      Tensor<1, 3> point(const unsigned int node) const
      {
        Tensor<1, 3> p;
        for (unsigned int d = 0; d < dim; ++d)
          p[d] = mesh.points[node][d];
        return p;
      }

      Bin bin_of(const Tensor<1, 3> &p) const
      {
        Bin bin;
        for (unsigned int d = 0; d < 3; ++d)
          bin[d] =
            static_cast<std::int64_t>(std::min(1e15, std::max(-1e15, std::floor(p[d] / width))));
        return bin;
      }

      const MshMesh            &mesh;
      const unsigned int        dim;
      double                    width = 0.;
      std::vector<unsigned int> nodes;

      std::unordered_map<Bin, std::vector<unsigned int>, HashOfBin> bins;
    };
  } // namespace


  std::vector<unsigned int> touching_nodes(const MshMesh        &mesh,
                                           std::vector<MshEdge> &edges,
                                           const unsigned int    dim)
  {
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    std::vector<unsigned int> found;
    if (edges.empty())
      return found;
    const Surface surface(mesh, edges, dim);
    for (const MshEdge &edge : edges)
      surface.find_on(edge, found);
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }
} // namespace PeriDeal
