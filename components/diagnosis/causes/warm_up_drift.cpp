// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/causes/makers.hpp"

namespace palpate::diagnosis {

namespace {

/// Depth drifts while the camera gets warm, with a time constant near one that it is looked for at.
/// Nobody knows when the camera was switched on: it counts from the first stamp.
class WarmUpDrift final : public FaultModel {
 public:
  explicit WarmUpDrift(double tau_s)
      : FaultModel({"warm_up_drift", {"camera"}}, "depth drift of the camera",
                   {{.name = "amplitude_m", .fault = 5e-3},
                    {.name = "tau_s",
                     .nominal = tau_s,
                     .fault = 0.6,
                     .scale = FaultParameter::Scale::kFactor,
                     .qualifies = true}}) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->camera.drifts.push_back(
        {.amplitude_m = z[0], .tau_s = parameters()[1].ValueOf(z[1])});
  }

  void OnMeasurement(int parameter, const Eigen::VectorXd& z, const FaultContext& at,
                     Eigen::Matrix3Xd* motion_m) const override {
    const double tau_s = parameters()[1].ValueOf(z[1]);
    const double depth_m = parameter == 0 ? DriftShare(at.observed, at.seen(), tau_s)
                                          : z[0] * DriftShareByTau(at.observed, at.seen(), tau_s);
    for (Eigen::Index m = 0; m < motion_m->cols(); ++m) {
      motion_m->col(m) += depth_m * at.sight.camera->ByDrift(at.sight.point(m));
    }
  }
};

}  // namespace

void MakeWarmUpDrift(const CauseWorld& world, std::vector<FaultModelPtr>* causes) {
  if (!HasDepthCamera(world.observed)) return;
  for (const double tau_s : {20.0, 60.0, 200.0, 600.0}) {
    causes->push_back(std::make_unique<WarmUpDrift>(tau_s));
  }
}

}  // namespace palpate::diagnosis
