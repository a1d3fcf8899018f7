// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "serve_command.h"

#include <deal.II/base/mpi.h>

#include <fcntl.h>
#include <malloc.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <thread>

namespace PeriDeal
{
  namespace
  {
    using Json = nlohmann::json;

    const MPI_Comm communicator = MPI_COMM_WORLD;

    bool is_first()
    {
      return dealii::Utilities::MPI::this_mpi_process(communicator) == 0;
    }


    /** While it lives, what is written to standard output or error goes elsewhere. */
    class Redirection
    {
    public:
      /** @param file whose end it is; empty, or none that can be opened: standard error. */
      Redirection(const int descriptor, const std::string &file)
        : descriptor(descriptor)
        , before(dup(descriptor))
      {
        int target = file.empty() ? -1 : open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
        if (target < 0)
          target = dup(STDERR_FILENO);
        dup2(target, descriptor);
        close(target);
      }

      ~Redirection()
      {
        std::cout.flush();
        std::fflush(nullptr);
        dup2(before, descriptor);
        close(before);
      }

      Redirection(const Redirection &)            = delete;
      Redirection &operator=(const Redirection &) = delete;

    private:
      const int descriptor, before;
    };


    /**
     * Rank 0 has the message; the others look for it now and then, since those who wait in a
     * broadcast take the cores from who computes.
     */
    template <typename Value>
    void send_to_all(Value *const data, const int size, const MPI_Datatype type)
    {
      MPI_Request request;
      MPI_Ibcast(data, size, type, 0, communicator, &request);
      for (int done = 0; MPI_Test(&request, &done, MPI_STATUS_IGNORE), done == 0;)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }


    /** The next request on all processes; false after the last one. */
    bool read_request(std::string &line)
    {
      int size = -1;
      if (is_first() && std::getline(std::cin, line))
        size = static_cast<int>(line.size());
      send_to_all(&size, 1, MPI_INT);
      line.resize(std::max(size, 0));
      if (size > 0)
        send_to_all(&line[0], size, MPI_CHAR);
      return size >= 0;
    }


    struct Request
    {
      std::vector<std::string> arguments;
      std::string              directory, output, errors;
    };


    /** Throws std::exception where the line is no request. */
    Request parse_request(const std::string &line)
    {
      const Json json = Json::parse(line);
      Request    request;
      request.arguments = json.at("arguments").get<std::vector<std::string>>();
      request.directory = json.value("directory", "");
      request.output    = json.value("output", "");
      request.errors    = json.value("errors", "");
      return request;
    }


    /**
     * Whether the first process, which may be alone on its machine with the files, can write to
     * them. Collective.
     */
    bool can_write(const Request &request)
    {
      int can = 1;
      for (const std::string &file : {request.output, request.errors})
        if (is_first() && !file.empty())
          {
            const int target = open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
            can              = can != 0 && target >= 0 ? 1 : 0;
            if (target >= 0)
              close(target);
          }
      MPI_Bcast(&can, 1, MPI_INT, 0, communicator);
      return can != 0;
    }


    /** As a program of its own in that directory. */
    Ending execute(const Request                                                 &request,
                   const std::function<Ending(const std::vector<std::string> &)> &perform)
    {
      if (!can_write(request))
        throw std::runtime_error("'" + request.output + "' or '" + request.errors +
                                 "' cannot be written to");
      const Redirection           output(STDOUT_FILENO, request.output);
      const Redirection           errors(STDERR_FILENO, request.errors);
      const std::filesystem::path before = std::filesystem::current_path();
      if (!request.directory.empty())
        std::filesystem::current_path(request.directory);
      const Ending    ending = perform(request.arguments);
      std::error_code gone; // the directory may have been removed meanwhile
      std::filesystem::current_path(before, gone);
      return ending;
    }
  } // namespace


  ExitStatus serve(const std::function<Ending(const std::vector<std::string> &)> &perform)
  {
    for (std::string line; read_request(line);)
      {
        Ending ending;
        try
          {
            ending = execute(parse_request(line), perform);
          }
        catch (const std::exception &error)
          {
            ending = {ExitStatus::error, std::string("serve: this is no request: ") + error.what()};
          }
        malloc_trim(0);
        MPI_Barrier(communicator); // all have written what they had to say
        if (is_first())
          std::cout << Json(
                         {{"status", static_cast<int>(ending.status)}, {"message", ending.message}})
                         .dump(-1, ' ', false, Json::error_handler_t::replace)
                    << std::endl;
        if (ending.status == ExitStatus::stopped)
          return ending.status;
      }
    return ExitStatus::complete;
  }
} // namespace PeriDeal
