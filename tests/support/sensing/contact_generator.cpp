// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/support/sensing/contact_generator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "libs/core/check.hpp"
#include "libs/geometry/closest_point.hpp"

namespace palpate::test_support {

namespace {

constexpr int kAttempts = 200;
constexpr int kPlaces = 500;
constexpr int kSteps = 60;
constexpr int kCableSteps = 4;
constexpr double kGap_m = 5e-4;        ///< of the ball before it moves in
constexpr double kFirstStep_m = 4e-4;  ///< also while nothing touches
constexpr double kSmallestStep_m = 5e-5;
constexpr double kLargestStep_m = 2e-3;
constexpr double kDeepest_m = 0.03;
constexpr double kCloseEnough = 0.05;  ///< of the force that is wanted

scenario::ToolPose At(const std::string& tool, const Eigen::Vector3d& position_m) {
  scenario::ToolPose pose{.tool = tool};
  pose.T_robot_tool.translation() = position_m;
  return pose;
}

}  // namespace

double ForceOf_N(const SceneState& state, const std::string& tool) {
  for (const virtual_robot::TrueForce& force : state.forces) {
    if (force.name == tool) return force.force_N.norm();
  }
  return 0.0;
}

ContactGenerator::ContactGenerator(SensingScene& scene, const ContactWish& wish, std::uint64_t seed)
    : scene_{scene},
      wish_{wish},
      random_{seed, "contacts"},
      sight_{scene},
      cables_before_m_{scene.Nothing().displacement_m} {
  const geometry::TriangleSurface rest{.vertices_m = scene.robot().mesh().nodes_m,
                                       .triangles = scene.triangles()};
  const double lowest_m = rest.vertices_m.row(2).minCoeff() + wish.above_clamp_m;
  double sum_m2 = 0.0;
  for (int t = 0; t < rest.TriangleCount(); ++t) {
    const bool allowed = Centroid_m(rest, t).z() >= lowest_m;
    if (allowed) sum_m2 += geometry::TriangleAreaVector_m2(rest, t).norm();
    area_below_m2_.push_back(sum_m2);
  }
  PALPATE_CHECK(sum_m2 > 0.0, wish.above_clamp_m);
}

bool ContactGenerator::Next() {
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    if (Attempt()) {
      ++made_;
      return true;
    }
    ++skipped_;
  }
  return false;
}

/// All tools away; then the cables move to `displacement_m`.
bool ContactGenerator::Clear(const Eigen::VectorXd& displacement_m) {
  path_.clear();
  scenario::BenchInputs inputs = scene_.Nothing();
  inputs.displacement_m = cables_before_m_;
  if (!scene_.Go(inputs).ok() && !scene_.Start(inputs).ok()) return false;
  path_.push_back(scene_.state());
  const Eigen::VectorXd way_m = displacement_m - cables_before_m_;
  for (int k = 1; k <= kCableSteps && !way_m.isZero(); ++k) {
    inputs.displacement_m = cables_before_m_ + way_m * k / kCableSteps;
    if (!Step(inputs)) return false;
  }
  return true;
}

bool ContactGenerator::Step(const scenario::BenchInputs& inputs) {
  if (!scene_.Go(inputs).ok()) return false;
  path_.push_back(scene_.state());
  return true;
}

bool ContactGenerator::Attempt() {
  Eigen::VectorXd displacement_m = cables_before_m_;
  for (double& cable_m : displacement_m) cable_m = wish_.largest_command * random_.Uniform();
  if (!Clear(displacement_m)) return false;
  sight_.Look();
  const std::vector<Ball> balls = DrawBalls();
  std::vector<Place> places;
  for (const Ball& ball : balls) {
    const std::optional<Place> place = DrawPlace(ball, places);
    if (!place) return false;
    places.push_back(*place);
  }
  for (std::size_t k = 0; k < balls.size(); ++k) {
    const double share = random_.Uniform();
    const double wanted_N = wish_.smallest_N + share * (wish_.largest_N - wish_.smallest_N);
    if (!Press(balls[k], places[k], wanted_N)) return false;
  }
  if (!CameAsWanted(balls)) return false;
  cables_before_m_ = displacement_m;
  return true;
}

/// The second ball has moved the first, and both have turned the body.
bool ContactGenerator::CameAsWanted(const std::vector<Ball>& balls) {
  const std::vector<virtual_robot::TrueForce>& forces = scene_.state().forces;
  if (forces.size() != balls.size()) return false;
  sight_.Look();
  return std::all_of(forces.begin(), forces.end(), [&](const virtual_robot::TrueForce& force) {
    const double force_N = force.force_N.norm();
    return force_N >= 0.8 * wish_.smallest_N && force_N <= 1.1 * wish_.largest_N &&
           IsWanted(force.position_m);
  });
}

std::vector<ContactGenerator::Ball> ContactGenerator::DrawBalls() {
  std::vector<Ball> all;
  for (const scenario::Tool& tool : scene_.scenario().tools) {
    if (tool.shape == scenario::ToolShape::kSphere) all.push_back({tool.name, tool.radius_m});
  }
  PALPATE_CHECK(static_cast<int>(all.size()) >= wish_.count, all.size());
  std::vector<Ball> drawn;
  for (int k = 0; k < wish_.count; ++k) {
    const auto which = static_cast<std::ptrdiff_t>(random_.Below(all.size()));
    drawn.push_back(all[static_cast<std::size_t>(which)]);
    all.erase(all.begin() + which);
  }
  return drawn;
}

std::optional<ContactGenerator::Place> ContactGenerator::DrawPlace(
    const Ball& ball, const std::vector<Place>& taken) {
  for (int k = 0; k < kPlaces; ++k) {
    const double area_m2 = random_.Uniform() * area_below_m2_.back();
    const auto found = std::upper_bound(area_below_m2_.begin(), area_below_m2_.end(), area_m2);
    const int triangle = static_cast<int>(found - area_below_m2_.begin());
    const Place place{.position_m = Centroid_m(sight_.surface(), triangle),
                      .inward = -geometry::TriangleNormal(sight_.surface(), triangle)};
    const bool apart = std::all_of(taken.begin(), taken.end(), [&](const Place& other) {
      return (other.position_m - place.position_m).norm() >= wish_.apart_m;
    });
    if (apart && IsWanted(place.position_m) && IsFree(place, ball)) return place;
  }
  return std::nullopt;
}

bool ContactGenerator::IsWanted(const Eigen::Vector3d& position_m) const {
  if (wish_.where == ContactWish::Where::kAnywhere) return true;
  const double share = sight_.SeenShare(position_m, wish_.patch_radius_m);
  return wish_.where == ContactWish::Where::kHidden ? share == 0.0 : share >= wish_.visible_share;
}

/// The ball beside it touches nothing else, and stands above the plate.
bool ContactGenerator::IsFree(const Place& place, const Ball& ball) const {
  const Eigen::Vector3d centre_m = place.position_m - (ball.radius_m + kGap_m) * place.inward;
  if (centre_m.z() < ball.radius_m) return false;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (int t = 0; t < sight_.surface().TriangleCount(); ++t) {
    const Eigen::Vector3d a = sight_.surface().Corner(t, 0);
    if ((a - centre_m).squaredNorm() > 9.0 * ball.radius_m * ball.radius_m) continue;
    const Eigen::Vector3d share = geometry::ClosestPointOnTriangle(
        a, sight_.surface().Corner(t, 1), sight_.surface().Corner(t, 2), centre_m);
    const Eigen::Vector3d point_m = share[0] * a + share[1] * sight_.surface().Corner(t, 1) +
                                    share[2] * sight_.surface().Corner(t, 2);
    nearest_m = std::min(nearest_m, (point_m - centre_m).norm());
  }
  return nearest_m > ball.radius_m + 0.5 * kGap_m;
}

bool ContactGenerator::Press(const Ball& ball, const Place& place, double wanted_N) {
  scenario::BenchInputs inputs = scene_.state().inputs;
  inputs.tools.push_back({});
  double depth_m = -kGap_m;
  double before_m = depth_m;
  double before_N = 0.0;
  double step_m = 0.0;
  for (int k = 0; k < kSteps && depth_m < kDeepest_m; ++k) {
    depth_m += step_m;
    inputs.tools.back() =
        At(ball.tool, place.position_m + (depth_m - ball.radius_m) * place.inward);
    if (!Step(inputs)) return false;
    const double force_N = ForceOf_N(scene_.state(), ball.tool);
    if (force_N >= (1.0 - kCloseEnough) * wanted_N) return force_N <= 1.1 * wish_.largest_N;
    const double slope_N_m = (force_N - before_N) / std::max(depth_m - before_m, kSmallestStep_m);
    step_m = slope_N_m > 0.0
                 ? std::clamp((wanted_N - force_N) / slope_N_m, kSmallestStep_m, kLargestStep_m)
                 : kFirstStep_m;
    before_m = depth_m;
    before_N = force_N;
  }
  return false;
}

}  // namespace palpate::test_support
