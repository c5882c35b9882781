// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/causes/makers.hpp"

namespace palpate::diagnosis {

namespace {

/// A surface that is seen askew seems farther away, or nearer.
class DepthIncidenceBias final : public FaultModel {
 public:
  DepthIncidenceBias()
      : FaultModel({"depth_incidence_bias", {"camera"}}, "depth of surfaces seen askew",
                   {{.name = "b_m", .fault = 3e-3}}) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->camera.incidence_bias_m += z[0];
  }

  void OnMeasurement(int /*parameter*/, const Eigen::VectorXd& /*z*/, const FaultContext& at,
                     Eigen::Matrix3Xd* motion_m) const override {
    for (Eigen::Index m = 0; m < motion_m->cols(); ++m) {
      motion_m->col(m) += at.sight.camera->ByIncidence(at.sight.point(m));
    }
  }
};

}  // namespace

void MakeDepthIncidenceBias(const CauseWorld& world, std::vector<FaultModelPtr>* causes) {
  if (HasDepthCamera(world.observed)) causes->push_back(std::make_unique<DepthIncidenceBias>());
}

}  // namespace palpate::diagnosis
