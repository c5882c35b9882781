// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/data/timebase.hpp"

#include <gtest/gtest.h>

#include "tests/components/diagnosis/small_robot.hpp"

namespace palpate::diagnosis {
namespace {

experiment::Experiment TwoOfFiveSeconds(double second_begins_s) {
  const robot::RobotBody body = SmallRobot();
  experiment::Experiment experiment;
  for (const double begin_s : {0.0, second_begins_s}) {
    experiment.recordings.push_back(
        MakeRecording("r", body, {{begin_s, {0.0}}, {begin_s + 5.0, {0.001}}}, 0.5));
  }
  experiment::Recording& second = experiment.recordings[1];
  second.steady_window_s = experiment::TimeWindow{second_begins_s + 2.0, second_begins_s + 5.0};
  second.reference = experiment::Reference{{second_begins_s, second_begins_s + 1.0}};
  second.loads.resize(1);
  second.loads[0].t_s = second_begins_s + 3.0;
  return experiment;
}

TEST(Timebase, LeavesRecordingsThatFollowEachOther) {
  const experiment::Experiment experiment = OnOneTimebase(TwoOfFiveSeconds(7.0));
  EXPECT_EQ(experiment.recordings[1].markers->frames.front().t_s, 7.0);
  EXPECT_EQ(experiment.recordings[1].actuation->t_s.front(), 7.0);
}

TEST(Timebase, ShiftsAllOfARecordingWhoseClockBeganAnew) {
  experiment::Experiment given = TwoOfFiveSeconds(0.0);
  given.rest_between_s = 4.0;
  const experiment::Experiment experiment = OnOneTimebase(given);
  EXPECT_EQ(experiment.recordings[0].markers->frames.front().t_s, 0.0);
  const experiment::Recording& second = experiment.recordings[1];
  EXPECT_EQ(second.markers->frames.front().t_s, 9.0);
  EXPECT_EQ(second.markers->frames.back().t_s, 14.0);
  EXPECT_EQ(second.actuation->t_s.front(), 9.0);
  EXPECT_EQ(second.steady_window_s->begin_s, 11.0);
  EXPECT_EQ(second.reference->window_s.end_s, 10.0);
  EXPECT_EQ(second.loads[0].t_s, 12.0);
  given.rest_between_s.reset();
  EXPECT_GT(OnOneTimebase(given).recordings[1].markers->frames.front().t_s, 1000.0)
      << "the duration of the rest is unknown";
}

}  // namespace
}  // namespace palpate::diagnosis
