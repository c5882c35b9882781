// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/simulate/simulated_bench.hpp"

#include <cmath>
#include <limits>
#include <optional>

#include "components/palpate/simulate/marked_surface.hpp"
#include "components/virtual_camera/camera_faults.hpp"
#include "components/virtual_camera/measured_points.hpp"
#include "components/virtual_camera/virtual_camera.hpp"
#include "libs/core/check.hpp"

namespace palpate::command {

namespace {

class VirtualBench : public SimulatedBench {
 public:
  VirtualBench(const robot::RobotDescription& robot, const scenario::Scenario& scenario,
               const std::vector<scenario::ActiveEffect>& effects, std::uint64_t seed)
      : robot_{robot, scenario, effects, seed},
        faults_{virtual_camera::FaultsFrom(effects, seed)},
        skin_{robot_.mesh(), robot_.boundary(), robot_.MarkerPositions_m(),
              scenario.stage.marker_radius_m},
        rest_markers_m_{robot_.MarkerPositions_m()},  // nothing has moved yet
        rest_normals_{skin_.Normals(robot_.mesh().nodes_m.reshaped())} {
    if (scenario.camera) {
      data_sheet_ = scenario.camera->camera.depth;
      grazing_cosine_ = std::cos(scenario.camera->noise.grazing_angle_rad);
    }
    if (!scenario.TakesPictures()) return;
    virtual_camera::RobotSurface skin;
    skin.rest_m = robot_.mesh().nodes_m;
    skin.triangles = robot_.boundary().DrawnTriangles();
    skin.markers_m = robot_.MarkerPositions_m();  // nothing has moved yet
    cameras_ = virtual_camera::MakeCameras(scenario, skin, effects, seed);
  }

  Status Start(double t_s, const scenario::BenchInputs& inputs) override {
    return robot_.Start(t_s, inputs);
  }
  Status Advance(double t_s, const scenario::BenchInputs& inputs) override {
    return robot_.Advance(t_s, inputs);
  }

  std::vector<virtual_robot::CableReading> Cables() const override { return robot_.cables(); }
  Eigen::Matrix3Xd Markers_m() const override { return robot_.MarkerPositions_m(); }
  Eigen::Matrix3Xd MarkersByCamera_m(const CameraInput& input) const override {
    const Eigen::Isometry3d T_camera_robot = TrueCameraPose(input).inverse();
    Eigen::Matrix3Xd measured_m = virtual_camera::MeasurePoints(
        faults_, data_sheet_, input.t_s, T_camera_robot * Markers_m(),
        T_camera_robot.linear() * skin_.Normals(robot_.positions_m()));
    // At rest and from the nominal camera pose, so that visibility does not reveal hidden effects.
    for (Eigen::Index m = 0; m < measured_m.cols(); ++m) {
      const Eigen::Vector3d to_camera_m =
          input.T_robot_camera.translation() - rest_markers_m_.col(m);
      const double cosine = rest_normals_.col(m).dot(to_camera_m.normalized());
      if (cosine < grazing_cosine_) {
        measured_m.col(m).setConstant(std::numeric_limits<double>::quiet_NaN());
      }
    }
    return measured_m;
  }
  std::vector<virtual_robot::TrueForce> Forces() const override { return robot_.forces(); }
  std::string MeshHash() const override { return robot_.mesh_hash(); }

  void TakeFrame(const scenario::BenchInputs& inputs, const CameraInput& input,
                 rgbd::RgbdFrame* frame) override {
    PALPATE_CHECK(input.camera < cameras_.size(), input.camera, cameras_.size());
    const Eigen::VectorXd& positions_m = robot_.positions_m();
    view_.t_s = input.t_s;
    view_.nodes_m =
        Eigen::Map<const Eigen::Matrix3Xd>(positions_m.data(), 3, positions_m.size() / 3);
    view_.tools = inputs.tools;
    view_.T_robot_camera = input.T_robot_camera;
    view_.recording = input.recording;
    cameras_[input.camera]->Take(view_, frame);
  }

  Eigen::Isometry3d TrueCameraPose(const CameraInput& input) const override {
    return faults_.MovedPose(input.T_robot_camera, input.recording);
  }

 private:
  virtual_robot::VirtualRobot robot_;
  virtual_camera::CameraFaults faults_;
  MarkedSurface skin_;
  Eigen::Matrix3Xd rest_markers_m_;
  Eigen::Matrix3Xd rest_normals_;
  rgbd::CameraModel data_sheet_;
  double grazing_cosine_ = 0.0;
  std::vector<std::unique_ptr<virtual_camera::VirtualCamera>> cameras_;
  virtual_camera::View view_;
};

}  // namespace

std::unique_ptr<SimulatedBench> MakeVirtualBench(const robot::RobotDescription& robot,
                                                 const scenario::Scenario& scenario,
                                                 const std::vector<scenario::ActiveEffect>& effects,
                                                 std::uint64_t seed) {
  return std::make_unique<VirtualBench>(robot, scenario, effects, seed);
}

}  // namespace palpate::command
