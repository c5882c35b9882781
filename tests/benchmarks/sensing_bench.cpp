// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/benchmarks/sensing_bench.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <string>
#include <utility>

#include "libs/core/error.hpp"
#include "libs/core/statistics.hpp"
#include "libs/core/text.hpp"
#include "tests/benchmarks/lazy.hpp"
#include "tests/benchmarks/sensing_frames.hpp"
#include "tests/benchmarks/sensing_sets.hpp"
#include "tests/support/robots.hpp"
#include "tests/support/sensing/sensing_scene.hpp"

namespace palpate::benchmarks {

namespace {

using test_support::AccuracySummary;
using test_support::ContactWish;
using Eyes = SensingSets::Eyes;
using Onlooker = SensingSets::Onlooker;

constexpr double kWantedError = 0.1;  ///< of a hidden force
constexpr double kLargestPressure_Pa = 13e3;

int NumberFrom(const char* variable, int otherwise) {
  const char* text = std::getenv(variable);
  if (text == nullptr) return otherwise;
  double number = 0.0;
  if (!ParseFinite(text, &number) || number < 1.0 || number > 1e6) {
    throw InputError(std::string(variable) + " is '" + text + "', not a number from 1 to 1000000");
  }
  return static_cast<int>(number);
}

SensingSize SizeFromEnvironment() {
  SensingSize size;
  size.contacts = NumberFrom("PALPATE_SENSING_CONTACTS", size.contacts);
  size.untouched_frames = NumberFrom("PALPATE_SENSING_FRAMES", size.untouched_frames);
  size.seed = static_cast<std::uint64_t>(NumberFrom("PALPATE_SENSING_SEED", 1));
  size.texture_points = NumberFrom("PALPATE_SENSING_TEXTURE", size.texture_points);
  size.converged_truth = std::getenv("PALPATE_SENSING_CONVERGED") != nullptr;
  return size;
}

/// What is not known is left out.
void Count(benchmark::State& state, const char* name, double value) {
  if (std::isfinite(value)) state.counters[name] = value;
}

void CountFalseAlarms(benchmark::State& state, const AccuracySummary& summary) {
  Count(state, "frames", summary.frames);
  Count(state, "false_alarms", summary.false_alarms);
  Count(state, "failed_frames", summary.failed_frames);
}

void CountAccuracy(benchmark::State& state, const test_support::Watched& watched) {
  constexpr double kPercent = 100.0;
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  const AccuracySummary held = watched.held.Summary();
  AccuracySummary all = watched.underway.Summary();
  all.frames += held.frames;
  all.false_alarms += held.false_alarms;
  all.failed_frames += held.failed_frames;
  CountFalseAlarms(state, all);
  Count(state, "forces", held.forces);
  Count(state, "found_percent", kPercent * held.found_share);
  Count(state, "error_mean_percent", kPercent * held.mean_relative_error);
  Count(state, "error_median_percent", kPercent * held.median_relative_error);
  Count(state, "error_largest_percent", kPercent * held.largest_relative_error);
  Count(state, "location_median_mm", 1e3 * held.median_location_error_m);
  Count(state, "location_largest_mm", 1e3 * held.largest_location_error_m);
  Count(state, "force_coverage_percent", kPercent * held.force_coverage);
  Count(state, "location_coverage_percent", kPercent * held.location_coverage);
  Count(state, "nees_per_degree", held.nees_per_degree);
  Count(state, "nees_lowest", held.lowest_nees);
  Count(state, "nees_highest", held.highest_nees);
  Count(state, "within_ellipsoid_percent", kPercent * held.within_ellipsoid);
  Count(state, "directions", held.directions);
  Count(state, "direction_mean_deg", kDegrees * held.mean_direction_error_rad);
  Count(state, "direction_largest_deg", kDegrees * held.largest_direction_error_rad);
  Count(state, "found_from_N", Median(watched.found_from_N));
}

/// First part of the names of what is seen so.
std::string NameOf(const Onlooker& onlooker) {
  if (onlooker.cameras == 2) return "sensing/two_cameras/";
  return onlooker.eyes == Eyes::kIdeal ? "sensing/ideal_perception/" : "sensing/whole/";
}

/// How a set of contacts is shown.
using Showing = test_support::Watched (SensingSets::*)(const Onlooker&, const ContactWish&, int);

Benchmark OfTouches(const SharedSets& sets, const Onlooker& onlooker, const std::string& name,
                    const ContactWish& wish, int contacts, Showing show = &SensingSets::Touches) {
  return {.name = NameOf(onlooker) + name,
          .measure =
              [sets, onlooker, wish, contacts, show](benchmark::State& state) {
                test_support::Watched watched;
                for ([[maybe_unused]] auto iteration : state) {
                  watched = (sets->Get().*show)(onlooker, wish, contacts);
                }
                CountAccuracy(state, watched);
              },
          .max_repetitions = 1};
}

/// What the frames could tell of forces at best, as shares of them.
Benchmark OfBounds(const SharedSets& sets, const std::string& name, const ContactWish& wish,
                   int contacts) {
  return {.name = "sensing/bound/" + name,
          .measure =
              [sets, wish, contacts](benchmark::State& state) {
                std::vector<test_support::ForceBound> bounds;
                for ([[maybe_unused]] auto iteration : state) {
                  bounds = sets->Get().Bounds(wish, contacts);
                }
                std::vector<double> noise, whole, at_place;
                double beyond = 0.0;
                for (const test_support::ForceBound& bound : bounds) {
                  noise.push_back(100.0 * bound.noise);
                  whole.push_back(100.0 * bound.whole);
                  at_place.push_back(100.0 * bound.at_place);
                  beyond += bound.whole > kWantedError ? 1.0 : 0.0;
                }
                state.counters["contacts"] = static_cast<double>(bounds.size());
                state.counters["noise_median_percent"] = Median(noise);
                state.counters["whole_median_percent"] = Median(whole);
                state.counters["whole_mean_percent"] = Mean(whole);
                state.counters["whole_largest_percent"] = test_support::Largest(whole);
                state.counters["at_place_median_percent"] = Median(at_place);
                state.counters["beyond_10_percent"] = beyond;
              },
          .max_repetitions = 1};
}

Benchmark OfNobody(const SharedSets& sets, const Onlooker& onlooker) {
  return {.name = NameOf(onlooker) + "nobody_touches",
          .measure =
              [sets, onlooker](benchmark::State& state) {
                SensingSets::Untouched untouched;
                for ([[maybe_unused]] auto iteration : state) {
                  untouched = sets->Get().NobodyTouches(onlooker);
                }
                CountFalseAlarms(state, untouched.alarms.Summary());
                Count(state, "smallest_force_N", untouched.smallest_force_N);
              },
          .max_repetitions = 1};
}

Benchmark OfWeights(const SharedSets& sets, Eyes eyes, const char* name, bool given) {
  return {.name = NameOf({.eyes = eyes}) + name,
          .measure =
              [sets, eyes, given](benchmark::State& state) {
                std::array<double, kTableWeights_mN.size()> found_N = {};
                for ([[maybe_unused]] auto iteration : state) {
                  found_N = sets->Get().HangWeights(eyes, given);
                }
                for (std::size_t w = 0; w < found_N.size(); ++w) {
                  const std::string weight = "weight_" + std::to_string(kTableWeights_mN[w]);
                  state.counters[weight + "_mN"] = 1e3 * found_N[w];
                }
              },
          .max_repetitions = 1};
}

/// Contacts of a robot that is driven by air: on the upper half of the finger, where they move its
/// tip by 3 to 14 mm.
std::vector<Benchmark> OfFinger(const SensingSize& size) {
  const SharedSets sets = MakeLazy<SensingSets>([size] {
    return std::make_unique<SensingSets>(size, test_support::ReadRobot("pneumatic_finger"),
                                         test_support::FingerBallScenario(), kLargestPressure_Pa);
  });
  const ContactWish wish{.where = ContactWish::Where::kVisible,
                         .smallest_N = 0.05,
                         .largest_N = 0.2,
                         .above_clamp_m = 0.055,
                         .visible_share = 0.5,
                         .patch_radius_m = 0.006};
  std::vector<Benchmark> found;
  for (const Eyes eyes : {Eyes::kPerception, Eyes::kIdeal}) {
    Benchmark touches = OfTouches(sets, {.eyes = eyes}, "one_visible", wish, size.contacts);
    touches.name.insert(std::string("sensing/").size(), "pneumatic_finger/");
    found.push_back(std::move(touches));
  }
  Benchmark bounds = OfBounds(sets, "one_visible", wish, size.contacts);
  bounds.name.insert(std::string("sensing/").size(), "pneumatic_finger/");
  found.push_back(std::move(bounds));
  return found;
}

}  // namespace

std::vector<Block> SensingBlocks() {
  using Where = ContactWish::Where;
  const SensingSize size = SizeFromEnvironment();
  const SharedSets sets =
      MakeLazy<SensingSets>([size] { return std::make_unique<SensingSets>(size); });
  const int half = (size.contacts + 1) / 2;
  std::vector<Block> blocks = FrameBlocks(sets);
  const auto add = [&](Benchmark set) {
    blocks.push_back(
        {.heading = "force estimation from depth images: whole sets (their accuracy: below)",
         .benchmarks = {std::move(set)}});
  };
  const auto add_contacts = [&](const Onlooker& onlooker) {
    add(OfTouches(sets, onlooker, "one_visible", {.where = Where::kVisible}, size.contacts));
    add(OfTouches(sets, onlooker, "two_visible", {.where = Where::kVisible, .count = 2}, half));
    add(OfTouches(sets, onlooker, "one_hidden", {.where = Where::kHidden}, half));
    add(OfNobody(sets, onlooker));
  };
  for (const Eyes eyes : {Eyes::kPerception, Eyes::kIdeal}) {
    add_contacts({.eyes = eyes});
    add(OfWeights(sets, eyes, "weights_searched", false));
  }
  add(OfWeights(sets, Eyes::kIdeal, "weights_given", true));
  const auto add_first = [&](const std::string& name, const ContactWish& wish, int contacts) {
    add(OfTouches(sets, {.eyes = Eyes::kPerception}, "first_picture/" + name, wish, contacts,
                  &SensingSets::FirstPictures));
  };
  add_first("one_visible", {.where = Where::kVisible}, size.contacts);
  add_first("two_visible", {.where = Where::kVisible, .count = 2}, half);
  add_first("one_hidden", {.where = Where::kHidden}, half);
  add(OfBounds(sets, "one_visible", {.where = Where::kVisible}, size.contacts));
  add(OfBounds(sets, "two_visible", {.where = Where::kVisible, .count = 2}, half));
  add(OfBounds(sets, "one_hidden", {.where = Where::kHidden}, half));
  add_contacts({.eyes = Eyes::kPerception, .cameras = 2});
  for (Benchmark& set : OfFinger(size)) add(std::move(set));
  return blocks;
}

}  // namespace palpate::benchmarks
