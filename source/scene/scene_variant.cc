// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/scene/scene_variant.h>

#include <algorithm>

namespace PeriDeal
{
  namespace
  {
    std::string full_name(const SceneSection &section, const Entry &entry)
    {
      return section.name().empty() ? entry.name : section.name() + "/" + entry.name;
    }
  } // namespace


  template <int dim>
  std::shared_ptr<Scene<dim>> scene_variant(const Scene<dim>           &scene,
                                            const std::vector<Setting> &settings)
  {
    const auto                        variant = std::make_shared<Scene<dim>>();
    const std::vector<SceneSection *> to      = variant->sections(),
                                      from    = const_cast<Scene<dim> &>(scene).sections();
    std::size_t n_set                         = 0;
    for (std::size_t k = 0; k < from.size(); ++k)
      for (const Entry &entry : from[k]->entries())
        {
          const std::string name = full_name(*from[k], entry);
          const auto        other =
            std::find_if(settings.begin(), settings.end(), [&](const Setting &setting) {
              return setting.first == name;
            });
          n_set += other != settings.end() ? 1 : 0;
          to[k]->set(entry.name, other != settings.end() ? other->second : entry.text);
        }
    Assert(n_set == settings.size(),
           dealii::ExcMessage("Not all settings are entries, once each."));
    (void)n_set;
    variant->domain.files.folder       = scene.domain.files.folder;
    variant->domain.files.communicator = scene.domain.files.communicator;
    variant->parse_and_validate();
    return variant;
  }


  template std::shared_ptr<Scene<1>> scene_variant(const Scene<1> &, const std::vector<Setting> &);
  template std::shared_ptr<Scene<2>> scene_variant(const Scene<2> &, const std::vector<Setting> &);
  template std::shared_ptr<Scene<3>> scene_variant(const Scene<3> &, const std::vector<Setting> &);
} // namespace PeriDeal
