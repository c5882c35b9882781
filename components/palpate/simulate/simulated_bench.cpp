// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/simulate/simulated_bench.hpp"

#include <optional>

#include "components/virtual_camera/camera_faults.hpp"
#include "components/virtual_camera/virtual_camera.hpp"
#include "libs/core/check.hpp"

namespace palpate::command {

namespace {

class VirtualBench : public SimulatedBench {
 public:
  VirtualBench(const robot::RobotDescription& robot, const scenario::Scenario& scenario,
               const std::vector<scenario::ActiveEffect>& effects, std::uint64_t seed)
      : robot_{robot, scenario, effects, seed}, faults_{virtual_camera::FaultsFrom(effects, seed)} {
    if (!scenario.camera) return;
    virtual_camera::Skin skin;
    skin.rest_m = robot_.mesh().nodes_m;
    skin.triangles = robot_.boundary().DrawnTriangles();
    skin.markers_m = robot_.MarkerPositions_m();  // nothing has moved yet
    camera_ =
        std::make_unique<virtual_camera::VirtualCamera>(scenario, std::move(skin), effects, seed);
  }

  Status Start(double t_s, const scenario::BenchInputs& inputs) override {
    return robot_.Start(t_s, inputs);
  }
  Status Advance(double t_s, const scenario::BenchInputs& inputs) override {
    return robot_.Advance(t_s, inputs);
  }

  std::vector<virtual_robot::CableReading> Cables() const override { return robot_.cables(); }
  Eigen::Matrix3Xd Markers_m() const override { return robot_.MarkerPositions_m(); }
  std::vector<virtual_robot::TrueForce> Forces() const override { return robot_.forces(); }
  std::string MeshHash() const override { return robot_.mesh_hash(); }

  void TakeFrame(const scenario::BenchInputs& inputs, const CameraMoment& moment,
                 rgbd::RgbdFrame* frame) override {
    PALPATE_CHECK(camera_ != nullptr, "the scenario has no camera");
    const Eigen::VectorXd& positions_m = robot_.positions_m();
    view_.t_s = moment.t_s;
    view_.nodes_m =
        Eigen::Map<const Eigen::Matrix3Xd>(positions_m.data(), 3, positions_m.size() / 3);
    view_.tools = inputs.tools;
    view_.T_robot_camera = moment.T_robot_camera;
    view_.recording = moment.recording;
    camera_->Take(view_, frame);
  }

  Eigen::Isometry3d TrueCameraPose(const CameraMoment& moment) const override {
    return faults_.MovedPose(moment.T_robot_camera, moment.recording);
  }

 private:
  virtual_robot::VirtualRobot robot_;
  virtual_camera::CameraFaults faults_;
  std::unique_ptr<virtual_camera::VirtualCamera> camera_;
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
