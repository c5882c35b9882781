// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/start_shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace palpate::diagnosis {
namespace {

/// Two actuators, of which the second is not driven in all samples; each has one part.
class StartShapesTest : public testing::Test {
 protected:
  void Add(double first_m, double second_m, const Eigen::Matrix3d& base_rotation) {
    ObservedRecording recording;
    recording.base_rotation = base_rotation;
    observed_.recordings.push_back(recording);
    Sample sample;
    sample.recording = static_cast<int>(observed_.recordings.size()) - 1;
    observed_.samples.push_back(sample);
    SamplePart part;
    part.taken_in = Eigen::Vector2d(first_m, second_m);
    parts_.push_back({part});
  }
  void Add(double first_m, double second_m) { Add(first_m, second_m, Eigen::Matrix3d::Identity()); }

  static Eigen::VectorXd ShapeAt_m(double first_m, double stiffness) {
    const double bend_m = first_m / stiffness;
    Eigen::VectorXd nodes_m = Eigen::VectorXd::Zero(6);  // of which the first is held
    nodes_m.tail<3>() << 1.0 - 3.0 * bend_m * bend_m, bend_m, 0.1 * std::sin(20.0 * bend_m);
    return nodes_m;
  }

  static SimulatedSample Balanced(double first_m, double stiffness) {
    SimulatedSample sample;
    sample.middle.state.x_m = ShapeAt_m(first_m, stiffness);
    return sample;
  }

  ObservedExperiment observed_;
  std::vector<std::vector<SamplePart>> parts_;
};

TEST_F(StartShapesTest, OfNoShapesThereIsNoStart) {
  Add(0.0, 0.0);
  const DriveDistance distance(observed_, parts_);
  const StartShapes starts(distance);
  HeldShape shape;
  EXPECT_FALSE(starts.Begin(0, std::vector<SimulatedSample>(1), &shape));
  shape.state.x_m = Eigen::VectorXd::Ones(6);
  EXPECT_FALSE(starts.Begin(0, std::vector<SimulatedSample>(1), &shape));
  EXPECT_TRUE(shape.state.x_m.isOnes(0.0));
}

/// Actuators count by their ranges, a tilt of the base as much as the half of one. What is not
/// driven is at zero.
TEST_F(StartShapesTest, IsThatOfTheNearestDrive) {
  Add(0.0, 0.0);
  Add(0.01, 0.0);
  Add(0.0, 2.0);
  Add(0.0, 0.0, Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()).toRotationMatrix());
  Add(0.006, std::numeric_limits<double>::quiet_NaN());
  Add(0.0, 1.2);
  const DriveDistance distance(observed_, parts_);
  std::vector<SimulatedSample> samples(6);
  StartShapes starts(distance);
  for (std::size_t s = 0; s < 4; ++s) {
    samples[s] = Balanced(static_cast<double>(s), 1.0);
    starts.Learn(s, {}, samples[s].middle);
  }
  HeldShape shape;
  ASSERT_TRUE(starts.Begin(4, samples, &shape));
  EXPECT_EQ(shape.state.x_m, samples[1].middle.state.x_m);
  shape.state.x_m.resize(0);
  ASSERT_TRUE(starts.Begin(5, samples, &shape));
  EXPECT_EQ(shape.state.x_m, samples[2].middle.state.x_m);
}

TEST_F(StartShapesTest, IsTheUndeformedBodyWhereThatIsNearer) {
  Add(0.0, 0.0);
  Add(0.01, 0.0);
  Add(0.0, 2.0);
  const DriveDistance distance(observed_, parts_);
  std::vector<SimulatedSample> samples(3);
  samples[1] = Balanced(0.01, 1.0);
  StartShapes starts(distance);
  starts.Learn(1, {}, samples[1].middle);
  HeldShape shape;
  EXPECT_FALSE(starts.Begin(2, samples, &shape));
  EXPECT_EQ(shape.state.x_m.size(), 0);
}

/// Two ways from where nothing is driven, each sample after one that is near.
TEST_F(StartShapesTest, AreOfSamplesFromNearToFar) {
  for (const auto& [first_m, second_m] : std::vector<std::pair<double, double>>{{0.01, 0.0},
                                                                                {0.0, 2.0},
                                                                                {0.006, 0.0},
                                                                                {0.0, 1.1},
                                                                                {0.003, 0.0},
                                                                                {0.0, 0.0},
                                                                                {0.003, 0.0}})
    Add(first_m, second_m);
  const DriveDistance distance(observed_, parts_);
  EXPECT_EQ(distance.FromNearToFar({0, 1, 2, 3, 4, 5, 6}),
            (std::vector<std::size_t>{5, 4, 6, 2, 0, 3, 1}));
  EXPECT_EQ(distance.FromNearToFar({1, 3}), (std::vector<std::size_t>{3, 1}));
  EXPECT_TRUE(distance.FromNearToFar({}).empty());
}

/// A body that is 10 % stiffer than the one that was simulated before.
TEST_F(StartShapesTest, MovesAsTheOthersMoved) {
  constexpr double kStiffer = 1.1;
  std::vector<double> drive_m;
  for (int k = 0; k <= 10; ++k) drive_m.push_back(0.01 * k);
  drive_m.push_back(0.045);
  for (const double first_m : drive_m) Add(first_m, 0.0);
  const DriveDistance distance(observed_, parts_);
  StartShapes starts(distance);
  const std::size_t last = drive_m.size() - 1;
  for (std::size_t s = 0; s < last; ++s)
    starts.Learn(s, Balanced(drive_m[s], 1.0).middle, Balanced(drive_m[s], kStiffer).middle);
  HeldShape shape = Balanced(drive_m[last], 1.0).middle;
  ASSERT_TRUE(starts.Begin(last, {}, &shape));
  const Eigen::VectorXd truth_m = ShapeAt_m(drive_m[last], kStiffer);
  const double change_m = (truth_m - ShapeAt_m(drive_m[last], 1.0)).norm();
  EXPECT_LT((shape.state.x_m - truth_m).norm(), 0.02 * change_m);
}

/// A command that is held: what its samples differ by beside the drive, they keep.
TEST_F(StartShapesTest, MovesAsTheSampleOfTheSameDrive) {
  for (const double first_m : {0.0, 0.05, 0.1, 0.05}) Add(first_m, 0.0);
  const DriveDistance distance(observed_, parts_);
  StartShapes starts(distance);
  SimulatedSample was = Balanced(0.05, 1.0);
  SimulatedSample now = Balanced(0.05, 1.1);
  was.middle.state.multipliers_N = Eigen::VectorXd::Constant(1, 2.0);
  now.middle.state.multipliers_N = Eigen::VectorXd::Constant(1, 2.5);
  for (const double first_m : {0.0, 0.1})
    starts.Learn(first_m > 0.0 ? 2 : 0, Balanced(first_m, 1.0).middle,
                 Balanced(first_m, 1.1).middle);
  starts.Learn(1, was.middle, now.middle);
  HeldShape shape = was.middle;
  shape.state.x_m[4] += 0.01;
  ASSERT_TRUE(starts.Begin(3, {}, &shape));
  Eigen::VectorXd expected_m = now.middle.state.x_m;
  expected_m[4] += 0.01;
  EXPECT_LT((shape.state.x_m - expected_m).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_DOUBLE_EQ(shape.state.multipliers_N[0], 2.5);
  // A cable that becomes slack is noticed by that.
  shape = was.middle;
  shape.state.multipliers_N[0] = 0.0;
  ASSERT_TRUE(starts.Begin(3, {}, &shape));
  EXPECT_EQ(shape.state.multipliers_N[0], 0.0);
}

/// Differences of robots that hardly differ would hold two errors of the balance instead of none.
TEST_F(StartShapesTest, StaysWhereOthersHardlyMoved) {
  Add(0.05, 0.0);
  Add(0.06, 0.0);
  const DriveDistance distance(observed_, parts_);
  StartShapes starts(distance);
  starts.Learn(0, Balanced(0.05, 1.0).middle, Balanced(0.05, 1.001).middle);
  HeldShape shape = Balanced(0.06, 1.0).middle;
  EXPECT_FALSE(starts.Begin(1, {}, &shape));
  EXPECT_EQ(shape.state.x_m, ShapeAt_m(0.06, 1.0));
}

}  // namespace
}  // namespace palpate::diagnosis
