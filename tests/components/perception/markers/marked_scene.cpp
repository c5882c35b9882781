// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/components/perception/markers/marked_scene.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "libs/app/yaml.hpp"
#include "libs/geometry/closest_point.hpp"
#include "libs/robot/robot_body.hpp"
#include "libs/scenario/scenario_sections.hpp"
#include "tests/support/robots.hpp"

namespace palpate::perception {

namespace {

constexpr double kLeastCosine = 0.45;
/// So far round a disc the skin is seen, too.
constexpr double kClear_px = 5.0;
/// The skin is seen at a place where the picture's surface is no farther from it than this.
constexpr double kSameSurface_m = 2e-3;

geometry::SurfaceIndex IndexOf(const virtual_camera::RobotSurface& skin) {
  return geometry::SurfaceIndex({.vertices_m = skin.rest_m, .triangles = skin.triangles});
}

}  // namespace

virtual_camera::RobotSurface SkinOf(const robot::RobotDescription& robot) {
  const robot::RobotBody body = robot::BuildRobotBody(robot);
  virtual_camera::RobotSurface skin;
  skin.rest_m = body.mesh.nodes_m;
  skin.triangles = body.boundary.DrawnTriangles();
  skin.markers_m.resize(3, static_cast<Eigen::Index>(robot.markers.size()));
  for (std::size_t i = 0; i < robot.markers.size(); ++i) {
    skin.markers_m.col(static_cast<Eigen::Index>(i)) = robot.markers[i].position_m;
  }
  return skin;
}

const virtual_camera::RobotSurface& FourLegSurface() {
  static const virtual_camera::RobotSurface skin =
      SkinOf(OnSkin(test_support::LinearFourLegRobot()));
  return skin;
}

robot::RobotDescription OnSkin(robot::RobotDescription robot) {
  const geometry::SurfaceIndex index = IndexOf(SkinOf(robot));
  for (auto& marker : robot.markers) {
    marker.position_m = index.Closest(marker.position_m).position_m;
  }
  return robot;
}

scenario::Scenario MarkedScenario() {
  scenario::Scenario scenario =
      scenario::ReadScenario(PALPATE_SOURCE_DIR "/config/scenarios/pushes.yaml", app::LoadYaml);
  scenario.stage.marker_color_rgb = kMarkerColor;
  return scenario;
}

void PlaceCamera(double distance_m, double azimuth_deg, double height_deg,
                 scenario::Scenario* scenario) {
  constexpr double kRadian_deg = 57.29577951308232;
  const double azimuth = azimuth_deg / kRadian_deg, height = height_deg / kRadian_deg;
  const Eigen::Vector3d away(std::cos(height) * std::cos(azimuth),
                             std::cos(height) * std::sin(azimuth), std::sin(height));
  const Eigen::Vector3d target_m(0.0, 0.0, 0.09);
  scenario->camera->T_robot_camera = scenario::LookAt(target_m + distance_m * away, target_m);
}

FiducialConfig ConfigOf(const scenario::Scenario& scenario) {
  FiducialConfig config;
  const Eigen::Vector3d rgb = scenario.stage.marker_color_rgb.value_or(kMarkerColor);
  config.color_rgb = {rgb.x(), rgb.y(), rgb.z()};
  return config;
}

MarkedScene::MarkedScene(const virtual_camera::RobotSurface& skin,
                         const scenario::Scenario& scenario, std::uint64_t seed)
    : scenario_{scenario}, skin_{skin}, camera_{scenario, skin_, {}, seed} {
  const geometry::SurfaceIndex index = IndexOf(skin_);
  barycentric_.resize(3, skin_.markers_m.cols());
  for (Eigen::Index m = 0; m < skin_.markers_m.cols(); ++m) {
    const geometry::SurfacePoint place = index.Closest(skin_.markers_m.col(m));
    triangle_.push_back(place.triangle);
    barycentric_.col(m) = place.barycentric;
  }
}

virtual_camera::View MarkedScene::Rest() const {
  virtual_camera::View view;
  view.nodes_m = skin_.rest_m;
  view.T_robot_camera = scenario_.camera->T_robot_camera;
  return view;
}

const rgbd::RgbdFrame& MarkedScene::Take(const virtual_camera::View& view) {
  camera_.Take(view, &frame_);
  truth_.clear();
  for (int m = 0; m < static_cast<int>(triangle_.size()); ++m) truth_.push_back(TruthOf(m, view));
  return frame_;
}

bool MarkedScene::Sees(const Eigen::Vector3d& point_m) const {
  const rgbd::CameraModel& camera = scenario_.camera->camera.depth;
  const Eigen::Vector2i pixel = rgbd::Project(camera, point_m).array().round().cast<int>();
  constexpr int kMargin_px = 8;
  const bool inside = (pixel.array() >= kMargin_px).all() &&
                      pixel.x() < camera.width_px - kMargin_px &&
                      pixel.y() < camera.height_px - kMargin_px;
  if (!inside) return false;
  const auto seen_m = static_cast<double>(*camera_.true_range().Pixel(pixel.x(), pixel.y()));
  return std::abs(seen_m - point_m.z()) < kSameSurface_m + 0.006 * std::abs(point_m.z());
}

TrueMarker MarkedScene::TruthOf(int marker, const virtual_camera::View& view) const {
  const Eigen::Isometry3d T_camera_robot = view.T_robot_camera.inverse();
  Eigen::Matrix3d corners_m;
  for (int k = 0; k < 3; ++k) {
    const int node = skin_.triangles(k, triangle_[static_cast<std::size_t>(marker)]);
    corners_m.col(k) = T_camera_robot * Eigen::Vector3d(view.nodes_m.col(node));
  }
  const Eigen::Vector3d a_m = corners_m.col(1) - corners_m.col(0);
  const Eigen::Vector3d b_m = corners_m.col(2) - corners_m.col(0);
  const Eigen::Vector3d normal = a_m.cross(b_m).normalized();
  TrueMarker truth;
  truth.position_m = corners_m * barycentric_.col(marker);
  truth.cosine = -normal.dot(truth.position_m.normalized());
  truth.in_view = truth.cosine > kLeastCosine && Sees(truth.position_m);
  const Eigen::Vector3d side = a_m.normalized(), other = normal.cross(side);
  constexpr int kDirections = 8;
  for (int k = 0; k < kDirections; ++k) {
    const double angle = 6.283185307179586 * k / kDirections;
    const double px_m = truth.position_m.z() / scenario_.camera->camera.depth.fx_px;
    const double rim_m = scenario_.stage.marker_radius_m + kClear_px * px_m;
    const Eigen::Vector3d off = std::cos(angle) * side + std::sin(angle) * other;
    truth.in_view = truth.in_view && Sees(truth.position_m + rim_m * off);
  }
  return truth;
}

int NearestMarker(const std::vector<TrueMarker>& truth, const Fiducial& fiducial) {
  constexpr double kNear_m = 5e-3;
  for (std::size_t m = 0; m < truth.size(); ++m) {
    if ((truth[m].position_m - fiducial.position_m).norm() < kNear_m) return static_cast<int>(m);
  }
  return -1;
}

}  // namespace palpate::perception
