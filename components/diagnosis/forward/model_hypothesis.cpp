// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/model_hypothesis.hpp"

#include "libs/core/index.hpp"

namespace palpate::diagnosis {

ModelHypothesis NominalHypothesis(const robot::RobotBody& body,
                                  const ObservedExperiment& observed) {
  ModelHypothesis hypothesis(body);
  hypothesis.places = std::make_shared<fem::PointLocator>(body.mesh);
  hypothesis.assembled_m = body.mesh.nodes_m.reshaped();
  hypothesis.cable_compliance_m_N = Eigen::VectorXd::Zero(std::ssize(body.cables));
  hypothesis.marker_offset_m = Eigen::Matrix3Xd::Zero(3, std::ssize(observed.markers));
  hypothesis.T_seen.assign(observed.recordings.size(), Eigen::Isometry3d::Identity());
  hypothesis.T_surface_seen = hypothesis.T_seen;
  for (const fem::PronyTerm& term : body.creep)
    hypothesis.creep.push_back({.g = term.g, .tau_s = term.tau_s});
  if (body.softening) {
    hypothesis.mullins =
        MullinsSoftening{.inverse_r = 1.0 / body.softening->r, .m_J_m3 = body.softening->m_J_m3};
  }
  for (std::size_t c = 0; c < body.cables.size(); ++c)
    hypothesis.actuators.play_m[ToIndex(c)] = body.cables[c].play_m;
  hypothesis.surface_offset_m = Eigen::VectorXd::Zero(observed.feature_rest_m.cols());
  return hypothesis;
}

Eigen::Vector3d GravityIn(const ModelHypothesis& hypothesis, const ObservedRecording& recording) {
  return (recording.base_rotation * hypothesis.R_tilt_error).transpose() *
         hypothesis.body.gravity_m_s2;
}

Eigen::Vector3d MiddleOfBase(const robot::RobotBody& body) {
  Eigen::Vector3d sum_m = Eigen::Vector3d::Zero();
  int held = 0;
  for (int node = 0; node < body.mesh.NodeCount(); ++node) {
    if (!body.fixed.col(node).all()) continue;
    sum_m += body.mesh.nodes_m.col(node);
    ++held;
  }
  return sum_m / std::max(held, 1);
}

}  // namespace palpate::diagnosis
