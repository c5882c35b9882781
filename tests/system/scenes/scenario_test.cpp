// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <map>
#include <string>
#include <vector>

#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/scenario/robot_names.hpp"
#include "libs/scenario/schedule.hpp"
#include "tests/support/robots.hpp"
#include "tests/support/sensing/scene_sight.hpp"
#include "tests/support/sensing/sensing_scene.hpp"

namespace palpate::test_support {
namespace {

using testing::Contains;
using testing::IsEmpty;
using testing::SizeIs;

/// Forces at a time of the scenario.
struct Moment {
  double t_s = 0.0;
  std::map<std::string, double> force_N;
  double seen_share = 0.0;  ///< of the surface at the first force
};

scenario::Scenario Shipped() {
  return scenario::ReadScenario(PALPATE_SOURCE_DIR "/config/scenarios/sensing.yaml", app::LoadYaml);
}

/// The scenario from beginning to end at half its rate.
class Moments {
 public:
  static constexpr double kFrame_s = 1.0 / 15.0;

  Moments() {
    scenario::Scenario scenario = Shipped();
    scenario.motion.time_step_s = kFrame_s;
    const scenario::Schedule schedule(scenario, scenario::NamesOf(FourLegRobot()).cables);
    SensingScene scene(FourLegRobot(), scenario, 1);
    SceneSight sight(scene);
    for (int frame = 1; frame * kFrame_s <= schedule.Duration_s(); ++frame) {
      Moment& moment = moments_.emplace_back();
      moment.t_s = frame * kFrame_s;
      if (!scene.Go(schedule.InputsAt(moment.t_s)).ok()) throw RunError("no balance");
      for (const auto& force : scene.state().forces) {
        moment.force_N[force.name] = force.force_N.norm();
      }
      if (moment.force_N.empty()) continue;
      sight.Look();
      moment.seen_share = sight.SeenShare(scene.state().forces[0].position_m, 0.010);
    }
  }

  std::vector<Moment> Between(double begin_s, double end_s) const {
    std::vector<Moment> some;
    for (const Moment& moment : moments_) {
      if (moment.t_s >= begin_s && moment.t_s <= end_s) some.push_back(moment);
    }
    return some;
  }

 private:
  std::vector<Moment> moments_;
};

TEST(SensingScenario, RestsAndPushesWhereItIsSeenAndWhereNotAndTwiceAtOnce) {
  const Moments moments;
  for (const Moment& moment : moments.Between(0.0, 4.5)) EXPECT_THAT(moment.force_N, IsEmpty());
  for (const Moment& moment : moments.Between(6.6, 7.3)) {
    EXPECT_THAT(moment.force_N, SizeIs(1));
    EXPECT_GT(moment.seen_share, 0.6);
  }
  for (const Moment& moment : moments.Between(11.6, 12.3)) {
    EXPECT_THAT(moment.force_N, SizeIs(1));
    EXPECT_EQ(moment.seen_share, 0.0);
  }
  for (const Moment& moment : moments.Between(16.7, 17.3)) EXPECT_THAT(moment.force_N, SizeIs(2));
  for (const Moment& moment : moments.Between(25.5, 30.0)) EXPECT_THAT(moment.force_N, IsEmpty());
  for (const double begin_s : {6.6, 11.6, 16.7, 23.0}) {  // held
    for (const Moment& moment : moments.Between(begin_s, begin_s + 0.6)) {
      ASSERT_FALSE(moment.force_N.empty()) << moment.t_s;
      for (const auto& [name, force_N] : moment.force_N) {
        EXPECT_GT(force_N, 0.3) << name << " at " << moment.t_s << " s";
        EXPECT_LT(force_N, 1.5) << name << " at " << moment.t_s << " s";
      }
    }
  }
}

TEST(SensingScenario, HasABallOfTheRobotsColor) {
  const scenario::Scenario scenario = Shipped();
  std::vector<double> differences;
  for (const scenario::Tool& tool : scenario.tools) {
    differences.push_back((tool.color_rgb - scenario.stage.robot_color_rgb).norm());
  }
  EXPECT_THAT(differences, Contains(0.0));
  EXPECT_THAT(differences, Contains(testing::Gt(0.5)));
}

}  // namespace
}  // namespace palpate::test_support
