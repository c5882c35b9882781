// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>

#include "components/diagnosis/faults/makers.hpp"

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
      motion_m->col(m) += at.measured_points.camera->ByDepthScale(at.measured_points.point(m));
    }
  }
};

}  // namespace

void MakeDepthScale(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  if (HasDepthCamera(inputs.observed)) faults->push_back(std::make_unique<DepthScale>());
}

namespace {

/// A surface that is seen askew seems farther away, or nearer.
class DepthIncidenceBias final : public FaultModel {
 public:
  DepthIncidenceBias()
      : FaultModel({"depth_incidence_bias", {"camera"}}, "depth error at oblique incidence",
                   {{.name = "b_m", .fault = 3e-3}}) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->camera.incidence_bias_m += z[0];
  }

  void OnMeasurement(int /*parameter*/, const Eigen::VectorXd& /*z*/, const FaultContext& at,
                     Eigen::Matrix3Xd* motion_m) const override {
    for (Eigen::Index m = 0; m < motion_m->cols(); ++m) {
      motion_m->col(m) += at.measured_points.camera->ByIncidence(at.measured_points.point(m));
    }
  }
};

}  // namespace

void MakeDepthIncidenceBias(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  if (HasDepthCamera(inputs.observed)) faults->push_back(std::make_unique<DepthIncidenceBias>());
}

namespace {

/// The camera's focal length and image centre are not those of its data sheet. The image centre is
/// left out unless the focal length is known in pixels.
class Intrinsics final : public FaultModel {
 public:
  explicit Intrinsics(bool with_centre)
      : FaultModel({"intrinsics", {"camera"}}, "intrinsics of the camera",
                   Parameters(with_centre)) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->camera.focal += z[0];
    if (z.size() == 1) return;
    hypothesis->camera.cx_px += z[1];
    hypothesis->camera.cy_px += z[2];
  }

  void OnMeasurement(int parameter, const Eigen::VectorXd& /*z*/, const FaultContext& at,
                     Eigen::Matrix3Xd* motion_m) const override {
    for (Eigen::Index m = 0; m < motion_m->cols(); ++m) {
      const CameraView& camera = *at.measured_points.camera;
      motion_m->col(m) += parameter == 0
                              ? camera.ByFocal(at.measured_points.point(m))
                              : camera.ByCentre(at.measured_points.point(m), parameter - 1);
    }
  }

 private:
  static std::vector<FaultParameter> Parameters(bool with_centre) {
    std::vector<FaultParameter> parameters = {
        {.name = "focal", .tolerance = 0.002, .fault = 0.02, .least = -0.9}};
    if (!with_centre) return parameters;
    for (const char* name : {"cx_px", "cy_px"}) {
      parameters.push_back({.name = name, .tolerance = 1.0, .fault = 10.0});
    }
    return parameters;
  }
};

}  // namespace

void MakeIntrinsics(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  if (!HasDepthCamera(inputs.observed)) return;
  const auto& recordings = inputs.observed.recordings;
  const bool with_centre =
      std::all_of(recordings.begin(), recordings.end(), [](const ObservedRecording& recording) {
        const bool seen = recording.by_depth_camera || recording.T_camera_robot;
        return !seen || recording.focal_px.has_value();
      });
  faults->push_back(std::make_unique<Intrinsics>(with_centre));
}

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
      motion_m->col(m) += at.measured_points.camera->ByDistortion(at.measured_points.point(m));
    }
  }
};

}  // namespace

void MakeLensDistortion(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  if (HasDepthCamera(inputs.observed)) faults->push_back(std::make_unique<LensDistortion>());
}

namespace {

/// Depth drifts while the camera gets warm, with a time constant near one that it is searched at.
/// The time of switching on is unknown: drift counts from the first stamp.
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
      motion_m->col(m) += depth_m * at.measured_points.camera->ByDrift(at.measured_points.point(m));
    }
  }
};

}  // namespace

void MakeWarmUpDrift(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  if (!HasDepthCamera(inputs.observed)) return;
  for (const double tau_s : {20.0, 60.0, 200.0, 600.0}) {
    faults->push_back(std::make_unique<WarmUpDrift>(tau_s));
  }
}

}  // namespace palpate::diagnosis
