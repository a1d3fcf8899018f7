// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/archive.h>
#include <perideal/base/text_file.h>

#include <nlohmann/json.hpp>

#include <string>

namespace PeriDeal
{
  /** Exchange what rank 0 alone knows; all processes have it when it is loaded. Collective. */
  inline void exchange_of_first(Archive                &archive,
                                const std::string      &name,
                                nlohmann::ordered_json &value,
                                const MPI_Comm          communicator)
  {
    using Json       = nlohmann::ordered_json;
    std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
    if (!archive.loads())
      share_text(text, communicator);
    archive.exchange(name, text);
    if (archive.loads())
      value = Json::parse(text);
  }
} // namespace PeriDeal
