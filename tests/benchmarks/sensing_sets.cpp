// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/benchmarks/sensing_sets.hpp"

#include <cmath>
#include <utility>

#include "libs/core/error.hpp"
#include "libs/core/statistics.hpp"
#include "tests/support/robots.hpp"
#include "tests/support/sensing/accuracy.hpp"
#include "tests/support/sensing/ideal_perception.hpp"
#include "tests/support/sensing/paths.hpp"

namespace palpate::benchmarks {

namespace {

using test_support::ContactWish;
using test_support::FourLegRobot;
using test_support::SceneState;
using test_support::SensingChain;
using test_support::Watched;

constexpr double kLargestCable_m = 0.003;
constexpr int kLearningFrames = 40;
constexpr int kPostures = 4;
constexpr int kHandFrames = 30;
constexpr double kHandNearest_m = 0.008;
const Eigen::Vector3d kTip_m(0.0, 0.0, 0.125);
constexpr double kTipPatch_m = 0.006;

std::string KeyOf(const ContactWish& wish, int count) {
  return std::to_string(static_cast<int>(wish.where)) + " " + std::to_string(wish.count) + " " +
         std::to_string(count);
}

scenario::Scenario ScenarioOf(const SensingSize& size) {
  scenario::Scenario scenario =
      size.converged_truth ? test_support::ConvergedBallScenario() : test_support::BallScenario();
  scenario.further_cameras = test_support::OppositeCamera();
  return scenario;
}

double MedianSmallestForce_N(SensingChain& chain) {
  std::vector<double> smallest_N;
  const auto& features = chain.estimator().features();
  const auto& points = chain.model().body().feature_points;
  for (std::size_t k = 0; k < features.size(); ++k) {
    if (features[k].state != correspondence::MatchState::kMatched) continue;
    const double force_N = chain.estimator().SmallestForce_N(points[k].rest_m);
    if (std::isfinite(force_N)) smallest_N.push_back(force_N);
  }
  return Median(smallest_N);
}

}  // namespace

SensingSets::SensingSets(const SensingSize& size)
    : SensingSets(size, FourLegRobot(), ScenarioOf(size), kLargestCable_m) {}

SensingSets::SensingSets(const SensingSize& size, const robot::RobotDescription& robot,
                         const scenario::Scenario& scenario, double largest_command)
    : size_(size),
      robot_(robot),
      largest_command_(largest_command),
      scene_(robot, scenario, size.seed) {}

SensingChain& SensingSets::ChainOf(const Onlooker& onlooker) {
  std::unique_ptr<SensingChain>& chain = chains_[onlooker];
  if (chain == nullptr) {
    test_support::ChainSettings settings;
    settings.eyes = onlooker.eyes;
    settings.cameras = onlooker.cameras;
    settings.perception.texture.max_points = size_.texture_points;
    settings.weights_given = onlooker.weights_given;
    chain = std::make_unique<SensingChain>(robot_, scene_, settings, size_.seed);
    chain->Learn(kLearningFrames, kPostures, largest_command_);
  }
  if (!scene_.Start(scene_.Nothing()).ok()) throw RunError("the virtual robot does not hang");
  return *chain;
}

const std::vector<SensingSets::Path>& SensingSets::PathsOf(const ContactWish& wish, int count) {
  std::vector<Path>& paths = paths_[KeyOf(wish, count)];
  if (!paths.empty()) return paths;
  ContactWish with_cables = wish;
  with_cables.largest_command = largest_command_;
  if (!scene_.Start(scene_.Nothing()).ok()) throw RunError("the virtual robot does not hang");
  test_support::ContactGenerator generator(scene_, with_cables, size_.seed);
  while (static_cast<int>(paths.size()) < count && generator.Next()) {
    paths.push_back(generator.path());
  }
  if (paths.empty()) throw RunError("no contact of this kind was found");
  return paths;
}

Watched SensingSets::Touches(const Onlooker& onlooker, const ContactWish& wish, int count) {
  const std::vector<Path>& paths = PathsOf(wish, count);
  SensingChain& chain = ChainOf(onlooker);
  Watched watched;
  for (const Path& path : paths) test_support::Watch(path, {}, scene_, chain, &watched);
  return watched;
}

Watched SensingSets::FirstPictures(const Onlooker& onlooker, const ContactWish& wish, int count) {
  const std::vector<Path>& paths = PathsOf(wish, count);
  SensingChain& chain = ChainOf(onlooker);
  Watched watched;
  for (const Path& path : paths) {
    scene_.Show(path.back());
    chain.Open();
    watched.held.BeginContacts();
    watched.held.Add(path.back().forces, chain.Take());
  }
  chain.Open();
  return watched;
}

std::vector<test_support::ForceBound> SensingSets::Bounds(const ContactWish& wish, int count) {
  const std::vector<Path>& paths = PathsOf(wish, count);
  robot::RobotModel model(robot::BuildRobotBody(robot_));
  test_support::ForceBounds bounds(model, force_estimation::ShapeConfig());
  test_support::IdealPerception ideal(scene_);
  const auto take = [&] {
    scene_.TakeFrame();
    force_estimation::ShapeFrame frame = ideal.Frame({});
    frame.cables = scene_.Cables();
    return frame;
  };
  if (!scene_.Start(scene_.Nothing()).ok()) throw RunError("the virtual robot does not hang");
  std::vector<force_estimation::ShapeFrame> untouched;
  for (int k = 0; k < kLearningFrames; ++k) untouched.push_back(take());
  bounds.Learn(untouched);
  const test_support::WatchPlan plan;
  std::vector<test_support::ForceBound> all;
  for (const Path& path : paths) {
    scene_.Show(path.back());
    for (const auto& bound : bounds.Of(path.back().forces, take(), plan.settle + plan.measured))
      all.push_back(bound);
  }
  return all;
}

SensingSets::Untouched SensingSets::NobodyTouches(const Onlooker& onlooker) {
  SensingChain& chain = ChainOf(onlooker);
  Untouched untouched;
  scenario::Random random(size_.seed, "hand");
  const SceneState rest = scene_.state();
  const int at_rest = size_.untouched_frames / 2;
  for (int k = 0; k < at_rest; ++k) untouched.alarms.Add({}, chain.Take());
  untouched.smallest_force_N = MedianSmallestForce_N(chain);
  for (int k = at_rest; k < size_.untouched_frames;) {
    scene_.Show(rest);
    for (const SceneState& state :
         test_support::HandComesNear(scene_, kHandNearest_m, kHandFrames, &random)) {
      if (k++ == size_.untouched_frames) break;
      scene_.Show(state);
      untouched.alarms.Add({}, chain.Take());
    }
  }
  scene_.Show(rest);
  return untouched;
}

std::array<double, kTableWeights_mN.size()> SensingSets::HangWeights(Eyes eyes, bool given) {
  std::array<double, kTableWeights_mN.size()> found_N = {};
  constexpr int kSettling = 5;
  constexpr int kMeasured = 10;
  SensingChain& chain = ChainOf({.eyes = eyes, .weights_given = given});
  for (std::size_t w = 0; w < kTableWeights_mN.size(); ++w) {
    const Path path =
        test_support::HangWeight(scene_, kTip_m, 1e-3 * kTableWeights_mN[w], kTipPatch_m);
    for (int k = 0; k < kSettling; ++k) {  // the weight before has gone
      scene_.Show(path.front());
      chain.Take();
    }
    for (const SceneState& state : path) {
      scene_.Show(state);
      chain.Take();
    }
    for (int k = 0; k < kSettling; ++k) chain.Take();
    for (int k = 0; k < kMeasured; ++k) {
      const force_estimation::ForceEstimate& estimate = chain.Take();
      Eigen::Vector3d force_N = Eigen::Vector3d::Zero();
      if (estimate.status.ok()) {
        for (const auto& contact : estimate.contacts) force_N += contact.force_N;
      }
      found_N[w] += force_N.norm() / kMeasured;
    }
  }
  return found_N;
}

std::vector<PhaseFrame> SensingSets::Frames(int untouched, int contacts) {
  std::vector<PhaseFrame> frames;
  const std::vector<Path>& paths = PathsOf({}, contacts);
  SensingChain& chain = ChainOf({});
  for (int k = 0; k < untouched; ++k) {
    chain.Take();
    frames.push_back({Phase::kUntouched, chain.frame()});
    frames.back().frame.untouched = true;
  }
  const auto show = [&](const SceneState& state, Phase phase) {
    scene_.Show(state);
    chain.Take();
    frames.push_back({phase, chain.frame()});
  };
  for (const Path& path : paths) {
    for (const SceneState& state : path) show(state, Phase::kMoving);
    for (int k = 0; k < kHeldFrames; ++k) show(path.back(), Phase::kHeld);
    for (auto state = path.rbegin(); state != path.rend(); ++state) show(*state, Phase::kMoving);
  }
  return frames;
}

}  // namespace palpate::benchmarks
