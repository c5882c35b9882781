// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/node/convert_texts.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "components/view/frames/binary_frame.hpp"
#include "libs/dds/geometry_messages.hpp"
#include "libs/dds/message.hpp"
#include "libs/dds/stamp.hpp"

namespace palpate::view {

namespace {

using Json = nlohmann::json;

std::string StringOf(const char* field) { return std::string(dds::Text(field)); }

std::string StampText(const idl::builtin_interfaces::Time& stamp) {
  return std::to_string(dds::StampNs(stamp));
}

Json VectorJson(const Eigen::Vector3d& v) { return Json::array({v.x(), v.y(), v.z()}); }

Json ForceJson(const auto& force) {
  const Eigen::Vector3d force_N = dds::ToVector(force.force_n);
  const bool known = force_N.allFinite();
  return {{"name", StringOf(force.name)},
          {"status", StringOf(force.status)},
          {"reason", StringOf(force.reason)},
          {"position_m", VectorJson(dds::ToVector(force.position_m))},
          {"force_N", known ? VectorJson(force_N) : Json(nullptr)},
          {"magnitude_N", known ? Json(force_N.norm()) : Json(nullptr)},
          {"ci95_N", force.ci95_n},
          {"location_ci95_m", force.location_ci95_m}};
}

template <typename Sequence>
Json NumberAt(const Sequence& numbers, std::size_t i) {
  return i < numbers._length && std::isfinite(numbers._buffer[i]) ? Json(numbers._buffer[i])
                                                                  : Json(nullptr);
}

Json ProcessJson(const monitor::ProcessState& process) {
  return {{"name", process.name},
          {"status", process.status},
          {"reason", process.reason},
          {"waiting_for", process.waiting_for},
          {"silence_s", process.silence_s},
          {"uptime_s", process.uptime_s},
          {"received", process.received},
          {"published", process.published},
          {"dropped", process.dropped},
          {"refused", process.refused},
          {"input_rate_hz", process.input_rate_hz},
          {"output_rate_hz", process.output_rate_hz},
          {"latency_mean_s", process.latency_mean_s},
          {"latency_max_s", process.latency_max_s},
          {"restarts", process.restarts},
          {"silent", process.IsSilent()}};
}

}  // namespace

OutMessage ForcesMessage(const std::string& kind, const idl::palpate_msgs::ForceArray& message) {
  Json forces = Json::array();
  for (const auto& force : dds::Elements(message.forces)) forces.push_back(ForceJson(force));
  return TextMessage(kind, JsonText({{"kind", kind},
                                     {"stamp_ns", StampText(message.header.stamp)},
                                     {"status", StringOf(message.status)},
                                     {"reason", StringOf(message.reason)},
                                     {"age_s", message.age_s},
                                     {"latency_s", message.latency_s},
                                     {"forces", std::move(forces)}}));
}

OutMessage ModelErrorMessage(const idl::palpate_msgs::ModelGap& message,
                             const std::string& judgement) {
  return TextMessage("model_error", JsonText({{"kind", "model_error"},
                                              {"stamp_ns", StampText(message.header.stamp)},
                                              {"residual_rms_m", message.residual_rms_m},
                                              {"noise_rms_m", message.noise_rms_m},
                                              {"samples", message.sample_count},
                                              {"judgement", judgement}}));
}

OutMessage CablesMessage(const idl::sensor_msgs::JointState& message,
                         const std::vector<std::string>& chambers) {
  Json cables = Json::array();
  Json filled = Json::array();
  for (std::size_t i = 0; i < message.name._length; ++i) {
    std::string name = StringOf(message.name._buffer[i]);
    const bool is_chamber = std::find(chambers.begin(), chambers.end(), name) != chambers.end();
    Json& list = is_chamber ? filled : cables;
    list.push_back({{"name", std::move(name)},
                    {is_chamber ? "volume_m3" : "displacement_m", NumberAt(message.position, i)},
                    {is_chamber ? "pressure_Pa" : "tension_N", NumberAt(message.effort, i)}});
  }
  return TextMessage("cables",
                     JsonText({{"kind", "cables"},
                               {"stamp_ns", StampText(message.header.stamp)},
                               {"cables", std::move(cables)},
                               {"chambers", std::move(filled)}}),
                     Delivery::kLatest);
}

OutMessage HealthMessage(const monitor::SystemSnapshot& snapshot,
                         const std::vector<TopicState>& topics) {
  Json processes = Json::array();
  for (const auto& process : snapshot.processes) processes.push_back(ProcessJson(process));
  Json flows = Json::array();
  for (const TopicState& topic : topics) {
    flows.push_back({{"name", topic.name},
                     {"rate_hz", topic.flow.rate_hz},
                     {"lost", topic.flow.lost},
                     {"silence_s", topic.flow.silence_s}});
  }
  Json clocks = Json::array();
  for (const monitor::ClockState& clock : snapshot.clocks) {
    clocks.push_back({{"host", clock.host},
                      {"other_host", clock.other_host},
                      {"offset_s", clock.offset_s},
                      {"bound_s", clock.bound_s}});
  }
  return TextMessage("health", JsonText({{"kind", "health"},
                                         {"processes", std::move(processes)},
                                         {"topics", std::move(flows)},
                                         {"clocks", std::move(clocks)}}));
}

ShownCalibration::ShownCalibration()
    : fields_({{"kind", "calibration"},
               {"state", nullptr},
               {"reason", ""},
               {"frames_taken", 0},
               {"frames_wanted", 0},
               {"found_ns", nullptr},
               {"has_camera", false},
               {"T_robot_camera", nullptr},
               {"residual_rms_m", nullptr}}) {}

void ShownCalibration::Take(const idl::palpate_msgs::CalibrationStatus& message) {
  fields_["state"] = StringOf(message.state);
  fields_["reason"] = StringOf(message.reason);
  fields_["frames_taken"] = message.frames_taken;
  fields_["frames_wanted"] = message.frames_wanted;
}

void ShownCalibration::Take(const idl::palpate_msgs::Calibration& message) {
  fields_["found_ns"] = StampText(message.header.stamp);
  fields_["has_camera"] = message.has_camera;
  fields_["residual_rms_m"] = message.residual_rms_m;
  fields_["T_robot_camera"] = nullptr;
  if (!message.has_camera) return;
  const auto& pose = message.camera_in_robot;
  fields_["T_robot_camera"] = {
      {"translation_m", VectorJson(dds::ToVector(pose.position))},
      {"rotation_xyzw",
       {pose.orientation.x, pose.orientation.y, pose.orientation.z, pose.orientation.w}}};
}

OutMessage ShownCalibration::Message() const {
  return TextMessage("calibration", JsonText(fields_));
}

}  // namespace palpate::view
