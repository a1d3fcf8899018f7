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
   * A law of a shared library, with Abaqus' interface of a UMAT for small strains. Parameters: the
   * three coordinates of a point, and the number of its material in the list of them. State:
   * strain, stress, energies (elastic, plastic, by creep), work, then STATEV.
   *
   * Stored and dissipated are what the library gives, SSE and SPD + SCD. Where it gives one of
   * them the other is the rest of the work (of the mean of the stresses before and after each
   * step), and where it gives none all work is stored. Where strain and time rest the accepted
   * state stays, and the library is asked for its tangent alone.
   *
   * Throws UserError, with the place, the strain and the increment, for what is no number, what was
   * written behind STRESS, STATEV or DDSDDE, a tangent that is not its own transpose (by more than
   * 1e-6 of its largest entry; less, as differences leave, is halved between both), PNEWDT < 1, and
   * XIT.
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

    /** @param dim of the body; in two dimensions @p kind tells plane strain from plane stress */
    UserStress(const std::shared_ptr<const UserLibrary> &library,
               const unsigned int                        dim,
               const StressState                         kind,
               const Numbers                            &numbers);

    unsigned int n_parameters() const override
    {
      return 4;
    }

    unsigned int n_state() const override
    {
      return first_of_user + numbers.n_states;
    }

    bool may_fail() const override
    {
      return true;
    }

    Response update(const Trial &trial, double *next, Tangent *tangent) const override;

    /** `state_1`, ... */
    std::vector<std::pair<std::string, unsigned int>> shown() const override;

  private:
    static constexpr unsigned int first_of_user = 6 + 6 + 3 + 1;

    struct Call;

    const OfMaterial &material_of(const Trial &trial) const
    {
      return numbers.materials[static_cast<unsigned int>(trial.parameters[3] + 0.5)];
    }

    /** What is wrong with what a call has left, or nothing. */
    std::string fault_of(const Call &call, const bool with_tangent) const;

    [[noreturn]] void throw_fault(const std::string &fault,
                                  const Call        &call,
                                  const Trial       &trial) const;

    const std::shared_ptr<const UserLibrary> library;
    const unsigned int                       n_normal, n_shear;
    const Numbers                            numbers;
  };
} // namespace PeriDeal
