// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/analysis/coupling_certificate.h>
#include <perideal/base/user_error.h>
#include <perideal/output/result_folder.h>
#include <perideal/output/tables.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "stability_map.h"
#include "stability_scene.h"

namespace PeriDeal
{
  namespace
  {
    /** Where there are bonds in the unit square. */
    struct ZoneShape
    {
      std::string name, formula;
    };

    struct CoupledSquare
    {
      std::string scheme;
      ZoneShape   zone;
      double      contrast = 1., distortion = 0.;
    };


    /**
     * The unit square of n x n cells as a file of Gmsh; every other vertex is moved up by a share
     * of an edge, the others down.
     */
    std::string mesh_text(const unsigned int n, const double share)
    {
      std::string text =
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" + std::to_string((n + 1) * (n + 1)) + "\n";
      const auto node = [n](const unsigned int i, const unsigned int j) {
        return std::to_string(j * (n + 1) + i + 1);
      };
      for (unsigned int j = 0; j <= n; ++j)
        for (unsigned int i = 0; i <= n; ++i)
          {
            const double moved = j == 0 || j == n ? 0. : (i + j) % 2 == 0 ? share : -share;
            text += node(i, j) + " " + full_precision(i / static_cast<double>(n)) + " " +
                    full_precision((j + moved) / n) + " 0\n";
          }
      unsigned int number = 0;
      text += "$EndNodes\n$Elements\n" + std::to_string(n * n + 2 * n) + "\n";
      for (unsigned int j = 0; j < n; ++j)
        {
          text += std::to_string(++number) + " 1 2 1 1 " + node(0, j) + " " + node(0, j + 1) + "\n";
          text += std::to_string(++number) + " 1 2 2 2 " + node(n, j) + " " + node(n, j + 1) + "\n";
        }
      for (unsigned int j = 0; j < n; ++j)
        for (unsigned int i = 0; i < n; ++i)
          text += std::to_string(++number) + " 3 2 9 9 " + node(i, j) + " " + node(i + 1, j) + " " +
                  node(i + 1, j + 1) + " " + node(i, j + 1) + "\n";
      return text + "$EndElements\n";
    }


    class EigenvalueMap : public StabilityMap
    {
    public:
      explicit EigenvalueMap(const StabilityScene &scene)
        : scene(scene)
      {}

      ~EigenvalueMap() override
      {
        if (is_first())
          std::remove(mesh_file().c_str());
      }

      std::string meaning_of_predicted() const override
      {
        return "the lowest eigenvalue of what bonds leave of a cell, in units of its conductivity: not below 0, no field grows; infinite where no cell is divided";
      }

      std::string meaning_of_observed() const override
      {
        return "the lowest eigenvalue of the whole body with its surface held, the rate of the slowest decay";
      }

      std::string bound() const override
      {
        return "'safe' where the certificate of the coupling finds no fault; with one, 'exchange' is refused, and of the others the user is told ('warned')";
      }

      std::string obstacle() const override
      {
        return scene.facts.dim == 2 || scene.facts.deforms ?
                 scene.no_diffusion_with(ModelKind::coupled) :
                 "it is of plane bodies";
      }

      std::vector<StabilityPoint> points(const bool quick) override
      {
        std::vector<StabilityPoint> list;
        for (const std::string &scheme : schemes)
          for (const ZoneShape &zone : quick ? std::vector<ZoneShape>{zones[0], zones[2]} : zones)
            for (const double contrast :
                 quick ? std::vector<double>{1., 1e4} : std::vector<double>{1., 1e2, 1e4, 1e6, 1e8})
              for (const double distortion :
                   scheme == "exchange" && !quick ?
                     std::vector<double>{0., 0.2, 0.4, 0.49, 0.499, 0.51} :
                   scheme == "exchange" ? std::vector<double>{0., 0.4, 0.51} :
                                          std::vector<double>{0.})
                {
                  const CoupledSquare square{scheme, zone, contrast, distortion};
                  write_mesh(square);
                  try
                    {
                      list.push_back(point(square));
                    }
                  catch (const UserError &error)
                    {
                      left_out.push_back(scheme + ", zone " + zone.name + ": " +
                                         mistake_in_overrides(error));
                    }
                }
        return list;
      }

      std::optional<StabilityPoint> random_point(const bool inside, std::mt19937 &random) override
      {
        CoupledSquare square;
        square.zone     = any_of_list(random, zones);
        square.contrast = std::pow(10., uniform(random, 0., 6.));
        square.scheme   = "exchange";
        // At 0.5 of an edge cells are triangles.
        square.distortion = inside ? uniform(random, 0., 0.45) : uniform(random, 0.5, 0.8);
        write_mesh(square);
        return point(square);
      }

    private:
      bool is_first() const
      {
        return dealii::Utilities::MPI::this_mpi_process(scene.communicator) == 0;
      }

      std::string mesh_file() const
      {
        return scene.folder + "/.stability_mesh.msh";
      }

      /**
       * Only distorted cells come from a file: bonds of a lattice are calibrated. An error is
       * everybody's, and no fault of the square. Collective.
       */
      void write_mesh(const CoupledSquare &square) const
      {
        if (square.distortion == 0.)
          return;
        std::string message;
        if (is_first())
          try
            {
              write_file(mesh_file(), mesh_text(n, square.distortion));
            }
          catch (const UserError &error)
            {
              message = error.message();
            }
        throw_on_all_if_any(scene.communicator, message);
      }

      std::vector<Setting> settings_of(const CoupledSquare &square) const
      {
        const double         ratio = std::clamp(scene.facts.ratio, 2., 4.);
        std::vector<Setting> settings{
          {"Material/Conductivity", "if(y < 0.5, 1, " + full_precision(square.contrast) + ")"},
          {"Peridynamics/Horizon", full_precision(ratio / n)},
          {"Coupling/Scheme", square.scheme},
          {"Coupling/Zone", square.zone.formula},
          {"Coupling/Certificate", "false"}, // which would end here
          {"Time/Steady", "true"}};
        if (square.distortion == 0.)
          {
            settings.insert(settings.end(),
                            {{"Domain/Lower corner", "0, 0"},
                             {"Domain/Upper corner", "1, 1"},
                             {"Domain/Cells", to_text({n, n})},
                             {"Boundary conditions/Dirichlet", "left: 1; right: 0"}});
            return settings;
          }
        settings.insert(settings.end(),
                        {{"Domain/Shape", "mesh file"},
                         {"Domain/Mesh file", mesh_file()},
                         {"Boundary conditions/Dirichlet", "1: 1; 2: 0"}});
        return settings;
      }

      /** The mesh of the square has been written. */
      StabilityPoint point(const CoupledSquare &square) const
      {
        StabilityPoint point;
        point.parameters = {{"scheme", square.scheme},
                            {"zone", square.zone.name},
                            {"contrast", square.contrast},
                            {"distortion", square.distortion}};
        CouplingCertificate certificate;
        try
          {
            scene.with_body(ModelKind::coupled,
                            settings_of(square),
                            [&](auto &problem, const auto &parsed) {
                              constexpr int dim =
                                std::decay_t<decltype(parsed.domain.lower)>::dimension;
                              const auto &op = dynamic_cast<const FEMOperator<dim> &>(problem.op());
                              certificate    = examine_coupling(op, op.symmetric());
                            });
          }
        catch (const UserError &error)
          {
            if (square.distortion < 0.5) // only cells that are inside out are part of the map
              throw;
            point.parameters.emplace_back("fault", mistake_in_overrides(error));
            point.predicted = -std::numeric_limits<double>::infinity();
            point.observed  = std::numeric_limits<double>::quiet_NaN();
            point.verdict   = "refused";
            return point;
          }
        point.predicted = certificate.lowest_remainder;
        point.observed  = certificate.lowest_eigenvalue;
        point.verdict   = certificate.fault().empty() ? (point.observed > 0. ? "safe" : "fails") :
                          square.scheme == "exchange" ? "refused" :
                                                        "warned";
        if (!certificate.fault().empty())
          point.parameters.emplace_back("fault", certificate.fault());
        return point;
      }

      static constexpr unsigned int  n = 16; // cells along an edge
      const StabilityScene          &scene;
      const std::vector<std::string> schemes = {"exchange", "splice", "blending"};
      const std::vector<ZoneShape>   zones   = {
            {"half", "0.5 - x"},
            {"disc", "0.3 - sqrt((x - 0.5)^2 + (y - 0.5)^2)"},
            {"L", "0.6 - max(x, y) + 0.4*(x < 0.3 || y < 0.3)"},
            {"two squares",
             "0.14 - min(max(abs(x - 0.3), abs(y - 0.3)), max(abs(x - 0.7), abs(y - 0.7)))"},
            {"ring", "0.1 - abs(sqrt((x - 0.5)^2 + (y - 0.5)^2) - 0.3)"}};
    };
  } // namespace


  std::unique_ptr<StabilityMap> make_eigenvalue_map(const StabilityScene &scene)
  {
    return std::make_unique<EigenvalueMap>(scene);
  }
} // namespace PeriDeal
