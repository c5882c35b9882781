// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "libs/core/utc_text.hpp"
#include "libs/monitor/snapshot_json.hpp"

namespace palpate::monitor {

namespace {

using Json = nlohmann::ordered_json;

Json Number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json Numbers(const Eigen::Vector3d& vector) {
  return {Number(vector.x()), Number(vector.y()), Number(vector.z())};
}

/// Rows of three.
Json Numbers(const Eigen::Matrix3d& matrix) {
  Json rows = Json::array();
  for (Eigen::Index row = 0; row < 3; ++row) {
    rows.push_back(Numbers(Eigen::Vector3d(matrix.row(row))));
  }
  return rows;
}

/// The fields of a topic's flow, to which others are added.
Json FlowJson(const TopicFlow& flow) {
  return {{"rate_hz", Number(flow.rate_hz)},
          {"silence_s", Number(flow.silence_s)},
          {"received", flow.received},
          {"lost", flow.lost}};
}

Json With(Json json, const Json& further) {
  json.update(further);
  return json;
}

Json ToJson(const ForceState& force) {
  return {{"name", force.name},
          {"size_N", Number(force.force_N.norm())},
          {"ci95_N", Number(force.ci95_N)},
          {"force_robot_N", Numbers(force.force_N)},
          {"covariance_robot_N2", Numbers(force.covariance_N2)},
          {"position_robot_m", Numbers(force.position_m)},
          {"location_ci95_m", Number(force.location_ci95_m)},
          {"location_covariance_robot_m2", Numbers(force.location_covariance_m2)},
          {"status", force.status},
          {"reason", force.reason}};
}

Json ToJson(const ForcesState& state) {
  Json forces = Json::array();
  for (const ForceState& force : state.forces) forces.push_back(ToJson(force));
  return With(FlowJson(state.flow), {{"stamp_utc", UtcTextOfNs(state.stamp_ns)},
                                     {"status", state.status},
                                     {"reason", state.reason},
                                     {"age_s", Number(state.age_s)},
                                     {"latency_s", Number(state.latency_s)},
                                     {"contacts", forces}});
}

Json ToJson(const ModelErrorState& state) {
  return With(FlowJson(state.flow), {{"judgement", state.judgement},
                                     {"residual_rms_m", Number(state.residual_rms_m)},
                                     {"noise_rms_m", Number(state.noise_rms_m)},
                                     {"samples", state.samples}});
}

Json ToJson(const PerceptionState& state) {
  return With(FlowJson(state.flow), {{"status", state.status},
                                     {"reason", state.reason},
                                     {"robot_points", state.robot_points},
                                     {"object_points", state.object_points},
                                     {"contacts", state.contacts},
                                     {"age_s", Number(state.age_s)},
                                     {"latency_s", Number(state.latency_s)},
                                     {"notes", state.notes}});
}

Json ToJson(const CameraState& state) {
  return With(FlowJson(state.flow), {{"device", state.device},
                                     {"epoch", state.epoch},
                                     {"valid_ratio", Number(state.valid_ratio)},
                                     {"packets_lost", state.packets_lost},
                                     {"frames_failed", state.frames_failed},
                                     {"frames_dropped", state.frames_dropped},
                                     {"socket_drops", state.socket_drops}});
}

Json ToJson(const MeshShapeState& state) {
  return With(FlowJson(state.flow), {{"status", state.status}});
}

Json ToJson(const CablesState& state) {
  Json cables = Json::array();
  Json chambers = Json::array();
  for (const CableValue& cable : state.cables) {
    Json& list = cable.is_chamber ? chambers : cables;
    list.push_back(
        {{"name", cable.name},
         {cable.is_chamber ? "volume_m3" : "displacement_m", Number(cable.displacement_m)},
         {cable.is_chamber ? "pressure_Pa" : "tension_N", Number(cable.tension_N)}});
  }
  return With(FlowJson(state.flow), {{"cables", cables}, {"chambers", chambers}});
}

Json ToJson(const CalibrationState& state) {
  return {{"request_id", state.request_id},
          {"state", state.state},
          {"reason", state.reason},
          {"frames_taken", state.frames_taken},
          {"frames_wanted", state.frames_wanted}};
}

Json ToJson(const ProcessState& state) {
  Json values = Json::object();
  for (const auto& [key, value] : state.values) values[key] = value;
  return {{"name", state.name},
          {"status", state.IsSilent() ? std::string("silent") : state.status},
          {"reason", state.reason},
          {"waiting_for", state.waiting_for},
          {"silence_s", Number(state.silence_s)},
          {"uptime_s", Number(state.uptime_s)},
          {"received", state.received},
          {"published", state.published},
          {"dropped", state.dropped},
          {"refused", state.refused},
          {"input_rate_hz", Number(state.input_rate_hz)},
          {"output_rate_hz", Number(state.output_rate_hz)},
          {"latency_mean_s", Number(state.latency_mean_s)},
          {"latency_max_s", Number(state.latency_max_s)},
          {"restarts", state.restarts},
          {"diagnostics", values}};
}

Json ToJson(const ClockState& clock) {
  return {{"host", clock.host},
          {"other_host", clock.other_host},
          {"offset_s", Number(clock.offset_s)},
          {"bound_s", Number(clock.bound_s)}};
}

Json ToJson(const OtherDiagnosis& other) {
  return {{"name", other.name},
          {"level", other.level},
          {"message", other.message},
          {"silence_s", Number(other.silence_s)}};
}

template <typename State>
Json OrNull(const std::optional<State>& state) {
  return state ? ToJson(*state) : Json(nullptr);
}

template <typename State>
Json ListOf(const std::vector<State>& states) {
  Json list = Json::array();
  for (const State& state : states) list.push_back(ToJson(state));
  return list;
}

}  // namespace

std::string SnapshotJson(const SystemSnapshot& snapshot) {
  const Json json = {{"time_utc", UtcTextOfNs(snapshot.time_ns)},
                     {"domain", snapshot.domain_id},
                     {"forces", OrNull(snapshot.forces)},
                     {"model_error", OrNull(snapshot.model_error)},
                     {"mesh_state", OrNull(snapshot.mesh)},
                     {"perception", OrNull(snapshot.perception)},
                     {"camera", OrNull(snapshot.camera)},
                     {"cables", OrNull(snapshot.cables)},
                     {"calibration", OrNull(snapshot.calibration)},
                     {"clocks", ListOf(snapshot.clocks)},
                     {"processes", ListOf(snapshot.processes)},
                     {"other_diagnostics", ListOf(snapshot.others)}};
  // Texts of other programs may be no UTF-8.
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace palpate::monitor
