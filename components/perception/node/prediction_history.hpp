// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "components/perception/observation.hpp"
#include "libs/core/status.hpp"
#include "libs/dds/topics.hpp"

namespace palpate::perception {

/// The model's surface at one instant, camera frame.
struct Prediction {
  std::int64_t stamp_ns = 0;
  PredictedSurface surface;
};

/// The last states of the model, from which a frame takes the newest one before it.
class PredictionHistory {
 public:
  /// kInvalidInput for an invalid mesh; the one before stays.
  Status SetMesh(const idl::palpate_msgs::Mesh& message);
  /// A state without positions marks its frame as answered; one before its mesh waits for it.
  /// kInvalidInput for a state of another mesh, and an invalid one.
  Status Add(const idl::palpate_msgs::MeshState& message);
  void Clear();

  const std::string& mesh_hash() const { return mesh_hash_; }  ///< empty: none has come
  bool has_mesh() const { return !mesh_hash_.empty(); }
  /// Whether the model's answer to the frame of this stamp has come.
  bool IsAnswered(std::int64_t stamp_ns) const;
  /// The newest state before `stamp_ns` that is no older than `max_age_s`.
  std::optional<Prediction> Before(std::int64_t stamp_ns, double max_age_s,
                                   const Eigen::Isometry3d& T_robot_camera) const;
  /// The one that came last, whatever its stamp.
  std::optional<Prediction> Last(const Eigen::Isometry3d& T_robot_camera) const;

 private:
  struct State {
    std::int64_t stamp_ns = 0;
    Eigen::Matrix3Xf nodes_m;  ///< [3 x n] robot frame; empty: none
  };

  bool IsUsable(const State& state) const;
  Prediction PredictionOf(const State& state, const Eigen::Isometry3d& T_robot_camera) const;

  static constexpr std::size_t kMostStates = 16;

  std::string mesh_hash_;
  Eigen::Index node_count_ = 0;
  Eigen::Matrix3Xi triangles_;
  std::deque<State> states_;  ///< in the order of their coming
};

}  // namespace palpate::perception
