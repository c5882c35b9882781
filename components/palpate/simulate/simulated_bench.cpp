// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/simulate/simulated_bench.hpp"

#include <optional>

#include "components/virtual_camera/camera_faults.hpp"
#include "components/virtual_camera/measured_points.hpp"
#include "components/virtual_camera/virtual_camera.hpp"
#include "libs/core/check.hpp"
#include "libs/geometry/closest_point.hpp"

namespace palpate::command {

namespace {

class VirtualBench : public SimulatedBench {
 public:
  VirtualBench(const robot::RobotDescription& robot, const scenario::Scenario& scenario,
               const std::vector<scenario::ActiveEffect>& effects, std::uint64_t seed)
      : robot_{robot, scenario, effects, seed},
        faults_{virtual_camera::FaultsFrom(effects, seed)},
        facets_{FacetsUnder(robot_.MarkerPositions_m())} {
    if (scenario.camera) data_sheet_ = scenario.camera->camera.depth;
    if (!scenario.TakesPictures()) return;
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
  Eigen::Matrix3Xd MarkersByCamera_m(const CameraMoment& moment) const override {
    const Eigen::Isometry3d T_camera_robot = TrueCameraPose(moment).inverse();
    const Eigen::VectorXd& x_m = robot_.positions_m();
    Eigen::Matrix3Xd normals(3, facets_.cols());
    for (Eigen::Index m = 0; m < facets_.cols(); ++m) {
      const auto corner_m = [&](int k) { return x_m.segment<3>(3 * facets_(k, m)); };
      normals.col(m) = (corner_m(1) - corner_m(0)).cross(corner_m(2) - corner_m(0)).normalized();
    }
    return virtual_camera::MeasurePoints(faults_, data_sheet_, moment.t_s,
                                         T_camera_robot * Markers_m(),
                                         T_camera_robot.linear() * normals);
  }
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
  /// [3 x markers] corners of the facet of the skin that each sits on.
  Eigen::Matrix3Xi FacetsUnder(const Eigen::Matrix3Xd& markers_m) const {
    const Eigen::Matrix3Xi corners = robot_.boundary().CornerTriangles();
    const geometry::SurfaceIndex skin(fem::RestSurface(robot_.mesh(), robot_.boundary()));
    Eigen::Matrix3Xi facets(3, markers_m.cols());
    for (Eigen::Index m = 0; m < markers_m.cols(); ++m) {
      facets.col(m) = corners.col(skin.Closest(markers_m.col(m)).triangle);
    }
    return facets;
  }

  virtual_robot::VirtualRobot robot_;
  virtual_camera::CameraFaults faults_;
  Eigen::Matrix3Xi facets_;
  rgbd::CameraModel data_sheet_;
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
