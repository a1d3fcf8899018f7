// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/exceptions.h>

#include <mpi.h>

#include <string>

namespace PeriDeal
{
  /**
   * A mistake in what the user gave us: a scene, an option, a file. Thrown with AssertThrow.
   *
   * The program prints message() alone, without file, line or stack, and ends with exit status 1.
   * So the message must name the entry and its section, what was found, what is allowed, and what
   * to do.
   */
  class UserError : public dealii::ExceptionBase
  {
  public:
    explicit UserError(const std::string &message);

    /** The sentence for the user. */
    const std::string &message() const
    {
      return text;
    }

    void print_info(std::ostream &out) const override;

  private:
    std::string text;
  };

  /**
   * Make an error that only some processes have seen everybody's error. Each process passes its own
   * message, empty if it has none; if any is not empty, every process throws the UserError of the
   * lowest such rank. Collective.
   */
  void throw_on_all_if_any(const MPI_Comm communicator, const std::string &message);

  /**
   * Whether every process calls this within five seconds. For error handling: a process that failed
   * alone must not wait for the others in a collective operation, which they would never reach.
   */
  bool all_processes_arrive(const MPI_Comm communicator);

  /**
   * The name in @p known nearest to @p name in edit distance (upper and lower case are the same),
   * or an empty string if none is near enough to be what the user meant.
   */
  template <typename Container>
  std::string nearest_name(const std::string &name, const Container &known);

  /**
   * Number of insertions, deletions, replacements and swaps of neighbours that turn one name into
   * the other, ignoring case.
   */
  unsigned int edit_distance(const std::string &a, const std::string &b);

  /** `a`, `b` or `c`: a list of names as it reads in a sentence. */
  template <typename Container>
  std::string join_names(const Container &names, const std::string &separator = ", ");


  template <typename Container>
  std::string nearest_name(const std::string &name, const Container &known)
  {
    std::string  best;
    unsigned int best_distance = static_cast<unsigned int>(name.size() / 2 + 1);
    for (const std::string &candidate : known)
      {
        const unsigned int distance = edit_distance(name, candidate);
        if (distance < best_distance)
          {
            best_distance = distance;
            best          = candidate;
          }
      }
    return best;
  }


  template <typename Container>
  std::string join_names(const Container &names, const std::string &separator)
  {
    std::string text;
    for (const std::string &name : names)
      text += (text.empty() ? "" : separator) + name;
    return text;
  }
} // namespace PeriDeal
