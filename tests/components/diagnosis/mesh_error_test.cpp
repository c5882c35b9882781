// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/mesh_error.hpp"

#include <gtest/gtest.h>

#include "components/diagnosis/forward/simulator.hpp"
#include "tests/components/diagnosis/small_robot.hpp"

namespace palpate::diagnosis {
namespace {

class MeshErrorTest : public testing::Test {
 protected:
  struct Pulled {
    Simulation simulated;
    Simulation on_finer;
  };

  /// One cable after the other, each in a recording of its own.
  Pulled PulledBy(const std::vector<std::vector<double>>& commands) const {
    experiment::Experiment experiment;
    experiment.markers_sigma_m = Eigen::Vector3d::Constant(3e-4);
    for (std::size_t k = 0; k < commands.size(); ++k) {
      const double begin_s = 10.0 * static_cast<double>(k);
      experiment.recordings.push_back(
          MakeRecording("r" + std::to_string(k), body_,
                        {{begin_s, commands[k]}, {begin_s + 1.0, commands[k]}}, 0.5));
    }
    const ObservedExperiment observed = Observe(experiment, body_, {});
    const Simulator simulator(observed, 1);
    return {simulator.Run(NominalHypothesis(body_, observed)),
            simulator.Run(NominalHypothesis(finer_, observed))};
  }

  std::optional<MeshError> Compared(const Pulled& pulled) const {
    return CompareMeshes(body_, pulled.simulated, finer_, pulled.on_finer);
  }

  /// Of the squared error at the nodes in a sample of `pulled`, what `error` does not tell.
  double NotTold(const MeshError& error, const Pulled& pulled, std::size_t sample) const {
    const Eigen::VectorXd& x_m = pulled.simulated.samples[sample].middle.state.x_m;
    const Eigen::VectorXd off_m =
        pulled.on_finer.samples[sample].middle.state.x_m.head(x_m.size()) - x_m;
    const Eigen::VectorXd told_m =
        error.of_nodes * error.BendIn(x_m - body_.mesh.nodes_m.reshaped());
    return (off_m - told_m).squaredNorm() / off_m.squaredNorm();
  }

  const robot::RobotBody body_ = SmallRobot();
  const robot::RobotBody finer_ = SmallRobotOnFinerMesh();
  const std::vector<std::vector<double>> each_ = {
      {0.0, 0.0, 0.0}, {0.004, 0.0, 0.0}, {0.0, 0.004, 0.0}, {0.0, 0.0, 0.004}};
};

TEST_F(MeshErrorTest, TellsWhatCoarseCellsErrByInTheMotionsItWasFoundFrom) {
  const Pulled pulled = PulledBy(each_);
  const auto error = Compared(pulled);
  ASSERT_TRUE(error);
  EXPECT_GT(error->relative, 0.02);  // linear elements, two across the beam
  EXPECT_LT(error->share_beyond_shapes, 1e-3);
  for (std::size_t s = 0; s < pulled.simulated.samples.size(); ++s) {
    EXPECT_LT(NotTold(*error, pulled, s), 0.01) << s;
    const Eigen::VectorXd& x_m = pulled.simulated.samples[s].middle.state.x_m;
    const Eigen::VectorXd bend = error->BendIn(x_m - body_.mesh.nodes_m.reshaped());
    const Eigen::VectorXd farther_m = error->of_markers * bend;
    const Eigen::Matrix3Xd off_m =
        pulled.on_finer.samples[s].markers_m() - pulled.simulated.samples[s].markers_m();
    EXPECT_LT((farther_m - off_m.reshaped()).norm(), 0.1 * off_m.norm()) << s;
  }
}

/// Far enough to separate the mesh error from other faults; the finer mesh gives its exact effect.
TEST_F(MeshErrorTest, TellsMostOfItForOtherPullsOfTheSameCables) {
  std::vector<std::vector<double>> pulls = each_;
  for (const std::vector<double>& pull : each_) {
    pulls.push_back({0.5 * pull[0], 0.5 * pull[1], 0.5 * pull[2]});
  }
  const auto error = Compared(PulledBy(pulls));
  ASSERT_TRUE(error);
  const Pulled others = PulledBy({{0.002, 0.003, 0.0}, {0.0, 0.001, 0.003}, {0.003, 0.0, 0.002}});
  for (std::size_t s = 0; s < others.simulated.samples.size(); ++s) {
    EXPECT_LT(NotTold(*error, others, s), 0.5) << s;
  }
}

TEST_F(MeshErrorTest, LeavesOutWhatFailedOnEitherMesh) {
  Pulled pulled = PulledBy(each_);
  pulled.on_finer.samples.front().status = {StatusCode::kNotConverged, "made up"};
  pulled.on_finer.samples.front().middle.state.x_m.resize(0);
  ASSERT_TRUE(Compared(pulled));
  for (SimulatedSample& sample : pulled.simulated.samples) {
    sample.status = {StatusCode::kNotConverged, "made up"};
  }
  EXPECT_FALSE(Compared(pulled));
}

/// A mass that the nodes share is another on more of them.
TEST_F(MeshErrorTest, ComparesNoMeshesOfOtherBodies) {
  robot::RobotDescription robot;
  robot.element = fem::ElementType::kTet4;
  robot.mass.distribution = robot::MassDistribution::kPerNode;
  EXPECT_EQ(CompareWithFinerMesh(robot, body_, {}, {}, 1), nullptr);
}

}  // namespace
}  // namespace palpate::diagnosis
