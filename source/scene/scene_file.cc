// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/parameter_handler.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/text_file.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/scene.h>
#include <perideal/scene/scene_lines.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <sstream>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** The entries of each section, by its path. */
    using DeclaredNames = std::map<std::string, std::vector<std::string>>;


    /** All that is declared at present: the scene alive, and the sections that the calling program
     * has added to ParameterAcceptor. */
    DeclaredNames declared_names()
    {
      ParameterAcceptor::declare_all_parameters();
      std::ostringstream out;
      ParameterAcceptor::prm.print_parameters(out, ParameterHandler::ShortPRM);
      const SceneLines lines = scan_lines(out.str(), "declared entries");
      DeclaredNames    names;
      for (const auto &section : lines.sections)
        names[section.first];
      for (const SceneLine &line : lines.entries)
        names[line.section].push_back(line.entry);
      return names;
    }


    void check_section(const std::string   &section,
                       const std::string   &at,
                       const DeclaredNames &declared)
    {
      if (declared.count(section) > 0)
        return;
      std::vector<std::string> known;
      for (const auto &entry : declared)
        if (!entry.first.empty())
          known.push_back(entry.first);
      const std::string message = at + ": unknown section '" + section +
                                  "'; known: " + join_names(known) + "." +
                                  did_you_mean(section, known);
      AssertThrow(false, UserError(message));
    }


    void check_name(const SceneLine &line, const std::string &at, const DeclaredNames &declared)
    {
      check_section(line.section, at, declared);
      const std::vector<std::string> &known = declared.at(line.section);
      if (has(known, line.entry))
        return;
      std::string message =
        at + ": unknown entry '" + line.entry + "' " + in_section(line.section) + ".";
      std::string elsewhere;
      for (const auto &section : declared)
        if (has(section.second, line.entry))
          elsewhere += (elsewhere.empty() ? "" : ", ") + in_section(section.first);
      if (!elsewhere.empty())
        message += " There is one " + elsewhere + ".";
      else
        message += did_you_mean(line.entry, known);
      AssertThrow(false, UserError(message));
    }


    /** Unknown names, entries given twice, and plain values (numbers, choices) of the wrong type.
     */
    void check_lines(const SceneText                   &text,
                     const std::vector<SceneSection *> &sections,
                     const DeclaredNames               &declared)
    {
      const SceneLines lines = scan_lines(text.text, text.file_name);
      for (const auto &section : lines.sections)
        if (std::none_of(lines.entries.begin(), lines.entries.end(), [&](const SceneLine &line) {
              return line.section == section.first;
            }))
          check_section(section.first,
                        text.file_name + ":" + std::to_string(section.second),
                        declared);

      std::map<std::pair<std::string, std::string>, const SceneLine *> seen;
      for (const SceneLine &line : lines.entries)
        {
          const std::string at = location(text.file_name, line);
          check_name(line, at, declared);
          const auto inserted = seen.insert({{line.section, line.entry}, &line});
          AssertThrow(inserted.second,
                      UserError(at + ": the entry '" + line.entry + "' " +
                                in_section(line.section) + " is given twice, first in line " +
                                std::to_string(inserted.first->second->line) + ", again in line " +
                                std::to_string(line.line) + "."));
          for (const SceneSection *const section : sections)
            if (section->name() == line.section)
              for (const Entry &entry : section->entries())
                if (entry.name == line.entry)
                  check_plain_value(entry, line.value, section->where(entry.name));
        }
    }


    /**
     * The path as it is, or beside the scene file if there is nothing at that path but something
     * there.
     */
    std::string found_near(const std::string &path, const std::string &scene_file)
    {
      namespace fs          = std::filesystem;
      const fs::path beside = fs::path(scene_file).parent_path() / path;
      return !path.empty() && !fs::exists(path) && fs::exists(beside) ? beside.string() : path;
    }


    template <int dim>
    void check_text(const SceneText &text)
    {
      Scene<dim> scene;
      with_location(text, [&] { check_lines(text, scene.sections(), declared_names()); });
    }


    /** The text of a file, read on rank 0. Collective. */
    std::string read_on_root(const std::string &file_name, const MPI_Comm communicator)
    {
      int rank = 0;
      MPI_Comm_rank(communicator, &rank);
      std::string text, message;
      if (rank == 0)
        {
          // "\r\n" and "\r" alone are line ends, too
          text = std::regex_replace(read_file(file_name, most_bytes_of_text, message),
                                    std::regex("\r\n?"),
                                    "\n");
          if (!message.empty())
            message = "The scene file '" + file_name + "' " + message +
                      ". Check its path, which is relative to the working directory.";
          else if (trimmed(text).empty())
            message = "The scene file '" + file_name + "' is empty.";
          else if (text.find('\0') != std::string::npos)
            message = "The scene file '" + file_name + "' is no text file.";
        }
      throw_on_all_if_any(communicator, message);

      share_text(text, communicator);
      // the mark that some editors put at the beginning of a UTF-8 file
      if (text.compare(0, 3, "\xEF\xBB\xBF") == 0)
        text.erase(0, 3);
      return text;
    }
  } // namespace


  void with_location(const SceneText &text, const std::function<void()> &action)
  {
    std::string message;
    try
      {
        action();
        return;
      }
    catch (const UserError &error)
      {
        message = error.message();
      }
    // messages of the scan begin with their location already
    if (message.compare(0, 6, "Entry ") == 0)
      {
        std::string at    = text.file_name;
        std::size_t first = std::string::npos;
        for (const SceneLine &line : scan_lines(text.text, text.file_name).entries)
          {
            const std::size_t position =
              message.find("'" + line.entry + "' " + in_section(line.section));
            if (position < first)
              {
                first = position;
                at    = location(text.file_name, line);
              }
          }
        message = at + ": " + message;
      }
    AssertThrow(false, UserError(message));
  }


  SceneText read_scene(const std::string              &file_name,
                       const std::vector<std::string> &overrides,
                       const MPI_Comm                  communicator)
  {
    SceneText scene_text;
    scene_text.file_name    = file_name;
    scene_text.communicator = communicator;
    const std::string text  = read_on_root(file_name, communicator);
    scene_text.text         = apply_overrides(text, file_name, overrides);
    switch (dimension_of(scene_text))
      {
        case 1:
          check_text<1>(scene_text);
          break;
        case 2:
          check_text<2>(scene_text);
          break;
        default:
          check_text<3>(scene_text);
      }
    AssertThrow(
      !scan_lines(text, file_name).entries.empty(),
      UserError(
        "The scene file '" + file_name +
        "' has no entry, only comments or sections: nothing in it says what to compute. Entries are lines "
        "'set entry = value'; `perideal parameters` lists them all."));
    return scene_text;
  }


  unsigned int dimension_of(const SceneText &text)
  {
    for (const SceneLine &line : scan_lines(text.text, text.file_name).entries)
      if (line.section.empty() && line.entry == "Dimension")
        {
          AssertThrow(line.value == "1" || line.value == "2" || line.value == "3",
                      UserError(location(text.file_name, line) +
                                ": Entry 'Dimension' outside all sections: found '" + line.value +
                                "', needs 1, 2 or 3."));
          return static_cast<unsigned int>(line.value[0] - '0');
        }
    return General().dimension;
  }


  template <int dim>
  void parse_scene(const SceneText &text, Scene<dim> &scene)
  {
    AssertThrow(dimension_of(text) == dim,
                ExcMessage("A scene of another dimension cannot be parsed into a Scene<dim>."));
    with_location(text, [&] {
      check_lines(text, scene.sections(), declared_names());
      try
        {
          ParameterAcceptor::prm.parse_input_from_string(text.text);
          ParameterAcceptor::parse_all_parameters();
        }
      catch (const UserError &)
        {
          throw;
        }
      catch (const ExceptionBase &error)
        {
          // an entry that the calling program has added to ParameterAcceptor
          std::ostringstream out;
          error.print_info(out);
          const std::string message = text.file_name + ": " + trimmed(out.str());
          AssertThrow(false, UserError(message));
        }
      scene.domain.files.folder = std::filesystem::path(text.file_name).parent_path().string();
      scene.domain.files.communicator = text.communicator;
      scene.parse_and_validate();
    });
    scene.domain.files.mesh = found_near(scene.domain.files.mesh, text.file_name);
  }


  template <int dim>
  std::shared_ptr<Scene<dim>> scene_variant(const Scene<dim>           &scene,
                                            const std::vector<Setting> &settings)
  {
    const auto                        variant = std::make_shared<Scene<dim>>();
    const std::vector<SceneSection *> to      = variant->sections(),
                                      from    = const_cast<Scene<dim> &>(scene).sections();
    for (std::size_t k = 0; k < from.size(); ++k)
      *to[k] = *from[k]; // the texts
    for (const auto &[name, text] : settings)
      {
        const std::size_t slash   = name.rfind('/');
        const std::string section = slash == std::string::npos ? "" : name.substr(0, slash);
        const auto of_name = std::find_if(to.begin(), to.end(), [&](const SceneSection *const one) {
          return one->name() == section;
        });
        Assert(of_name != to.end(), dealii::ExcMessage("There is no such section."));
        (*of_name)->set(name.substr(slash + 1), text);
      }
    variant->domain.files.folder       = scene.domain.files.folder;
    variant->domain.files.communicator = scene.domain.files.communicator;
    variant->parse_and_validate();
    return variant;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(parse_scene);
  PERIDEAL_INSTANTIATE_FUNCTION(scene_variant);
} // namespace PeriDeal
