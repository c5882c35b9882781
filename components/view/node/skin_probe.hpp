// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "components/view/config.hpp"
#include "components/view/frames/page_request.hpp"
#include "components/view/node/shown_markers.hpp"
#include "components/view/node/shown_mesh.hpp"
#include "components/view/robot/known_robot.hpp"

namespace palpate::view {

/// Answers clicks on the skin: place, displacement, and the smallest force that could be felt
/// there by what is measured now (KnownRobot::SmallestForce).
class SkinProbe {
 public:
  /// `robot`: null where it is not known; else it must outlive this.
  SkinProbe(const ProbeConfig& config, KnownRobot* robot) : config_(config), robot_(robot) {}

  void Take(const idl::sensor_msgs::JointState& message);
  void Take(const idl::palpate_msgs::ModelGap& message);
  void Take(ShownMarkers markers) { markers_ = std::move(markers); }
  /// [nodes of the surface] NaN: no measured point is near the node.
  void TakeResidual(std::vector<float> residual_m) { residual_m_ = std::move(residual_m); }
  void Forget();

  OutMessage Answer(const ProbeRequest& request, const ShownMesh& mesh);

 private:
  Status Measured(const ShownMesh& mesh, MeasuredRows* measured) const;
  Status MeasuredByMarkers(MeasuredRows* measured) const;
  Status MeasuredByCloud(const ShownMesh& mesh, MeasuredRows* measured) const;
  Status SmallestForce(std::size_t vertex, const ShownMesh& mesh, double* force_N);
  Eigen::VectorXd Tensions_N() const;

  ProbeConfig config_;
  KnownRobot* robot_;
  std::map<std::string, double> tension_N_;  ///< by cable
  std::optional<ShownMarkers> markers_;
  std::vector<float> residual_m_;
  double noise_rms_m_ = 0.0;  ///< of /model_gap, per sample
  std::uint32_t sample_count_ = 0;
};

}  // namespace palpate::view
