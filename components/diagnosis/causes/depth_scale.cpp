// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/causes/makers.hpp"

namespace palpate::diagnosis {

namespace {

/// A depth camera that was calibrated at another distance, or another temperature.
class DepthScale final : public FaultModel {
 public:
  DepthScale()
      : FaultModel({"depth_scale", {"camera"}}, "depth scale of the camera",
                   {{.name = "s", .tolerance = 0.002, .fault = 0.02, .least = -0.9}}) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->camera.depth_scale += z[0];
  }

  void OnMeasurement(int /*parameter*/, const Eigen::VectorXd& /*z*/, const FaultContext& at,
                     Eigen::Matrix3Xd* motion_m) const override {
    for (Eigen::Index m = 0; m < motion_m->cols(); ++m) {
      motion_m->col(m) += at.sight.camera->ByDepthScale(at.sight.point(m));
    }
  }
};

}  // namespace

void MakeDepthScale(const CauseWorld& world, std::vector<FaultModelPtr>* causes) {
  if (HasDepthCamera(world.observed)) causes->push_back(std::make_unique<DepthScale>());
}

}  // namespace palpate::diagnosis
