// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "formula_scan.h"

#include <perideal/base/instantiate.h>
#include <perideal/study/cracked_box.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "given_values.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** Cells of the finest raster that is looked at, along each edge of a body or its side. */
    template <int dim>
    unsigned int finest_raster(const bool on_side)
    {
      return dim == 1 ? 4096 : dim == 2 ? (on_side ? 1024 : 256) : (on_side ? 128 : 32);
    }


    /** Values of a function on a raster of a box of n dimensions, the first axis fastest. */
    struct Raster
    {
      /**
       * @param cells    along each edge
       * @param edges    the lengths of the edges; the unit is that of fineness_needed()
       * @param function of coordinates between 0 and 1
       */
      Raster(const unsigned int                           cells,
             const std::vector<double>                   &edges,
             const std::function<double(const double *)> &function)
        : n(edges.size())
        , cells(cells)
        , edges(edges)
      {
        std::size_t size = 1;
        for (unsigned int d = 0; d < n; ++d)
          size *= cells + 1;
        values.reserve(size);
        for (std::size_t k = 0; k < size; ++k)
          {
            double      x[3] = {0., 0., 0.};
            std::size_t rest = k;
            for (unsigned int d = 0; d < n; ++d, rest /= cells + 1)
              x[d] = static_cast<double>(rest % (cells + 1)) / cells;
            values.push_back(function(x));
          }
      }


      static constexpr unsigned int all = numbers::invalid_unsigned_int;

      /**
       * Points of the raster between those of cells of about this size, along each edge or, as
       * short as can be along the others, along one.
       */
      std::array<std::size_t, 3> strides(const double fineness, const unsigned int axis) const
      {
        std::array<std::size_t, 3> strides{{1, 1, 1}};
        for (unsigned int d = 0; d < n; ++d)
          if (axis == all || axis == d)
            {
              const double wanted = std::exp2(std::round(std::log2(fineness * edges[d])));
              strides[d] = cells / static_cast<std::size_t>(std::clamp<double>(wanted, 1., cells));
            }
        return strides;
      }


      /** The multilinear interpolant from the points that are so far apart. */
      double interpolant(const std::size_t k, const std::array<std::size_t, 3> &strides) const
      {
        std::size_t rest = k, base = 0, step = 1;
        double      fraction[3];
        std::size_t steps[3];
        for (unsigned int d = 0; d < n; ++d)
          {
            const std::size_t i = rest % (cells + 1), stride = strides[d];
            rest /= cells + 1;
            const std::size_t low = std::min<std::size_t>(i / stride * stride, cells - stride);
            fraction[d]           = static_cast<double>(i - low) / stride;
            base += low * step;
            steps[d] = stride * step;
            step *= cells + 1;
          }
        double sum = 0.;
        for (unsigned int v = 0; v < (1u << n); ++v)
          {
            double      weight = 1.;
            std::size_t at     = base;
            for (unsigned int d = 0; d < n; ++d)
              {
                weight *= (v >> d) & 1 ? fraction[d] : 1. - fraction[d];
                at += (v >> d) & 1 ? steps[d] : 0;
              }
            sum += weight > 0. ? weight * values[at] : 0.;
          }
        return sum;
      }


      /**
       * Sum of the squares of what is left of the interpolant on such cells, or of some of them as
       * soon as that is more than enough.
       */
      double squared_error(const std::array<std::size_t, 3> &strides, const double enough) const
      {
        double error = 0.;
        for (std::size_t k = 0; k < values.size() && error <= enough; ++k)
          {
            const double left = values[k] - interpolant(k, strides);
            if (!std::isnan(left)) // beside the body
              error += left * left;
          }
        return error;
      }


      /** That of the mean; 0 but for round-off is none. */
      double variation() const
      {
        double      mean = 0., sum = 0.;
        std::size_t n_inside = 0;
        for (const double v : values)
          if (!std::isnan(v))
            {
              mean += v;
              ++n_inside;
            }
        mean /= std::max<std::size_t>(1, n_inside);
        for (const double v : values)
          if (!std::isnan(v))
            sum += (v - mean) * (v - mean);
        return sum > 1e-24 * n_inside * (mean * mean + 1e-300) ? sum : 0.;
      }


      /** Along all edges, or along one. */
      double fineness_needed(const unsigned int axis) const
      {
        // Near a jump no interpolant is, and what jumps is seen by cells of about its width.
        constexpr double allowed = 0.2, of_jumps = 0.3, many = 16.;
        const double     variation = this->variation();
        if (variation == 0.)
          return 1.;
        const double finest = cells / *std::min_element(edges.begin(), edges.end());
        double       most   = allowed * allowed * variation;
        for (double fineness = 1.; fineness < finest; fineness *= 2.)
          {
            if (fineness == many && jumps())
              most = of_jumps * of_jumps * variation;
            if (squared_error(strides(fineness, axis), most) < most)
              return fineness;
          }
        return finest;
      }


      /** As cells are halved, errors of smooth functions become a quarter, of jumps 0.7. */
      bool jumps() const
      {
        constexpr double least = 0.5;
        const double variation = this->variation(), fine = squared_error({{2, 2, 2}}, variation),
                     coarse = fine / (least * least);
        return variation > 0. && fine > 1e-8 * variation &&
               squared_error({{4, 4, 4}}, coarse) < coarse;
      }

      const unsigned int        n, cells;
      const std::vector<double> edges;
      std::vector<double>       values;
    };


    /** Looks at one function after the other. */
    template <int dim>
    class FormulaScan
    {
    public:
      using Function = std::function<double(const Point<dim> &, const double t)>;

      enum class Jumps
      {
        matter,       // the solution becomes rough
        do_not_matter // its gradient at most
      };

      static constexpr unsigned int nowhere = numbers::invalid_unsigned_int;

      /** @param by_direction look at each direction, too */
      FormulaScan(const BodyOfChoice<dim> &body, const bool by_direction)
        : body(body.given.get())
        , scene(*body.scene)
        , by_direction(by_direction)
        , fineness_along(dim, 1.)
      {}

      const std::vector<double> &along_edges() const
      {
        return fineness_along;
      }

      const NeedsOfFormulas &needs() const
      {
        return found;
      }

      /** In the body or, if @p side is one, on it. */
      void see(const Function    &function,
               const bool         changes,
               const Jumps        jumps,
               const unsigned int side = nowhere)
      {
        // At the beginning much is still zero.
        static constexpr double parts_of_time[] = {0., 0.31, 0.67, 1.};
        for (const double part : parts_of_time)
          if (part == 0. || (changes && !scene.time.steady))
            see_at(part * scene.time.end_time, function, jumps, side);
      }

      void see(const Expression &formula, const Jumps jumps, const unsigned int side = nowhere)
      {
        if (formula.depends_on_position())
          see([&](const Point<dim> &p, const double t) { return formula.value(p, t); },
              formula.depends_on_time(),
              jumps,
              side);
      }

      void see(const MaterialProperty &property, const Jumps jumps)
      {
        if (!property.is_constant())
          see([&](const Point<dim> &p, double) { return property.value(p); }, false, jumps);
      }

      /** Where the part is; a point is not seen by any mesh. */
      void see(const Part &part)
      {
        if (part.kind != Part::point)
          see([&](const Point<dim> &p, double) { return part.holds(p) ? 1. : 0.; },
              false,
              // What enters in a region does so at its nodes, in more or less of it.
              part.kind == Part::region || holds_values(part.id) ? Jumps::matter :
                                                                   Jumps::do_not_matter,
              side_of(part.id));
      }

      /** A formula of a condition on a side or part. It may jump on sides that a crack reaches. */
      void see_condition(const types::boundary_id id, const Expression &formula, const Jumps jumps)
      {
        const unsigned int side = side_of(id);
        if (side == nowhere && body != nullptr && id < first_part_id)
          return see_on_given_side(id, formula);
        see(formula, meets_crack(side) ? Jumps::do_not_matter : jumps, side);
      }

    private:
      /** A side that is none of the box around the body. */
      void see_on_given_side(const types::boundary_id id, const Expression &formula)
      {
        if (!formula.depends_on_position())
          return;
        static constexpr double parts_of_time[] = {0., 0.31, 0.67, 1.};
        for (const double part : parts_of_time)
          if (part == 0. || (formula.depends_on_time() && !scene.time.steady))
            found.fineness =
              std::max(found.fineness, body->fineness_on_side(id, [&](const Point<dim> &p) {
                return formula.value(p, part * scene.time.end_time);
              }));
      }

      unsigned int side_of(const types::boundary_id id) const
      {
        const Domain<dim> &domain    = scene.domain;
        const bool         box_sides = domain.has_lattice() || domain.holes.fitted();
        for (const Part &part : scene.boundary_conditions.parts)
          if (part.id == id)
            return part.kind == Part::of_side && part.side < 2 * dim && box_sides ? part.side :
                                                                                    nowhere;
        return id < 2 * dim && box_sides ? id : nowhere;
      }

      bool meets_crack(const unsigned int side) const
      {
        if (side == nowhere)
          return false;
        const unsigned int d     = side / 2;
        const double       place = side % 2 == 0 ? scene.domain.lower[d] : scene.domain.upper[d];
        const double       slack = 1e-6 * (scene.domain.upper[d] - scene.domain.lower[d]);
        const auto         lies_lower = [&](const auto &a, const auto &b) { return a[d] < b[d]; };
        for (const auto &crack : cracked_box(scene).cracks)
          {
            const auto [low, high] = std::minmax_element(crack.begin(), crack.end(), lies_lower);
            if ((*low)[d] < place + slack && (*high)[d] > place - slack)
              return true;
          }
        return false;
      }

      bool holds_values(const types::boundary_id id) const
      {
        return find_condition(scene.boundary_conditions.dirichlet, id) != nullptr ||
               find_condition(scene.boundary_conditions.displacement, id) != nullptr;
      }

      void see_at(const double       t,
                  const Function    &function,
                  const Jumps        jumps,
                  const unsigned int side)
      {
        const bool on_side = side < 2 * dim;
        double     longest = 0.;
        for (unsigned int d = 0; d < dim; ++d)
          longest = std::max(longest, scene.domain.upper[d] - scene.domain.lower[d]);
        std::vector<double> edges;
        for (unsigned int d = 0; d < dim; ++d)
          if (!on_side || d != side / 2)
            edges.push_back((scene.domain.upper[d] - scene.domain.lower[d]) / longest);
        if (edges.empty())
          return;
        const Raster raster(finest_raster<dim>(on_side), edges, [&](const double *x) {
          Point<dim> p;
          for (unsigned int d = 0, k = 0; d < dim; ++d)
            {
              const double s = on_side && d == side / 2 ? side % 2 : x[k++];
              p[d]           = (1. - s) * scene.domain.lower[d] + s * scene.domain.upper[d];
            }
          return body == nullptr || body->contains(p) ? function(p, t) :
                                                        std::numeric_limits<double>::quiet_NaN();
        });
        const double fineness = raster.fineness_needed(Raster::all);
        found.fineness        = std::max(found.fineness, fineness);
        for (unsigned int d = 0; by_direction && d < dim; ++d)
          fineness_along[d] =
            std::max(fineness_along[d], on_side ? fineness : raster.fineness_needed(d));
        found.jumps = found.jumps || (jumps == Jumps::matter && raster.jumps());
      }

      const GivenBody<dim> *const body; // null: a box
      const Scene<dim>           &scene;
      const bool                  by_direction;
      NeedsOfFormulas             found;
      std::vector<double>         fineness_along;
    };


    template <int dim>
    void see_body(const Scene<dim> &scene, FormulaScan<dim> &scan, const bool materials_on_lines)
    {
      using Jumps                      = typename FormulaScan<dim>::Jumps;
      const InitialAndSource &in_body  = scene.initial_and_source;
      const Material         &material = scene.material;
      const Jumps of_material          = materials_on_lines ? Jumps::do_not_matter : Jumps::matter;
      scan.see(in_body.source, Jumps::do_not_matter);
      if (scene.deforms ? !scene.elasticity.is_static() : !scene.time.steady)
        scan.see(material.density, of_material);
      if (!scene.deforms && !scene.time.steady)
        scan.see(material.heat_capacity, of_material);
      if (!scene.time.steady)
        scan.see(in_body.initial_value, Jumps::matter);
      for (const Expression &formula : in_body.body_force)
        scan.see(formula, Jumps::do_not_matter);
      for (const auto *const list : {&in_body.initial_displacement, &in_body.initial_velocity})
        for (const Expression &formula : *list)
          scan.see(formula, Jumps::matter);
      if (!scene.deforms || scene.elasticity.computes_temperature)
        scan.see(material.conductivity, of_material);
      if (!scene.deforms)
        return;
      if (!material.thermal_expansion.is_constant())
        scan.see(
          [&](const Point<dim> &p, double) {
            return material.thermal_expansion.value(p,
                                                    scene.elasticity.reference_temperature +
                                                      scene.elasticity.temperature_change.value(p));
          },
          false,
          of_material);
      scan.see(scene.elasticity.temperature_change, Jumps::matter);
      if (!material.uniform_moduli())
        for (const auto modulus : {&Moduli::bulk, &Moduli::shear})
          scan.see([&](const Point<dim> &p, double) { return scene.moduli(p).*modulus; },
                   false,
                   of_material);
    }


    template <int dim>
    void see_conditions(const Scene<dim> &scene, FormulaScan<dim> &scan)
    {
      using Jumps                          = typename FormulaScan<dim>::Jumps;
      const BoundaryConditions<dim> &given = scene.boundary_conditions;
      for (const Part &part : given.parts)
        scan.see(part);
      for (const SideCondition &condition : given.dirichlet)
        scan.see_condition(condition.id, condition.value, Jumps::matter);
      for (const SurfaceTransfer &transfer : given.transfers)
        for (const Expression *const formula :
             {&transfer.flux, &transfer.coefficient, &transfer.ambient})
          scan.see_condition(transfer.id, *formula, Jumps::do_not_matter);
      for (const auto *const list : {&given.displacement, &given.traction})
        for (const VectorCondition &condition : *list)
          for (const auto &value : condition.values)
            if (value)
              scan.see_condition(condition.id,
                                 *value,
                                 list == &given.displacement ? Jumps::matter :
                                                               Jumps::do_not_matter);
    }


    template <int dim>
    FormulaScan<dim> scan_of(const BodyOfChoice<dim> &body,
                             const bool               by_direction,
                             const bool               materials_on_lines)
    {
      const DeferredFormulaErrors ignored; // they are told where the values are used
      FormulaScan<dim>            scan(body, by_direction);
      see_body(*body.scene, scan, materials_on_lines);
      see_conditions(*body.scene, scan);
      return scan;
    }
  } // namespace


  template <int dim>
  NeedsOfFormulas needs_of_formulas(const BodyOfChoice<dim> &body, const bool materials_on_lines)
  {
    const Scene<dim>      &scene = *body.scene;
    const SidePoints<dim> &sides = body.sides;
    NeedsOfFormulas        needs = scan_of(body, false, materials_on_lines).needs();
    needs.fineness               = std::max(needs.fineness, fineness_of_first_layer(scene, sides));
    needs.jumps                  = needs.jumps || given_values_disagree(scene, sides);
    return needs;
  }


  template <int dim>
  std::vector<double> needs_along_edges(const BodyOfChoice<dim> &body)
  {
    std::vector<double> along = scan_of(body, true, false).along_edges();
    for (double &fineness : along)
      fineness = std::max(fineness, fineness_of_first_layer(*body.scene, body.sides));
    return along;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(needs_of_formulas);
  PERIDEAL_INSTANTIATE_FUNCTION(needs_along_edges);
} // namespace PeriDeal
