// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <functional>
#include <map>
#include <optional>

#include "components/force_estimation/marker_force_estimator.hpp"
#include "libs/dds/participant.hpp"
#include "libs/dds/wait_set.hpp"

namespace palpate::command {

/// Reads the topics of palpate-force-estimation.
class ForceListener {
 public:
  /// Throws RunError where DDS refuses.
  explicit ForceListener(int domain_id);

  /// Takes messages until `done()` holds, which is checked at least every 50 ms; false where
  /// `limit` passes first.
  bool Listen(const std::function<bool()>& done, std::chrono::seconds limit);

  bool estimator_is_there() const { return forces_.matched() > 0; }

  /// The estimate for each marker frame, by its stamp in ns; the last one where a frame was played
  /// twice.
  const std::map<int64_t, force_estimation::ForceEstimate>& estimates() const { return estimates_; }

  /// [3n] nodes of the newest usable mesh state; nullopt where there was none.
  const std::optional<Eigen::VectorXd>& mesh_state_m() const { return mesh_state_m_; }

 private:
  void TakeForces();
  void TakeMeshStates();

  dds::Participant participant_;
  dds::WaitSet loop_;
  dds::Reader<idl::palpate_msgs::ForceArray> forces_;
  dds::Reader<idl::palpate_msgs::MeshState> mesh_states_;
  std::map<int64_t, force_estimation::ForceEstimate> estimates_;
  std::optional<Eigen::VectorXd> mesh_state_m_;
};

}  // namespace palpate::command
