// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/components/perception/touch_of.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

#include "libs/geometry/closest_point.hpp"

namespace palpate::perception {

Eigen::Vector3d TouchOf(const PredictedSurface& skin, const scenario::Scenario& scenario,
                        const virtual_camera::ToolPose& tool) {
  const geometry::SurfaceIndex index({skin.vertices_m, skin.triangles});
  const geometry::SurfacePoint nearest =
      index.Closest(scenario.camera->T_robot_camera.inverse() * tool.T_robot_tool.translation());
  EXPECT_LT(nearest.distance_m, scenario.ToolNamed(tool.tool).radius_m + 5e-4)
      << "the ball does not touch";
  return nearest.position_m;
}

void ExpectContacts(const Observation& seen, const scenario::Scenario& scenario,
                    const virtual_camera::View& view, double largest_error_m) {
  EXPECT_EQ(seen.contacts.size(), view.tools.size());
  const PredictedSurface skin = Predict(scenario, view.nodes_m);
  for (const virtual_camera::ToolPose& tool : view.tools) {
    const Eigen::Vector3d touch_m = TouchOf(skin, scenario, tool);
    const auto found = std::min_element(
        seen.contacts.begin(), seen.contacts.end(), [&](const auto& a, const auto& b) {
          return (a.position_m - touch_m).norm() < (b.position_m - touch_m).norm();
        });
    ASSERT_NE(found, seen.contacts.end());
    const Eigen::Vector3d off_m = found->position_m - touch_m;
    const double chi_squared = off_m.dot(found->covariance_m2.inverse() * off_m);
    std::cout << tool.tool << ": " << found->name << " is off by " << 1e3 * off_m.norm()
              << " mm, chi^2 " << chi_squared << "\n";
    EXPECT_LT(off_m.norm(), largest_error_m);
    EXPECT_LT(chi_squared, 7.815);
  }
}

}  // namespace palpate::perception
