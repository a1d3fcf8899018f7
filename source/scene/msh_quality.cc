// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/tensor.h>

#include <perideal/scene/msh_file.h>

#include <algorithm>
#include <cmath>

#include "msh_shapes.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    using Place = MshQuality::Place;

    Tensor<1, 3> between(const Place &a, const Place &b, const unsigned int dim)
    {
      Tensor<1, 3> e;
      for (unsigned int d = 0; d < dim; ++d)
        e[d] = b[d] - a[d];
      return e;
    }


    /** Volume of what three edges span; those beyond the dimension are unit vectors. */
    double determinant_of(Tensor<1, 3> (&edges)[3], const unsigned int dim)
    {
      for (unsigned int k = dim; k < 3; ++k)
        edges[k][k] = 1.;
      return edges[0] * cross_product_3d(edges[1], edges[2]);
    }


    struct Volume
    {
      double sum, least; // what the edges at one of the points span, as at corners
    };

    /** By Gauss' points, two in each direction: exact. */
    Volume volume_of(const MshMesh &mesh, const MshElement &cell, const unsigned int dim)
    {
      const auto at = [&](const unsigned int corner) { return mesh.points[cell.nodes[corner]]; };
      if (dim == 1)
        return {between(at(0), at(1), 1)[0], 1.};
      constexpr unsigned int ends[3][4][2] = {{{0, 1}, {3, 2}, {4, 5}, {7, 6}}, // by direction
                                              {{0, 3}, {1, 2}, {4, 7}, {5, 6}},
                                              {{0, 4}, {1, 5}, {3, 7}, {2, 6}}};
      Tensor<1, 3>           along[3][4];
      for (unsigned int d = 0; d < dim; ++d)
        for (unsigned int k = 0; k < 1u << (dim - 1); ++k)
          along[d][k] = between(at(ends[d][k][0]), at(ends[d][k][1]), dim);
      const double s[2] = {0.5 - std::sqrt(1. / 12.), 0.5 + std::sqrt(1. / 12.)};
      Volume       volume{0., 1.};
      for (unsigned int q = 0; q < 1u << dim; ++q)
        {
          const double x[3] = {s[q & 1], s[q >> 1 & 1], s[q >> 2]};
          Tensor<1, 3> edges[3];
          for (unsigned int d = 0; d < dim; ++d)
            {
              const double u = x[d == 0 ? 1 : 0], v = dim == 2 ? 0. : x[d == 2 ? 1 : 2];
              edges[d] = (1. - u) * (1. - v) * along[d][0] + u * (1. - v) * along[d][1];
              if (dim == 3)
                edges[d] += (1. - u) * v * along[d][2] + u * v * along[d][3];
            }
          double product = 1.;
          for (unsigned int d = 0; d < dim; ++d)
            product *= edges[d].norm();
          const double spanned = determinant_of(edges, dim);
          volume.sum += spanned / (1u << dim);
          volume.least = std::min(volume.least, product > 0. ? spanned / product : 0.);
        }
      return volume;
    }


    class Measured
    {
    public:
      Measured(const MshMesh &mesh, const unsigned int dim)
        : mesh(mesh)
        , dim(dim)
      {
        // The median of some millions of lengths is known from every other.
        constexpr std::size_t enough = 4000000;
        stride                       = 1 + mesh.cells.size() * (dim << (dim - 1)) / enough;
      }

      MshQuality get()
      {
        quality.lower.fill(1e300);
        quality.upper.fill(-1e300);
        quality.smallest = 1e300;
        for (std::size_t c = 0; c < mesh.cells.size(); ++c)
          add(mesh.cells[c], c);
        const auto half = lengths.begin() + lengths.size() / 2;
        std::nth_element(lengths.begin(), half, lengths.end());
        quality.median = *half;
        return quality;
      }

    private:
      void add(const MshElement &cell, const std::size_t index)
      {
        const Volume volume = volume_of(mesh, cell, dim);
        quality.volume += volume.sum;
        if (volume.least <= 0.)
          add_spanned(volume.least, mesh.points[cell.nodes[0]], index);
        const MshShape &shape = shape_of_cell(dim, cell.n);
        for (unsigned int corner = 0; corner < cell.n; ++corner)
          {
            const Place &p = mesh.points[cell.nodes[corner]];
            Tensor<1, 3> edges[3];
            double       product = 1.;
            for (unsigned int d = 0; d < 3; ++d)
              {
                quality.lower[d] = std::min(quality.lower[d], p[d]);
                quality.upper[d] = std::max(quality.upper[d], p[d]);
              }
            for (unsigned int k = 0; k < dim; ++k)
              {
                const unsigned int end = shape.neighbors[corner][k];
                edges[k]               = between(p, mesh.points[cell.nodes[end]], dim);
                const double length    = edges[k].norm();
                product *= length;
                if (corner < end)
                  add_length(length, p, mesh.points[cell.nodes[end]]);
              }
            if (dim > 1)
              add_spanned(determinant_of(edges, dim) / product, p, index);
          }
      }

      void add_spanned(const double spanned, const Place &place, const std::size_t index)
      {
        if (spanned >= quality.worst)
          return;
        quality.worst      = spanned;
        quality.worst_at   = place;
        quality.worst_cell = index;
      }

      void add_length(const double length, const Place &a, const Place &b)
      {
        if (n++ % stride == 0)
          lengths.push_back(static_cast<float>(length));
        quality.largest = std::max(quality.largest, length);
        if (length >= quality.smallest)
          return;
        quality.smallest = length;
        for (unsigned int d = 0; d < 3; ++d)
          quality.smallest_at[d] = 0.5 * (a[d] + b[d]);
      }

      const MshMesh     &mesh;
      const unsigned int dim;
      std::size_t        stride, n = 0;
      std::vector<float> lengths;
      MshQuality         quality;
    };
  } // namespace


  MshQuality quality_of_msh(const MshMesh &mesh, const unsigned int dim)
  {
    return Measured(mesh, dim).get();
  }
} // namespace PeriDeal
