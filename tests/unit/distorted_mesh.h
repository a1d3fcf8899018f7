// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

namespace PeriDeal
{
  namespace OperatorTests
  {
    /**
     * A Gmsh file of n^dim quadrilaterals or hexahedra on the unit square or cube, whose inner
     * vertices are moved by up to a part of the spacing. Each process writes its own, all the same.
     * @param power above 1 the cells are the smaller the nearer they are to the middle
     */
    template <int dim>
    std::string distorted_mesh(const unsigned int n, const double part, const double power = 1.)
    {
      const std::string name =
        (std::filesystem::temp_directory_path() /
         ("perideal_" + std::to_string(getpid()) + "_" + std::to_string(dim) + ".msh"))
          .string();
      std::ofstream file(name);
      file.precision(17);
      unsigned int n_nodes = 1, n_cells = 1;
      for (unsigned int d = 0; d < dim; ++d)
        {
          n_nodes *= n + 1;
          n_cells *= n;
        }
      std::mt19937                           random(7);
      std::uniform_real_distribution<double> shift(-part / n, part / n);
      file << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" << n_nodes << '\n';
      for (unsigned int k = 0; k < n_nodes; ++k)
        {
          std::array<unsigned int, 3> at{k % (n + 1), k / (n + 1) % (n + 1), k / (n + 1) / (n + 1)};
          bool                        inside = true;
          for (unsigned int d = 0; d < dim; ++d)
            inside = inside && at[d] > 0 && at[d] < n;
          file << k + 1;
          for (unsigned int d = 0; d < 3; ++d)
            {
              const double moved = shift(random);
              const double t     = 2. * (at[d] / double(n) + (inside ? moved : 0.)) - 1.;
              const double x     = 0.5 + 0.5 * std::copysign(std::pow(std::abs(t), power), t);
              file << ' ' << (d < dim ? x : 0.);
            }
          file << '\n';
        }
      file << "$EndNodes\n$Elements\n" << n_cells << '\n';
      const auto node = [&](const unsigned int i, const unsigned int j, const unsigned int k) {
        return 1 + i + (n + 1) * (j + (dim == 3 ? (n + 1) * k : 0));
      };
      for (unsigned int c = 0; c < n_cells; ++c)
        {
          const unsigned int i = c % n, j = c / n % n, k = c / n / n;
          file << c + 1 << (dim == 3 ? " 5 2 1 1" : " 3 2 1 1");
          for (unsigned int level = 0; level < (dim == 3 ? 2u : 1u); ++level)
            file << ' ' << node(i, j, k + level) << ' ' << node(i + 1, j, k + level) << ' '
                 << node(i + 1, j + 1, k + level) << ' ' << node(i, j + 1, k + level);
          file << '\n';
        }
      file << "$EndElements\n";
      return name;
    }
  } // namespace OperatorTests
} // namespace PeriDeal
