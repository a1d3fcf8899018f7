// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/connected_sets.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/phase_map.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace PeriDeal
{
  namespace
  {
    std::string color_text(const Pixel &p)
    {
      return "rgb(" + std::to_string(p[0]) + "," + std::to_string(p[1]) + "," +
             std::to_string(p[2]) + ")";
    }


    double distance(const Pixel &a, const Pixel &b)
    {
      double square = 0.;
      for (unsigned int c = 0; c < 3; ++c)
        square += (double(a[c]) - b[c]) * (double(a[c]) - b[c]);
      return std::sqrt(square);
    }


    int grey_of(const Pixel &p)
    {
      return static_cast<int>(std::lround(0.299 * p[0] + 0.587 * p[1] + 0.114 * p[2]));
    }


    std::string pixels_text(const std::size_t n)
    {
      return std::to_string(n) + (n == 1 ? " pixel" : " pixels");
    }
  } // namespace


  ImageColors::ImageColors(const std::string &text,
                           const double       tolerance,
                           const std::string &where)
    : tolerance(tolerance)
  {
    for (const std::string &piece : split_list(text, ';'))
      {
        const auto [name, value] = name_and_value(piece, where);
        if (name != void_name && !has(phases, name))
          phases.push_back(name);
        rules.push_back(read(name, value, where));
      }
    check_for_contradictions(where);
    if (phases.empty())
      entry_error(
        where,
        "names no phase but '" + void_name +
          "', so that nothing is left of the body. It has the form 'silver: rgb(255,255,255) ; oxide: 40..140 ; void: 0'.");
  }


  ImageColors::Rule ImageColors::read(const std::string &name,
                                      const std::string &value,
                                      const std::string &where) const
  {
    const std::string at   = where + ", phase '" + name + "'";
    const auto        grey = [&](const std::string &text) {
      return static_cast<int>(parse_whole_number(trimmed(text), at, 255));
    };
    const auto found = std::find(phases.begin(), phases.end(), name);
    Rule       rule{found == phases.end() ? empty : static_cast<int>(found - phases.begin()),
              false,
              0,
              0,
              Pixel{}};
    if (const std::size_t dots = value.find(".."); dots != std::string::npos)
      {
        rule.range = true;
        rule.from  = grey(value.substr(0, dots));
        rule.to    = grey(value.substr(dots + 2));
        if (rule.from > rule.to)
          entry_error(at, "the range '" + value + "' ends before it begins.");
        const auto middle = static_cast<std::uint8_t>((rule.from + rule.to) / 2);
        rule.color        = {middle, middle, middle, 255};
        return rule;
      }
    if (value.compare(0, 3, "rgb") == 0)
      {
        const std::string list = trimmed(value.substr(3));
        if (list.size() < 2 || list.front() != '(' || list.back() != ')')
          entry_error(at, "found '" + value + "', needs the form rgb(255,128,0).");
        const std::vector<std::string> numbers = split_list(list.substr(1, list.size() - 2), ',');
        if (numbers.size() != 3)
          entry_error(at, "found '" + value + "', needs three numbers as in rgb(255,128,0).");
        for (unsigned int c = 0; c < 3; ++c)
          rule.color[c] = static_cast<std::uint8_t>(grey(numbers[c]));
      }
    else if (!value.empty() && value.find_first_not_of("0123456789") == std::string::npos)
      rule.color.fill(static_cast<std::uint8_t>(grey(value)));
    else
      entry_error(
        at,
        "found '" + value +
          "', needs a colour as rgb(255,128,0), a range of greys as 40..140, or one grey from 0 to 255.");
    rule.color[3] = 255;
    return rule;
  }


  void ImageColors::check_for_contradictions(const std::string &where) const
  {
    for (std::size_t a = 0; a < rules.size(); ++a)
      for (std::size_t b = 0; b < a; ++b)
        {
          if (rules[a].phase == rules[b].phase || rules[a].range != rules[b].range)
            continue;
          if (rules[a].range ?
                std::max(rules[a].from, rules[b].from) <= std::min(rules[a].to, rules[b].to) :
                rules[a].color == rules[b].color)
            entry_error(
              where,
              "'" + name_of(rules[b].phase) + "' and '" + name_of(rules[a].phase) +
                (rules[a].range ? "' have overlapping ranges." : "' have the same colour."));
        }
  }


  const std::string &ImageColors::name_of(const int phase) const
  {
    return phase < 0 ? void_name : phases[phase];
  }


  int ImageColors::phase_of(const Pixel &pixel) const
  {
    if (pixel[3] < 128)
      return empty;
    const Rule *best     = nullptr;
    double      smallest = tolerance;
    for (const Rule &rule : rules)
      if (const double d = rule.range ? 1e9 : distance(rule.color, pixel);
          d < smallest || (best == nullptr && d <= smallest))
        {
          best     = &rule;
          smallest = d;
        }
    if (best != nullptr)
      return best->phase;
    const int grey = grey_of(pixel);
    for (const Rule &rule : rules)
      if (rule.range && grey >= rule.from && grey <= rule.to)
        return rule.phase;
    return unknown;
  }


  Pixel ImageColors::color_of(const int phase) const
  {
    for (const Rule &rule : rules)
      if (rule.phase == phase)
        return rule.color;
    return {0, 0, 0, 255};
  }


  std::pair<std::string, double> ImageColors::nearest(const Pixel &pixel) const
  {
    std::pair<std::string, double> result{"", 1e9};
    for (const Rule &rule : rules)
      if (const double d = distance(rule.color, pixel); !rule.range && d < result.second)
        result = {name_of(rule.phase), d};
    return result;
  }


  PhaseMap PhaseMap::surrounded(const std::array<unsigned int, 4> &n_layers, const int phase) const
  {
    PhaseMap map = *this;
    for (unsigned int d = 0; d < 2; ++d)
      {
        map.lower[d] -= spacing[d] * n_layers[2 * d];
        map.n_cells[d] += n_layers[2 * d] + n_layers[2 * d + 1];
      }
    map.phases.clear();
    const auto near = [&](const unsigned int k, const unsigned int d) {
      return std::clamp(static_cast<int>(k) - static_cast<int>(n_layers[2 * d]),
                        0,
                        static_cast<int>(n_cells[d]) - 1);
    };
    for (unsigned int j = 0; j < map.n_cells[1]; ++j)
      for (unsigned int i = 0; i < map.n_cells[0]; ++i)
        {
          const bool own = i >= n_layers[0] && i < n_layers[0] + n_cells[0] && j >= n_layers[2] &&
                           j < n_layers[2] + n_cells[1];
          map.phases.push_back(own || phase == nearest ? phases[index(near(i, 0), near(j, 1))] :
                                                         phase);
        }
    return map;
  }


  PhaseMap PhaseMap::without(const std::array<unsigned int, 4> &n_layers) const
  {
    PhaseMap map = *this;
    for (unsigned int d = 0; d < 2; ++d)
      {
        map.lower[d] += spacing[d] * n_layers[2 * d];
        map.n_cells[d] -= n_layers[2 * d] + n_layers[2 * d + 1];
      }
    map.phases.clear();
    for (unsigned int j = 0; j < map.n_cells[1]; ++j)
      for (unsigned int i = 0; i < map.n_cells[0]; ++i)
        map.phases.push_back(phases[index(i + n_layers[0], j + n_layers[2])]);
    return map;
  }


  int PhaseMap::phase(const int i, const int j) const
  {
    const bool inside = i >= 0 && j >= 0 && i < static_cast<int>(n_cells[0]) &&
                        j < static_cast<int>(n_cells[1]);
    return inside ? phases[index(i, j)] : empty;
  }


  dealii::Point<2> PhaseMap::center(const std::size_t cell) const
  {
    const auto [i, j] = place(cell);
    return {lower[0] + (i + 0.5) * spacing[0], lower[1] + (j + 0.5) * spacing[1]};
  }


  std::array<int, 2> PhaseMap::place(const std::size_t cell) const
  {
    return {{static_cast<int>(cell % n_cells[0]), static_cast<int>(cell / n_cells[0])}};
  }


  int PhaseMap::at(const double x, const double y) const
  {
    constexpr double   slack = 1e-7;
    std::array<int, 2> first, last;
    for (unsigned int d = 0; d < 2; ++d)
      {
        const double s = ((d == 0 ? x : y) - lower[d]) / spacing[d];
        first[d]       = static_cast<int>(std::floor(s - slack));
        last[d]        = static_cast<int>(std::floor(s + slack));
      }
    if (first == last)
      return phase(first[0], first[1]);
    std::vector<unsigned int> votes(names.size(), 0);
    for (int j = first[1]; j <= last[1]; ++j)
      for (int i = first[0]; i <= last[0]; ++i)
        if (const int k = phase(i, j); k >= 0)
          ++votes[k];
    const auto most = std::max_element(votes.begin(), votes.end());
    return most == votes.end() || *most == 0 ? empty : static_cast<int>(most - votes.begin());
  }


  bool PhaseMap::has_voids() const
  {
    return has(phases, empty);
  }


  std::vector<std::size_t> PhaseMap::counts() const
  {
    std::vector<std::size_t> n(names.size() + 1, 0);
    for (const int phase : phases)
      ++n[phase < 0 ? names.size() : phase];
    return n;
  }


  Picture PhaseMap::picture() const
  {
    Picture picture;
    picture.n_columns = n_cells[0];
    picture.n_rows    = n_cells[1];
    for (unsigned int j = n_cells[1]; j-- > 0;)
      for (unsigned int i = 0; i < n_cells[0]; ++i)
        {
          const int phase = phases[index(i, j)];
          Pixel     pixel = phase < 0 ? colors.back() : colors[phase];
          pixel[3]        = phase < 0 ? 0 : 255;
          picture.pixels.push_back(pixel);
        }
    return picture;
  }


  std::vector<int> PhaseMap::parts(const std::vector<std::array<int, 2>> &offsets) const
  {
    ConnectedSets sets(phases.size());
    for (unsigned int j = 0; j < n_cells[1]; ++j)
      for (unsigned int i = 0; i < n_cells[0]; ++i)
        if (phases[index(i, j)] != empty)
          for (const auto &offset : offsets)
            if (const int k = i + offset[0], l = j + offset[1]; phase(k, l) != empty)
              sets.join(index(i, j), index(k, l));
    std::vector<int> part(phases.size(), -1);
    int              n = 0;
    for (std::size_t c = 0; c < phases.size(); ++c)
      if (phases[c] != empty)
        part[c] = sets.root(c) == c ? n++ : part[sets.root(c)]; // the root is the lowest
    return part;
  }


  std::string frequent_colors(const Picture &picture, const unsigned int n)
  {
    std::map<Pixel, std::size_t> counts;
    for (const Pixel &pixel : picture.pixels)
      ++counts[{pixel[0], pixel[1], pixel[2], 255}];
    std::vector<std::pair<std::size_t, Pixel>> list;
    for (const auto &[pixel, count] : counts)
      list.emplace_back(count, pixel);
    std::stable_sort(list.begin(), list.end(), [](const auto &a, const auto &b) {
      return a.first > b.first;
    });
    std::string text;
    for (unsigned int k = 0; k < std::min<std::size_t>(n, list.size()); ++k)
      text +=
        (k > 0 ? ", " : "") + color_text(list[k].second) + " (" + pixels_text(list[k].first) + ")";
    if (list.size() > n)
      text += " and " + std::to_string(list.size() - n) + " more";
    return text;
  }


  PhaseMap make_phase_map(const Picture     &picture,
                          const ImageColors &colors,
                          const unsigned int pixels_per_cell,
                          const unsigned int cells_per_pixel,
                          const std::string &where)
  {
    PhaseMap map;
    map.names = colors.names();
    for (std::size_t k = 0; k < map.names.size(); ++k)
      map.colors.push_back(colors.color_of(static_cast<int>(k)));
    map.colors.push_back(colors.color_of(ImageColors::empty));
    const unsigned int n_columns = picture.n_columns / pixels_per_cell,
                       n_rows    = picture.n_rows / pixels_per_cell;
    map.n_cells                  = {{n_columns * cells_per_pixel, n_rows * cells_per_pixel}};
    map.phases.assign(static_cast<std::size_t>(map.n_cells[0]) * map.n_cells[1], map.empty);
    std::map<Pixel, std::size_t> strange; // and how often
    std::map<Pixel, std::string> place_of;
    std::size_t                  n_strange = 0;
    for (unsigned int row = 0; row < n_rows; ++row)
      for (unsigned int column = 0; column < n_columns; ++column)
        {
          const unsigned int x = column * pixels_per_cell + pixels_per_cell / 2,
                             y = row * pixels_per_cell + pixels_per_cell / 2;
          const Pixel &pixel   = picture.at(x, y);
          const int    phase   = colors.phase_of(pixel);
          if (phase == ImageColors::unknown)
            {
              ++n_strange;
              if (strange[pixel]++ == 0)
                place_of[pixel] =
                  "column " + std::to_string(x + 1) + ", row " + std::to_string(y + 1);
              continue;
            }
          for (unsigned int b = 0; b < cells_per_pixel; ++b)
            for (unsigned int a = 0; a < cells_per_pixel; ++a)
              map.phases[map.index(column * cells_per_pixel + a,
                                   map.n_cells[1] - 1 - (row * cells_per_pixel + b))] = phase;
        }
    if (n_strange > 0)
      {
        const auto most =
          std::max_element(strange.begin(), strange.end(), [](const auto &a, const auto &b) {
            return a.second < b.second;
          });
        const auto [name, gap] = colors.nearest(most->first);
        entry_error(where,
                    pixels_text(n_strange) + " of the image " + (n_strange == 1 ? "has" : "have") +
                      " a colour of no phase, most often " + color_text(most->first) + " (" +
                      pixels_text(most->second) + ", the first in " + place_of[most->first] +
                      (name.empty() ? std::string(")") :
                                      "; " + number_text(std::round(10. * gap) / 10.) + " from '" +
                                        name + "')") +
                      ". Name that colour, or allow more in 'Color tolerance'.");
      }
    if (std::all_of(map.phases.begin(), map.phases.end(), [](const int phase) {
          return phase < 0;
        }))
      entry_error(where,
                  "no pixel of the image belongs to a phase with material; its colours are: " +
                    frequent_colors(picture, 6) + ".");
    return map;
  }
} // namespace PeriDeal
