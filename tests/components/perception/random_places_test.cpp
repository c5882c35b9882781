// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

// Balls of any size at places of the robot, seen from anywhere above. Where the place faces the
// camera all are found in the first frame, about where they touch; where it faces away, of those
// that stick out from behind the robot.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>
#include <random>
#include <vector>

#include "components/perception/perception.hpp"
#include "libs/geometry/closest_point.hpp"
#include "libs/scenario/scenario_sections.hpp"
#include "tests/components/perception/labelled_scene.hpp"

namespace palpate::perception {
namespace {

constexpr double kDent_m = 5e-4;
const Eigen::Vector3d kMiddle_m(0.0, 0.0, 0.06);

class RandomPlaces {
 public:
  RandomPlaces() : surface_({PushSkin().rest_m, PushSkin().triangles}) {}

  double Draw(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }

  Eigen::Vector3d DrawEye() {
    const double turn = Draw(0.0, 2.0 * std::numbers::pi);
    const double height = Draw(0.3, 1.0);
    return kMiddle_m + Draw(0.38, 0.63) * Eigen::Vector3d(std::cos(turn) * std::cos(height),
                                                          std::sin(turn) * std::cos(height),
                                                          std::sin(height));
  }

  struct Place {
    Eigen::Vector3d at_m;
    Eigen::Vector3d normal;
  };

  enum class Side { kTowardsEye, kAway };

  /// Where a ball of `radius_m` touches nothing else, on this side of the robot as seen from
  /// `eye_m`.
  Place DrawPlace(const Eigen::Vector3d& eye_m, double radius_m, Side side) {
    while (true) {
      const auto& skin = surface_.surface();
      const auto triangle =
          static_cast<Eigen::Index>(Draw(0.0, static_cast<double>(skin.triangles.cols()) - 1.0));
      const Eigen::Matrix3d corners_m = skin.vertices_m(Eigen::all, skin.triangles.col(triangle));
      const Place place = {corners_m.rowwise().mean(),
                           (corners_m.col(1) - corners_m.col(0))
                               .cross(corners_m.col(2) - corners_m.col(0))
                               .normalized()};
      const bool wanted = side == Side::kAway ? FacesAway(place, eye_m) : IsSeen(place, eye_m);
      if (place.at_m.z() > 0.03 && Fits(place, radius_m) && wanted) return place;
    }
  }

 private:
  bool Fits(const Place& place, double radius_m) const {
    const double height_m = radius_m - kDent_m;
    const double free_m = surface_.Closest(place.at_m + height_m * place.normal).distance_m;
    return std::abs(free_m - height_m) < 1e-4;
  }

  static bool FacesAway(const Place& place, const Eigen::Vector3d& eye_m) {
    const double facing = place.normal.dot((eye_m - place.at_m).normalized());
    return facing > -0.6 && facing < -0.1;
  }

  bool IsSeen(const Place& place, const Eigen::Vector3d& eye_m) const {
    const Eigen::Vector3d to_eye = (eye_m - place.at_m).normalized();
    if (place.normal.dot(to_eye) < 0.3) return false;
    for (double way_m = 0.02; way_m < 0.3; way_m += 0.004) {
      if (surface_.Closest(place.at_m + way_m * to_eye).distance_m < 0.004) return false;
    }
    return true;
  }

  geometry::SurfaceIndex surface_;
  std::mt19937 random_{3};
};

struct Found {
  std::vector<double> errors_m;     ///< of the contact that is nearest; 1 m: there is none
  std::vector<double> chi_squared;  ///< of those that were found, by their covariance
  int too_many = 0;
};

Found FindEach(int count, const scenario::Scenario& pushes,
               RandomPlaces::Side side = RandomPlaces::Side::kTowardsEye) {
  RandomPlaces places;
  Found found;
  for (int k = 0; k < count; ++k) {
    scenario::Scenario scenario = pushes;
    scenario.tools.resize(1);
    const double radius_m = scenario.tools[0].radius_m = places.Draw(0.006, 0.014);
    const Eigen::Vector3d eye_m = places.DrawEye();
    scenario.camera->T_robot_camera = scenario::LookAt(eye_m, kMiddle_m);
    const RandomPlaces::Place place = places.DrawPlace(eye_m, radius_m, side);
    virtual_camera::View view = RestView(scenario);
    view.tools.push_back({scenario.tools[0].name, Eigen::Isometry3d::Identity()});
    view.tools[0].T_robot_tool.translation() = place.at_m + (radius_m - kDent_m) * place.normal;
    LabelledScene scene(scenario, 100 + static_cast<std::uint64_t>(k));
    scene.Take(view);
    Config config;
    config.tracking.appear_frames = 1;
    Perception perception(config);
    perception.SetCamera(scenario.camera->camera);
    const PredictedSurface predicted = Predict(scenario, view.nodes_m);
    const Observation& seen = perception.Update(scene.frame(), &predicted);
    const Eigen::Vector3d touch_m = scenario.camera->T_robot_camera.inverse() * place.at_m;
    double nearest_m = 1.0;
    double chi_squared = 0.0;
    for (const DetectedContact& contact : seen.contacts) {
      const Eigen::Vector3d off_m = contact.position_m - touch_m;
      if (off_m.norm() >= nearest_m) continue;
      nearest_m = off_m.norm();
      chi_squared = off_m.dot(contact.covariance_m2.inverse() * off_m);
    }
    found.errors_m.push_back(nearest_m);
    if (!seen.contacts.empty()) found.chi_squared.push_back(chi_squared);
    found.too_many += std::max(0, static_cast<int>(seen.contacts.size()) - 1);
  }
  std::sort(found.errors_m.begin(), found.errors_m.end());
  std::sort(found.chi_squared.begin(), found.chi_squared.end());
  return found;
}

void ExpectFound(const std::string& name, const scenario::Scenario& scenario) {
  constexpr int kScenes = 12;
  const Found found = FindEach(kScenes, scenario);
  std::cout << name << ": off by " << 1e3 * found.errors_m[kScenes / 2] << " mm median, "
            << 1e3 * found.errors_m.back() << " mm at most, " << found.too_many << " too many\n";
  EXPECT_LT(found.errors_m[kScenes / 2], 0.003);
  EXPECT_LT(found.errors_m.back(), 0.012) << "none is missed";
  EXPECT_LE(found.too_many, 1);
}

TEST(ContactsAtRandomPlaces, AreFoundForBallsOfAnotherColor) {
  ExpectFound("another color", PushScenario());
}

TEST(ContactsAtRandomPlaces, AreFoundForBallsOfTheRobotsColor) {
  scenario::Scenario scenario = PushScenario();
  scenario.tools[0].color_rgb = scenario.stage.robot_color_rgb;
  ExpectFound("the robot's color", scenario);
}

TEST(ContactsAtRandomPlaces, AreFoundInMillimetresWithoutNoise) {
  scenario::Scenario scenario = PushScenario();
  scenario.camera->noise.sensor = scenario::DepthSensor::kNone;
  scenario.camera->camera.depth_unit_m = 1e-3;
  ExpectFound("millimetres", scenario);
}

/// At the visible rim they would be off by most of the ball's radius.
TEST(ContactsAtRandomPlaces, ThatFaceAwayAreFoundBehindTheRim) {
  constexpr std::size_t kScenes = 30;
  const Found found = FindEach(kScenes, PushScenario(), RandomPlaces::Side::kAway);
  const std::size_t seen = found.chi_squared.size();
  ASSERT_GE(seen, kScenes / 3) << "balls stick out";
  std::cout << "facing away: " << seen << " of " << kScenes << " seen, off by "
            << 1e3 * found.errors_m[seen / 2] << " mm median, "
            << 1e3 * found.errors_m[9 * seen / 10] << " mm for nine of ten, chi^2 "
            << found.chi_squared[seen / 2] << " median, " << found.chi_squared[9 * seen / 10]
            << " for nine of ten\n";
  EXPECT_LT(found.errors_m[seen / 2], 0.003);
  EXPECT_LT(found.chi_squared[9 * seen / 10], 7.815);
  EXPECT_GT(found.chi_squared[seen / 2], 0.1) << "nor is it much too large";
}

}  // namespace
}  // namespace palpate::perception
