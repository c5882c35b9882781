// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/estimate/estimate_settings.hpp"

#include "libs/app/settings.hpp"
#include "libs/app/yaml.hpp"

namespace palpate::command {

EstimateSettings ReadEstimateSettings(const experiment::Experiment& experiment,
                                      const std::filesystem::path& file,
                                      const std::vector<std::string>& overrides,
                                      const std::vector<std::string>& contacts, bool as_process) {
  EstimateSettings settings = offline::DefaultForceSettings(experiment, as_process);
  const std::vector<app::Setting> list = app::ListSettings(settings);
  if (!file.empty()) app::LoadSettings(app::LoadYaml(file), list);
  for (const std::string& assignment : overrides) app::ApplyOverride(assignment, list);
  std::vector<std::string>& sites = settings.forces.contacts;
  sites.insert(sites.end(), contacts.begin(), contacts.end());
  return settings;
}

}  // namespace palpate::command
