// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/scene/lists.h>
#include <perideal/scene/models.h>

namespace PeriDeal
{
  Peridynamics::Peridynamics()
    : SceneSection("Peridynamics")
  {
    declare(horizon_ratio, "Horizon ratio", "3", "1", Bounds::one_or_more) =
      "m, the horizon divided by the (smallest) node spacing; at least 1. 3 is usual, larger values "
      "cost more and sample the kernel better.";
    declare_if_given(horizon, "Horizon", "", "length", Bounds::length) =
      "The horizon as a length, instead of Horizon ratio.";
    declare(kernel, "Kernel", "conical", {"constant", "conical", "gaussian"}) =
      "Shape k(r) of the micro-conductivity within the horizon delta: 1, 1 - r/delta, or "
      "exp(-(2 r/delta)^2).";
    declare("Kernel exponent", EntryType::text, "auto", "1") =
      "n of the pair law k(r)/r^n: 0, 1 or 2. `auto` is 2, and 0 with `Physics = elasticity`, where bonds of equal weight keep the moduli best, but 1 with `Model = correspondence`.";
    declare(sampling.volume_fraction, "Volume fraction", "linear", {"none", "linear", "exact"}) =
      "Share of a neighbour's volume that counts: all of it for r <= delta (none); a linear ramp one spacing wide about r = delta; or the exact part of its lattice cell within the horizon.";
    declare("Calibration",
            EntryType::choice,
            "auto",
            "",
            {"auto", "discrete", "isotropic", "analytic"}) =
      "What makes a linear field conduct Conductivity times its gradient: the sum over a full family of the lattice (`discrete`, exact at any m), or the integral (`analytic`, low by 7 % at m = 3 in 2D). `isotropic`, on lattices: the sum, by factors that depend on the direction of a bond, with which "
      "solids have their moduli in all directions. `auto` is `isotropic` for solids on lattices whose bonds do not break, else `discrete`.";
    declare(sampling.self_term, "Self term", "none", {"none", "paper"}) =
      "The term of a node with itself as published by Bobaru and Duangpanya; inflates the conductivity.";
    declare(sampling.nodal_volume, "Nodal volume", "partial", {"partial", "full"}) =
      "Volume of nodes on the boundary: half a cell on an edge, a quarter at a corner, or full cells.";
    declare(form, "Operator form", "auto", {"auto", "lattice", "stored"}) =
      "How bonds are kept: computed from the lattice, stored one by one, or whichever suits.";
    declare(treatment,
            "Boundary treatment",
            "auto",
            {"auto", "exchange", "none", "layer", "fictitious mirror", "fictitious constant"}) =
      "What happens at the surface of the body. `exchange`: bonds in exchange for what finite elements conduct along them, with the rest "
      "left to the elements, so that a linear field is exact up to the surface and all conditions act as in finite elements. The others "
      "cut families off at the surface, and Dirichlet values act on the nodes of the side (`none`), on layers of nodes inside, or on "
      "fictitious nodes outside the body, mirrored (2 T* - T) or constant (T*). `auto`: exchange where it is possible (nodes on "
      "vertices, no slaves, self term or energy correction), else none, as for elasticity.";
    declare(layer_rows, "Layer rows", "1", Bounds::one_or_more) =
      "With 'layer': rows of nodes nearest to the side that carry the value.";
    declare(flux_treatment,
            "Flux treatment",
            "natural",
            {"natural", "extrapolation", "layer extrapolation"}) =
      "How a given Flux enters: as a source in the outermost row of nodes; by values of the side's "
      "nodes extrapolated from their families; or (1D) by values of all nodes within the horizon "
      "of the end.";
    declare(surface_correction,
            "Surface correction",
            "auto",
            {"none", "crack scaling", "energy", "moments", "fictitious nodes", "auto"}) =
      "What makes up for missing bonds. `auto`: for diffusion crack scaling beside insulated cracks that lie still, where it is the more accurate one for all models of the scene, else nothing; families of elastic peridynamics go on beyond planes of symmetry and all flat sides of a lattice, and beyond the whole boundary of a mesh from a file with nodes at vertices, at no more cost than their bonds; where bonds may break, in motion, and where a body without holes on a lattice is thin (a third as long as along another direction, or less, and 16 horizons at most), "
      "beyond free flat sides of a lattice in part, what they lack there and at its holes being made up for by the weights of their own bonds, and on meshes beyond sides with conditions, with such weights at all others; at rest on meshes beyond free sides in part, too, where the body behind them is thin (5 horizons, 3 at rims of round holes, and half of its extent at most). Factors of bonds: beside cracks only (`crack scaling`, for finite elements with "
      "`Mesh = pairs`, too); or wherever the energy of a unit gradient is not that of the classical body (`energy`), at sides, cracks and "
      "voids. Elasticity has `energy`, of stretches along the axes, and `moments`, the smallest change of bonds "
      "with which a uniform strain has its dilatation, stress and energy at each node whose bonds do not get negative factors by it; and `fictitious nodes` beyond flat sides, "
      "which continue the displacement linearly and complete the families inside.";
    declare(correction_direction, "Correction direction", "both", {"x", "y", "z", "both"}) =
      "With `energy`: the direction of the unit gradient. `both`: one factor for each direction of space, "
      "weighted with the squares of the bond's direction cosines.";
    declare(across_voids, "Bonds across voids", "auto", {"auto", "keep", "cut"}) =
      "Bonds whose straight way leaves the body, through a hole, a slit, a notch or an empty part of an image, on lattices and meshes: `cut` them, as `auto` does, "
      "or `keep` them, so that a void narrower than the horizon is no gap; `Boundary treatment = exchange` never has them.";
    parse();
  }


  void Peridynamics::parse(const Physics physics)
  {
    SceneSection::parse();
    refuse(horizon > 0. && is_given("Horizon ratio"),
           "Horizon",
           "'Horizon ratio' is given, too: give one of the two.");
    const std::string calibration = text("Calibration");
    sampling.calibration          = calibration == "isotropic" ? Calibration::isotropic :
                                    calibration == "analytic"  ? Calibration::analytic :
                                                                 Calibration::discrete;
    kernel_exponent               = physics == Physics::elasticity ? 0 : 2;
    if (const std::string &given = text("Kernel exponent"); given != "auto")
      {
        if (given != "0" && given != "1" && given != "2")
          error("Kernel exponent",
                "found " + given + ", needs 'auto' or a whole number: 0, 1 or 2.");
        kernel_exponent = given[0] - '0';
      }
    if (physics != Physics::elasticity &&
        (surface_correction == SurfaceCorrection::moments || completes_families()))
      error("Surface correction",
            "'" + text("Surface correction") +
              "' is for 'Physics = elasticity'; use 'none', 'crack scaling' or 'energy'.");
    const auto refuse_in_solids = [&](const bool         given,
                                      const std::string &entry,
                                      const std::string &remedy,
                                      const std::string &what = "has no effect") {
      refuse(physics == Physics::elasticity && given,
             entry,
             what + " with 'Physics = elasticity'; " + remedy);
    };
    refuse_in_solids(sampling.self_term != SelfTerm::none, "Self term", "use 'none'.");
    refuse_in_solids(!natural_fluxes(), "Flux treatment", "use 'natural'.");
    refuse_in_solids(correction_direction != CorrectionDirection::both,
                     "Correction direction",
                     "use 'both'.");
    // On square cells any factor cancels; on others the factors of `discrete` make theta exact
    // (doc/elasticity.md).
    refuse_in_solids(sampling.calibration == Calibration::analytic,
                     "Calibration",
                     "bonds are scaled by the sums over their own families. Leave the entry out.",
                     "'analytic' is not for use");
    refuse_in_solids(
      treatment != BoundaryTreatment::none && treatment != BoundaryTreatment::automatic,
      "Boundary treatment",
      "use 'none'; 'Surface correction' and 'Traction layer' are for the surfaces of elastic bodies.",
      treatment == BoundaryTreatment::exchange ?
        "'exchange' has no place for a nonlocal dilatation" :
        "fictitious nodes and layers are not defined");
  }


  FiniteElements::FiniteElements()
    : SceneSection("Finite elements")
  {
    declare(degree, "Degree", "1", Bounds::one_to_three) =
      "Polynomial degree of the elements: 1, 2 or 3.";
    declare("Capacity", EntryType::choice, "lumped", "", {"lumped", "consistent"}) =
      "Capacity matrix: diagonal by row sums, or as integrated (needs an implicit stepper).";
    parse();
  }


  void FiniteElements::parse(const Physics physics, const bool with_heat)
  {
    SceneSection::parse();
    consistent_capacity = text("Capacity") == "consistent";
    refuse(consistent_capacity && physics == Physics::elasticity && !with_heat,
           "Capacity",
           "'consistent' is for diffusion; masses are lumped with 'Physics = elasticity'.");
  }
} // namespace PeriDeal
