// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_camera/node/node.hpp"

#include <optional>
#include <utility>

#include "components/virtual_camera/node/convert.hpp"
#include "libs/core/clock.hpp"
#include "libs/core/error.hpp"
#include "libs/core/seconds.hpp"
#include "libs/core/text.hpp"
#include "libs/dds/stamp.hpp"

namespace palpate::virtual_camera {

namespace {

using Clock = dds::WaitSet::Clock;

constexpr auto kReportPeriod = std::chrono::seconds(1);
constexpr std::size_t kMostBenchStates = 64;

const scenario::CameraSpec& CameraOf(const Scene& scene) {
  const scenario::Scenario& scenario = scene.schedule.scenario();
  if (!scenario.camera) {
    throw InputError("scenario '" + scenario.name + "' has no camera: nothing can be streamed");
  }
  return scene.camera == 0 ? *scenario.camera : scenario.further_cameras.at(scene.camera - 1);
}

/// `name` of the process or component, of a further camera with that camera's name behind it.
std::string NameOf(const std::string& name, const Scene& scene) {
  if (scene.camera == 0) return name;
  return name + "_" + scene.schedule.scenario().further_cameras.at(scene.camera - 1).name;
}

gige_vision::DeviceSettings DeviceOf(const NodeConfig& config, const Scene& scene) {
  gige_vision::DeviceSettings settings;
  settings.interface_address = config.interface_address;
  settings.vendor = config.vendor;
  settings.model = config.model;
  settings.serial = config.serial;
  settings.user_name = config.user_name;
  settings.rate_hz = CameraOf(scene).rate_hz;
  settings.confidence = config.confidence;
  settings.impairment.loss = config.network.loss;
  settings.impairment.seed = scene.seed;
  return settings;
}

}  // namespace

VirtualCameraNode::VirtualCameraNode(const NodeConfig& config, Scene scene, int domain_id,
                                     dds::TopicTable table, dds::NodeLog::ProcessLog process_log)
    : scene_{std::move(scene)},
      silence_s_{config.silence_s},
      participant_{
          dds::ParticipantOf(config.dds, NameOf("palpate_virtual_camera", scene_), domain_id),
          std::move(table)},
      loop_{participant_},
      log_{participant_, std::move(process_log)},
      health_{participant_, NameOf("virtual_camera", scene_), Clock::now()},
      meshes_{participant_.CreateReader(dds::kTrueMeshTopic)},
      bench_states_{participant_.CreateReader(dds::kBenchStateTopic)},
      mesh_states_{participant_.CreateReader(dds::kTrueMeshStateTopic)},
      device_{DeviceOf(config, scene_), CameraOf(scene_).camera},
      last_state_ns_{MonotonicNow_ns()},
      inputs_{participant_, loop_, log_} {
  const std::string publisher = "palpate-virtual-robot";
  inputs_.Expect(meshes_, publisher, dds::InputKind::kLatched);
  inputs_.Expect(bench_states_, publisher);
  inputs_.Expect(mesh_states_, publisher);
  robot_surface_.markers_m = scene_.markers_m;
  loop_.Attach(meshes_, [this] { TakeMesh(); });
  loop_.Attach(bench_states_, [this] { TakeBenchStates(); });
  loop_.Attach(mesh_states_, [this] { TakeMeshStates(); });
  loop_.Every(kReportPeriod, [this] { ReportHealth(); });
  log_.Write(Severity::kInfo,
             "camera " + config.vendor + "-" + config.serial + " on " + config.interface_address);
}

void VirtualCameraNode::TakeMesh() {
  for (const idl::palpate_msgs::Mesh& message : meshes_.Take()) {
    if (const Status status = FromMesh(message, &robot_surface_); !status.ok()) {
      Refuse(status, dds::StampNs(message.header.stamp));
      continue;
    }
    mesh_hash_ = dds::Text(message.mesh_hash);
    camera_ = MakeCamera(scene_.schedule.scenario(), scene_.camera, robot_surface_, scene_.effects,
                         scene_.seed);
  }
}

void VirtualCameraNode::TakeBenchStates() {
  for (const idl::palpate_msgs::BenchState& message : bench_states_.Take()) {
    View view;
    Status status = FromBenchState(message, scene_.schedule, &view);
    if (status.ok() &&
        (dds::Text(message.scenario) != scene_.scenario_sha256 || message.seed != scene_.seed)) {
      status = {StatusCode::kInvalidInput, "the virtual robot runs another scenario or seed"};
    }
    if (!status.ok()) {
      Refuse(status, dds::StampNs(message.header.stamp));
      continue;
    }
    // The bench says where the first camera stands. The others stay where the scenario has them.
    if (scene_.camera > 0) view.T_robot_camera = CameraOf(scene_).T_robot_camera;
    benches_[dds::StampNs(message.header.stamp)] = std::move(view);
    if (benches_.size() > kMostBenchStates) benches_.erase(benches_.begin());
  }
}

void VirtualCameraNode::TakeMeshStates() {
  TakeBenchStates();
  std::optional<States::value_type> newest;
  for (const idl::palpate_msgs::MeshState& message : mesh_states_.Take()) {
    ++counts_.received;
    const std::int64_t stamp_ns = dds::StampNs(message.header.stamp);
    auto bench = benches_.extract(stamp_ns);
    if (!camera_ || bench.empty() || dds::Text(message.mesh_hash) != mesh_hash_) {
      ++counts_.dropped;
      continue;
    }
    View& view = bench.mapped();
    if (const Status status = FromMeshState(message, robot_surface_.rest_m.cols(), &view);
        !status.ok()) {
      Refuse(status, dds::StampNs(message.header.stamp));
      continue;
    }
    if (newest) ++counts_.dropped;
    newest.emplace(stamp_ns, std::move(view));
  }
  if (newest) TakePicture(newest->first, newest->second);
}

void VirtualCameraNode::TakePicture(std::int64_t stamp_ns, const View& view) {
  const Clock::time_point start = Clock::now();
  last_state_ns_ = MonotonicNow_ns();
  last_refusal_.clear();
  benches_.erase(benches_.begin(), benches_.upper_bound(stamp_ns));
  camera_->Take(view, &frame_);
  frame_.stamp_ns = stamp_ns;
  device_.Send(frame_);
  ++counts_.published;
  counts_.latencies_s.push_back(SecondsSince(start));
}

void VirtualCameraNode::Refuse(const Status& status, std::int64_t stamp_ns) {
  ++counts_.refused;
  last_refusal_ = status.message();
  log_.WarnRepeatedly("truth refused: " + status.message(), dds::StampText(stamp_ns));
}

Status VirtualCameraNode::StatusNow() const {
  const double silent_s = NsToSeconds(MonotonicNow_ns() - last_state_ns_);
  if (silent_s <= silence_s_) return Status::Ok();
  return {StatusCode::kStale, "no state of the virtual robot for " + FormatNumber(silent_s) + " s" +
                                  (last_refusal_.empty() ? std::string() : ": " + last_refusal_)};
}

void VirtualCameraNode::ReportHealth() {
  const gige_vision::DeviceCounters sent = device_.counters();
  health_.Report(StatusNow(), counts_,
                 {{"streaming", device_.streaming() ? "yes" : "no"},
                  {"frames_sent", std::to_string(sent.frames_sent)},
                  {"frames_skipped", std::to_string(sent.frames_skipped)},
                  {"packets_sent", std::to_string(sent.packets_sent)},
                  {"packets_withheld", std::to_string(sent.packets_withheld)},
                  {"packets_resent", std::to_string(sent.packets_resent)},
                  {"resend_refused", std::to_string(sent.resend_refused)},
                  {"waiting_for", inputs_.Waiting()}},
                 Clock::now());
  log_.WriteCounted();
  counts_.latencies_s.clear();
}

}  // namespace palpate::virtual_camera
