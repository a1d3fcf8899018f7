// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/process_end.h>
#include <perideal/output/summary_file.h>

namespace PeriDeal
{
  namespace
  {
    using Json = nlohmann::ordered_json;

    const char *const file_name = "summary.json";

    /** With the status as the first entry, where one looks for it. */
    std::string text_of(const Json        &summary,
                        const std::string &status,
                        const std::string &message = "")
    {
      Json all = {{"status", status}};
      if (!message.empty())
        all["message"] = message;
      all.update(summary);
      return all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
    }
  } // namespace


  SummaryFile::SummaryFile(ResultFolder &folder, const Json &start)
    : folder(folder)
  {
    update(start, "there are none yet");
  }


  SummaryFile::~SummaryFile()
  {
    clear_farewell();
  }


  void SummaryFile::update(const Json &summary, const std::string &reached)
  {
    if (!folder.writes())
      return;
    known = summary;
    folder.write(file_name, text_of(known, "running"));
    set_farewell(folder.directory() + "/" + file_name,
                 text_of(known, "stopped", "stopped by a signal"),
                 "Results in '" + folder.directory() + "': " + reached + ".");
  }


  void SummaryFile::complete(const Json &summary)
  {
    clear_farewell();
    folder.write(file_name, text_of(summary, "complete"));
  }


  void SummaryFile::end(const std::string &status, const std::string &message)
  {
    if (!folder.writes())
      return;
    clear_farewell();
    folder.write(file_name, text_of(known, status, message));
  }
} // namespace PeriDeal
