// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/watch/system_listener.hpp"

#include <algorithm>
#include <set>

#include "components/palpate/find_robot.hpp"
#include "components/palpate/node/live/live_messages.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/clock.hpp"
#include "libs/core/error.hpp"
#include "libs/core/seconds.hpp"
#include "libs/dds/message.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/robot/robot_description.hpp"

namespace palpate::command {

namespace {

constexpr auto kListenPeriod = std::chrono::milliseconds(50);

double MonotonicNow_s() { return NsToSeconds(MonotonicNow_ns()); }

std::set<std::string> ChambersOf(const std::filesystem::path& robot) {
  std::set<std::string> names;
  for (const auto& chamber : robot::ReadRobotFile(robot, app::LoadYaml).chambers) {
    names.insert(chamber.name);
  }
  return names;
}

}  // namespace

SystemListener::SystemListener(int domain_id, const std::vector<std::string>& remap,
                               const std::filesystem::path& robot)
    : participant_(JoinDomain("palpate_watch", domain_id, remap)),
      loop_(participant_),
      builder_(domain_id),
      statuses_(participant_.CreateReader(dds::kComponentStatusTopic)),
      diagnostics_(participant_.CreateReader(dds::kDiagnosticsTopic)),
      forces_(participant_.CreateReader(dds::kForcesTopic)),
      model_errors_(participant_.CreateReader(dds::kModelGapTopic)),
      reports_(participant_.CreateReader(dds::kPerceptionReportTopic)),
      frames_(participant_.CreateReader(dds::kFrameInfoTopic)),
      meshes_(participant_.CreateReader(dds::kMeshStateTopic)),
      cables_(participant_.CreateReader(dds::kJointStatesTopic)),
      calibrations_(participant_.CreateReader(dds::kCalibrationStatusTopic)) {
  Attach(statuses_);
  Attach(diagnostics_);
  Attach(forces_);
  Attach(model_errors_);
  Attach(reports_);
  Attach(frames_);
  Attach(meshes_);
  Attach(cables_);
  loop_.Attach(calibrations_, [this] {
    for (const auto& message : calibrations_.Take()) builder_.Add(message);
  });
  if (!robot.empty()) {
    builder_.SetChambers(ChambersOf(FindRobotFile(robot)));
  } else {
    mesh_at_rest_.emplace(participant_.CreateReader(dds::kMeshTopic));
    loop_.Attach(*mesh_at_rest_, [this] { TakeRobotOfMesh(); });
  }
  loop_.Every(kListenPeriod, [] {});
}

void SystemListener::TakeRobotOfMesh() {
  for (const auto& message : mesh_at_rest_->Take()) {
    const std::string name(dds::Text(message.robot));
    const std::vector<std::string> known = KnownRobots();
    if (std::find(known.begin(), known.end(), name) == known.end()) continue;
    try {
      builder_.SetChambers(ChambersOf(FindRobotFile(name)));
    } catch (const InputError&) {
      // A file that cannot be read names no chambers.
    }
  }
}

template <typename T>
void SystemListener::Attach(dds::Reader<T>& reader) {
  loop_.Attach(reader, [this, &reader] {
    for (const T& message : reader.Take()) builder_.Add(message, MonotonicNow_s());
  });
}

void SystemListener::Listen(const std::function<bool()>& done,
                            std::chrono::duration<double> limit) {
  loop_.DispatchUntil(done, dds::WaitSet::Clock::now() + FromSeconds(limit.count()));
}

monitor::SystemSnapshot SystemListener::Snapshot() const {
  return builder_.At(MonotonicNow_s(), dds::WallClockNs());
}

bool SystemListener::HeardAll() const {
  return statuses_.matched() > 0 && builder_.processes() >= statuses_.matched();
}

}  // namespace palpate::command
