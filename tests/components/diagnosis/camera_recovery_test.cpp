// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "components/diagnosis/faults/catalogue.hpp"
#include "components/diagnosis/inference/selection.hpp"
#include "tests/components/diagnosis/small_robot.hpp"

namespace palpate::diagnosis {
namespace {

constexpr unsigned kCameraSeed = 5;
constexpr double kSigma_m = 1e-4;

/// SmallExperiment, all of it seen by one depth camera that is moved for the last recording.
experiment::Experiment SeenByACamera(const robot::RobotBody& body) {
  experiment::Experiment experiment = SmallExperiment(body);
  for (experiment::Recording& recording : experiment.recordings) {
    if (recording.frame) continue;
    recording.frame = experiment::MeasurementFrame::kCamera;
    recording.T_robot_camera = experiment.recordings[2].T_robot_camera;
  }
  experiment.markers_sigma_m = Eigen::Vector3d::Constant(kSigma_m);
  return experiment;
}

/// A small robot as its file has it, and a camera with something wrong.
class CameraRecovery : public testing::Test {
 protected:
  CameraRecovery() {
    std::map<std::string, rgbd::CameraModel> cameras = SmallCameras();
    cameras["a_ramp"] = cameras["b_hold"] = cameras["c_tilt"];
    observed_ =
        Observe(SeenByACamera(body_), body_, {.most_samples = 24, .depth_cameras = cameras});
    hypotheses_.emplace(MakeFaultModels({body_, observed_}, {}), std::map<std::string, double>{});
  }

  /// The first fault of this name; of those that begin with a recording, with this one.
  int Find(const std::string& id, const std::string& recording = "") const {
    for (int k = 0; k < hypotheses_->size(); ++k) {
      const FaultModel& cause = hypotheses_->model(k);
      if (cause.name().id == id && cause.words().ends_with(recording)) return k;
    }
    ADD_FAILURE() << id;
    return 0;
  }

  /// What the markers would be measured at; everything else as it is.
  Selection Diagnose(int cause, const Eigen::VectorXd& z) {
    const FaultModelList one{&hypotheses_->model(cause)};
    const Simulation truth =
        Simulator(observed_, 1).Run(HypothesisWith(NominalHypothesis(body_, observed_), one, z));
    EXPECT_TRUE(truth.status.ok()) << truth.status.message();
    std::mt19937 random(kCameraSeed);
    std::normal_distribution<double> noise_m(0.0, kSigma_m);
    for (std::size_t s = 0; s < observed_.samples.size(); ++s) {
      Sample& sample = observed_.samples[s];
      sample.position_m = truth.samples[s].markers_m();
      for (Eigen::Index m = 0; m < sample.position_m.cols(); ++m) {
        for (double& coordinate_m : sample.position_m.col(m)) {
          coordinate_m += noise_m(random) / std::sqrt(sample.count[m]);
        }
      }
    }
    const Fitter fitter(observed_, body_, *hypotheses_, NoiseModel{}, 1);
    return SelectFaults(observed_, fitter, fitter.AsBuilt(), 4, [](int, int, const auto&) {});
  }

  /// Named alone, each parameter within `sigmas` of what is known of it.
  void ExpectFound(const std::string& id, const std::string& recording, const Eigen::VectorXd& z) {
    const int cause = Find(id, recording);
    const Selection selection = Diagnose(cause, z);
    ASSERT_EQ(selection.named.size(), 1U) << "seed " << kCameraSeed;
    EXPECT_EQ(selection.named[0].fault, cause)
        << hypotheses_->model(selection.named[0].fault).words() << ", seed " << kCameraSeed;
    for (Eigen::Index p = 0; p < z.size(); ++p) {
      const Eigen::Index column = hypotheses_->first(cause) + p;
      const double sigma = std::sqrt(selection.best.posterior.covariance(column, column));
      EXPECT_NEAR(selection.best.posterior.mean[column], z[p], 4.0 * sigma) << p;
      EXPECT_LT(sigma,
                0.5 * hypotheses_->model(cause).parameters()[static_cast<std::size_t>(p)].fault);
    }
  }

  robot::RobotBody body_ = SmallRobot();
  ObservedExperiment observed_;
  std::optional<HypothesisSet> hypotheses_;
};

TEST_F(CameraRecovery, AHealthyCameraIsAcquitted) {
  const Selection selection = Diagnose(Find("depth_scale"), Eigen::VectorXd::Constant(1, 0.0015));
  EXPECT_TRUE(selection.named.empty())
      << hypotheses_->model(selection.named.front().fault).words() << ", seed " << kCameraSeed;
}

TEST_F(CameraRecovery, DepthScaleIsNamed) {
  ExpectFound("depth_scale", "", Eigen::VectorXd::Constant(1, -0.025));
}

TEST_F(CameraRecovery, IntrinsicsAreNamed) {
  ExpectFound("intrinsics", "", Eigen::Vector3d(0.025, 8.0, -5.0));
}

TEST_F(CameraRecovery, ACameraThatMovedIsNamedWithTheRecordingFromWhichOn) {
  Eigen::VectorXd z(6);
  z << 0.006, -0.004, 0.005, 0.02, -0.03, 0.01;
  ExpectFound("camera_moved", "c_tilt", z);
}

TEST_F(CameraRecovery, TheCentreOfAnUnknownCameraIsNotToldInPixels) {
  observed_ = Observe(SeenByACamera(body_), body_, {.most_samples = 24});
  const auto causes = MakeFaultModels({body_, observed_}, {});
  const auto found = std::find_if(causes.begin(), causes.end(), [](const FaultModelPtr& cause) {
    return cause->name().id == "intrinsics";
  });
  ASSERT_NE(found, causes.end());
  ASSERT_EQ((*found)->parameters().size(), 1U);
  EXPECT_EQ((*found)->parameters()[0].name, "focal");
}

TEST_F(CameraRecovery, OfARobotThatNoCameraSawNoCameraIsBlamed) {
  experiment::Experiment experiment = SmallExperiment(body_);
  experiment.recordings.resize(2);
  observed_ = Observe(experiment, body_, {.most_samples = 24});
  for (const FaultModelPtr& cause : MakeFaultModels({body_, observed_}, {})) {
    EXPECT_NE(cause->name().where.front(), "camera") << cause->words();
  }
}

}  // namespace
}  // namespace palpate::diagnosis
