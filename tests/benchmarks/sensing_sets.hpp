// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "components/force_estimation/shape/shape_frame.hpp"
#include "libs/robot/robot_description.hpp"
#include "libs/scenario/scenario.hpp"
#include "tests/support/sensing/contact_generator.hpp"
#include "tests/support/sensing/force_bound.hpp"
#include "tests/support/sensing/sensing_chain.hpp"
#include "tests/support/sensing/sensing_scene.hpp"
#include "tests/support/sensing/watch.hpp"

namespace palpate::benchmarks {

/// The weights of the paper's Table III, hung on the tip, and what was computed there, mN.
inline constexpr std::array<int, 6> kTableWeights_mN = {260, 460, 660, 760, 860, 1060};
inline constexpr std::array<int, 6> kTableComputed_mN = {230, 434, 634, 756, 873, 1045};

/// Frames in which a contact of SensingSets::Frames is held.
inline constexpr int kHeldFrames = 30;

/// What happens in a frame of SensingSets::Frames.
enum class Phase { kUntouched, kMoving, kHeld };

struct PhaseFrame {
  Phase phase = Phase::kUntouched;
  force_estimation::ShapeFrame frame;
};

struct SensingSize {
  int contacts = 10;
  int untouched_frames = 300;
  int texture_points = 0;        ///< of perception, that are followed
  bool converged_truth = false;  ///< ConvergedBallScenario in place of BallScenario
  std::uint64_t seed = 1;
};

/// Sets of contacts with their truth, each made when it is first asked for, and what the chain from
/// camera frames to forces makes of them. The chain learns from 40 untouched frames, 8 at rest and
/// 8 in each of four other postures, then takes one set after the other.
class SensingSets {
 public:
  using Path = std::vector<test_support::SceneState>;
  using Eyes = test_support::ChainSettings::Eyes;

  /// Who looks at the contacts.
  struct Onlooker {
    Eyes eyes = Eyes::kIdeal;
    std::size_t cameras = 1;  ///< of the two that are opposite each other
    bool weights_given = false;

    auto operator<=>(const Onlooker&) const = default;
  };

  /// Of the four-legged robot.
  explicit SensingSets(const SensingSize& size);
  /// Of another one; its actuators are commanded by 0 to `largest_command`, m or Pa.
  SensingSets(const SensingSize& size, const robot::RobotDescription& robot,
              const scenario::Scenario& scenario, double largest_command);

  /// `count` of them, with cables pulled in by up to 3 mm (`largest_command`). Throws RunError
  /// where there are none.
  test_support::Watched Touches(const Onlooker& onlooker, const test_support::ContactWish& wish,
                                int count);

  /// The same contacts, each there already in the first picture of a sequence, which has no second.
  test_support::Watched FirstPictures(const Onlooker& onlooker,
                                      const test_support::ContactWish& wish, int count);

  /// Accuracy bound of each of these contacts' forces, held as long as Touches holds them.
  std::vector<test_support::ForceBound> Bounds(const test_support::ContactWish& wish, int count);

  struct Untouched {
    test_support::Accuracy alarms{1e9};
    double smallest_force_N = 0.0;  ///< that would be found, median over the features in view
  };
  /// Half of the frames at rest, half with a hand that comes as near as 8 mm.
  Untouched NobodyTouches(const Onlooker& onlooker);

  /// Mean of |F| over the frames for each weight of Table III, N; 0 where it was not found.
  /// `given`: the estimator knows the contact at the tip; else it searches.
  std::array<double, kTableWeights_mN.size()> HangWeights(Eyes eyes, bool given);

  /// The frames of `contacts` contacts in view, one after the other, each coming, held and going,
  /// as an estimator gets them, after `untouched` ones.
  std::vector<PhaseFrame> Frames(int untouched, int contacts);

 private:
  /// Shows the scene at rest.
  test_support::SensingChain& ChainOf(const Onlooker& onlooker);
  const std::vector<Path>& PathsOf(const test_support::ContactWish& wish, int count);

  SensingSize size_;
  robot::RobotDescription robot_;
  double largest_command_;
  test_support::SensingScene scene_;
  std::map<std::string, std::vector<Path>> paths_;
  std::map<Onlooker, std::unique_ptr<test_support::SensingChain>> chains_;
};

}  // namespace palpate::benchmarks
