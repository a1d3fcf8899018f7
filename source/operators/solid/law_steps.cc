// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/laws/bond_force_formula.h>
#include <perideal/laws/user_bond_law.h>
#include <perideal/laws/viscoelastic_solid.h>
#include <perideal/operators/solid/law_fault.h>
#include <perideal/operators/solid/law_steps.h>

#include <algorithm>
#include <functional>
#include <map>
#include <unordered_map>

namespace PeriDeal
{
  namespace
  {
    using Maker =
      std::function<std::unique_ptr<BondLaw>(const Material::Law &, const LawSteps::Files &)>;

    /** The one list of laws, but for the linear one, which is LinearPeridynamicSolid. */
    const std::map<SolidLaw, Maker> &makers()
    {
      static const std::map<SolidLaw, Maker> list = {
        {SolidLaw::viscoelastic,
         [](const Material::Law &law, const auto &) {
           return std::make_unique<ViscoelasticSolid>(law.relaxation);
         }},
        {SolidLaw::formula,
         [](const Material::Law &law, const auto &) {
           return std::make_unique<BondForceFormula>(
             [force = law.bond_force](const double s, const double damage) {
               return force.value(dealii::Point<2>(s, damage));
             });
         }},
        {SolidLaw::user_bonds, [](const Material::Law &law, const LawSteps::Files &files) {
           return std::make_unique<UserBondLaw>(UserLibrary::of_file(law.user.library,
                                                                     files.folder,
                                                                     files.communicator,
                                                                     UserLibrary::Wanted::bonds),
                                                law.user.properties,
                                                law.user.n_states);
         }}};
      return list;
    }
  } // namespace


  LawSteps::LawSteps(const Material::Law &of_scene, const Files &files)
    : file(of_scene.user.library)
  {
    const auto found = makers().find(of_scene.kind);
    if (found != makers().end())
      law = found->second(of_scene, files);
    throw_faults(files.communicator);
    set_time(0.);
  }


  void LawSteps::throw_faults(const MPI_Comm communicator) const
  {
    LawFault *const fault = any() ? law->fault() : nullptr;
    if (fault == nullptr) // on all processes or on none
      return;
    const LawFault found = *fault;
    *fault               = LawFault();
    throw_law_fault(found.text.empty() ?
                      "" :
                      "Entry 'User law' in section 'Material': '" + file + "' " + found.text + ".",
                    found.asks_for_less,
                    accepted,
                    communicator);
  }


  void LawSteps::set_time(const double t) const
  {
    if (any())
      law->set_step(begun ? std::max(0., t - accepted) : 0.);
  }


  void LawSteps::accept(const double t)
  {
    begun    = true;
    accepted = t;
    set_time(t);
  }


  void LawSteps::exchange(Archive &archive)
  {
    archive.exchange("begun", begun);
    archive.exchange("accepted", accepted);
    if (archive.loads())
      set_time(accepted);
  }


  void exchange_history(Archive                    &archive,
                        const BondState::Numbering &numbering,
                        const NodeKeys             &keys,
                        const unsigned int          n,
                        std::vector<double>        &history)
  {
    KeyedPairs pairs; // a node, and the number of its bond among its own
    if (!archive.loads())
      {
        for (std::size_t number = 0; number < numbering.n_bonds(); ++number)
          {
            const std::size_t node = numbering.node_of(number);
            pairs.keys.push_back({keys[node], number - numbering.first_of(node)});
          }
        pairs.values = history;
      }
    archive.exchange("history", pairs, keys);
    if (!archive.loads())
      return;
    std::unordered_map<std::uint64_t, std::size_t> node_of;
    for (std::size_t node = 0; node < keys.size(); ++node)
      node_of[keys[node]] = node;
    for (std::size_t k = 0; k < pairs.keys.size(); ++k)
      {
        const std::size_t first = numbering.first_of(node_of.at(pairs.keys[k][0]));
        std::copy_n(pairs.values.begin() + n * k,
                    n,
                    history.begin() + n * (first + pairs.keys[k][1]));
      }
  }
} // namespace PeriDeal
