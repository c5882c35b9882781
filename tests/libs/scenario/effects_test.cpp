// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <cmath>
#include <set>

#include "libs/core/file.hpp"
#include "libs/scenario/random.hpp"
#include "tests/libs/scenario/scenario_text.hpp"

namespace palpate::scenario {
namespace {

using test_support::MessageOf;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

RobotNames FourLeg() {
  return {.cables = {"north", "west", "south", "east"},
          .regions = {"leg_north", "leg_west"},
          .markers = {"tip", "hub"},
          .poissons_ratio = 0.45};
}

Scenario With(const std::string& effects, const std::string& more = "") {
  return Parse("name: s\n" + more + "effects: [" + effects +
               "]\nrecordings: [{name: a, duration_s: 1}, {name: b, duration_s: 1}]\n");
}

std::string Refusal(const std::string& effects) {
  return MessageOf([&] { With(effects); });
}

std::string Misfit(const std::string& effects) {
  return MessageOf([&] { CheckAgainst(With(effects, "markers: {}\n"), FourLeg()); });
}

const ActiveEffect* FindActive(const std::vector<ActiveEffect>& effects, const std::string& id,
                               const std::string& where) {
  for (const ActiveEffect& effect : effects) {
    if (effect.id == id && effect.where == std::vector<std::string>{where}) return &effect;
  }
  return nullptr;
}

TEST(EffectCatalogue, EveryEntryIsFoundOnceAndHasSaneParameters) {
  std::set<std::string_view> ids;
  for (const EffectKind& kind : EffectCatalogue()) {
    EXPECT_TRUE(ids.insert(kind.id).second) << kind.id;
    EXPECT_EQ(FindEffect(kind.id), &kind);
    EXPECT_FALSE(kind.what.empty());
    std::set<std::string_view> names;
    for (const EffectParameter& parameter : kind.parameters) {
      EXPECT_TRUE(names.insert(parameter.name).second) << kind.id;
      EXPECT_LT(parameter.min, parameter.max) << kind.id << parameter.name;
      EXPECT_GE(parameter.tolerance, 0.0);
      if (std::isnan(parameter.healthy)) continue;
      EXPECT_GE(parameter.healthy, parameter.min) << kind.id << parameter.name;
      EXPECT_LE(parameter.healthy, parameter.max) << kind.id << parameter.name;
    }
  }
  EXPECT_EQ(ids.size(), 41u);
  EXPECT_EQ(FindEffect("discretisation"), nullptr);
}

TEST(EffectCatalogue, SpellsParametersAsTheVerdictDoes) {
  const auto names = [](std::string_view id) {
    std::vector<std::string> list;
    for (const EffectParameter& p : FindEffect(id)->parameters) list.emplace_back(p.name);
    return list;
  };
  EXPECT_THAT(names("stiffening"), ElementsAre("C2_over_C1"));
  EXPECT_THAT(names("viscoelastic_creep"), ElementsAre("g", "tau_s"));
  EXPECT_THAT(names("temperature"), ElementsAre("relative_E_change_at_end"));
  EXPECT_THAT(names("base_compliance"), ElementsAre("compliance_rad_Nm"));
  EXPECT_THAT(names("gravity_direction"), ElementsAre("theta_x_deg", "theta_y_deg"));
  EXPECT_THAT(names("payload"), ElementsAre("mass_kg", "x_m", "y_m", "z_m"));
  EXPECT_THAT(names("permanent_force"), ElementsAre("fx_N", "fy_N", "fz_N", "x_m", "y_m", "z_m"));
  EXPECT_THAT(names("hidden_obstacle"), ElementsAre("gap_m", "nx", "ny", "nz"));
  EXPECT_THAT(names("cable_elasticity"), ElementsAre("k_N_m"));
  EXPECT_THAT(names("cable_cutting"), ElementsAre("compliance_m_N"));
  EXPECT_THAT(names("cable_routing"), ElementsAre("dy_m", "dz_m"));
  EXPECT_THAT(names("backlash"), ElementsAre("play_m"));
  EXPECT_THAT(names("lag"), ElementsAre("delay_s", "tau_s"));
  EXPECT_THAT(names("camera_moved"),
              ElementsAre("translation_m", "rotation_rad", "from_recording"));
  EXPECT_THAT(names("intrinsics"), ElementsAre("focal", "cx_px", "cy_px"));
  EXPECT_THAT(names("warm_up_drift"), ElementsAre("amplitude_m", "tau_s"));
  EXPECT_THAT(names("marker_misplacement"), ElementsAre("d_m"));
}

TEST(EffectRefusals, IdsPlacesAndSizes) {
  EXPECT_THAT(Refusal("{id: cable_fiction, mu: 1}"),
              AllOf(HasSubstr("s.yaml:2:16"), HasSubstr("did you mean 'cable_friction'")));
  EXPECT_THAT(Refusal("{id: discretisation}"), HasSubstr("body.refine"));
  EXPECT_THAT(Refusal("{id: cable_friction, nu: 1}"), HasSubstr("'mu' is missing"));
  EXPECT_THAT(Refusal("{id: cable_friction, mu: 1, k: 2}"),
              HasSubstr("unknown key 'effects[0].k'"));
  EXPECT_THAT(Refusal("{id: cable_friction, mu: 3}"), HasSubstr(">= 0 and <= 2, not 3"));
  EXPECT_THAT(Refusal("{id: cable_friction, mu: [0.5, 0.2]}"), HasSubstr("[lower, upper]"));
  EXPECT_THAT(Refusal("{id: cable_friction, mu: [0.5]}"), HasSubstr("[lower, upper]"));
  EXPECT_THAT(Refusal("{id: cable_friction, where: north, mu: 1}"), HasSubstr("is cable:<name>"));
  EXPECT_THAT(Refusal("{id: cable_friction, where: \"cable:\", mu: 1}"),
              HasSubstr("is cable:<name> for cable_friction"));
  EXPECT_THAT(Refusal("{id: cable_friction, where: [cable:a, cable:b], mu: 1}"),
              HasSubstr("is cable:<name>"));
  EXPECT_THAT(Refusal("{id: swapped_cables, where: cable:north}"), HasSubstr("[cable:<name>, "));
  EXPECT_THAT(Refusal("{id: swapped_cables, where: [cable:a, cable:a]}"), HasSubstr("another"));
  EXPECT_THAT(Refusal("{id: density, where: base, factor: 1.1}"), HasSubstr("is body for density"));
  EXPECT_THAT(Refusal("{id: lag}"), HasSubstr("at least one of its parameters"));
  EXPECT_THAT(Refusal("{id: hidden_obstacle, gap_m: 0.01, nx: 0, ny: [-0.1, 0.1], nz: 0}"),
              HasSubstr("must not be able to be zero"));
  EXPECT_THAT(Refusal("{id: cable_gain, where: cable:a, g: 0.1}, {id: cable_gain, where: cable:a, "
                      "g: 0.2}"),
              HasSubstr("a second 'cable_gain' at the same place"));
  EXPECT_THAT(Refusal("{id: swapped_cables, where: [cable:a, cable:b]}, {id: swapped_cables, "
                      "where: [cable:b, cable:a]}"),
              HasSubstr("a second 'swapped_cables'"));
}

TEST(EffectRefusals, WhatTheRobotHasNot) {
  EXPECT_THAT(Misfit("{id: cable_gain, where: cable:nort, g: 0.1}"),
              AllOf(HasSubstr("s.yaml:3:11"), HasSubstr("did you mean 'cable:north'")));
  EXPECT_THAT(Misfit("{id: regional_stiffness, where: region:leg_east, factor: 0.5}"),
              HasSubstr("the robot has no region:leg_east"));
  EXPECT_THAT(Misfit("{id: marker_misplacement, where: marker:top, d_m: 0.01}"),
              HasSubstr("the robot has no marker:top"));
  EXPECT_THAT(Misfit("{id: swapped_cables, where: [cable:north, cable:up]}"),
              HasSubstr("the robot has no cable:up"));
  EXPECT_THAT(Misfit("{id: regional_stiffness, factor: 0.5}, {id: regional_stiffness, factor: 0.6},"
                     " {id: regional_stiffness, factor: 0.7}"),
              HasSubstr("wanted 3 times, and the robot has 2 places"));
  Scenario scenario = With("");
  scenario.recordings[1].commands.cables = {"wst"};
  EXPECT_THAT(MessageOf([&] { CheckAgainst(scenario, FourLeg()); }),
              AllOf(HasSubstr("recording 'b'"), HasSubstr("did you mean 'west'")));
  EXPECT_NO_THROW(CheckAgainst(With("{id: cable_gain, where: cable:west, g: 0.1}"), FourLeg()));
}

TEST(DrawEffects, KeepsWhatIsGivenAndFillsInWhatIsLeftOut) {
  const auto effects = DrawEffects(With("{id: cable_friction, where: cable:west, mu: 0.3}, "
                                        "{id: lag, delay_s: 0.05}, {id: swapped_cables, where: "
                                        "[cable:east, cable:north]}"),
                                   FourLeg(), 1);
  ASSERT_EQ(effects.size(), 3u);
  EXPECT_EQ(effects[0].id, "cable_friction");
  EXPECT_THAT(effects[0].where, ElementsAre("cable:west"));
  EXPECT_EQ(effects[0].Get("mu"), 0.3);
  EXPECT_FALSE(effects[0].clutter);
  EXPECT_THAT(effects[1].where, ElementsAre("body"));
  EXPECT_EQ(effects[1].Get("delay_s"), 0.05);
  EXPECT_EQ(effects[1].Get("tau_s"), 0.0);
  EXPECT_THAT(effects[2].where, ElementsAre("cable:east", "cable:north"));
  EXPECT_TRUE(effects[2].parameters.empty());
}

TEST(DrawEffects, SameSeedSameEffectsAnotherSeedOthers) {
  const Scenario scenario = With("{id: cable_gain, g: [0.02, 0.1]}", "clutter: 1\n");
  const auto first = DrawEffects(scenario, FourLeg(), 7);
  const auto again = DrawEffects(scenario, FourLeg(), 7);
  ASSERT_EQ(first.size(), again.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].where, again[i].where);
    EXPECT_EQ(first[i].parameters, again[i].parameters);
  }
  EXPECT_NE(first[0].Get("g"), DrawEffects(scenario, FourLeg(), 8)[0].Get("g"));
}

TEST(DrawEffects, DrawsEveryPlaceAndTheWholeRange) {
  const Scenario scenario = With("{id: cable_gain, g: [0.02, 0.1]}");
  std::set<std::string> places;
  double lowest = 1.0, highest = 0.0, sum = 0.0;
  const int count = 400;
  for (int seed = 0; seed < count; ++seed) {
    const ActiveEffect effect = DrawEffects(scenario, FourLeg(), static_cast<unsigned>(seed))[0];
    places.insert(effect.where[0]);
    lowest = std::min(lowest, effect.Get("g"));
    highest = std::max(highest, effect.Get("g"));
    sum += effect.Get("g");
  }
  EXPECT_EQ(places.size(), 4u);
  EXPECT_GE(lowest, 0.02);
  EXPECT_LT(lowest, 0.022);
  EXPECT_LE(highest, 0.1);
  EXPECT_GT(highest, 0.098);
  EXPECT_NEAR(sum / count, 0.06, 0.005);
}

TEST(DrawEffects, DrawsLogarithmicallyOverMoreThanADecade) {
  const Scenario scenario = With("{id: cable_elasticity, where: cable:east, k_N_m: [500, 50000]}");
  int below = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    if (DrawEffects(scenario, FourLeg(), seed)[0].Get("k_N_m") < 5000.0) ++below;
  }
  EXPECT_NEAR(below, 200, 40);
}

TEST(DrawEffects, TheSameKindTwiceNeverSitsAtOnePlace) {
  const Scenario scenario = With(
      "{id: regional_stiffness, factor: 0.5}, {id: regional_stiffness, "
      "where: region:leg_north, factor: 0.6}");
  for (unsigned seed = 0; seed < 20; ++seed) {
    const auto effects = DrawEffects(scenario, FourLeg(), seed);
    EXPECT_THAT(effects[0].where, ElementsAre("region:leg_west"));
    EXPECT_THAT(effects[1].where, ElementsAre("region:leg_north"));
  }
}

TEST(DrawEffects, DrawsRecordingsAsWholeNumbers) {
  const Scenario scenario = With("{id: camera_moved, translation_m: 0.01, from_recording: [0, 1]}",
                                 "camera: {depth: {width_px: 4, height_px: 4, fx_px: 3, fy_px: 3, "
                                 "cx_px: 2, cy_px: 2, unit_m: 0.001}, noise: {sensor: none}, "
                                 "eye_m: [0, 0, 1], target_m: [0, 0, 0]}\n");
  std::set<double> drawn;
  for (unsigned seed = 0; seed < 40; ++seed) {
    drawn.insert(DrawEffects(scenario, FourLeg(), seed)[0].Get("from_recording"));
  }
  EXPECT_THAT(drawn, ElementsAre(0.0, 1.0));
}

TEST(DrawEffects, ClutterIsNormalWithTheTolerances) {
  const Scenario scenario = With("", "clutter: 2\nmarkers: {}\n");
  double sum = 0.0, sum_squared = 0.0, nu_sum = 0.0;
  const int count = 2000;
  for (unsigned seed = 0; seed < count; ++seed) {
    const auto effects = DrawEffects(scenario, FourLeg(), seed);
    const double off = FindActive(effects, "youngs_modulus", "body")->Get("factor") - 1.0;
    sum += off;
    sum_squared += off * off;
    nu_sum += FindActive(effects, "poissons_ratio", "body")->Get("nu");
    EXPECT_GE(FindActive(effects, "cable_friction", "cable:south")->Get("mu"), 0.0);
    EXPECT_GT(FindActive(effects, "marker_misplacement", "marker:hub")->Get("d_m"), 0.0);
  }
  EXPECT_NEAR(sum / count, 0.0, 3.0 * 0.06 / std::sqrt(count));
  EXPECT_NEAR(std::sqrt(sum_squared / count), 0.06, 0.06 * 0.05);
  EXPECT_NEAR(nu_sum / count, 0.45, 3.0 * 0.01 / std::sqrt(count));
}

TEST(DrawEffects, ClutterLeavesOutWhatIsWantedAndWhatIsNotThere) {
  const auto effects = DrawEffects(
      With("{id: cable_gain, where: cable:north, g: 0.1}", "clutter: 1\n"), FourLeg(), 3);
  EXPECT_FALSE(effects[0].clutter);
  EXPECT_EQ(FindActive(effects, "cable_gain", "cable:north"), &effects[0]);
  EXPECT_TRUE(FindActive(effects, "cable_gain", "cable:west")->clutter);
  EXPECT_EQ(FindActive(effects, "depth_scale", "camera"), nullptr);              // no camera
  EXPECT_EQ(FindActive(effects, "marker_misplacement", "marker:tip"), nullptr);  // no markers
  EXPECT_EQ(FindActive(effects, "payload", "body"), nullptr);                    // no tolerance
  RobotNames unknown = FourLeg();
  unknown.poissons_ratio = std::nan("");
  EXPECT_EQ(FindActive(DrawEffects(With("", "clutter: 1\n"), unknown, 3), "poissons_ratio", "body"),
            nullptr);
}

TEST(DrawEffects, ClutterOfOneThingDoesNotDependOnTheOthers) {
  const auto alone = DrawEffects(With("", "clutter: 1\n"), FourLeg(), 5);
  const auto with = DrawEffects(With("{id: density, factor: 1.2}", "clutter: 1\n"), FourLeg(), 5);
  EXPECT_EQ(FindActive(alone, "backlash", "cable:east")->Get("play_m"),
            FindActive(with, "backlash", "cable:east")->Get("play_m"));
}

TEST(Random, TheFirstNumbersOfAStreamAreThoseOfEveryMachine) {
  Random random(42, "stream");  // the numbers were worked out with whole numbers of any size
  EXPECT_EQ(random.Bits(), 0xe2456fee399a9324U);
  EXPECT_EQ(random.Bits(), 0xa9ee6aa92fa8104dU);
  EXPECT_EQ(random.Uniform(), 0x1.8b789ca1ce254p-1);
  EXPECT_EQ(random.Normal(), 0x1.2394c57ec6944p+1);
}

TEST(Random, StreamsDifferByNameAndSeed) {
  EXPECT_NE(Random(1, "a").Bits(), Random(1, "b").Bits());
  EXPECT_NE(Random(1, "a").Bits(), Random(2, "a").Bits());
}

TEST(Random, NormalNumbersHaveTheMomentsOfTheNormalDistribution) {
  Random random(9, "moments");
  const int count = 100000;
  double sum = 0.0, squares = 0.0;
  int beyond_two = 0;
  for (int i = 0; i < count; ++i) {
    const double x = random.Normal();
    sum += x;
    squares += x * x;
    if (std::abs(x) > 2.0) ++beyond_two;
  }
  EXPECT_NEAR(sum / count, 0.0, 0.01);
  EXPECT_NEAR(squares / count, 1.0, 0.015);
  EXPECT_NEAR(static_cast<double>(beyond_two) / count, 0.0455, 0.003);
}

TEST(Random, DirectionsFillTheSphereEvenly) {
  Random random(9, "directions");
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  const int count = 20000;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d d = random.Direction();
    ASSERT_NEAR(d.norm(), 1.0, 1e-14);
    mean += d / count;
    second += d * d.transpose() / count;
  }
  EXPECT_LT(mean.norm(), 0.02);
  EXPECT_TRUE(second.isApprox(Eigen::Matrix3d::Identity() / 3.0, 0.02));
}

}  // namespace
}  // namespace palpate::scenario
