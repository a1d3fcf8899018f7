// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/text_file.h>
#include <perideal/base/user_error.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/physical_names.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /**
     * The lines of the section of physical names, which stands before those of nodes and elements.
     */
    std::string names_section(std::ifstream &file)
    {
      std::string text, line;
      bool        inside = false;
      while (std::getline(file, line))
        {
          const std::string word = trimmed(line);
          if (word == "$EndPhysicalNames" || word == "$Nodes" || word == "$Elements")
            break;
          if (inside)
            text += word + "\n";
          inside = inside || word == "$PhysicalNames";
        }
      return text;
    }
  } // namespace


  std::vector<std::pair<std::string, int>> named_sides(const std::string &lines,
                                                       const unsigned int dim)
  {
    std::vector<std::pair<std::string, int>> names;
    std::istringstream                       text(lines);
    for (std::string line; std::getline(text, line);)
      {
        std::istringstream words(line);
        unsigned int       of_dim = 0;
        int                id     = -1;
        const std::size_t  begin = line.find('"'), end = line.rfind('"');
        if (words >> of_dim >> id && of_dim + 1 == dim && id >= 0 && begin < end)
          names.emplace_back(trimmed(line.substr(begin + 1, end - begin - 1)), id);
      }
    return names;
  }


  std::map<std::string, types::boundary_id> read_physical_names(const std::string &file_name,
                                                                const std::string &folder,
                                                                const unsigned int dim,
                                                                const MPI_Comm     communicator)
  {
    std::string text, message;
    if (Utilities::MPI::this_mpi_process(communicator) == 0)
      {
        bool found = false;
        for (const std::filesystem::path &path :
             {std::filesystem::path(file_name), std::filesystem::path(folder) / file_name})
          if (std::error_code fault; !found && std::filesystem::is_regular_file(path, fault))
            {
              std::ifstream file(path);
              text  = names_section(file);
              found = true;
            }
        if (!found)
          {
            read_file(file_name, most_bytes_of_data, message);
            message = "'Mesh file' in section 'Domain': '" + file_name + "' " + message +
                      places_looked_at(file_name, folder);
          }
      }
    throw_on_all_if_any(communicator, message);
    share_text(text, communicator);

    std::map<std::string, types::boundary_id> names;
    for (const auto &[name, id] : named_sides(text, dim))
      names.emplace(name, id); // the first of a name
    return names;
  }
} // namespace PeriDeal
