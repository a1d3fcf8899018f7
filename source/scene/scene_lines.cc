// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/scene/lists.h>
#include <perideal/scene/scene_lines.h>

#include <algorithm>
#include <sstream>

namespace PeriDeal
{
  namespace
  {
    // ends the lines that overrides have put into the text
    const std::string command_line_mark = "# from the command line";


    // deeper than any scene is, and than what ParameterHandler and the paths in messages stand
    constexpr std::size_t deepest_section = 16;


    [[noreturn]] void line_error(const std::string &file_name,
                                 const unsigned int line,
                                 const std::string &what)
    {
      AssertThrow(false, UserError(file_name + ":" + std::to_string(line) + ": " + what));
      std::abort(); // never reached: AssertThrow throws
    }


    std::vector<std::string> lines_of(const std::string &text)
    {
      std::vector<std::string> lines;
      std::istringstream       in(text);
      for (std::string line; std::getline(in, line);)
        lines.push_back(line);
      return lines;
    }


    std::string section_path(const std::vector<std::pair<std::string, unsigned int>> &open)
    {
      std::string path;
      for (const auto &section : open)
        path += (path.empty() ? "" : "/") + section.first;
      return path;
    }


    /** The statements, one by one, with the sections that are open. */
    class Scanner
    {
    public:
      explicit Scanner(const std::string &file_name)
        : file_name(file_name)
      {}

      void statement(const std::string &joined, const unsigned int line, const unsigned int n_lines)
      {
        const std::string code = trimmed(joined.substr(0, joined.find('#')));
        if (code.empty())
          return;
        const std::size_t blank   = code.find_first_of(" \t");
        const std::string keyword = code.substr(0, blank);
        const std::string rest    = blank == std::string::npos ? "" : trimmed(code.substr(blank));
        if (keyword == "subsection" || keyword == "SUBSECTION")
          begin_section(rest, line);
        else if (keyword == "set" || keyword == "SET")
          entry(rest, line, n_lines, joined.find(command_line_mark) != std::string::npos);
        else if (code == "end" || code == "END")
          {
            if (open.empty())
              line_error(file_name, line, "'end' without a subsection that it could close.");
            open.pop_back();
          }
        else if (keyword == "include" || keyword == "INCLUDE")
          line_error(file_name,
                     line,
                     "'include' is not supported; write the entries into the scene itself.");
        else
          {
            const std::vector<std::string> keywords = {"set", "subsection", "end"};
            line_error(
              file_name,
              line,
              "'" + code +
                "' is none of: 'set entry = value', 'subsection name', 'end', '# comment'." +
                did_you_mean(keyword, keywords));
          }
      }

      SceneLines finish()
      {
        if (!open.empty())
          line_error(file_name,
                     open.back().second,
                     "the subsection '" + open.back().first + "' that begins here has no 'end'.");
        return result;
      }

    private:
      void begin_section(const std::string &name, const unsigned int line)
      {
        if (name.empty())
          line_error(file_name, line, "'subsection' needs a name.");
        if (open.size() == deepest_section)
          line_error(file_name,
                     line,
                     "found a subsection within " + std::to_string(deepest_section) +
                       " others, more than any scene has. Is an 'end' missing?");
        open.emplace_back(name, line);
        result.sections.emplace_back(section_path(open), line);
      }

      void entry(const std::string &statement,
                 const unsigned int line,
                 const unsigned int n_lines,
                 const bool         from_command_line)
      {
        const std::size_t equals = statement.find('=');
        const std::string name   = trimmed(statement.substr(0, equals));
        if (equals == std::string::npos || name.empty())
          line_error(file_name,
                     line,
                     "'set " + statement + "' needs the form 'set entry = value'.");
        result.entries.push_back({section_path(open),
                                  name,
                                  trimmed(statement.substr(equals + 1)),
                                  line,
                                  n_lines,
                                  from_command_line});
      }

      std::string                                       file_name;
      std::vector<std::pair<std::string, unsigned int>> open;
      SceneLines                                        result;
    };


    /** "Section/Entry=value" taken apart. */
    SceneLine parse_override(const std::string &text)
    {
      const std::size_t equals = text.find('=');
      const std::string name   = trimmed(text.substr(0, equals));
      const std::size_t slash  = name.rfind('/');
      SceneLine         line;
      line.section = slash == std::string::npos ? "" : trimmed(name.substr(0, slash));
      line.entry   = trimmed(slash == std::string::npos ? name : name.substr(slash + 1));
      line.value   = equals == std::string::npos ? "" : trimmed(text.substr(equals + 1));
      AssertThrow(equals != std::string::npos && !line.entry.empty(),
                  UserError("command line: '" + text +
                            "' needs the form 'Section/Entry=value', or 'Entry=value' for entries "
                            "outside all sections."));
      AssertThrow(line.value.find_first_of("#\n\r") == std::string::npos &&
                    (line.value.empty() || line.value.back() != '\\'),
                  UserError("command line: the value of '" + name +
                            "' must not contain # or line ends, nor end with a backslash."));
      return line;
    }
  } // namespace


  std::string location(const std::string &file_name, const SceneLine &line)
  {
    return line.from_command_line ? "command line" : file_name + ":" + std::to_string(line.line);
  }


  SceneLines scan_lines(const std::string &text, const std::string &file_name)
  {
    Scanner      scanner(file_name);
    std::string  joined;
    unsigned int line = 0, n_lines = 0;
    for (const std::string &raw : lines_of(text))
      {
        ++line;
        ++n_lines;
        const std::string piece     = trimmed(raw);
        const bool        continues = !piece.empty() && piece.back() == '\\';
        joined += continues ? piece.substr(0, piece.size() - 1) : piece;
        if (continues)
          continue;
        scanner.statement(joined, line + 1 - n_lines, n_lines);
        joined.clear();
        n_lines = 0;
      }
    if (n_lines > 0)
      scanner.statement(joined, line + 1 - n_lines, n_lines);
    return scanner.finish();
  }


  SceneEntries entries_of(const std::string &text)
  {
    SceneEntries entries;
    for (const SceneLine &line : scan_lines(text, "scene").entries)
      entries.emplace_back((line.section.empty() ? "" : line.section + "/") + line.entry,
                           line.value);
    return entries;
  }


  std::string apply_overrides(const std::string              &text,
                              const std::string              &file_name,
                              const std::vector<std::string> &overrides)
  {
    std::vector<std::string> lines = lines_of(text);
    for (const std::string &override_text : overrides)
      {
        const SceneLine   wanted = parse_override(override_text);
        const std::string statement =
          "set " + wanted.entry + " = " + wanted.value + " " + command_line_mark;
        std::string now;
        for (const std::string &line : lines)
          now += line + "\n";
        const SceneLines scanned = scan_lines(now, file_name);
        const auto       found =
          std::find_if(scanned.entries.begin(), scanned.entries.end(), [&](const SceneLine &line) {
            return line.section == wanted.section && line.entry == wanted.entry;
          });
        if (found != scanned.entries.end())
          {
            std::fill_n(lines.begin() + (found->line - 1), found->n_lines, "");
            lines[found->line - 1] = statement;
            continue;
          }
        const std::vector<std::string> path = split_list(wanted.section, '/');
        for (const std::string &section : path)
          lines.push_back("subsection " + section);
        lines.push_back(statement);
        lines.insert(lines.end(), path.size(), "end");
      }
    std::string result;
    for (const std::string &line : lines)
      result += line + "\n";
    return result;
  }
} // namespace PeriDeal
