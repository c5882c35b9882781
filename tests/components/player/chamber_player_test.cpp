// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <cmath>

#include "components/player/experiment_player.hpp"
#include "components/player/node/convert.hpp"
#include "libs/experiment/actuation.hpp"
#include "tests/components/player/sample_experiment.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::player {
namespace {

TEST(ChamberPlayer, PlaysVolumeAsPositionAndPressureAsEffort) {
  const test_support::TestFolder folder;
  experiment::Experiment experiment = SampleExperiment();
  experiment.recordings.front().actuation = experiment::ReadActuation(folder.Write(
      "actuation.csv",
      "t_s,bend.volume_m3,bend.pressure_Pa,open.pressure_Pa\n0,1e-6,-500,0\n0.25,3e-6,20e3,0\n"));
  ExperimentPlayer player(experiment, "a", true);
  const auto first = ToJointState(*player.Next(), 0);
  ASSERT_EQ(first->name._length, 2u);
  EXPECT_EQ(dds::Text(first->name._buffer[0]), "bend");
  EXPECT_EQ(first->position._buffer[0], 1e-6);
  EXPECT_TRUE(std::isnan(first->position._buffer[1]));
  EXPECT_EQ(first->effort._buffer[0], -500.0);  // below ambient
  EXPECT_EQ(first->effort._buffer[1], 0.0);
  player.Next();
  const auto between = ToJointState(*player.Next(), 0);  // at 0.2 s
  EXPECT_NEAR(between->position._buffer[0], 2.6e-6, 1e-18);
  EXPECT_NEAR(between->effort._buffer[0], 15900.0, 1e-9);
}

}  // namespace
}  // namespace palpate::player
