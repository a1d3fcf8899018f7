// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/text_file.h>
#include <perideal/scene/expression.h>
#include <perideal/scene/formula_names.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <sstream>

namespace PeriDeal
{
  namespace
  {
    unsigned int n_that_hold = 0;

    std::shared_ptr<const FormulaNames> &names_in_force()
    {
      static std::shared_ptr<const FormulaNames> names = std::make_shared<const FormulaNames>();
      return names;
    }
  } // namespace


  const std::shared_ptr<const FormulaNames> &names_of_formulas()
  {
    return names_in_force();
  }


  TableFault &table_fault()
  {
    static TableFault fault;
    return fault;
  }


  std::string TableFault::text() const
  {
    return table == nullptr ?
             "" :
             " The table '" + table->name + "' (" + table->file + ") goes from " +
               number_text(table->places.front()) + " to " + number_text(table->places.back()) +
               " and was asked for " + number_text(place) +
               ". Add rows, or write 'hold' behind its file in 'Tables' for the numbers at its ends." +
               (place == 0. ?
                  " If 0 is the temperature that the body starts from, give another 'Initial value' in section 'Initial and source'." :
                  "");
  }


  HeldTableEnds::HeldTableEnds()
  {
    ++n_that_hold;
  }


  HeldTableEnds::~HeldTableEnds()
  {
    --n_that_hold;
  }


  double FormulaTable::value(const double place) const
  {
    if (!(place >= places.front() && place <= places.back()))
      {
        const double slack  = 1e-9 * (places.back() - places.front()); // of round-off
        const bool   is_end = place >= places.front() - slack && place <= places.back() + slack;
        if ((holds || n_that_hold > 0 || is_end) && !std::isnan(place))
          return place < places.front() ? numbers.front() : numbers.back();
        table_fault() = {this, place};
        return std::numeric_limits<double>::quiet_NaN();
      }
    const std::size_t k = std::clamp<std::ptrdiff_t>(
      std::upper_bound(places.begin(), places.end(), place) - places.begin(),
      1,
      static_cast<std::ptrdiff_t>(places.size()) - 1);
    const double share = (place - places[k - 1]) / (places[k] - places[k - 1]);
    return share == 1. ? numbers[k] : numbers[k - 1] + share * (numbers[k] - numbers[k - 1]);
  }


  namespace
  {
    /** The cells of a row; separators are those of the row itself. */
    std::vector<std::string> cells_of(const std::string &line)
    {
      const char               separator = line.find(';') != std::string::npos  ? ';' :
                                           line.find(',') != std::string::npos  ? ',' :
                                           line.find('\t') != std::string::npos ? '\t' :
                                                                                  ' ';
      std::vector<std::string> cells(1);
      bool                     is_quoted = false;
      for (const char c : line)
        if (c == '"')
          is_quoted = !is_quoted;
        else if (c != separator || is_quoted)
          cells.back() += c;
        else if (separator != ' ' || !cells.back().empty())
          cells.emplace_back();
      for (std::string &cell : cells)
        cell = trimmed(cell);
      if (separator == ' ' && cells.back().empty())
        cells.pop_back();
      return cells;
    }


    /** What a scene says of a table. */
    struct TableEntry
    {
      std::string              name, file;
      bool                     holds = false;
      std::vector<std::string> columns; // two, numbers or names
    };


    /** The column of a number from 1 on, or of a name in the head of the file. */
    std::size_t column_of(const std::string              &column,
                          const std::vector<std::string> &head,
                          const std::string              &where,
                          const std::string              &file)
    {
      if (const std::optional<double> number = plain_number(column))
        {
          if (!(*number >= 1. && *number <= 1000. && *number == std::floor(*number)))
            entry_error(where, "found the column '" + column + "', needs 1, 2, ... or a name.");
          return static_cast<std::size_t>(*number) - 1;
        }
      const auto found = std::find(head.begin(), head.end(), column);
      if (found == head.end())
        entry_error(where,
                    "there is no column '" + column + "' in '" + file + "'" +
                      (head.empty() ?
                         ", which has no row of names at its head." :
                         ", which has " + join_names(head) + "." + did_you_mean(column, head)));
      return static_cast<std::size_t>(found - head.begin());
    }


    /** @param at tells the place in the file */
    double number_in(const std::vector<std::string>     &cells,
                     const std::size_t                   column,
                     const std::string                  &where,
                     const std::function<std::string()> &at)
    {
      const auto which = [&]() { return "column " + std::to_string(column + 1); };
      if (column >= cells.size() || cells[column].empty())
        entry_error(where, at() + ": there is nothing in " + which() + ".");
      const std::string          &cell   = cells[column];
      const std::optional<double> number = plain_number(cell);
      if (!number || !std::isfinite(*number))
        entry_error(
          where,
          at() + ": found '" + cell + "' in " + which() + ", needs a number" +
            (cell.find(',') != std::string::npos ? " (decimals are written with a point)." : "."));
      return *number;
    }


    FormulaTable table_of(const TableEntry  &entry,
                          const std::string &text,
                          const std::string &file,
                          const std::string &where)
    {
      FormulaTable table;
      table.name  = entry.name;
      table.file  = file;
      table.holds = entry.holds;
      std::istringstream       lines(text);
      std::vector<std::string> head;
      std::size_t              columns[2] = {}, n_line = 0;
      bool                     has_begun = false;
      for (std::string line; std::getline(lines, line);)
        {
          ++n_line;
          if (n_line == 1 && line.compare(0, 3, "\xEF\xBB\xBF") == 0)
            line.erase(0, 3);
          line = trimmed(line.substr(0, line.find('#')));
          if (line.empty())
            continue;
          const auto at = [&]() { return "'" + file + "', line " + std::to_string(n_line); };
          const std::vector<std::string> cells = cells_of(line);
          if (!has_begun)
            {
              has_begun = true;
              const bool is_head =
                std::none_of(cells.begin(), cells.end(), [](const std::string &cell) {
                  return plain_number(cell).has_value();
                });
              if (is_head)
                head = cells;
              for (unsigned int k = 0; k < 2; ++k)
                columns[k] = column_of(entry.columns[k], head, where, file);
              if (is_head)
                continue;
            }
          double numbers[2];
          for (unsigned int k = 0; k < 2; ++k)
            numbers[k] = number_in(cells, columns[k], where, at);
          if (!table.places.empty() && !(numbers[0] > table.places.back()))
            entry_error(where,
                        at() + ": found " + number_text(numbers[0]) + " behind " +
                          number_text(table.places.back()) +
                          "; the numbers of the first column have to ascend." +
                          (numbers[0] == table.places.back() ?
                             " A jump takes two rows that are a little apart." :
                             ""));
          table.places.push_back(numbers[0]);
          table.numbers.push_back(numbers[1]);
        }
      if (table.places.size() < 2)
        entry_error(where,
                    "'" + file + "' has " + std::to_string(table.places.size()) +
                      " rows of numbers, needs two or more.");
      return table;
    }


    TableEntry table_entry(const std::string &name,
                           const std::string &value,
                           const std::string &where)
    {
      TableEntry               entry{name, "", false, {}};
      std::vector<std::string> pieces = split_list(value, ',');
      entry.file                      = unquoted(pieces.front());
      pieces.erase(pieces.begin());
      if (!pieces.empty() && pieces.back() == "hold")
        {
          entry.holds = true;
          pieces.pop_back();
        }
      if (!pieces.empty() && pieces.size() != 2)
        entry_error(
          where,
          "the table '" + name + "': found '" + value +
            "', needs a file and, if it is not the first two, its columns of places and of "
            "numbers: 'name: file, 1, 3', and 'hold' at the end for the numbers at the ends "
            "beyond these.");
      entry.columns = pieces.empty() ? std::vector<std::string>{"1", "2"} : pieces;
      for (std::string &column : entry.columns)
        column = unquoted(column);
      return entry;
    }


    /** The bytes of the file, found beside the scene or at its path. Collective. */
    std::string text_of_table(TableEntry        &entry,
                              const std::string &folder,
                              const std::string &where,
                              const MPI_Comm     communicator)
    {
      namespace fs             = std::filesystem;
      const std::string name   = entry.file;
      const fs::path    beside = fs::path(folder) / name;
      int               rank   = 0;
      MPI_Comm_rank(communicator, &rank);
      std::string text, message;
      if (rank == 0)
        {
          std::error_code error;
          // The last is where results have a copy, for the scene that lies there.
          const fs::path copy = fs::path(folder) / "tables" / (entry.name + ".csv");
          for (const fs::path &other : {beside, copy})
            if (!fs::exists(entry.file, error) && fs::exists(other, error))
              entry.file = other.string();
          text = read_file(entry.file, most_bytes_of_data, message);
          if (!message.empty())
            message = "Entry " + where + ": the table '" + entry.name + "': the file '" + name +
                      "' " + message +
                      (fs::exists(entry.file, error) ? "." : places_looked_at(name, folder));
        }
      throw_on_all_if_any(communicator, message);
      share_text(entry.file, communicator);
      share_text(text, communicator);
      return text;
    }


    /** Names of formulas that are taken. */
    void check_name(const std::string &name, const std::string &where, const FormulaNames &so_far)
    {
      const bool is_name = (std::isalpha(static_cast<unsigned char>(name[0])) || name[0] == '_') &&
                           std::all_of(name.begin(), name.end(), [](const unsigned char c) {
                             return std::isalnum(c) || c == '_';
                           });
      if (!is_name)
        entry_error(where,
                    "found the name '" + name +
                      "', needs letters, digits and '_', a letter at the beginning.");
      bool is_taken = Expression::is_reserved(name);
      for (const auto &constant : so_far.constants)
        is_taken = is_taken || constant.first == name;
      for (const FormulaTable &table : so_far.tables)
        is_taken = is_taken || table.name == name;
      if (is_taken)
        entry_error(
          where,
          "the name '" + name +
            "' is taken, by a variable, a function or a constant of formulas. Take another.");
    }
  } // namespace


  Formulas::Formulas()
    : SceneSection("Formulas")
  {
    declare("Constants", EntryType::list) =
      "Names of numbers, for all formulas of the scene: `E0: 210e9 ; tau: 3*60`, each a number or a formula of those before it.";
    declare("Tables", EntryType::list) =
      "Functions of one number, for all formulas of the scene, from files of columns (CSV): `k: steel.csv ; press: test.csv, 1, 3`, "
      "with the columns of places and of numbers, the first two if none are named, by number or by their names in the first row. "
      "Then `k(T)` and `press(t)` are linear between the rows, whose places ascend. Beyond its ends a table has no numbers, which is an error, "
      "unless `hold` stands at the end: `k: steel.csv, hold` has the number of the end there. Files are looked for beside the scene, and copied into the results.";
  }


  void Formulas::parse(const std::string &folder, const MPI_Comm communicator)
  {
    SceneSection::parse();
    const std::string of_constants = where("Constants"), of_tables = where("Tables");
    names_in_force()  = std::make_shared<const FormulaNames>(); // none of another scene
    const auto  found = std::make_shared<FormulaNames>();
    std::string contents;
    for (const std::string &piece : split_list(text("Tables"), ';'))
      {
        const auto [name, value] = name_and_value(piece, of_tables);
        check_name(name, of_tables, *found);
        TableEntry        entry = table_entry(name, value, of_tables);
        const std::string text  = text_of_table(entry, folder, of_tables, communicator);
        found->tables.push_back(table_of(entry, text, entry.file, of_tables));
        contents += text;
      }
    for (const std::string &piece : split_list(text("Constants"), ';'))
      {
        const auto [name, value] = name_and_value(piece, of_constants);
        check_name(name, of_constants, *found);
        names_in_force() = std::make_shared<const FormulaNames>(*found);
        const Expression formula(value,
                                 of_constants + ", '" + name + "'",
                                 "the constants before it");
        if (!formula.is_constant())
          entry_error(of_constants,
                      "the constant '" + name + "': found '" + value +
                        "', needs a number or a formula of constants before it.");
        found->constants.emplace_back(name, formula.value(dealii::Point<1>()));
      }
    // Formulas of the same names have their compiled form in common.
    static std::map<std::string, std::weak_ptr<const FormulaNames>> known;
    auto &same = known[text("Constants") + '\n' + text("Tables") + '\n' + folder + '\n' +
                       std::to_string(std::hash<std::string>()(contents))];
    names      = same.lock();
    if (names == nullptr)
      same = names = found;
    names_in_force() = names;
  }
} // namespace PeriDeal
