// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <string>
#include <vector>

namespace PeriDeal
{
  /** What VTU files of ours call the tensor of the components `stress_xx`, ... */
  std::string name_of_tensor(const std::vector<std::string> &names);

  /**
   * For each of the nine components of the tensor, row by row, the position of its field among the
   * names; -1 where there is none, which stands for 0.
   */
  std::vector<int> components_of_tensor(const std::vector<std::string> &names);

  /** A `DataArray` of a VTU file with nine numbers a point, compressed as deal.II's are. */
  std::string tensor_array(const std::string &name, const std::vector<float> &values);
} // namespace PeriDeal
