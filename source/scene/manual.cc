// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/utilities.h>

#include <perideal/scene/lists.h>
#include <perideal/scene/scene.h>

#include <boost/algorithm/string/predicate.hpp>

#include <sstream>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    std::string markdown(const std::vector<SceneSection *> &sections)
    {
      std::ostringstream out;
      out
        << "# Entries of a scene file\n\n"
        << "Defaults are those of two dimensions; lists with one number per direction have as many "
           "as `Dimension` says. Formulas follow muparser's syntax. In lists `;` separates sides "
           "and "
           "points, the first `:` separates a name from its value, and `,` separates components.\n";
      for (const SceneSection *const section : sections)
        {
          out << "\n## " << (section->name().empty() ? "Outside all sections" : section->name())
              << "\n\n| Entry | Type | Default | Unit | Meaning |\n|---|---|---|---|---|\n";
          for (const Entry &entry : section->entries())
            out << "| " << entry.name << " | "
                << Utilities::replace_in_string(type_text(entry), "|", "\\|") << " | "
                << (entry.default_text.empty() ?
                      "" :
                      "`" + Utilities::replace_in_string(entry.default_text, "|", "\\|") + "`")
                << " | " << entry.unit << " | "
                << Utilities::replace_in_string(entry.documentation, "|", "\\|") << " |\n";
        }
      return out.str();
    }


    std::string section_title(const SceneSection &section)
    {
      return section.name().empty() ? "outside all sections" : "section '" + section.name() + "'";
    }


    /** An entry as somebody reads it on a terminal. */
    std::string plain_text(const SceneSection &section, const Entry &entry)
    {
      constexpr std::size_t width = 78;
      std::ostringstream    out;
      out << entry.name << "  (" << section_title(section) << ")\n"
          << "  type:     " << type_text(entry) << "\n"
          << "  default:  " << (entry.default_text.empty() ? "(empty)" : entry.default_text)
          << "\n";
      if (!entry.unit.empty())
        out << "  unit:     " << entry.unit << "\n";
      std::istringstream words(entry.documentation);
      std::string        line, word;
      while (words >> word)
        {
          if (line.size() + word.size() + 3 > width && !line.empty())
            {
              out << "  " << line << "\n";
              line.clear();
            }
          line += (line.empty() ? "" : " ") + word;
        }
      out << "  " << line << "\n";
      return out.str();
    }


    /**
     * What is known of an entry, of `Section/Entry`, or of all entries of a section; empty if there
     * is no such name.
     */
    std::string explanation(const std::vector<SceneSection *> &sections, const std::string &name)
    {
      std::string text;
      for (const SceneSection *const section : sections)
        for (const Entry &entry : section->entries())
          if (boost::iequals(entry.name, name) || boost::iequals(section->name(), name) ||
              boost::iequals(section->name() + "/" + entry.name, name))
            text += (text.empty() ? "" : "\n") + plain_text(*section, entry);
      return text;
    }


    [[noreturn]] void unknown_name(const std::vector<SceneSection *> &sections,
                                   const std::string                 &name,
                                   const std::vector<std::string>    &formats)
    {
      std::vector<std::string> names = formats, titles;
      for (const SceneSection *const section : sections)
        {
          names.push_back(section->name());
          if (!section->name().empty())
            titles.push_back(section->name());
          for (const Entry &entry : section->entries())
            names.push_back(entry.name);
        }
      throw UserError("'" + name + "' is no entry and no section of a scene file." +
                      did_you_mean(name, names) + " Sections: " + join_names(titles) +
                      ". The whole manual: " + join_names(formats) + ".");
    }


    /** Into a handler of its own: the global one keeps the scene that was parsed last. */
    void declare(const std::vector<SceneSection *> &sections, ParameterHandler &prm)
    {
      for (SceneSection *const section : sections)
        {
          const std::vector<std::string> path = split_list(section->name(), '/');
          for (const std::string &name : path)
            prm.enter_subsection(name);
          section->declare_parameters(prm);
          for (std::size_t k = 0; k < path.size(); ++k)
            prm.leave_subsection();
        }
    }
  } // namespace


  std::string scene_with_defaults()
  {
    std::ostringstream out;
    ParameterAcceptor::prm.print_parameters(out,
                                            ParameterHandler::ShortPRM |
                                              ParameterHandler::KeepDeclarationOrder);
    return out.str();
  }


  std::string parameter_manual(const std::string &format)
  {
    const std::vector<std::string> formats = {"prm", "markdown", "JSON", "XML"};
    Scene<2>                       scene;
    if (!has(formats, format))
      {
        const std::string text = explanation(scene.sections(), format);
        if (text.empty())
          unknown_name(scene.sections(), format, formats);
        return text;
      }
    ParameterHandler   prm;
    std::ostringstream out;
    if (format == "markdown")
      return markdown(scene.sections());
    declare(scene.sections(), prm);
    prm.print_parameters(out,
                         (format == "prm"  ? ParameterHandler::PRM :
                          format == "JSON" ? ParameterHandler::JSON :
                                             ParameterHandler::XML) |
                           ParameterHandler::KeepDeclarationOrder);
    return out.str();
  }
} // namespace PeriDeal
