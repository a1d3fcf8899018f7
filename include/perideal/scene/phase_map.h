// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/point.h>

#include <perideal/base/picture.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /** The name of pixels without material in `Image colors`. */
  inline const std::string void_name = "void";


  /** `Image colors`: which phase a pixel belongs to. */
  class ImageColors
  {
  public:
    static constexpr int empty = -1, unknown = -2; // beside the phases 0, 1, ...

    /**
     * @param text      `silver: rgb(255,255,255) ; bi2212: 40..140 ; void: 0`: a colour, a range of
     *                  greys with its ends, or one grey. A name may come several times.
     * @param tolerance largest distance of a pixel from a colour, as the length of the difference
     *                  in (red, green, blue)
     * @param where     entry and section for messages. Throws UserError.
     */
    ImageColors(const std::string &text, const double tolerance, const std::string &where);

    /**
     * The phase of the nearest colour within the tolerance, of two equally near the one named
     * first; else that of the range that the grey of the pixel lies in, 0.299 red + 0.587 green +
     * 0.114 blue. Pixels that are more transparent than not are empty.
     */
    int phase_of(const Pixel &pixel) const;

    /** The phases in the order of their first mention. */
    const std::vector<std::string> &names() const
    {
      return phases;
    }

    /**
     * The first colour of a phase, or of `void` (empty); of a range the grey in its middle. Black
     * where none is named.
     */
    Pixel color_of(const int phase) const;

    /**
     * The name of the colour nearest to a pixel and how far it is, for messages; no name if there
     * are only ranges.
     */
    std::pair<std::string, double> nearest(const Pixel &pixel) const;

  private:
    struct Rule
    {
      int   phase;
      bool  range;
      int   from, to; // of a range
      Pixel color;
    };

    Rule read(const std::string &name, const std::string &value, const std::string &where) const;
    void check_for_contradictions(const std::string &where) const;
    const std::string &name_of(const int phase) const;

    std::vector<std::string> phases;
    std::vector<Rule>        rules;
    double                   tolerance;
  };


  /**
   * A body of square or rectangular cells, each of one phase or empty, as read from an image. The
   * first row of cells is the lowest one. Known in full to every process.
   */
  struct PhaseMap
  {
    static constexpr int empty = ImageColors::empty;

    dealii::Point<2>            lower;
    std::array<double, 2>       spacing{{1., 1.}};
    std::array<unsigned int, 2> n_cells{{0, 0}};
    std::vector<std::string>    names;
    std::vector<Pixel>          colors; // of the phases, then of what is empty
    std::vector<int>            phases; // of the cells, x fastest

    std::size_t index(const unsigned int i, const unsigned int j) const
    {
      return static_cast<std::size_t>(j) * n_cells[0] + i;
    }

    static constexpr int nearest = -3; // of surrounded(): the phase of the nearest cell

    /** With rows of cells of this phase beyond the left, right, lower and upper side. */
    PhaseMap surrounded(const std::array<unsigned int, 4> &n_layers, const int phase) const;

    /** Without these rows. */
    PhaseMap without(const std::array<unsigned int, 4> &n_layers) const;

    /** Phase of a cell, empty outside the image. */
    int phase(const int i, const int j) const;

    dealii::Point<2> center(const std::size_t cell) const;

    /** The number of the cell in its row, and of the row. */
    std::array<int, 2> place(const std::size_t cell) const;

    /**
     * The phase at a point. On edges and corners of cells that of most of the cells around that are
     * not empty, of equally many the one named first.
     */
    int at(const double x, const double y) const;

    bool has_voids() const;

    /** Number of cells of each phase, then of empty ones. */
    std::vector<std::size_t> counts() const;

    /** One pixel per cell in the colours of the phases; empty cells are transparent. */
    Picture picture() const;

    /**
     * The connected parts of the cells that are not empty: for each cell the number of its part
     * from 0 on, or -1.
     * @param offsets half of the differences between connected cells, as (1, 0) and (0, 1)
     */
    std::vector<int> parts(const std::vector<std::array<int, 2>> &offsets) const;
  };


  /**
   * The cells of an image: blocks of @p pixels_per_cell x the same, each of the phase of its middle
   * pixel (of an even number the one right of and below the middle), and each of those divided into
   * @p cells_per_pixel x the same. Incomplete blocks at the right and at the lower edge are left
   * out. Place and size of the cells are left to be set.
   *
   * Throws UserError: pixels of unknown colours, none with material.
   */
  PhaseMap make_phase_map(const Picture     &picture,
                          const ImageColors &colors,
                          const unsigned int pixels_per_cell,
                          const unsigned int cells_per_pixel,
                          const std::string &where);

  /** The most frequent colours of a picture, for messages: "rgb(0, 0, 0) (12 pixels), ...". */
  std::string frequent_colors(const Picture &picture, const unsigned int n);
} // namespace PeriDeal
