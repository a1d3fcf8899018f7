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
     * A Gmsh file of n^dim quadrilaterals or hexahedra with vertices at place(indices), with so
     * many digits behind the point, or all. Each process writes its own, all the same.
     */
    template <int dim, typename Place>
    std::string lattice_mesh(const std::string &what,
                             const unsigned int n,
                             const Place       &place,
                             const unsigned int n_digits = 0)
    {
      const std::string name = (std::filesystem::temp_directory_path() /
                                ("perideal_" + std::to_string(getpid()) + "_" + what + ".msh"))
                                 .string();
      std::ofstream file(name);
      file.precision(n_digits > 0 ? n_digits : 17);
      if (n_digits > 0)
        file << std::fixed;
      const auto n_of = [](const unsigned int m) { return m * m * (dim == 3 ? m : 1); };
      file << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" << n_of(n + 1) << '\n';
      for (unsigned int k = 0; k < n_of(n + 1); ++k)
        {
          const std::array<double, 3> p =
            place({k % (n + 1), k / (n + 1) % (n + 1), k / (n + 1) / (n + 1)});
          file << k + 1 << ' ' << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
        }
      file << "$EndNodes\n$Elements\n" << n_of(n) << '\n';
      for (unsigned int c = 0; c < n_of(n); ++c)
        {
          file << c + 1 << (dim == 3 ? " 5 2 1 1" : " 3 2 1 1");
          for (unsigned int level = 0; level < dim - 1u; ++level)
            {
              const unsigned int v =
                1 + c % n + (n + 1) * (c / n % n + (n + 1) * (c / n / n + level));
              for (const unsigned int corner : {v, v + 1, v + n + 2, v + n + 1})
                file << ' ' << corner;
            }
          file << '\n';
        }
      file << "$EndElements\n";
      return name;
    }


    /**
     * On the unit square or cube, inner vertices moved by up to a part of the spacing.
     * @param power above 1 the cells are the smaller the nearer they are to the middle
     */
    template <int dim>
    std::string distorted_mesh(const unsigned int n, const double part, const double power = 1.)
    {
      std::mt19937                           random(7);
      std::uniform_real_distribution<double> shift(-part / n, part / n);
      return lattice_mesh<dim>(std::to_string(dim), n, [&](const std::array<unsigned int, 3> &at) {
        std::array<double, 3> p{};
        bool                  inside = true;
        for (unsigned int d = 0; d < dim; ++d)
          inside = inside && at[d] > 0 && at[d] < n;
        for (unsigned int d = 0; d < 3; ++d)
          {
            const double moved = shift(random);
            const double t     = 2. * (at[d] / double(n) + (inside ? moved : 0.)) - 1.;
            if (d < dim)
              p[d] = 0.5 + 0.5 * std::copysign(std::pow(std::abs(t), power), t);
          }
        return p;
      });
    }
  } // namespace OperatorTests
} // namespace PeriDeal
