// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace PeriDeal
{
  /** A Gmsh file of the square [-1, 1]^2 without its lower right quarter, 2 n cells a side. */
  inline std::string angle_mesh(const unsigned int n)
  {
    const std::string name = (std::filesystem::temp_directory_path() /
                              ("perideal_" + std::to_string(getpid()) + "_angle.msh"))
                               .string();
    std::ofstream file(name);
    file.precision(17);
    const unsigned int m = 2 * n + 1;
    file << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" << m * m - n * n << '\n';
    std::vector<unsigned int> number(m * m, 0);
    unsigned int              last = 0;
    for (unsigned int j = 0; j < m; ++j)
      for (unsigned int i = 0; i < m; ++i)
        if (i <= n || j >= n)
          {
            number[j * m + i] = ++last;
            file << last << ' ' << double(i) / n - 1. << ' ' << double(j) / n - 1. << " 0\n";
          }
    file << "$EndNodes\n$Elements\n" << 3 * n * n << '\n';
    last = 0;
    for (unsigned int j = 0; j < 2 * n; ++j)
      for (unsigned int i = 0; i < 2 * n; ++i)
        if (i < n || j >= n)
          {
            const unsigned int v = j * m + i;
            file << ++last << " 3 2 1 1 " << number[v] << ' ' << number[v + 1] << ' '
                 << number[v + m + 1] << ' ' << number[v + m] << '\n';
          }
    file << "$EndElements\n";
    return name;
  }
} // namespace PeriDeal
