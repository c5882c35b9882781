// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/verbs.hpp"

#include "components/palpate/calibrate/calibrate_verb.hpp"
#include "components/palpate/capture_verb.hpp"
#include "components/palpate/compare_verb.hpp"
#include "components/palpate/diagnose_verb.hpp"
#include "components/palpate/estimate/estimate_verb.hpp"
#include "components/palpate/import_verb.hpp"
#include "components/palpate/info_verb.hpp"
#include "components/palpate/launch/launch_verb.hpp"
#include "components/palpate/new_robot/new_robot_verb.hpp"
#include "components/palpate/node/demo/demo_verb.hpp"
#include "components/palpate/node/doctor/doctor_verb.hpp"
#include "components/palpate/node/play/play_verb.hpp"
#include "components/palpate/node/record/record_verb.hpp"
#include "components/palpate/node/security/security_verb.hpp"
#include "components/palpate/node/topics/fail_verb.hpp"
#include "components/palpate/node/topics/node_verbs.hpp"
#include "components/palpate/node/topics/param_verbs.hpp"
#include "components/palpate/node/topics/topic_verbs.hpp"
#include "components/palpate/node/view/view_verb.hpp"
#include "components/palpate/node/watch/health_verb.hpp"
#include "components/palpate/node/watch/watch_verb.hpp"
#include "components/palpate/recordings/export_verb.hpp"
#include "components/palpate/recordings/repair_verb.hpp"
#include "components/palpate/reference_verb.hpp"
#include "components/palpate/simulate_verb.hpp"
#include "components/palpate/solve_verb.hpp"
#include "libs/app/verbs.hpp"

namespace palpate::command {

int RunCommand(const std::vector<std::string>& words) {
  const std::vector<app::Verb> verbs = {
      DemoVerb(),      LaunchVerb(),  SolveVerb(),    SimulateVerb(), CalibrateVerb(),
      EstimateVerb(),  CompareVerb(), DiagnoseVerb(), ImportVerb(),   CaptureVerb(),
      WatchVerb(),     HealthVerb(),  DoctorVerb(),   TopicVerb(),    NodeVerb(),
      ParamVerb(),     FailVerb(),    RecordVerb(),   PlayVerb(),     ViewVerb(),
      RepairVerb(),    ExportVerb(),  InfoVerb(),     NewRobotVerb(), SecurityVerb(),
      ReferenceVerb(),
  };
  return app::RunVerbs("palpate", "Estimate forces on cable-driven soft robots from images", verbs,
                       words);
}

}  // namespace palpate::command
