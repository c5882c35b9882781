// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "components/perception/markers/fiducial_detector.hpp"
#include "components/virtual_camera/virtual_camera.hpp"
#include "libs/geometry/triangle_surface.hpp"
#include "libs/robot/robot_description.hpp"
#include "libs/scenario/scenario.hpp"

namespace palpate::perception {

/// Of the discs; the green ball of pushes.yaml has it, too.
inline const Eigen::Vector3d kMarkerColor(0.15, 0.65, 0.30);

/// The same robot with each marker moved to the nearest place on the drawn skin.
robot::RobotDescription OnSkin(robot::RobotDescription robot);
virtual_camera::RobotSurface SkinOf(const robot::RobotDescription& robot);
/// Of config/robots/four_leg.yaml, markers on it.
const virtual_camera::RobotSurface& FourLegSurface();

/// Bench and camera of pushes.yaml, 0.45 m from the body; all discs of one colour.
scenario::Scenario MarkedScenario();
/// The camera `distance_m` from the body, so far round it and so high above it; to the east and in
/// the plane at zero.
void PlaceCamera(double distance_m, double azimuth_deg, double height_deg,
                 scenario::Scenario* scenario);
FiducialConfig ConfigOf(const scenario::Scenario& scenario);

/// The truth of one marker.
struct TrueMarker {
  Eigen::Vector3d position_m;  ///< centre of the disc, camera frame
  double cosine = 0.0;         ///< of the angle between the surface's normal and the ray
  bool in_view = false;        ///< the whole disc is seen, and not too much edge-on
};

/// A robot with coloured discs before the virtual camera. The renderer draws them: the part of the
/// skin that is no farther than the radius from a marker.
class MarkedScene {
 public:
  MarkedScene(const virtual_camera::RobotSurface& skin, const scenario::Scenario& scenario,
              std::uint64_t seed = 1);

  /// Undeformed, no tools.
  virtual_camera::View Rest() const;
  const rgbd::RgbdFrame& Take(const virtual_camera::View& view);
  /// At the last Take.
  const std::vector<TrueMarker>& truth() const { return truth_; }
  const scenario::Scenario& scenario() const { return scenario_; }

 private:
  TrueMarker TruthOf(int marker, const virtual_camera::View& view) const;
  bool Sees(const Eigen::Vector3d& point_m) const;

  scenario::Scenario scenario_;
  virtual_camera::RobotSurface skin_;
  std::vector<int> triangle_;     ///< [markers] that carries it
  Eigen::Matrix3Xd barycentric_;  ///< [3 x markers] there
  virtual_camera::VirtualCamera camera_;
  rgbd::RgbdFrame frame_;
  std::vector<TrueMarker> truth_;
};

/// Index of the true marker that a fiducial is, within 5 mm; -1: none.
int NearestMarker(const std::vector<TrueMarker>& truth, const Fiducial& fiducial);

}  // namespace palpate::perception
