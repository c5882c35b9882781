// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/experiment/experiment_frames.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "components/view/experiment/estimated_forces.hpp"
#include "components/view/experiment/near_points.hpp"
#include "libs/core/error.hpp"
#include "tests/components/view/robot/cabled_beam.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::view {
namespace {

using test_support::MessageOf;
using test_support::TestFolder;
using testing::HasSubstr;

robot::RobotBody MarkedBeam() {
  return CabledBeam({{"near", {-0.05, 0.015, 0.03}, {}}, {"tip", {0.0, 0.015, 0.03}, {}}});
}

/// The markers of the model, pulled by 0, 1 and 2 mm a tenth of a second apart.
class ModelExperiment : public testing::Test {
 protected:
  ModelExperiment() {
    experiment_.folder = "exp";
    experiment_.markers_sigma_m = Eigen::Vector3d::Constant(1e-4);
    experiment::Recording recording;
    recording.name = "r1_ramp";
    recording.actuation =
        experiment::Actuation{{0.0, 0.1, 0.2}, {{"top", {}, {0.0, 1e-3, 2e-3}, {}}}};
    recording.markers = experiment::MarkerTracks{{"near", "tip"}, {{}, {}}, {}};
    for (const double t_s : {0.0, 0.1, 0.2}) {
      experiment::MarkerFrame frame;
      frame.t_s = t_s;
      for (const Eigen::Vector3d& position_m : MarkersAt(0.01 * t_s)) {
        frame.positions_m.emplace_back(position_m);
      }
      recording.markers->frames.push_back(frame);
    }
    experiment_.recordings = {recording};
  }

  std::vector<Eigen::Vector3d> MarkersAt(double displacement_m) {
    KnownRobot robot(MarkedBeam());
    fem::StaticState state = robot.model().RestState();
    EXPECT_TRUE(
        robot.model()
            .Solve({{robot::ActuatorCommand::Kind::kDisplacement, displacement_m}}, {}, &state)
            .status.ok());
    std::vector<Eigen::Vector3d> markers_m;
    for (const robot::BodyMarker& marker : robot.body().markers) {
      markers_m.push_back(marker.point.weights.Position(state.x_m));
    }
    return markers_m;
  }
  std::optional<Eigen::Vector3d>& Measured(std::size_t frame, std::size_t marker) {
    return experiment_.recordings.front().markers->frames[frame].positions_m[marker];
  }

  experiment::Experiment experiment_;
  KnownRobot robot_{MarkedBeam()};
};

TEST_F(ModelExperiment, HasNoResidualAtItsOwnShape) {
  ExperimentFrames frames(experiment_, robot_, nullptr);
  ASSERT_EQ(frames.instants().size(), 3U);
  EXPECT_NEAR(frames.duration_s(), 0.2, 1e-12);
  for (const ExperimentInstant& instant : frames.instants()) {
    const ExperimentFrame frame = frames.FrameAt(instant);
    EXPECT_TRUE(frame.status.ok()) << frame.status.message();
    EXPECT_EQ(frame.seen, 2);
    EXPECT_LT(frame.residual_rms_m, 1e-9);
    EXPECT_NEAR(frame.noise_rms_m, 1e-4, 1e-12);
    EXPECT_NEAR(frame.cables.front().displacement_m, 0.01 * instant.t_s, 1e-9);
    EXPECT_EQ(frame.estimated, nullptr);
  }
}

TEST_F(ModelExperiment, ShowsWhereAMarkerIsOffTheModel) {
  const Eigen::Vector3d off_m(0.0, 3e-4, 0.0);
  *Measured(1, 1) += off_m;
  Measured(2, 0) = std::nullopt;
  ExperimentFrames frames(experiment_, robot_, nullptr);
  const ExperimentFrame frame = frames.FrameAt(frames.instants()[1]);
  EXPECT_LT((frame.measured_m.col(1) - frame.model_m.col(1) - off_m).norm(), 1e-9);
  EXPECT_NEAR(frame.residual_rms_m, off_m.norm() / std::sqrt(6.0), 1e-9);
  const ExperimentFrame hidden = frames.FrameAt(frames.instants()[2]);
  EXPECT_EQ(hidden.seen, 1);
  EXPECT_TRUE(hidden.measured_m.col(0).array().isNaN().all());
  EXPECT_LT(hidden.residual_rms_m, 1e-9);
}

TEST_F(ModelExperiment, ShowsNoResidualWithoutAnEquilibrium) {
  experiment_.recordings.front().actuation->columns.front().samples.back() = 1.9;
  ExperimentFrames frames(experiment_, robot_, nullptr);
  const ExperimentFrame frame = frames.FrameAt(frames.instants()[2]);
  EXPECT_FALSE(frame.status.ok()) << "a beam of 0.15 m cannot be pulled in by 1.9 m";
  EXPECT_TRUE(std::isnan(frame.residual_rms_m));
  EXPECT_TRUE(frame.model_m.array().isNaN().all());
  EXPECT_TRUE(std::isnan(frame.cables.front().tension_N));
  EXPECT_TRUE(frame.measured_m.allFinite()) << "what was measured is shown";
}

TEST_F(ModelExperiment, CountsMarkersFromTheirReference) {
  const Eigen::Vector3d elsewhere_m(0.02, -0.01, 0.3);
  for (std::size_t frame = 0; frame < 3; ++frame) {
    for (std::size_t marker = 0; marker < 2; ++marker) *Measured(frame, marker) += elsewhere_m;
  }
  experiment_.recordings.front().reference =
      experiment::Reference{{-0.05, 0.05}, experiment::ReferenceShape::kEquilibrium};
  ExperimentFrames frames(experiment_, robot_, nullptr);
  EXPECT_LT(frames.FrameAt(frames.instants()[2]).residual_rms_m, 1e-9);
}

TEST_F(ModelExperiment, LetsKnownLoadsAct) {
  const Eigen::Vector3d force_N(0.0, 0.0, -0.05);
  experiment::KnownLoad& load = experiment_.recordings.front().loads.emplace_back();
  load.position_m = {0.0, 0.015, 0.03};
  load.force_N = force_N;
  ExperimentFrames frames(experiment_, robot_, nullptr);
  const ExperimentFrame frame = frames.FrameAt(frames.instants()[0]);
  ASSERT_EQ(frame.known.size(), 1U);
  EXPECT_EQ(frame.known[0].force_N, force_N);
  EXPECT_LT(frame.model_m(2, 1), frame.measured_m(2, 1) - 1e-5);  // the model bends down
  EXPECT_NEAR(frame.known[0].position_m.z(), frame.model_m(2, 1), 1e-9);
}

TEST_F(ModelExperiment, FollowsRecordingsWithoutThePauseBetweenThem) {
  experiment::Recording second = experiment_.recordings.front();
  second.name = "r2_ramp";
  for (double& t_s : second.actuation->t_s) t_s += 100.0;
  for (experiment::MarkerFrame& frame : second.markers->frames) frame.t_s += 100.0;
  experiment_.recordings.push_back(second);
  ExperimentFrames frames(experiment_, robot_, nullptr);
  ASSERT_EQ(frames.instants().size(), 6U);
  EXPECT_LT(frames.duration_s(), 0.5);
  EXPECT_EQ(frames.RecordingOf(frames.instants()[3]).name, "r2_ramp");
  // Back and forth: the shape depends on the commands alone.
  EXPECT_LT(frames.FrameAt(frames.instants()[5]).residual_rms_m, 1e-9);
  EXPECT_LT(frames.FrameAt(frames.instants()[1]).residual_rms_m, 1e-9);
}

TEST_F(ModelExperiment, RefusesWhatDoesNotFitTheRobot) {
  experiment_.recordings.front().markers->names[1] = "top_of_it";
  EXPECT_THAT(MessageOf([&] { ExperimentFrames(experiment_, robot_, nullptr); }),
              HasSubstr("top_of_it"));
  experiment_.recordings.front().markers.reset();
  experiment_.recordings.front().actuation.reset();
  EXPECT_THAT(MessageOf([&] { ExperimentFrames(experiment_, robot_, nullptr); }),
              HasSubstr("no recording has markers, images, clouds or cable inputs"));
}

constexpr const char* kHeader =
    "recording,t_s,contact,x_m,y_m,z_m,fx_N,fy_N,fz_N,ci95_N,location_ci95_m,status,cov_xx_N2,"
    "cov_xy_N2,cov_xz_N2,cov_yy_N2,cov_yz_N2,cov_zz_N2\n";

TEST(EstimatedForces, AreThoseOfTheNewestFrame) {
  const TestFolder folder;
  const auto forces = EstimatedForces::Read(
      folder.Write("forces.csv", std::string(kHeader) +
                                     "r1,0.1,,,,,,,,,,no_contact,,,,,,\n"
                                     "r1,0.2,a,0.01,0.02,0.03,0,0,-0.5,0.1,0.002,ok,1,0,0,1,0.5,2\n"
                                     "r1,0.2,b,0.01,0.02,0.03,,,,,,unobservable,,,,,,\n"
                                     "r2,0.1,a,0,0,0,1,0,0,0.1,0,ok,1,0,0,1,0,1\n"));
  EXPECT_EQ(forces.At("r1", 0.05), nullptr);
  EXPECT_EQ(forces.At("r3", 1.0), nullptr);
  EXPECT_EQ(forces.At("r1", 0.1)->status, "no_contact");
  EXPECT_TRUE(forces.At("r1", 0.1)->forces.empty());
  const EstimatedFrame& frame = *forces.At("r1", 7.0);
  ASSERT_EQ(frame.forces.size(), 2U);
  EXPECT_EQ(frame.forces[0].force_N, Eigen::Vector3d(0.0, 0.0, -0.5));
  EXPECT_EQ(frame.forces[0].ci95_N, 0.1);
  EXPECT_EQ(frame.forces[0].covariance_N2(2, 1), 0.5);
  EXPECT_FALSE(frame.forces[1].force_N);
  EXPECT_TRUE(frame.forces[1].covariance_N2.array().isNaN().all());
  EXPECT_EQ(frame.forces[1].status, "unobservable");
}

TEST(EstimatedForces, AreRefusedWhereTimeFalls) {
  const TestFolder folder;
  const auto file = folder.Write("forces.csv", std::string(kHeader) +
                                                   "r1,0.2,,,,,,,,,,no_contact,,,,,,\n"
                                                   "r1,0.1,,,,,,,,,,no_contact,,,,,,\n");
  EXPECT_THAT(MessageOf([&] { EstimatedForces::Read(file); }), HasSubstr(":3:"));
}

TEST(NearPoints, AreThoseAboutTheRobotInItsFrame) {
  rgbd::RgbdCamera camera;
  camera.depth = {
      .width_px = 64, .height_px = 48, .fx_px = 50, .fy_px = 50, .cx_px = 31.5, .cy_px = 23.5};
  camera.depth_unit_m = 1e-3;
  rgbd::DepthImage depth(64, 48, 400);  // a wall 0.4 m before the camera
  *depth.Pixel(0, 0) = 0;
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
  T_robot_camera.translation().z() = -0.4;
  Eigen::Matrix3Xd nodes_m(3, 2);
  nodes_m << -0.05, 0.05, -0.05, 0.05, -0.05, 0.05;
  const auto near = NearPoints(depth, camera, T_robot_camera, nodes_m);
  ASSERT_GT(near.Count(), 100);
  EXPECT_LT(near.points_m.row(2).cwiseAbs().maxCoeff(), 1e-6F);
  EXPECT_LT(near.points_m.topRows(2).cwiseAbs().maxCoeff(), 0.05F + 0.0867F);
  EXPECT_LT(near.Count(), 64 * 48);
  T_robot_camera.translation().z() = -4.0;
  EXPECT_EQ(NearPoints(depth, camera, T_robot_camera, nodes_m).Count(), 0);
}

}  // namespace
}  // namespace palpate::view
