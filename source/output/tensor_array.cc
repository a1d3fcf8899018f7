// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "tensor_array.h"

#include <deal.II/base/exceptions.h>
#include <deal.II/base/utilities.h>

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

namespace PeriDeal
{
  namespace
  {
    const std::string stem = "stress_"; // of the one tensor that models write
  }


  std::string name_of_tensor(const std::vector<std::string> &names)
  {
    return std::find(names.begin(), names.end(), stem + "xx") == names.end() ? "" : "stress";
  }


  std::vector<int> components_of_tensor(const std::vector<std::string> &names)
  {
    std::vector<int> places;
    for (unsigned int a = 0; a < 3; ++a)
      for (unsigned int b = 0; b < 3; ++b)
        {
          const std::string component = stem + "xyz"[std::min(a, b)] + "xyz"[std::max(a, b)];
          const auto        at        = std::find(names.begin(), names.end(), component);
          places.push_back(at == names.end() ? -1 : static_cast<int>(at - names.begin()));
        }
    return places;
  }


  std::string tensor_array(const std::string &name, const std::vector<float> &values)
  {
    // One block: number of blocks, size of a block, size of the last one, compressed size.
    const std::size_t size = values.size() * sizeof(float);
    AssertThrow(size < (std::size_t(1) << 32),
                dealii::ExcMessage("a process has too many cells for a block of a VTU file"));
    uLongf                     compressed = compressBound(size);
    std::vector<unsigned char> data(compressed);
    const int                  status = compress2(data.data(),
                                 &compressed,
                                 reinterpret_cast<const Bytef *>(values.data()),
                                 size,
                                 Z_BEST_SPEED);
    AssertThrow(status == Z_OK, dealii::ExcMessage("zlib could not compress a field"));
    data.resize(compressed);
    const std::array<std::uint32_t, 4> head{{1u,
                                             static_cast<std::uint32_t>(size),
                                             static_cast<std::uint32_t>(size),
                                             static_cast<std::uint32_t>(compressed)}};
    std::vector<unsigned char>         head_bytes(sizeof head);
    std::memcpy(head_bytes.data(), head.data(), sizeof head);
    return "    <DataArray type=\"Float32\" Name=\"" + name +
           "\" NumberOfComponents=\"9\" format=\"binary\">\n" +
           dealii::Utilities::encode_base64(head_bytes) + dealii::Utilities::encode_base64(data) +
           "\n    </DataArray>\n";
  }
} // namespace PeriDeal
