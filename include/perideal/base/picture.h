// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <mpi.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * Red, green, blue and opacity of a pixel, each from 0 to 255. Pictures without opacity have 255.
   */
  using Pixel = std::array<std::uint8_t, 4>;


  /** A picture of square pixels, row by row from the top, each row from the left. */
  struct Picture
  {
    unsigned int       n_columns = 0, n_rows = 0;
    std::vector<Pixel> pixels;

    const Pixel &at(const unsigned int column, const unsigned int row) const
    {
      return pixels[static_cast<std::size_t>(row) * n_columns + column];
    }
  };


  /** The most pixels that a picture may have. */
  constexpr std::size_t most_pixels = 100000000;

  /**
   * A picture from the bytes of a PNG file (grey, palette or colour, with or without opacity, 1 to
   * 16 bits), or of a PGM or PPM file as text or binary (P2, P3, P5, P6). More than 8 bits are
   * rounded to 8, fewer are spread over 0 to 255; no gamma or colour profile is applied.
   *
   * @param name of the file, for messages. Throws UserError: no such picture, cut short, broken,
   *             more than most_pixels.
   */
  Picture decode_picture(const std::string &bytes, const std::string &name);

  /** Read a file on rank 0 and give it to all. Throws UserError on all processes. Collective. */
  Picture read_picture(const std::string &file_name, const MPI_Comm communicator);

  /** The bytes of a PNG file in colours with opacity. */
  std::string encode_png(const Picture &picture);
} // namespace PeriDeal
