// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/process_end.h>
#include <perideal/output/summary_file.h>

#include "exchange_of_first.h"

namespace PeriDeal
{
  namespace
  {
    using Json = nlohmann::ordered_json;

    const char *const file_name = "summary.json";

    /** With the status as the first entry, where one looks for it. */
    std::string text_of(const Json        &summary,
                        const std::string &status,
                        const std::string &message = "",
                        const Json        &more    = Json::object())
    {
      Json all = {{"status", status}};
      if (!message.empty())
        all["message"] = message;
      all.update(more);
      all.update(summary);
      return all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
    }
  } // namespace


  SummaryFile::SummaryFile(ResultFolder &folder, const Json &start, const bool goes_on)
    : folder(folder)
  {
    if (goes_on)
      return;
    update(start,
           folder.has_earlier_results() ? "there are none yet; those of the run before lie in '" +
                                            folder.directory() + "/.perideal/previous'" :
                                          "there are none yet");
  }


  SummaryFile::~SummaryFile()
  {
    clear_farewell();
  }


  void SummaryFile::update(const Json &summary, const std::string &until)
  {
    if (!folder.writes())
      return;
    known   = summary;
    reached = until;
    folder.write(file_name, text_of(known, "running"));
    prepare_farewell();
  }


  void SummaryFile::note_checkpoint(const std::string &file)
  {
    checkpoint = file;
    if (folder.writes())
      prepare_farewell();
  }


  void SummaryFile::prepare_farewell() const
  {
    set_farewell(folder.directory() + "/" + file_name,
                 text_of(known, "stopped", "the process was told to end, or failed"),
                 "Results in '" + folder.directory() + "': " + reached + "." +
                   (checkpoint.empty() ?
                      "" :
                      " Its last state is kept in " + checkpoint + ": go on with --resume."));
  }


  void SummaryFile::complete(const Json &summary)
  {
    folder.write(file_name, text_of(summary, "complete"));
    clear_farewell();
  }


  void SummaryFile::end(const std::string &status, const std::string &message, const Json &more)
  {
    if (!folder.writes())
      return;
    folder.write(file_name, text_of(known, status, message, more));
    clear_farewell();
  }


  void SummaryFile::exchange(Archive &archive)
  {
    Json state = Json::array({known, reached});
    exchange_of_first(archive, "known", state, folder.processes());
    if (archive.loads())
      update(state[0], state[1].get<std::string>());
  }
} // namespace PeriDeal
