// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// The unit tests as one program, on one or several processes: every process runs every test, in the
// same order. Process 0 reports; the others speak only of their own failures. A test has passed if
// it has on all.

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

#include <iostream>
#include <string>

namespace
{
  /**
   * Makes a failure on one process one of process 0 too, so that its report is complete. A failed
   * assertion is printed at once: if it leaves the other processes waiting, the reason stands in
   * the log before the time-out.
   */
  class AllProcesses : public testing::EmptyTestEventListener
  {
  public:
    AllProcesses()
      : rank(dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD))
    {
      MPI_Comm_dup(MPI_COMM_WORLD, &communicator);
    }

    ~AllProcesses() override
    {
      MPI_Comm_free(&communicator);
    }

    void OnTestPartResult(const testing::TestPartResult &result) override
    {
      if (rank > 0 && result.failed())
        std::cerr << "[rank " << rank << "] " << (result.file_name() ? result.file_name() : "")
                  << ':' << result.line_number() << ": " << result.message() << std::endl;
    }

    void OnTestEnd(const testing::TestInfo &test) override
    {
      const int failed   = test.result()->Failed() ? 1 : 0;
      int       n_failed = 0;
      MPI_Allreduce(&failed, &n_failed, 1, MPI_INT, MPI_SUM, communicator);
      if (n_failed > 0 && failed == 0)
        ADD_FAILURE() << "failed on " << n_failed << " other process(es)";
    }

  private:
    MPI_Comm  communicator;
    const int rank;
  };
} // namespace


int main(int argc, char *argv[])
{
  int n_words = 1; // the others are not for the libraries: PETSc would complain of them
  dealii::Utilities::MPI::MPI_InitFinalize mpi(n_words, argv, 1);
  testing::InitGoogleTest(&argc, argv);

  testing::TestEventListeners &listeners = testing::UnitTest::GetInstance()->listeners();
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) > 0)
    {
      delete listeners.Release(listeners.default_result_printer());
      delete listeners.Release(listeners.default_xml_generator());
    }
  auto *const all_processes = new AllProcesses;
  listeners.Append(all_processes);

  const int result = RUN_ALL_TESTS();

  // Before MPI_Finalize.
  delete listeners.Release(all_processes);
  return dealii::Utilities::MPI::max(result, MPI_COMM_WORLD);
}
