// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/components/diagnosis/small_robot.hpp"

#include "libs/fem/linearisation.hpp"
#include "libs/fem/shape_functions.hpp"
#include "tests/libs/fem/points/meshes.hpp"
#include "tests/support/robots.hpp"

namespace palpate::diagnosis {

namespace {

constexpr double kGuideRadius_m = 0.0015;

void AddCable(const std::string& name, const Eigen::Matrix3Xd& path_m,
              const fem::PointLocator& locator, robot::RobotBody* body) {
  robot::BodyCable cable{name, path_m.col(0), {}, 50.0};
  cable.guide_radius_m = kGuideRadius_m;
  for (const auto& eyelet_m : path_m.rightCols(path_m.cols() - 1).colwise()) {
    cable.eyelets.push_back(locator.EmbedBall(eyelet_m, kGuideRadius_m));
  }
  body->cables.push_back(cable);
}

void AddCables(const fem::PointLocator& locator, robot::RobotBody* body) {
  Eigen::Matrix3Xd up_m(3, 4);
  up_m << -0.01, 0.031, 0.062, 0.094,  //
      0.011, 0.0091, 0.0118, 0.0093,   //
      0.026, 0.0187, 0.0179, 0.0193;
  Eigen::Matrix3Xd aside_m(3, 2);
  aside_m << -0.012, 0.087,  //
      -0.003, 0.0019,        //
      0.008, 0.0131;
  Eigen::Matrix3Xd down_m(3, 3);
  down_m << -0.008, 0.047, 0.093,  //
      0.013, 0.0142, 0.0117,       //
      -0.004, 0.0013, 0.0021;
  AddCable("up", up_m, locator, body);
  AddCable("aside", aside_m, locator, body);
  AddCable("down", down_m, locator, body);
}

/// A camera that looks past the beam's middle, and is not level.
Eigen::Isometry3d CameraPose(const Eigen::Vector3d& at_m) {
  const Eigen::Vector3d z = (Eigen::Vector3d(0.03, 0.02, 0.01) - at_m).normalized();
  const Eigen::Vector3d x = z.cross(Eigen::Vector3d(0.2, 0.3, 0.9)).normalized();
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
  T_robot_camera.linear() << x, z.cross(x), z;
  T_robot_camera.translation() = at_m;
  return T_robot_camera;
}

robot::RobotBody RobotOf(const fem::TetMesh& mesh) {
  robot::RobotBody body;
  body.name = "small";
  body.mesh = mesh;
  body.boundary = fem::ExtractBoundary(body.mesh);
  const fem::Material material{fem::MaterialModel::kStableNeoHookean, fem::Volumetric::kPointwise,
                               65e3, 0.42};
  fem::Material softer = material;
  softer.youngs_modulus_Pa = 50e3;
  test_support::MakeTwoMaterialBeam(material, softer, &body);
  body.nominal_poissons_ratio = material.poissons_ratio;
  body.gravity_m_s2 = {0.0, 0.0, -9.81};
  const fem::PointLocator locator(body.mesh);
  AddCables(locator, &body);
  // Inside elements, so that a little of any move leaves them there.
  const Eigen::Vector3d markers_m[] = {
      {0.097, 0.011, 0.012}, {0.071, 0.017, 0.013}, {0.034, 0.004, 0.017}, {0.011, 0.012, 0.004}};
  for (const Eigen::Vector3d& marker_m : markers_m) {
    body.markers.push_back({"m" + std::to_string(body.markers.size()), locator.Embed(marker_m)});
  }
  for (const Eigen::Vector3d& point_m :
       {Eigen::Vector3d(0.093, 0.012, 0.0191), Eigen::Vector3d(0.067, 0.0012, 0.0123)}) {
    body.feature_points.push_back(locator.Embed(point_m));
  }
  return body;
}

}  // namespace

robot::RobotBody SmallRobot(fem::ElementType element) {
  const bool quadratic = element == fem::ElementType::kTet10;
  const fem::TetMesh cells =
      fem::BoxMesh({0.1, 0.02, 0.02}, {quadratic ? 3 : 5, quadratic ? 1 : 2, 1});
  return RobotOf(quadratic ? fem::MakeQuadratic(cells) : cells);
}

robot::RobotBody SmallRobotOnFinerMesh() { return RobotOf(fem::MakeQuadratic(SmallRobot().mesh)); }

experiment::Recording MakeRecording(const std::string& name, const robot::RobotBody& body,
                                    const std::vector<Knot>& knots, double frame_s,
                                    const Seen& seen_m) {
  experiment::Recording recording;
  recording.name = name;
  experiment::Actuation& actuation = recording.actuation.emplace();
  for (std::size_t c = 0; c < knots.front().command.size(); ++c) {
    actuation.columns.push_back(
        {body.cables[c].name, experiment::ActuatorQuantity::kDisplacement, {}, {}});
  }
  for (const Knot& knot : knots) {
    actuation.t_s.push_back(knot.t_s);
    for (std::size_t c = 0; c < knot.command.size(); ++c) {
      actuation.columns[c].samples.emplace_back(knot.command[c]);
    }
  }
  experiment::MarkerTracks& markers = recording.markers.emplace();
  for (const robot::BodyMarker& marker : body.markers) markers.names.push_back(marker.name);
  markers.names_where.resize(markers.names.size());
  const double length_s = knots.back().t_s - knots.front().t_s;
  const int frames = static_cast<int>(std::lround(length_s / frame_s));
  for (int k = 0; k <= frames; ++k) {
    experiment::MarkerFrame frame;
    frame.t_s = knots.front().t_s + length_s * k / frames;
    for (std::size_t m = 0; m < body.markers.size(); ++m) {
      frame.positions_m.push_back(seen_m ? seen_m(frame.t_s, static_cast<int>(m))
                                         : std::optional(body.markers[m].point.rest_m));
    }
    markers.frames.push_back(std::move(frame));
  }
  return recording;
}

experiment::Experiment SmallExperiment(const robot::RobotBody& body) {
  using experiment::MeasurementFrame;
  experiment::Experiment experiment;
  experiment.markers_sigma_m = Eigen::Vector3d::Constant(3e-4);
  experiment.rest_between_s = 4.0;
  const std::vector<double> low{0.002, 0.004, 0.002};
  const std::vector<double> high{0.007, 0.006, 0.003};
  experiment.recordings.push_back(
      MakeRecording("a_ramp", body, {{0.0, low}, {4.0, high}, {8.0, low}}, 0.1));
  experiment.recordings.push_back(MakeRecording("b_hold", body, {{12.0, high}, {32.0, high}}, 0.5));
  experiment::Recording& hold = experiment.recordings.back();
  hold.loads = {{12.0, {0.091, 0.012, 0.0011}, {0.0, 0.0, -0.06}, 0.0, {}},
                {12.0, {0.067, 0.0012, 0.0123}, {0.0, 0.04, 0.01}, 0.0, {}}};
  experiment.recordings.push_back(MakeRecording("c_tilt", body, {{36.0, low}, {38.0, high}}, 0.1));
  experiment::Recording& tilt = experiment.recordings.back();
  tilt.base_tilt_deg = Eigen::Vector2d(20.0, -15.0);
  tilt.frame = MeasurementFrame::kCamera;
  tilt.T_robot_camera = CameraPose({0.1, 0.2, 0.3});
  experiment.recordings.push_back(
      MakeRecording("d_camera", body, {{42.0, high}, {44.0, high}}, 0.1));
  experiment::Recording& moved = experiment.recordings.back();
  moved.frame = MeasurementFrame::kCamera;
  moved.T_robot_camera = CameraPose({0.3, -0.1, 0.2});
  return experiment;
}

experiment::Experiment SmallExperimentOfEachCable(const robot::RobotBody& body) {
  experiment::Experiment experiment = SmallExperiment(body);
  const std::vector<double> low{0.002, 0.004, 0.002};
  experiment.recordings.push_back(MakeRecording("e_each", body,
                                                {{48.0, low},
                                                 {50.0, {0.007, 0.004, 0.002}},
                                                 {52.0, {0.002, 0.008, 0.002}},
                                                 {54.0, {0.002, 0.004, 0.006}},
                                                 {56.0, low}},
                                                0.1));
  return experiment;
}

std::map<std::string, rgbd::CameraModel> SmallCameras() {
  const rgbd::CameraModel camera{.width_px = 640,
                                 .height_px = 480,
                                 .fx_px = 420.0,
                                 .fy_px = 400.0,
                                 .cx_px = 320.0,
                                 .cy_px = 240.0};
  return {{"c_tilt", camera}, {"d_camera", camera}};
}

}  // namespace palpate::diagnosis
