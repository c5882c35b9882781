// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <set>

#include "tests/components/diagnosis/fault_derivatives.hpp"

namespace palpate::diagnosis {
namespace {

/// Of all recordings but the hold: in those whose markers are in the camera's frame by that camera,
/// else by one of its own. One feature is not in view in the ramp.
void SeeSkin(const robot::RobotBody& body, ObservedExperiment* observed) {
  observed->feature_rest_m.resize(3, std::ssize(body.feature_points));
  for (std::size_t f = 0; f < body.feature_points.size(); ++f) {
    observed->feature_rest_m.col(static_cast<Eigen::Index>(f)) = body.feature_points[f].rest_m;
  }
  for (ObservedRecording& recording : observed->recordings) {
    if (recording.name == "b_hold") continue;
    Eigen::Isometry3d T_camera_robot = recording.T_measurement_robot;
    if (!recording.camera_frame) {
      T_camera_robot.linear() =
          Eigen::AngleAxisd(2.5, Eigen::Vector3d(1.0, 0.3, -0.2).normalized()).toRotationMatrix();
      T_camera_robot.translation() = Eigen::Vector3d(0.02, -0.01, 0.4);
    }
    recording.T_camera_robot = T_camera_robot;
    recording.by_depth_camera = false;
    recording.focal_px = Eigen::Vector2d(420.0, 400.0);
    recording.stereo_px_m = 20.0;
  }
  for (Sample& sample : observed->samples) {
    const auto& recording = observed->recordings[static_cast<std::size_t>(sample.recording)];
    sample.surface.resize(body.feature_points.size());
    for (std::size_t f = 0; f < sample.surface.size() && recording.T_camera_robot; ++f) {
      SurfaceMeasurement& surface = sample.surface[f];
      surface.count = recording.name == "a_ramp" && f == 0 ? 0 : 1;
      surface.point = body.feature_points[f].weights;
      surface.rest_m = body.feature_points[f].rest_m;
      const Eigen::Vector3d seen_m = *recording.T_camera_robot * surface.rest_m;
      surface.normal = 0.95 * (Eigen::Vector3d(0.3, -0.2, 0.1) - seen_m.normalized()).normalized();
      surface.sigma_m = 1e-4;
      surface.ripple_m_px = Eigen::Vector2d(3e-3, -5e-3);
    }
  }
}

/// Beside markers, of the camera that they are in the frame of, or another.
class FaultDerivativesOfSkin : public FaultDerivatives {
 protected:
  FaultDerivativesOfSkin()
      : FaultDerivatives(SmallRobot(), SmallExperiment(SmallRobot()), SeeSkin) {}
};

TEST_F(FaultDerivativesOfSkin, AreThoseOfApplyWhereTheRobotIsAsItsFileHasIt) {
  ExpectDerivativesAsBuilt();
}

/// Where all that a camera gets wrong is there, what moves the body is seen through it.
TEST_F(FaultDerivativesOfSkin, AreThoseOfApplyBehindABadCamera) {
  FaultModelList all;
  Eigen::Index parameters = 0;
  for (const FaultModelPtr& cause : causes_) {
    const std::set<std::string> looked_at = {"youngs_modulus", "cable_gain", "extrinsics",
                                             "depth_scale",    "intrinsics", "lens_distortion",
                                             "warm_up_drift",  "depth_bias", "depth_incidence_bias",
                                             "stereo_ripple",  "skin_offset"};
    if (!looked_at.contains(cause->name().id)) continue;
    all.push_back(cause.get());
    parameters += std::ssize(cause->parameters());
  }
  Eigen::VectorXd z(parameters);
  Eigen::Index p = 0;
  for (const FaultModel* cause : all) {
    for (const FaultParameter& parameter : cause->parameters()) z[p++] = 0.1 * parameter.fault;
  }
  const Eigen::MatrixXd analytic = Analytic(all, z);
  p = 0;
  for (const FaultModel* cause : all) {
    for (const FaultParameter& parameter : cause->parameters()) {
      ExpectAlike(parameter.fault * analytic.col(p),
                  parameter.fault * Difference(all, z, p, parameter), 4e-3,
                  cause->words() + ", " + parameter.name, 1e-2);
      ++p;
    }
  }
}

/// Without measured markers, places of markers do not matter.
TEST_F(FaultDerivativesOfSkin, NeedNoMarkers) {
  for (Sample& sample : observed_.samples) sample.count.setZero();
  const std::vector<FaultModelPtr> causes =
      MakeFaultModels({.body = body_, .observed = observed_}, {});
  for (const FaultModelPtr& cause : causes) EXPECT_NE(cause->name().id, "marker_misplacement");
  const auto modulus = std::find_if(causes.begin(), causes.end(), [](const FaultModelPtr& cause) {
    return cause->name().id == "youngs_modulus";
  });
  const FaultModelList one{modulus->get()};
  const Eigen::VectorXd alone = Analytic(one, Eigen::VectorXd::Zero(1));
  for (Sample& sample : observed_.samples) sample.count.setOnes();
  const Eigen::VectorXd beside = Analytic(one, Eigen::VectorXd::Zero(1));
  for (Eigen::Index s = 0; s < std::ssize(observed_.samples); ++s) {
    EXPECT_TRUE(alone.segment(each_ * s, each_ - 2).isZero(0.0));
    EXPECT_LT((alone - beside).segment(each_ * s + each_ - 2, 2).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace palpate::diagnosis
