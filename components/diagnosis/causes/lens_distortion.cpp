// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/causes/makers.hpp"

namespace palpate::diagnosis {

namespace {

/// The lens bends more, or less, than its data sheet says.
class LensDistortion final : public FaultModel {
 public:
  LensDistortion()
      : FaultModel({"lens_distortion", {"camera"}}, "distortion of the camera's lens",
                   {{.name = "k1", .fault = 0.1}}) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->camera.k1 += z[0];
  }

  void OnMeasurement(int /*parameter*/, const Eigen::VectorXd& /*z*/, const FaultContext& at,
                     Eigen::Matrix3Xd* motion_m) const override {
    for (Eigen::Index m = 0; m < motion_m->cols(); ++m) {
      motion_m->col(m) += at.sight.camera->ByDistortion(at.sight.point(m));
    }
  }
};

}  // namespace

void MakeLensDistortion(const CauseWorld& world, std::vector<FaultModelPtr>* causes) {
  if (HasDepthCamera(world.observed)) causes->push_back(std::make_unique<LensDistortion>());
}

}  // namespace palpate::diagnosis
