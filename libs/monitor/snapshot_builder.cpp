// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/monitor/snapshot_builder.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>

#include "libs/core/text.hpp"
#include "libs/dds/message.hpp"
#include "libs/dds/stamp.hpp"

namespace palpate::monitor {

namespace {

// As the data flow through them.
constexpr std::array<std::string_view, 7> kOrder = {
    "virtual_robot", "virtual_camera",   "capture",    "player",
    "perception",    "force_estimation", "calibration"};

/// Keys of /diagnostics that repeat what /component_status says.
constexpr std::array<std::string_view, 10> kOfStatus = {
    "status",  "uptime_s",      "received",       "published",      "dropped",
    "refused", "input_rate_hz", "output_rate_hz", "latency_mean_s", "latency_max_s"};

std::string ToText(const char* field) { return std::string(dds::Text(field)); }

std::size_t PlaceOf(const std::string& name) {
  return static_cast<std::size_t>(std::find(kOrder.begin(), kOrder.end(), name) - kOrder.begin());
}

std::string LevelOf(std::uint8_t level) {
  constexpr std::array<const char*, 4> kLevels = {"ok", "warning", "error", "stale"};
  return level < kLevels.size() ? kLevels[level] : std::to_string(level);
}

std::string ValueOf(const std::vector<std::pair<std::string, std::string>>& values,
                    std::string_view key) {
  for (const auto& [known, value] : values) {
    if (known == key) return value;
  }
  return {};
}

/// Adds what one process says of the clocks of other hosts.
void AddClocks(const std::vector<std::pair<std::string, std::string>>& values,
               std::vector<ClockState>* clocks) {
  constexpr std::string_view kOffset = "clock_offset_s.";
  for (const auto& [key, value] : values) {
    ClockState clock;
    if (!key.starts_with(kOffset) || !ParseFinite(value, &clock.offset_s)) continue;
    clock.host = ValueOf(values, "host");
    clock.other_host = key.substr(kOffset.size());
    if (!ParseFinite(ValueOf(values, "clock_offset_bound_s." + clock.other_host), &clock.bound_s)) {
      continue;
    }
    const auto known = std::find_if(clocks->begin(), clocks->end(), [&](const ClockState& one) {
      return (one.host == clock.host && one.other_host == clock.other_host) ||
             (one.host == clock.other_host && one.other_host == clock.host);
    });
    if (known == clocks->end()) {
      clocks->push_back(clock);
    } else if (clock.bound_s < known->bound_s) {
      *known = clock;
    }
  }
}

template <typename Sequence>
double NumberAt(const Sequence& numbers, std::size_t i) {
  return i < numbers._length ? numbers._buffer[i] : std::numeric_limits<double>::quiet_NaN();
}

Eigen::Vector3d ToVector(const auto& field) { return {field.x, field.y, field.z}; }

}  // namespace

void SnapshotBuilder::Add(const idl::palpate_msgs::ComponentStatus& message, double now_s) {
  const std::string name = ToText(message.component_name);
  Reported& reported = processes_[name];
  const int restarts =
      reported.state.restarts + (message.uptime_s < reported.state.uptime_s ? 1 : 0);
  reported = {{.name = name,
               .status = ToText(message.status),
               .reason = ToText(message.reason),
               .waiting_for = {},
               .uptime_s = message.uptime_s,
               .received = message.received,
               .published = message.published,
               .dropped = message.dropped,
               .refused = message.refused,
               .input_rate_hz = message.input_rate_hz,
               .output_rate_hz = message.output_rate_hz,
               .latency_mean_s = message.latency_mean_s,
               .latency_max_s = message.latency_max_s,
               .restarts = restarts,
               .values = {}},
              now_s};
}

/// Entries of our processes are called "node: component", nodes "palpate_...".
void SnapshotBuilder::Add(const idl::diagnostic_msgs::DiagnosticArray& message, double now_s) {
  for (const auto& entry : dds::Elements(message.status)) {
    const std::string name = ToText(entry.name);
    const std::size_t colon = name.find(": ");
    if (name.starts_with("palpate_") && colon != name.npos) {
      Values& values = values_[name.substr(colon + 2)];
      values.clear();
      for (const auto& value : dds::Elements(entry.values)) {
        const std::string_view key = dds::Text(value.key);
        if (std::find(kOfStatus.begin(), kOfStatus.end(), key) != kOfStatus.end()) continue;
        values.emplace_back(key, dds::Text(value.value));
      }
    } else {
      others_[name] = {
          {.name = name, .level = LevelOf(entry.level), .message = ToText(entry.message)}, now_s};
    }
  }
}

void SnapshotBuilder::Add(const idl::palpate_msgs::ForceArray& message, double now_s) {
  forces_.Add(now_s, message.counter);
  ForcesState& state = snapshot_.forces.emplace();
  state.status = ToText(message.status);
  state.reason = ToText(message.reason);
  state.stamp_ns = dds::StampNs(message.header.stamp);
  state.age_s = message.age_s;
  state.latency_s = message.latency_s;
  for (const auto& force : dds::Elements(message.forces)) {
    state.forces.push_back(
        {.name = ToText(force.name),
         .status = ToText(force.status),
         .reason = ToText(force.reason),
         .position_m = ToVector(force.position_m),
         .force_N = ToVector(force.force_n),
         .ci95_N = force.ci95_n,
         .covariance_N2 = Eigen::Matrix3d::Map(force.covariance_n2),
         .location_ci95_m = force.location_ci95_m,
         .location_covariance_m2 = Eigen::Matrix3d::Map(force.location_covariance_m2)});
  }
}

void SnapshotBuilder::Add(const idl::palpate_msgs::ModelGap& message, double now_s) {
  model_error_.Add(now_s, message.counter);
  ModelErrorState& state = snapshot_.model_error.emplace();
  state.residual_rms_m = message.residual_rms_m;
  state.noise_rms_m = message.noise_rms_m;
  state.samples = message.sample_count;
}

void SnapshotBuilder::Add(const idl::palpate_msgs::PerceptionReport& message, double now_s) {
  perception_.Add(now_s, message.counter);
  PerceptionState& state = snapshot_.perception.emplace();
  state.status = ToText(message.status);
  state.reason = ToText(message.reason);
  state.robot_points = message.robot_points;
  state.object_points = message.object_points;
  state.contacts = message.contacts;
  state.age_s = message.age_s;
  state.latency_s = message.latency_s;
  for (const char* note : dds::Elements(message.notes)) state.notes.push_back(ToText(note));
}

void SnapshotBuilder::Add(const idl::palpate_msgs::FrameInfo& message, double now_s) {
  camera_.Add(now_s, message.counter);
  if (!snapshot_.camera) snapshot_.camera.emplace();
  CameraState& state = *snapshot_.camera;
  state.device = ToText(message.device);
  state.epoch = message.epoch;
  state.valid_ratio = message.valid_ratio;
  state.packets_lost += message.packets_lost;
  state.frames_failed = message.frames_failed;
  state.frames_dropped = message.frames_dropped;
  state.socket_drops = message.socket_drops;
}

void SnapshotBuilder::Add(const idl::palpate_msgs::MeshState& message, double now_s) {
  mesh_.Add(now_s, message.counter);
  snapshot_.mesh.emplace().status = ToText(message.status);
}

void SnapshotBuilder::Add(const idl::sensor_msgs::JointState& message, double now_s) {
  cables_.Add(now_s, std::nullopt);
  CablesState& state = snapshot_.cables.emplace();
  for (std::size_t i = 0; i < message.name._length; ++i) {
    std::string name = ToText(message.name._buffer[i]);
    const bool is_chamber = chambers_.contains(name);
    state.cables.push_back({.name = std::move(name),
                            .displacement_m = NumberAt(message.position, i),
                            .tension_N = NumberAt(message.effort, i),
                            .is_chamber = is_chamber});
  }
}

void SnapshotBuilder::Add(const idl::palpate_msgs::CalibrationStatus& message) {
  snapshot_.calibration = CalibrationState{.request_id = ToText(message.request_id),
                                           .state = ToText(message.state),
                                           .reason = ToText(message.reason),
                                           .frames_taken = message.frames_taken,
                                           .frames_wanted = message.frames_wanted};
}

SystemSnapshot SnapshotBuilder::At(double now_s, std::int64_t time_ns) const {
  SystemSnapshot snapshot = snapshot_;
  snapshot.time_ns = time_ns;
  if (snapshot.forces) snapshot.forces->flow = forces_.At(now_s);
  if (snapshot.model_error) snapshot.model_error->flow = model_error_.At(now_s);
  if (snapshot.perception) snapshot.perception->flow = perception_.At(now_s);
  if (snapshot.camera) snapshot.camera->flow = camera_.At(now_s);
  if (snapshot.mesh) snapshot.mesh->flow = mesh_.At(now_s);
  if (snapshot.cables) snapshot.cables->flow = cables_.At(now_s);
  for (const auto& [name, reported] : processes_) {
    ProcessState& state = snapshot.processes.emplace_back(reported.state);
    state.silence_s = now_s - reported.report_s;
    if (const auto values = values_.find(name); values != values_.end()) {
      state.values = values->second;
    }
    if (!state.IsSilent()) AddClocks(state.values, &snapshot.clocks);
    state.waiting_for = ValueOf(state.values, "waiting_for");
    std::erase_if(state.values, [](const auto& value) { return value.first == "waiting_for"; });
    if (name == "force_estimation" && snapshot.model_error) {
      snapshot.model_error->judgement = ValueOf(state.values, "model_gap");
    }
  }
  std::stable_sort(snapshot.processes.begin(), snapshot.processes.end(),
                   [](const ProcessState& a, const ProcessState& b) {
                     return PlaceOf(a.name) < PlaceOf(b.name);
                   });
  for (const auto& [name, other] : others_) {
    snapshot.others.emplace_back(other.diagnosis).silence_s = now_s - other.report_s;
  }
  return snapshot;
}

}  // namespace palpate::monitor
