// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/reference_verb.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "components/offline/messages/phase_plan.hpp"
#include "components/palpate/system/system_file_keys.hpp"
#include "libs/app/key_reference.hpp"
#include "libs/app/run_main.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/experiment/recording_settings.hpp"
#include "libs/rgbd/rgbd_camera.hpp"
#include "libs/robot/calibration_keys.hpp"
#include "libs/robot/robot_file_keys.hpp"
#include "libs/scenario/scenario_keys.hpp"

namespace palpate::command {

namespace {

struct FileKind {
  std::string_view name;
  const KeyTable& (*keys)();
};

constexpr std::array<FileKind, 8> kFileKinds{{{"robot", robot::RobotFileKeys},
                                              {"experiment", experiment::ExperimentKeys},
                                              {"recording", experiment::RecordingKeys},
                                              {"camera", rgbd::CameraFileKeys},
                                              {"calibration", robot::CalibrationFileKeys},
                                              {"scenario", scenario::ScenarioKeys},
                                              {"phases", offline::PhaseFileKeys},
                                              {"system", SystemFileKeys}}};

std::vector<std::string> KindNames() {
  std::vector<std::string> names;
  for (const FileKind& kind : kFileKinds) names.emplace_back(kind.name);
  return names;
}

const KeyTable& KeysOf(const std::string& name) {
  for (const FileKind& kind : kFileKinds) {
    if (kind.name == name) return kind.keys();
  }
  const std::vector<std::string> names = KindNames();
  throw InputError("there is no reference of '" + Excerpt(name) + "'" + DidYouMean(name, names) +
                   "; it is one of " + Listed(names));
}

}  // namespace

std::string Reference(const std::vector<std::string>& kinds, bool as_json_schema) {
  std::vector<const KeyTable*> tables;
  for (const std::string& kind : kinds) tables.push_back(&KeysOf(kind));
  if (!as_json_schema) return app::PrintKeysMarkdown(tables);
  if (tables.size() != 1) {
    throw InputError("--format json-schema: name one kind of file, not " +
                     std::to_string(tables.size()));
  }
  return app::PrintJsonSchema(*tables.front());
}

app::Verb ReferenceVerb() {
  struct Options {
    std::vector<std::string> kinds;
    std::string format = "markdown";
  };
  return {"reference", "Print every key of a kind of file, with type, unit, default and meaning",
          [](app::Arguments& arguments) -> app::Verb::Action {
            const auto options = std::make_shared<Options>();
            arguments.Positionals("KIND", &options->kinds,
                                  "Kinds of files: robot, experiment, recording, camera, "
                                  "calibration, scenario, phases, system",
                                  app::Need::kRequired);
            arguments.Suggest("KIND", KindNames());
            arguments.Choice("--format", &options->format, {"markdown", "json-schema"},
                             "Markdown tables, or a JSON Schema (draft 2020-12) of one kind for "
                             "editors");
            return [options] {
              fmt::print("{}", Reference(options->kinds, options->format == "json-schema"));
              return app::kExitDone;
            };
          }};
}

}  // namespace palpate::command
