// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/laws/stress_law.h>
#include <perideal/scene/user_library.h>

#include <memory>
#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * A law of a shared library, with Abaqus' interface of a UMAT. Parameters: the three coordinates
   * of a point, and the number of its material in the list of them. State: strain, stress, energies
   * (elastic, plastic, by creep), work, of large deformations F - 1 and what is lost, then STATEV.
   *
   * Large deformations: of F F_0^-1 = V R (FiniteStep) R is DROT and ln V is DSTRAN; stress and
   * strain of the state are Cauchy's and the sum of these, turned by R before each call. DDSDDE is
   * that of Jaumann's rate of J sigma, over J (second_tangent()). The answer to StressLaw is S.
   *
   * Stored and dissipated are what the library gives, SSE and SPD + SCD, per volume that is
   * deformed. Where it gives one of them the other is the rest of the work (of the mean of the
   * stresses before and after each step), and where it gives none all work is stored. Under large
   * deformations, where that mean is less exact, SSE alone leaves nothing dissipated. Where strain
   * and time rest the accepted state stays, and the library is asked for its tangent alone.
   *
   * A tangent that is its own transpose but for 1e-6 of its largest entry, as differences leave it,
   * is made that; another one is taken as it is.
   *
   * Throws UserError, with the place, the strain and the increment, for what is no number, what was
   * written behind STRESS, STATEV or DDSDDE, PNEWDT < 1, and XIT.
   */
  class UserStress : public StressLaw
  {
  public:
    struct OfMaterial
    {
      std::string         name; // CMNAME
      std::vector<double> properties;
    };

    struct Numbers
    {
      unsigned int            n_states = 0;
      std::vector<OfMaterial> materials;
    };

    /**
     * @param dim of the body; in two dimensions @p kind tells plane strain from plane stress
     * @param is_full deformations are large: not in plane stress
     */
    UserStress(const std::shared_ptr<const UserLibrary> &library,
               const unsigned int                        dim,
               const StressState                         kind,
               const Numbers                            &numbers,
               const bool                                is_full = false);

    unsigned int n_parameters() const override
    {
      return 4;
    }

    unsigned int n_state() const override
    {
      return first_of_user() + numbers.n_states;
    }

    bool may_fail() const override
    {
      return true;
    }

    Response update(const Trial &trial, double *next, Tangent *tangent) const override;

    /** `state_1`, ... */
    std::vector<std::pair<std::string, unsigned int>> shown() const override;

  private:
    struct Call;

    /** Of the state. */
    unsigned int first_of_user() const
    {
      return 6 + 6 + 3 + 1 + (is_full ? 9 + 1 : 0);
    }

    const OfMaterial &material_of(const Trial &trial) const
    {
      return numbers.materials[static_cast<unsigned int>(trial.parameters[3] + 0.5)];
    }

    /** What is wrong with what a call has left, or nothing. */
    std::string fault_of(const Call &call, const bool with_tangent) const;

    /** Put what a call has left into the state. */
    void keep(const Call &call, const Trial &trial, double *next) const;

    /** Stored, and dissipated in the step. */
    void find_energies(Response &response, const Trial &trial, const double *next) const;

    /** DDSDDE. @param symmetric the mean with its transpose */
    Tangent tangent_of(const Call &call, const bool symmetric) const;

    [[noreturn]] void throw_fault(const std::string &fault,
                                  const Call        &call,
                                  const Trial       &trial) const;

    const std::shared_ptr<const UserLibrary> library;
    const unsigned int                       n_normal, n_shear;
    const Numbers                            numbers;
    const bool                               is_full;
  };
} // namespace PeriDeal
