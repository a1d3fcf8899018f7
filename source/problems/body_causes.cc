// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/user_error.h>
#include <perideal/problems/body_causes.h>
#include <perideal/problems/guards.h>
#include <perideal/scene/expression.h>
#include <perideal/scene/lists.h>

#include <vector>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** How many times the second value the first one is, both values, and the place. */
    using Jump = std::vector<double>;


    /** Of the same ratio the one whose place comes first, so that all processes find the same. */
    bool is_worse(const Jump &a, const Jump &b)
    {
      constexpr double same = 1. + 1e-12;
      if (a.empty() || b.empty())
        return b.empty() && !a.empty();
      if (a[0] > same * b[0] || b[0] > same * a[0])
        return a[0] > b[0];
      return std::vector<double>(a.begin() + 3, a.end()) <
             std::vector<double>(b.begin() + 3, b.end());
    }


    Jump worst_of(const std::vector<Jump> &jumps)
    {
      Jump worst;
      for (const Jump &jump : jumps)
        if (is_worse(jump, worst))
          worst = jump;
      return worst;
    }


    template <int dim>
    Jump largest_jump(const Triangulation<dim>                        &mesh,
                      const std::function<double(const Point<dim> &)> &property)
    {
      Jump worst;
      for (const auto &cell : mesh.active_cell_iterators())
        for (const unsigned int f : cell->face_indices())
          if (cell->is_locally_owned() && !cell->at_boundary(f))
            {
              const double here  = property(cell->center()),
                           there = property(cell->neighbor(f)->center());
              const Point<dim> p = cell->face(f)->center();
              Jump             jump{here / there, here, there}; // each face has two sides
              jump.insert(jump.end(), p.begin_raw(), p.end_raw());
              worst = worst_of({worst, jump});
            }
      return worst;
    }
  } // namespace


  template <int dim>
  std::string cause_in_contrast(const Triangulation<dim>                        &mesh,
                                const std::string                               &entry,
                                const std::function<double(const Point<dim> &)> &property,
                                const std::string                               &monitor)
  {
    const bool   of_balance = monitor == "balance";
    const double much       = of_balance ? 1e9 : 1e5;
    if (!of_balance && monitor != "solver")
      return "";
    Jump worst;
    try
      {
        with_formulas(mesh.get_communicator(), [&] { worst = largest_jump(mesh, property); });
      }
    catch (const UserError &) // no value at some point that nothing else has asked for
      {
        return "";
      }
    worst = worst_of(Utilities::MPI::all_gather(mesh.get_communicator(), worst));
    if (worst.empty() || !(worst[0] > much))
      return "";
    return entry + " in section 'Material' is " + rounded_text(worst[1]) + " in one cell and " +
           rounded_text(worst[2]) + " in the next, at " +
           text_of_place(std::vector<double>(worst.begin() + 3, worst.end())) +
           (of_balance ?
              ": the round-off of the one is no less than all that the other lets through. " :
              ": iterations hardly get across. ") +
           "Beyond a thousand times hardly anything changes but that: choose values that differ less, or leave out what hardly takes part, as a hole or a crack.";
  }


  template std::string cause_in_contrast(const Triangulation<1> &,
                                         const std::string &,
                                         const std::function<double(const Point<1> &)> &,
                                         const std::string &);
  template std::string cause_in_contrast(const Triangulation<2> &,
                                         const std::string &,
                                         const std::function<double(const Point<2> &)> &,
                                         const std::string &);
  template std::string cause_in_contrast(const Triangulation<3> &,
                                         const std::string &,
                                         const std::function<double(const Point<3> &)> &,
                                         const std::string &);
} // namespace PeriDeal
