// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Computes scenes one after the other, as `perideal run` does, for scripts that need many of them:
// with its two hundred shared libraries a program takes longer to start than a small scene to
// compute. Only for tests; scene_test.py talks to it.
//
// A line of standard input is a request, {"scene": file, "overrides": ["Section/Entry=value", ...],
// "output": file, "errors": file}. What the run says goes to the two files; the answer on standard
// output is a line with its exit status.

#include <deal.II/base/mpi.h>

#include <perideal/base/process_end.h>
#include <perideal/base/user_error.h>
#include <perideal/output/field_writer.h>
#include <perideal/study/model_choice.h>

#include <fcntl.h>
#include <malloc.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <iostream>
#include <string>
#include <thread>

namespace
{
  using namespace PeriDeal;
  using Json = nlohmann::json;

  const MPI_Comm communicator = MPI_COMM_WORLD;

  bool is_first()
  {
    return dealii::Utilities::MPI::this_mpi_process(communicator) == 0;
  }


  /** While it lives, standard output or error is the end of a file. */
  class Redirection
  {
  public:
    Redirection(const int descriptor, const std::string &file)
      : descriptor(descriptor)
      , before(dup(descriptor))
    {
      const int target = open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
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


  /** The next request on all processes; empty after the last one. */
  std::string next_request()
  {
    std::string line;
    if (is_first())
      std::getline(std::cin, line);
    int size = static_cast<int>(line.size());
    send_to_all(&size, 1, MPI_INT);
    line.resize(size);
    send_to_all(&line[0], size, MPI_CHAR);
    return line;
  }


  template <int dim>
  void compute(const SceneText &text)
  {
    Scene<dim> scene;
    parse_scene(text, scene);
    run_scene(scene, text, communicator, RunMode::begin, false);
  }


  void compute(const Json &request)
  {
    const SceneText text = read_scene(request.at("scene").get<std::string>(),
                                      request.at("overrides").get<std::vector<std::string>>(),
                                      communicator);
    switch (dimension_of(text))
      {
        case 1:
          return compute<1>(text);
        case 2:
          return compute<2>(text);
        default:
          return compute<3>(text);
      }
  }


  /** As the program does: one message, and the end of all processes where one failed alone. */
  int report(const std::string &message, const ExitStatus status)
  {
    const int  number = static_cast<int>(status);
    const bool all    = all_processes_arrive(communicator);
    if (is_first() || !all)
      std::cerr << "\nperideal: " << message << std::endl;
    if (!all)
      MPI_Abort(communicator, number);
    return number;
  }


  /** Exit status. */
  int answer(const Json &request)
  {
    const Redirection output(STDOUT_FILENO, request.at("output").get<std::string>());
    const Redirection errors(STDERR_FILENO, request.at("errors").get<std::string>());
    try
      {
        compute(request);
        return 0;
      }
    catch (const UserError &error)
      {
        return report("error: " + error.message(), ExitStatus::error);
      }
    catch (const std::exception &error)
      {
        return report(std::string("internal error:\n") + error.what(), ExitStatus::fault);
      }
  }
} // namespace


int main(int, char **argv)
{
  prepare_mpi_environment();
  start_hdf5();
  int n_words = 1; // the others are not for the libraries: PETSc would complain of them
  dealii::Utilities::MPI::MPI_InitFinalize mpi(n_words, argv, 1);
  handle_signals(is_first(), dealii::Utilities::MPI::n_mpi_processes(communicator) == 1);
  while (true)
    {
      const std::string request = next_request();
      if (request.empty())
        return 0;
      const int status = answer(Json::parse(request));
      malloc_trim(0);
      MPI_Barrier(communicator); // all have written what they had to say
      if (is_first())
        std::cout << "exit status " << status << std::endl;
    }
}
