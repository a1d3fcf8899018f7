// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <mpi.h>

#include <cstddef>
#include <string>

namespace PeriDeal
{
  /** The largest files that are read, in bytes: of text that people write (scenes, studies), and of
   * meshes and pictures. */
  constexpr std::size_t most_bytes_of_text = 16000000, most_bytes_of_data = 1000000000;

  /**
   * The bytes of a file. Only what is a file on a disk is opened, since a pipe may wait, and a
   * device give, for ever.
   *
   * @param fault set to what goes behind the file's name in a message, "cannot be read", where the
   * file is missing, no file or larger than @p most_bytes; else empty Not collective.
   */
  std::string read_file(const std::string &file_name,
                        const std::size_t  most_bytes,
                        std::string       &fault);

  /**
   * Where a file of a scene was looked for, for a message that it is not there: `. Looked for it at
   * ...`. @param folder that of the scene file. Not collective.
   */
  std::string places_looked_at(const std::string &file_name, const std::string &folder);

  /** Give the text that rank 0 has to all. At most 2^31 - 1 bytes. Collective. */
  void share_text(std::string &text, const MPI_Comm communicator);
} // namespace PeriDeal
