// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/scene/cell_lines.h>
#include <perideal/scene/lists.h>

#include <cmath>
#include <string>

namespace PeriDeal
{
  template <int dim>
  std::array<std::vector<double>, dim> cell_lines(const Domain<dim> &domain)
  {
    const std::string                    entry  = "Cell lines";
    const std::vector<std::string>       pieces = split_list(domain.text(entry), ';');
    std::array<std::vector<double>, dim> lines;
    domain.refuse(pieces.size() != dim,
                  entry,
                  "needs a list for each of the " + std::to_string(dim) + " directions, found " +
                    std::to_string(pieces.size()) + ".");
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double lower = domain.lower[d], upper = domain.upper[d],
                     slack = 1e-9 * (upper - lower);
        for (const std::string &piece : split_list(pieces[d], ','))
          lines[d].push_back(parse_number(piece, domain.where(entry)));
        bool grows = lines[d].size() > 1 && std::abs(lines[d].front() - lower) <= slack &&
                     std::abs(lines[d].back() - upper) <= slack;
        for (std::size_t k = 1; k < lines[d].size(); ++k)
          grows = grows && lines[d][k] > lines[d][k - 1] + slack;
        domain.refuse(!grows,
                      entry,
                      "found '" + pieces[d] + "', needs growing numbers from " +
                        number_text(lower) + " to " + number_text(upper) +
                        ", the corners of the body.");
        lines[d].front() = lower;
        lines[d].back()  = upper;
      }
    return lines;
  }


#define PERIDEAL_TEMPLATES(dim) \
  template std::array<std::vector<double>, dim> cell_lines<dim>(const Domain<dim> &);
  PERIDEAL_FOR_EACH_DIM(PERIDEAL_TEMPLATES)
#undef PERIDEAL_TEMPLATES
} // namespace PeriDeal
