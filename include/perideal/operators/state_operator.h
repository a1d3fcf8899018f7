// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/bond_state.h>
#include <perideal/bonds/families.h>
#include <perideal/laws/elasticity.h>
#include <perideal/mesh/cell_corners.h>
#include <perideal/mesh/lattice_sites.h>
#include <perideal/operators/displacement_conditions.h>
#include <perideal/operators/elastic_operator.h>
#include <perideal/operators/fictitious_bonds.h>
#include <perideal/operators/surface_factors.h>
#include <perideal/operators/traction_layer.h>

#include <memory>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /** At the nodes, for output: xx, yy, xy in 2D, xx, yy, zz, xy, xz, yz in 3D. */
  template <int dim>
  struct NodalTensors
  {
    std::vector<dealii::SymmetricTensor<2, dim>> stress, strain;
  };


  template <int dim>
  class StateLattice;


  /**
   * Linear peridynamic solid (Silling 2007; in 2D Le 2014 section 2 in the corrected form of
   * doc/elasticity.md), and the bond-based solid as the same without dilatation. With xi the bond,
   * x its length, M = xi/x, the extension e = M . (u_j - u_i) - s x, s the mean thermal strain of
   * both ends, and W_ij = V_i V_j omega f (f the volume fraction) over unbroken bonds:
   *
   *   q_i = sum_j W_ij x^2 / V_i,  theta_i = d sum_j W_ij x e_ij / (V_i q_i)
   *   F_i = sum_j W_ij [ (c_i theta_i/q_i + c_j theta_j/q_j) x + (b_i/q_i + b_j/q_j) e_ij ] M
   *
   * with d, c, b the factors dilatation, volumetric and extension of StateLaw. The prefactor of
   * omega drops out. `Surface correction` multiplies W by a bond's factor a in theta and in the
   * forces from it, by s in those of e, and changes q (surface_factors.h), or lets families go on
   * beyond the sides (FictitiousBonds). An application takes two passes over the bonds, the
   * dilatations first. On a lattice in 2D and 3D, with linear kinematics, where nothing breaks and
   * no surface is corrected, nodes without cut bonds store none (StateLattice). Other bonds are
   * stored at both ends: W xi, one number, a column.
   *
   * With full kinematics Y = xi + u_j - u_i, e = |Y| - x - s x, and the force acts along Y/|Y|; a
   * rotation makes none. q is that of the undeformed body. The tangent of linearize() has W x Y/|Y|
   * in the place of W xi, and across the bond the stiffness force/|Y|.
   *
   * Bonds break for good at a stretch e/x of the smaller critical value s of both ends' materials.
   * It is given, or follows from the fracture energy: what crosses a plane of the lattice, mean
   * over the axes n, has stored, at this stretch while all else is at rest, s^2 (b B + c d D) with
   *   B = 1/q sum over half the family of omega f V xi_n x^2,
   *   D = h_n sum over the layers on one side of (1/q sum over what crosses of omega f V x^2)^2.
   * q stays that of the body before. Viscosity (Le 2014 eq 2.43) is K without the dilatations.
   */
  template <int dim>
  class StateOperator : public ElasticOperator
  {
  public:
    /** Adds the halo to the nodes. Collective. Throws UserError, among others: isolated nodes. */
    StateOperator(Nodes<dim> &nodes, const Scene<dim> &scene);
    ~StateOperator() override;

    void                initialize_vector(Vector &vector) const override;
    void                apply(Vector &y, const Vector &x) const override;
    void                residual(Vector &r, const Vector &u, const double t) const override;
    void                distribute(Vector &u, const double t) const override;
    void                distribute_homogeneous(Vector &x) const override;
    void                clear_constrained(Vector &y) const override;
    const Vector       &lumped_capacity() const override;
    const Vector       &diagonal() const override;
    Spectrum            spectrum() const override;
    bool                depends_on_time() const override;
    bool                has_steady_state() const override;
    void                surrogate(dealii::TrilinosWrappers::SparseMatrix &matrix) const override;
    bool                surrogate_is_exact() const override;
    std::vector<Vector> near_null_space() const override;
    std::string         place_of(const unsigned int local_index) const override;
    OperatorSize        size() const override;
    unsigned int        n_components() const override;
    ForceBalance        forces(const Vector &u, const double t) const override;
    double              energy(const Vector &u) const override;
    void                multiply(Vector &y, const Vector &x) const override;
    void                unbalanced(Vector &r, const Vector &u, const double t) const override;
    void                mechanical_loads(Vector &loads, const double t) const override;
    void                initialize_nodal_vector(Vector &vector) const override;
    void                set_temperature_change(const Vector &nodal) override;
    void                damping_force(Vector &y, const Vector &v) const override;
    double              damping_bound() const override;
    bool                nonlinear() const override;
    void                linearize(const Vector &u) override;
    double              largest_stretch(const Vector &u) const override;
    Inversion           inverted(const Vector &u) const override;
    bool                brittle() const override;
    unsigned long long  break_bonds(const Vector &u, double t, double share = 0.) override;
    void                exchange(Archive &archive, const NodeKeys &keys) override;
    double              released_energy() const override;
    unsigned long long  n_broken_bonds() const override;

    const Families<dim> &families() const;

    /** K of multiply(); rows hold some (4m)^dim nodes (bond-based: (2m)^dim). Collective. */
    void matrix(dealii::TrilinosWrappers::SparseMatrix &matrix) const;

    /** How many of this process's bonds are stored, each counted at both ends. */
    std::size_t n_stored_bonds() const;

    /** Of all processes, those that `moments` leaves as they are; and SurfaceFactors::gap. */
    unsigned long long n_uncorrected_nodes() const;
    double             gap_of_moments() const;

    /** Of the owned nodes and their ghosts; empty where bonds do not break. */
    const std::vector<double> &critical_stretches() const;

    /**
     * 1 - the volume of neighbours over unbroken bonds over that of the whole family, at the owned
     * nodes; bonds that cracks of the scene cut count as broken, those that voids cut as none.
     */
    std::vector<double> damage() const;

    /** theta, thermal extension taken off. Collective. */
    void dilatations(const Vector &u, std::vector<double> &theta) const;

    /**
     * The collapsed stress of the owned nodes, sum_j t_ij M (x) xi V_j (Le 2014 eq 1.26), or the
     * mean with that of the bonds' other ends (eq 3.1) where there are several phases, and the
     * strain of the nonlocal deformation gradient F (eq 1.25). With full kinematics Cauchy's
     * stress, sum t_ij M (x) Y V_j/det F, and Green's strain, (F^T F - I)/2. Collective.
     */
    NodalTensors<dim> tensors(const Vector &u) const;

  protected:
    void fill_noise(Vector &vector) const override;

  private:
    struct NodeLaw
    {
      StateLaw law;
      double   thermal; // strain
    };

    /** A bond of a node, as it is stored. */
    struct Bond
    {
      unsigned int           neighbor;
      dealii::Tensor<1, dim> moment;         // W xi, of the tangent W x Y/|Y|
      double                 spring, length; // length: W x, with full kinematics
      bool                   whole;
    };

    /** A bond of a complete family, with volumes of 1. */
    struct LatticeBond
    {
      typename Lattice<dim>::Index offset;
      dealii::Tensor<1, dim>       moment; // w xi
      double                       weight; // w x^2
    };

    /** Visit the bonds of an owned node, broken or not, stored or not, in its family's order. */
    template <typename Visit>
    void for_each_bond(const unsigned int i, const Visit &visit) const;

    /** The same of a node that stores none, those of the list. */
    template <typename Visit>
    void for_each_lattice_bond(const unsigned int              i,
                               const std::vector<LatticeBond> &list,
                               const Visit                    &visit) const;

    void     complete_families();
    void     find_laws();
    bool     may_leave_out_bonds() const;
    bool     has_complete_family(const unsigned int i) const; // cut or not
    double   complete_weighted() const;                       // q of one that is not cut
    void     find_bonds();
    void     store_bonds(const unsigned int                                 i,
                         const std::vector<typename Families<dim>::Member> &family,
                         std::string                                       &message);
    void     find_springs();
    void     correct_surface();
    void     make_lattice();
    StateLaw reference_law() const;
    void     find_thermal_loads();
    void     find_critical_stretches();
    void     find_overstretched(const Vector &u, const double share);
    void     find_what_is_beside_loads();
    void     keep_places(); // of what is overstretched
    void     find_diagonal();
    void     find_loads(Vector &loads, const double t) const;
    template <typename Visit>
    void for_each_load(const double t, const Visit &visit) const;
    void find_dilatation_forces(const Vector &x) const;
    void sum_forces(Vector &y, const Vector &x) const;
    void add_geometric_forces(Vector &y, const Vector &x) const;
    void find_strained_dilatation_forces(const Vector &u) const;
    void sum_deformed_forces(Vector &y, const Vector &u) const;
    void find_forces(Vector &y, const Vector &u) const;

    void         add_images_to_dilatations(const Vector &u, const bool strained) const; // to tau
    void         add_strained_image_forces(Vector &y, const Vector &u) const;
    void         add_geometric_image_forces(Vector &y, const Vector &x) const;
    void         linearize_images(const Vector &u);
    double       energy_of_images(const Vector &u) const;
    void         add_images_to_diagonal(const std::vector<double> &factor);
    Vector       rows_of_images(const bool with_dilatations) const;
    void         find_overstretched_images(const double *u);
    unsigned int break_images(const double t); // ends of bonds

    bool holds(const CellCorner<dim> &corner) const; // no bond of its node has broken
    dealii::Tensor<1, dim> deformed_bond(const double *u, unsigned int i, unsigned int j) const;

    /** W x e of a bond of an owned node, thermal extension taken off. */
    double extension_moment(const double *u, const unsigned int i, const Bond &bond) const
    {
      if (full || any_thermal)
        return strained_extension_moment(u, i, bond);
      double product = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        product += bond.moment[d] * (u[dim * bond.neighbor + d] - u[dim * i + d]);
      return product;
    }

    Bond stored_bond(const std::size_t k) const
    {
      return {neighbors[k], moments[k], springs[k], full ? lengths[k] : 0., state.is_whole(k)};
    }

    double strained_extension_moment(const double *u, const unsigned int i, const Bond &bond) const;
    void   release(const std::size_t stored_bond); // bears nothing any more

    const Scene<dim>                                          &scene;
    Families<dim>                                              bonds;
    std::shared_ptr<const dealii::Utilities::MPI::Partitioner> unknowns;
    std::unique_ptr<DisplacementConditions<dim>>               conditions;
    std::vector<NodeLaw>                                       laws;     // owned and ghosts
    Vector                                                     weighted; // q_i; ghosts up to date
    std::unique_ptr<FictitiousBonds<dim>>                      beyond;   // or none
    std::unique_ptr<StateLattice<dim>>                         lattice;  // or none
    std::vector<bool>                   on_lattice; // owned nodes that store no bond
    std::vector<LatticeBond>            lattice_bonds;
    std::vector<unsigned int>           stored_nodes; // the others
    std::vector<std::size_t>            starts{0};    // of the stored bonds of each owned node
    std::vector<unsigned int>           neighbors;
    std::vector<dealii::Tensor<1, dim>> moments; // W xi, of the tangent W x Y/|Y|
    std::vector<double>                 springs; // (b_i/q_i + b_j/q_j)/(W x^2)
    BondState                           state;   // of the stored bonds, where bonds may break
    std::vector<double> lengths, across; // full kinematics: W x; tangent's stiffness across bonds
    bool   full = false, volumetric = false, any_thermal = false, several_phases = false;
    double n_bonds = 0., released = 0., moments_gap = 0.;
    unsigned long long              n_broken = 0, n_not_corrected = 0;
    std::vector<TractionShare<dim>> tractions;
    std::vector<double>       critical; // stretch, of owned nodes and ghosts; empty: nothing breaks
    std::vector<unsigned int> loaded_side; // which in `Traction` is within a horizon of these
    std::vector<std::pair<std::size_t, double>> breaking, breaking_images; // place, overstretch
    bool           breaks = false, loads_vary = false; // some bond may break, on any process
    Vector         mass, stiffness_diagonal, thermal_loads, constant_loads;
    mutable Vector scratch, source, tau;          // tau_i = c_i theta_i/q_i
    mutable std::vector<CellCorner<dim>> corners; // once they have been asked for
  };


  template <int dim>
  template <typename Visit>
  inline void StateOperator<dim>::for_each_bond(const unsigned int i, const Visit &visit) const
  {
    if (on_lattice.empty() || !on_lattice[i])
      {
        for (std::size_t k = starts[i]; k < starts[i + 1]; ++k)
          visit(stored_bond(k));
        return;
      }
    for_each_lattice_bond(i, lattice_bonds, visit);
  }

  template <int dim>
  template <typename Visit>
  inline void StateOperator<dim>::for_each_lattice_bond(const unsigned int              i,
                                                        const std::vector<LatticeBond> &list,
                                                        const Visit                    &visit) const
  {
    const Nodes<dim> &nodes  = bonds.nodes();
    const auto        site   = nodes.lattice()->index(nodes.position(i));
    const double      volume = nodes.volume(i);
    const double      own    = laws[i].law.extension / weighted.local_element(i);
    for (const LatticeBond &bond : list)
      {
        const unsigned int j = bonds.neighbors().node_at(site + bond.offset);
        if (j == dealii::numbers::invalid_unsigned_int)
          continue;
        const double w     = volume * nodes.volume(j),
                     other = laws[j].law.extension / weighted.local_element(j);
        visit(Bond{j, w * bond.moment, (own + other) / (w * bond.weight), 0., true});
      }
  }
} // namespace PeriDeal
