// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>

#include "components/diagnosis/causes/makers.hpp"

namespace palpate::diagnosis {

namespace {

/// The camera's focal length and image centre are not those of its data sheet. Where nobody says
/// how many pixels that focal length is, its centre cannot be told in pixels, and is left out.
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
      const CameraView& camera = *at.sight.camera;
      motion_m->col(m) += parameter == 0 ? camera.ByFocal(at.sight.point(m))
                                         : camera.ByCentre(at.sight.point(m), parameter - 1);
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

void MakeIntrinsics(const CauseWorld& world, std::vector<FaultModelPtr>* causes) {
  if (!HasDepthCamera(world.observed)) return;
  const auto& recordings = world.observed.recordings;
  const bool with_centre =
      std::all_of(recordings.begin(), recordings.end(), [](const ObservedRecording& recording) {
        const bool seen = recording.by_depth_camera || recording.T_camera_robot;
        return !seen || recording.focal_px.has_value();
      });
  causes->push_back(std::make_unique<Intrinsics>(with_centre));
}

}  // namespace palpate::diagnosis
