// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/images/perception_settings.hpp"

#include "libs/app/settings.hpp"

namespace palpate::command {

namespace {

struct Settings {
  perception::Config perception;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("perception", perception, "Image processing: clouds, contacts and markers");
  }
};

}  // namespace

perception::Config PerceptionOf(const std::vector<std::string>& overrides,
                                const experiment::Experiment& experiment) {
  Settings settings;
  if (experiment.depth_noise && experiment.depth_noise->subpixel_px > 0.0) {
    settings.perception.depth_subpixel_px = experiment.depth_noise->subpixel_px;
  }
  const std::vector<app::Setting> list = app::ListSettings(settings);
  for (const std::string& assignment : overrides) app::ApplyOverride(assignment, list);
  return settings.perception;
}

}  // namespace palpate::command
