// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/prediction_history.hpp"

#include <algorithm>
#include <utility>

#include "components/perception/predicted_surface.hpp"
#include "libs/core/seconds.hpp"
#include "libs/dds/geometry_messages.hpp"
#include "libs/dds/stamp.hpp"

namespace palpate::perception {

Status PredictionHistory::SetMesh(const idl::palpate_msgs::Mesh& message) {
  Eigen::Matrix3Xd nodes_m;
  if (Status status = dds::FromMesh(message, &nodes_m, &triangles_); !status.ok()) return status;
  node_count_ = nodes_m.cols();
  const std::string before = std::exchange(mesh_hash_, dds::Text(message.mesh_hash));
  if (!before.empty() && before != mesh_hash_) Clear();
  return Status::Ok();
}

Status PredictionHistory::Add(const idl::palpate_msgs::MeshState& message) {
  if (has_mesh() && dds::Text(message.mesh_hash) != mesh_hash_) {
    return {StatusCode::kInvalidInput, "a state of another mesh than /robot/mesh"};
  }
  State state{dds::StampNs(message.header.stamp), {}};
  if (message.positions_m._length > 0) {
    const Eigen::Index node_count = has_mesh() ? node_count_ : message.positions_m._length / 3;
    Status status = dds::FromMeshState(message, node_count, &state.nodes_m);
    if (!status.ok()) return status;
  }
  if (states_.size() == kMostStates) states_.pop_front();
  states_.push_back(std::move(state));
  return Status::Ok();
}

void PredictionHistory::Clear() { states_.clear(); }

bool PredictionHistory::IsUsable(const State& state) const {
  return has_mesh() && state.nodes_m.cols() == node_count_;
}

bool PredictionHistory::IsAnswered(std::int64_t stamp_ns) const {
  return std::any_of(states_.begin(), states_.end(),
                     [&](const State& state) { return state.stamp_ns == stamp_ns; });
}

std::optional<Prediction> PredictionHistory::Before(std::int64_t stamp_ns, double max_age_s,
                                                    const Eigen::Isometry3d& T_robot_camera) const {
  const State* newest = nullptr;
  for (const State& state : states_) {
    if (!IsUsable(state) || state.stamp_ns >= stamp_ns) continue;
    if (!newest || state.stamp_ns >= newest->stamp_ns) newest = &state;
  }
  if (!newest) return std::nullopt;
  const double age_s = NsToSeconds(stamp_ns - newest->stamp_ns);
  if (age_s > max_age_s) return std::nullopt;
  return PredictionOf(*newest, T_robot_camera);
}

std::optional<Prediction> PredictionHistory::Last(const Eigen::Isometry3d& T_robot_camera) const {
  const auto last = std::find_if(states_.rbegin(), states_.rend(),
                                 [this](const State& state) { return IsUsable(state); });
  if (last == states_.rend()) return std::nullopt;
  return PredictionOf(*last, T_robot_camera);
}

Prediction PredictionHistory::PredictionOf(const State& state,
                                           const Eigen::Isometry3d& T_robot_camera) const {
  return {state.stamp_ns, MakePredictedSurface(state.nodes_m, triangles_, T_robot_camera)};
}

}  // namespace palpate::perception
