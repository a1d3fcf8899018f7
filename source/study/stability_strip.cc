// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/user_error.h>
#include <perideal/bonds/kernel_weights.h>
#include <perideal/output/tables.h>
#include <perideal/problems/diffusion_problem.h>

#include <algorithm>
#include <cmath>

#include "stability_map.h"
#include "stability_scene.h"

namespace PeriDeal
{
  namespace
  {
    using Value = StabilityPoint::Value;

    /** Bonds of a lattice of unit spacing. */
    struct LatticeBonds
    {
      std::string  kernel, fraction, calibration;
      unsigned int exponent = 0;
      double       ratio    = 0.;

      std::vector<Setting> settings() const
      {
        return {{"Peridynamics/Kernel", kernel},
                {"Peridynamics/Kernel exponent", std::to_string(exponent)},
                {"Peridynamics/Horizon ratio", full_precision(ratio)},
                {"Peridynamics/Volume fraction", fraction},
                {"Peridynamics/Calibration", calibration}};
      }

      template <int dim>
      KernelWeights<dim> weights() const
      {
        dealii::Tensor<1, dim> spacing;
        for (unsigned int d = 0; d < dim; ++d)
          spacing[d] = 1.;
        return KernelWeights<dim>(
          {kernel == "constant" ? KernelShape::constant :
           kernel == "conical"  ? KernelShape::conical :
                                  KernelShape::gaussian,
           exponent,
           fraction == "none"   ? VolumeFraction::none :
           fraction == "linear" ? VolumeFraction::linear :
                                  VolumeFraction::exact,
           calibration == "discrete" ? Calibration::discrete : Calibration::analytic,
           SelfTerm::none,
           ratio},
          spacing,
          1.);
      }
    };


    LatticeBonds bonds_of(const StabilityFacts &facts, const double ratio)
    {
      return {facts.kernel, facts.fraction, facts.calibration, facts.kernel_exponent, ratio};
    }


    /** Of a random point, away from the bound by a tenth of it, on which nothing can be told. */
    bool lies(const double error, const bool inside, const double bound)
    {
      return inside ? error < 0.9 * bound : error > 1.1 * bound;
    }


    /**
     * Heat through a strip of unit cells from its left end at 1 to its right end at 0, over what it
     * should be, minus one.
     */
    double conduction_error(const StabilityScene            &scene,
                            const LatticeBonds              &bonds,
                            const std::vector<unsigned int> &cells,
                            const std::vector<Setting>      &more)
    {
      std::string lower, upper;
      double      area = 1.;
      for (unsigned int d = 0; d < cells.size(); ++d)
        {
          lower += d == 0 ? "0" : ", 0";
          upper += (d == 0 ? "" : ", ") + std::to_string(cells[d]);
          area *= d == 0 ? 1. : cells[d];
        }
      std::vector<Setting> settings = bonds.settings();
      settings.insert(settings.end(),
                      {{"Domain/Lower corner", lower},
                       {"Domain/Upper corner", upper},
                       {"Domain/Cells", to_text(cells)},
                       {"Boundary conditions/Dirichlet", "left: 1; right: 0"},
                       {"Time/Steady", "true"}});
      settings.insert(settings.end(), more.begin(), more.end());
      double heat = 0.;
      scene.with_body(ModelKind::peridynamics, settings, [&](auto &problem, const auto &parsed) {
        constexpr int dim  = std::decay_t<decltype(parsed.domain.lower)>::dimension;
        auto         &body = dynamic_cast<DiffusionProblem<dim> &>(problem);
        body.solve();
        heat = body.op().balance(body.solution, 0., true).sides.at("left");
      });
      return heat * cells[0] / area - 1.;
    }


    /** The strip as wide as families between mirrors: what bonds conduct of a linear field. */
    class ConductionMap : public StabilityMap
    {
    public:
      explicit ConductionMap(const StabilityScene &scene)
        : scene(scene)
      {}

      std::string meaning_of_predicted() const override
      {
        return "by how much complete families conduct too much (or too little), from their sum";
      }

      std::string meaning_of_observed() const override
      {
        return "by how much more heat than it should flows through a strip between mirrors";
      }

      std::string bound() const override
      {
        return "'safe' where the heat is right to 0.5 %; beyond, a run says so in a note ('warned')";
      }

      std::string obstacle() const override
      {
        return scene.no_diffusion_with(ModelKind::peridynamics);
      }

      std::vector<StabilityPoint> points(const bool quick) override
      {
        std::vector<StabilityPoint> list;
        for (const std::string &calibration : calibrations)
          for (const std::string &fraction : fractions)
            for (const std::string &kernel :
                 quick ? std::vector<std::string>{scene.facts.kernel} : kernels)
              for (const unsigned int exponent :
                   quick ? std::vector<unsigned int>{scene.facts.kernel_exponent} : exponents)
                for (const double ratio : ratios(quick))
                  {
                    const LatticeBonds bonds{kernel, fraction, calibration, exponent, ratio};
                    try
                      {
                        list.push_back(point(bonds));
                      }
                    catch (const UserError &error)
                      {
                        left_out.push_back(mistake_in_overrides(error));
                      }
                  }
        return list;
      }

      std::optional<StabilityPoint> random_point(const bool inside, std::mt19937 &random) override
      {
        for (unsigned int n_trials = 0; n_trials < 1000; ++n_trials)
          {
            const LatticeBonds bonds{any_of_list(random, kernels),
                                     any_of_list(random, fractions),
                                     any_of_list(random, calibrations),
                                     any_of_list(random, exponents),
                                     uniform(random, 1.6, largest_ratio())};
            if (lies(std::abs(predicted(bonds)), inside, tolerable_conductivity_error))
              return point(bonds);
          }
        return {};
      }

    private:
      double largest_ratio() const
      {
        return scene.facts.dim == 3 ? 3. : 6.;
      }

      std::vector<double> ratios(const bool quick) const
      {
        return scene.facts.dim == 3 ? std::vector<double>{2., 2.5, 3.} :
               quick                ? std::vector<double>{2., 3., 6.} :
                                      std::vector<double>{2., 2.5, 3., 3.5, 4., 5., 6.};
      }

      double predicted(const LatticeBonds &bonds) const
      {
        double result = 0.;
        with_dimension(scene.facts.dim, [&](const auto d) {
          result = bonds.template weights<decltype(d)::value>().effective_conductivity() - 1.;
        });
        return result;
      }

      StabilityPoint point(const LatticeBonds &bonds) const
      {
        const unsigned int dim = scene.facts.dim, length = dim == 3 ? 8 : 12, width = 8;
        StabilityPoint     point;
        point.parameters = {{"m", bonds.ratio},
                            {"kernel", bonds.kernel},
                            {"kernel exponent", bonds.exponent},
                            {"volume fraction", bonds.fraction},
                            {"calibration", bonds.calibration}};
        point.predicted  = predicted(bonds);
        std::vector<Setting> more{{"Peridynamics/Boundary treatment", "fictitious mirror"}};
        if (dim > 1)
          more.emplace_back("Boundary conditions/Symmetry",
                            dim == 2 ? "bottom, top" : "bottom, top, back, front");
        std::vector<unsigned int> cells(dim, width);
        cells[0]       = length;
        point.observed = conduction_error(scene, bonds, cells, more);
        point.verdict  = std::abs(point.observed) <= tolerable_conductivity_error ? "safe" :
                         std::abs(point.predicted) > tolerable_conductivity_error ? "warned" :
                                                                                    "fails";
        return point;
      }

      const StabilityScene           &scene;
      const std::vector<std::string>  kernels      = {"constant", "conical", "gaussian"};
      const std::vector<std::string>  fractions    = {"none", "linear", "exact"};
      const std::vector<std::string>  calibrations = {"discrete", "analytic"};
      const std::vector<unsigned int> exponents    = {0, 1, 2};
    };


    /** The strip with free sides: what is missing there. */
    class SurfaceMap : public StabilityMap
    {
    public:
      explicit SurfaceMap(const StabilityScene &scene)
        : scene(scene)
      {}

      std::string meaning_of_predicted() const override
      {
        return "the share of the width of a strip that its free sides seem to lack, from the families cut there; 0 for treatments that cut none";
      }

      std::string meaning_of_observed() const override
      {
        return "the share of the heat through the strip that is missing (or too much), either sign";
      }

      std::string bound() const override
      {
        return "'safe' where the heat is right to 0.5 %; beyond, a run says so in a note ('warned')";
      }

      std::string obstacle() const override
      {
        if (scene.facts.dim != 2)
          return "it is of plane bodies";
        return scene.no_diffusion_with(ModelKind::peridynamics);
      }

      std::vector<StabilityPoint> points(const bool quick) override
      {
        std::vector<StabilityPoint> list;
        for (const Treatment &treatment : treatments)
          for (const unsigned int width : quick ?
                                            std::vector<unsigned int>{20, 200} :
                                            std::vector<unsigned int>{10, 20, 50, 100, 200, 400})
            for (const double ratio :
                 quick ? std::vector<double>{2., 4.} : std::vector<double>{2., 2.5, 3., 4., 5., 6.})
              try
                {
                  list.push_back(point(treatment, bonds_of(scene.facts, ratio), width));
                }
              catch (const UserError &error)
                {
                  left_out.push_back(treatment.name + ", m = " + Value(ratio).dump() + ": " +
                                     mistake_in_overrides(error));
                }
        return list;
      }

      std::optional<StabilityPoint> random_point(const bool inside, std::mt19937 &random) override
      {
        for (unsigned int n_trials = 0; n_trials < 1000; ++n_trials)
          {
            const Treatment   &treatment = any_of_list(random, treatments);
            const LatticeBonds bonds     = bonds_of(scene.facts, uniform(random, 1.6, 5.));
            const auto         width =
              static_cast<unsigned int>(std::exp(uniform(random, std::log(8.), std::log(400.))));
            if (lies(predicted(treatment, bonds, width), inside, tolerable_missing_share))
              return point(treatment, bonds, width);
          }
        return {};
      }

    private:
      struct Treatment
      {
        std::string          name;
        bool                 cuts; // families at free sides, and nothing makes up for it
        std::vector<Setting> settings;
      };

      double predicted(const Treatment    &treatment,
                       const LatticeBonds &bonds,
                       const unsigned int  width) const
      {
        if (!treatment.cuts)
          return 0.;
        const double first_row = scene.facts.nodes == "vertices" ? 0.5 : 1.;
        return 2. * missing_width<2>(bonds.weights<2>().members(), 1, first_row) / width;
      }

      StabilityPoint point(const Treatment    &treatment,
                           const LatticeBonds &bonds,
                           const unsigned int  width) const
      {
        constexpr unsigned int length = 12;
        StabilityPoint         point;
        point.parameters = {{"treatment", treatment.name},
                            {"m", bonds.ratio},
                            {"cells across", width}};
        point.predicted  = predicted(treatment, bonds, width);
        point.observed =
          std::abs(conduction_error(scene, bonds, {length, width}, treatment.settings));
        point.verdict = point.observed <= tolerable_missing_share ? "safe" :
                        point.predicted > tolerable_missing_share ? "warned" :
                                                                    "fails";
        return point;
      }

      static constexpr auto        entry = "Peridynamics/Boundary treatment";
      const StabilityScene        &scene;
      const std::vector<Treatment> treatments = {
        {"fictitious mirror", true, {{entry, "fictitious mirror"}}},
        {"fictitious mirror, symmetry",
         false,
         {{entry, "fictitious mirror"}, {"Boundary conditions/Symmetry", "bottom, top"}}},
        {"fictitious mirror, energy",
         false,
         {{entry, "fictitious mirror"}, {"Peridynamics/Surface correction", "energy"}}},
        {"exchange", false, {{entry, "exchange"}, {"Domain/Nodes", "vertices"}}}};
    };
  } // namespace


  std::unique_ptr<StabilityMap> make_conduction_map(const StabilityScene &scene)
  {
    return std::make_unique<ConductionMap>(scene);
  }


  std::unique_ptr<StabilityMap> make_surface_map(const StabilityScene &scene)
  {
    return std::make_unique<SurfaceMap>(scene);
  }
} // namespace PeriDeal
