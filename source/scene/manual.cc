// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/parameter_handler.h>

#include <perideal/scene/lists.h>
#include <perideal/scene/scene.h>

#include <sstream>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** A text that does not break a row of a Markdown table. */
    std::string cell(const std::string &text)
    {
      std::string result;
      for (const char c : text)
        result += c == '|' ? std::string("\\|") : std::string(1, c);
      return result;
    }


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
            out << "| " << entry.name << " | " << cell(type_text(entry)) << " | "
                << (entry.default_text.empty() ? "" : "`" + cell(entry.default_text) + "`") << " | "
                << entry.unit << " | " << cell(entry.documentation) << " |\n";
        }
      return out.str();
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
    unsigned int                   index   = 0;
    while (index < formats.size() && formats[index] != format)
      ++index;
    AssertThrow(index < formats.size(),
                UserError("Unknown format '" + format + "' of the parameter manual; known: " +
                          join_names(formats) + "." + did_you_mean(format, formats)));

    Scene<2>           scene;
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
