// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "libs/scenario/random.hpp"
#include "tests/support/sensing/scene_sight.hpp"
#include "tests/support/sensing/sensing_scene.hpp"

namespace palpate::test_support {

/// What kind of contacts are wanted.
struct ContactWish {
  enum class Where { kVisible, kHidden, kAnywhere };

  Where where = Where::kVisible;
  int count = 1;  ///< at once, 1 or 2
  double smallest_N = 0.3;
  double largest_N = 1.5;  ///< |F|, evenly between the two
  double apart_m = 0.04;   ///< two at once are no closer
  /// Height of the place above the clamp at rest, at least: nearer the body hardly moves.
  double above_clamp_m = 0.025;
  /// Each cable is pulled in, and each chamber filled, by 0 to so much at random: m, Pa.
  double largest_command = 0.0;
  /// Visible: the camera sees so much of the surface within patch_radius_m of the place, the tool
  /// aside; hidden: it sees nothing of it. Before and after the push.
  double visible_share = 0.6;
  double patch_radius_m = 0.010;
};

/// Presses balls (the scenario's spheres) along the inward normal onto random places of the
/// surface, evenly by area, until the force is what was drawn. Places that a ball cannot
/// come to, and those where the virtual robot finds no balance, are skipped and counted.
class ContactGenerator {
 public:
  ContactGenerator(SensingScene& scene, const ContactWish& wish, std::uint64_t seed);

  /// The next contacts: scene.state() has their forces. False: none found after many attempts.
  bool Next();

  /// How it came to them: without tools, first with the cables of the contacts before (at first at
  /// zero), then the cables move, then the balls one after the other; the last is scene.state().
  const std::vector<SceneState>& path() const { return path_; }

  int made() const { return made_; }
  /// Places of the wanted kind at which it did not work.
  int skipped() const { return skipped_; }

 private:
  struct Place {
    Eigen::Vector3d position_m;
    Eigen::Vector3d inward;
  };
  struct Ball {
    std::string tool;
    double radius_m = 0.0;
  };

  bool Clear(const Eigen::VectorXd& displacement_m);
  bool Step(const scenario::BenchInputs& inputs);
  bool Attempt();
  std::optional<Place> DrawPlace(const Ball& ball, const std::vector<Place>& taken);
  bool IsWanted(const Eigen::Vector3d& position_m) const;
  bool CameAsWanted(const std::vector<Ball>& balls);
  bool IsFree(const Place& place, const Ball& ball) const;
  /// Moves the ball in until its force is `wanted_N`.
  bool Press(const Ball& ball, const Place& place, double wanted_N);
  std::vector<Ball> DrawBalls();

  SensingScene& scene_;
  ContactWish wish_;
  scenario::Random random_;
  std::vector<double> area_below_m2_;  ///< [triangles] cumulated, of those that may be touched
  SceneSight sight_;
  Eigen::VectorXd cables_before_m_;
  std::vector<SceneState> path_;
  int made_ = 0;
  int skipped_ = 0;
};

/// Size of the force of a tool, N; 0 where it does not touch.
double ForceOf_N(const SceneState& state, const std::string& tool);

}  // namespace palpate::test_support
