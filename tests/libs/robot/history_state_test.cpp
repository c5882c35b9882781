// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/history_state.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tests/libs/robot/beam_model.hpp"

namespace palpate::robot {
namespace {

/// History variables in frames that follow each other.
class HistoryStateTest : public BeamModelTest {
 protected:
  /// The beam with these keys in its first cable, north, and in its material.
  std::unique_ptr<RobotModel> With(const std::string& cable, const std::string& material = "") {
    std::string text = FullRobotText();
    const auto add_behind = [&](const std::string& key, const std::string& more) {
      text.insert(text.find(key) + key.size(), more);
    };
    add_behind("max_tension_N: 20", cable);
    const std::string modulus_of_tip = ", youngs_modulus_Pa: 30e3";
    text.erase(text.find(modulus_of_tip), modulus_of_tip.size());
    add_behind("poissons_ratio: 0.45", material);
    return Build(text);
  }

  /// The equilibrium of a frame, committed.
  fem::StaticState Follow(double t_s, double displacement_m, RobotModel* model,
                          HistoryState* history) {
    std::vector<ActuatorCommand> commands(static_cast<std::size_t>(model->ActuatorCount()));
    commands[0] = Displace(displacement_m);
    const std::vector<ActuatorCommand> reached = history->Prepare(t_s, commands);
    EXPECT_TRUE(model->Solve(reached, {}, &state_).status.ok());
    history->Commit(state_.x_m, state_.multipliers_N);
    return state_;
  }

  /// By which the model's cells and history load a body at `x_m` [3n].
  static Eigen::VectorXd Resistance_N(RobotModel& model, const Eigen::VectorXd& x_m) {
    Eigen::VectorXd force_N = Eigen::VectorXd::Zero(x_m.size());
    model.elastic_body().AddForces(x_m, force_N);
    Eigen::VectorXd dead_N = Eigen::VectorXd::Zero(x_m.size());
    model.AddWeight(dead_N);
    return force_N - dead_N;
  }

  fem::StaticState state_;
};

TEST_F(HistoryStateTest, LeavesARobotWithoutThemAsItIs) {
  const auto model = With("");
  HistoryState history(*model);
  EXPECT_FALSE(history.active());
  const std::vector<ActuatorCommand> commands = {Displace(0.003), Pull(1.0)};
  for (const double t_s : {0.0, 0.1, 5.0}) EXPECT_EQ(history.Prepare(t_s, commands), commands);
  EXPECT_EQ(model->cable(0).friction().Sliding(0), 1.0);
}

TEST_F(HistoryStateTest, PlayFollowsTheCommandsAtAnySpeed) {
  const auto model = With(", play_m: 0.002");
  for (const double step_s : {0.01, 1.0}) {
    HistoryState history(*model);
    double t_s = 0.0;
    const auto reached = [&](double displacement_m) {
      t_s += step_s;
      return history.Prepare(t_s, {Displace(displacement_m), {}})[0].value;
    };
    EXPECT_EQ(reached(0.004), 0.004);            // in the middle
    EXPECT_NEAR(reached(0.0045), 0.004, 1e-15);  // within the play
    EXPECT_NEAR(reached(0.008), 0.007, 1e-15);   // pulls half the play behind
    EXPECT_NEAR(reached(0.0065), 0.007, 1e-15);  // let out by less than the play
    EXPECT_NEAR(reached(0.002), 0.003, 1e-15);   // lets out half the play behind
    EXPECT_NEAR(reached(0.003999), 0.003, 1e-15);
    history.Restart();
    EXPECT_EQ(reached(0.001), 0.001);
  }
}

TEST_F(HistoryStateTest, PlayIsOfDisplacementsOnly) {
  const auto model = With(", play_m: 0.002");
  HistoryState history(*model);
  for (const double tension_N : {1.0, 1.5, 0.5}) {
    EXPECT_EQ(history.Prepare(tension_N, {Pull(tension_N), {}})[0], Pull(tension_N));
  }
}

/// A held body resists with (1 + g exp(-t / tau)) times its elastic forces after a step.
TEST_F(HistoryStateTest, CreepRelaxesWithItsTime) {
  const auto model = With("", ", creep: [{share: 0.3, time_s: 2}]");
  model->SetGravity(Eigen::Vector3d::Zero());
  const Eigen::VectorXd rest_m = model->RestState().x_m;
  Eigen::VectorXd bent_m = rest_m;
  for (Eigen::Index n = 0; n < bent_m.size() / 3; ++n) {
    bent_m[3 * n + 2] += 2.0 * std::pow(rest_m[3 * n + 1], 2.0);
  }
  const Eigen::VectorXd elastic_N = Resistance_N(*model, bent_m);
  HistoryState history(*model);
  const std::vector<ActuatorCommand> off(2);
  const Eigen::VectorXd slack_N = Eigen::VectorXd::Zero(2);
  const auto commit = [&](double t_s, const Eigen::VectorXd& x_m) {
    history.Prepare(t_s, off);
    history.Commit(x_m, slack_N);
  };
  commit(0.0, rest_m);
  commit(1e-6, bent_m);
  // Steps of any length, also where frames are missing.
  for (const double t_s : {0.1, 0.2, 0.5, 1.0, 3.0, 3.1, 10.0}) {
    history.Prepare(t_s, off);
    const double factor = 1.0 + 0.3 * std::exp(-t_s / 2.0);
    EXPECT_LT((Resistance_N(*model, bent_m) - factor * elastic_N).norm(), 1e-5 * elastic_N.norm())
        << t_s;
    history.Commit(bent_m, slack_N);
  }
  history.Restart();
  EXPECT_EQ(Resistance_N(*model, bent_m), elastic_N);
}

/// Ogden and Roxburgh's law in a cell whose energy density has fallen.
TEST_F(HistoryStateTest, SoftensBelowTheLargestStrain) {
  const auto model = With("", ", softening: {r: 2, m_J_m3: 20}");
  model->SetGravity(Eigen::Vector3d::Zero());
  const Eigen::VectorXd rest_m = model->RestState().x_m;
  const auto stretched_m = [&](double by) {
    Eigen::VectorXd x_m = rest_m;
    for (Eigen::Index n = 0; n < x_m.size() / 3; ++n) x_m[3 * n + 1] *= 1.0 + by;
    return x_m;
  };
  const auto density_J_m3 = [&](double by) {
    Eigen::VectorXd energy_J;
    model->elastic_body().CellEnergies(stretched_m(by), &energy_J);
    return energy_J[0] / fem::CellVolumes_m3(model->body().mesh)[0];
  };
  const double largest_J_m3 = density_J_m3(0.05);
  const double now_J_m3 = density_J_m3(0.03);
  const Eigen::VectorXd virgin_N = Resistance_N(*model, stretched_m(0.03));
  HistoryState history(*model);
  const std::vector<ActuatorCommand> off(2);
  for (int frame = 0; frame < 40; ++frame) {
    history.Prepare(0.1 * frame, off);
    history.Commit(stretched_m(frame < 20 ? 0.05 : 0.03), Eigen::VectorXd::Zero(2));
  }
  history.Prepare(4.0, off);
  // The energy of a body stretched alike is the same in every cell of one material, and so is eta.
  const double eta = 1.0 - std::erf((largest_J_m3 - now_J_m3) / 20.0) / 2.0;
  ASSERT_LT(eta, 0.9);
  EXPECT_LT((Resistance_N(*model, stretched_m(0.03)) - eta * virgin_N).norm(),
            1e-4 * virgin_N.norm());
}

/// The actuator pulls harder than without friction while it takes the cable in, and less hard at
/// the same length while it lets it out.
TEST_F(HistoryStateTest, FrictionMakesAHysteresis) {
  const auto tensions_N = [&](const std::string& friction) {
    const auto model = With(friction);
    HistoryState history(*model);
    state_ = model->RestState();
    std::vector<double> tension_N;
    for (int frame = 0; frame <= 15; ++frame) {
      const double displacement_m = 4e-4 * (frame <= 10 ? frame : 20 - frame);
      const fem::StaticState state = Follow(0.1 * frame, displacement_m, model.get(), &history);
      if (frame == 5 || frame == 15) tension_N.push_back(state.multipliers_N[0]);
    }
    return tension_N;
  };
  const std::vector<double> smooth_N = tensions_N("");
  const std::vector<double> rough_N = tensions_N(", friction_coefficient: 0.2");
  EXPECT_NEAR(smooth_N[1], smooth_N[0], 1e-4 * smooth_N[0]);
  EXPECT_GT(rough_N[0], 1.001 * smooth_N[0]);
  EXPECT_LT(rough_N[1], 0.999 * smooth_N[1]);
}

/// Work of the actuator in a closed cycle of the command, and the largest on the way, J.
struct Cycle {
  double work_J = 0.0;
  double most_J = 0.0;
};

/// Friction, creep and softening lose energy in a cycle, and never give any.
TEST_F(HistoryStateTest, LosesEnergyInAClosedCycle) {
  const auto cycle = [&](const std::string& cable, const std::string& material) {
    const auto model = With(cable, material);
    model->SetGravity(Eigen::Vector3d::Zero());
    HistoryState history(*model);
    state_ = model->RestState();
    Cycle of;
    double tension_N = Follow(0.0, 0.0, model.get(), &history).multipliers_N[0];
    double displacement_m = 0.0;
    for (int frame = 1; frame <= 40; ++frame) {
      const double next_m = 2e-4 * (frame <= 20 ? frame : 40 - frame);
      const double next_N = Follow(0.05 * frame, next_m, model.get(), &history).multipliers_N[0];
      of.work_J += 0.5 * (tension_N + next_N) * (next_m - displacement_m);
      of.most_J = std::max(of.most_J, of.work_J);
      tension_N = next_N;
      displacement_m = next_m;
    }
    return of;
  };
  const Cycle elastic = cycle("", "");
  EXPECT_NEAR(elastic.work_J, 0.0, 1e-4 * elastic.most_J);
  EXPECT_GT(cycle(", friction_coefficient: 0.3", "").work_J, 1e-3 * elastic.most_J);
  EXPECT_GT(cycle("", ", creep: [{share: 0.3, time_s: 1}]").work_J, 1e-3 * elastic.most_J);
  EXPECT_GT(cycle("", ", softening: {r: 2, m_J_m3: 20}").work_J, 1e-3 * elastic.most_J);
}

/// The equilibrium of a command that is held tends to that of a robot that does not creep.
TEST_F(HistoryStateTest, CreepRelaxesToItsLongTimeValue) {
  const auto tensions_N = [&](const std::string& material) {
    const auto model = With("", material);
    model->SetGravity(Eigen::Vector3d::Zero());
    HistoryState history(*model);
    state_ = model->RestState();
    double at_once_N = 0.0;
    for (int frame = 0; frame <= 20; ++frame) {
      at_once_N = Follow(1e-3 * frame, 2e-4 * frame, model.get(), &history).multipliers_N[0];
    }
    double later_N = at_once_N;
    for (int frame = 1; frame <= 30; ++frame)
      later_N = Follow(1.0 * frame, 0.004, model.get(), &history).multipliers_N[0];
    return std::pair{at_once_N, later_N};
  };
  const auto [elastic_N, held_N] = tensions_N("");
  EXPECT_NEAR(held_N, elastic_N, 1e-6 * elastic_N);
  const auto [at_once_N, relaxed_N] = tensions_N(", creep: [{share: 0.3, time_s: 2}]");
  EXPECT_GT(at_once_N, 1.2 * elastic_N);
  EXPECT_NEAR(relaxed_N, elastic_N, 1e-3 * elastic_N);
}

/// A frame that is solved again about its own shape comes to rest.
TEST_F(HistoryStateTest, CorrectionsSettle) {
  constexpr int kMostRounds = 12;
  const auto model = With(", friction_coefficient: 0.3",
                          ", creep: [{share: 0.3, time_s: 1}], softening: {r: 3, m_J_m3: 50}");
  model->SetGravity(Eigen::Vector3d::Zero());
  HistoryState history(*model);
  state_ = model->RestState();
  std::vector<ActuatorCommand> commands(2);
  int corrected = 0;
  for (int frame = 0; frame <= 24; ++frame) {
    commands[0] = Displace(2e-4 * (frame <= 12 ? frame : 24 - frame));
    const std::vector<ActuatorCommand> reached = history.Prepare(0.1 * frame, commands);
    int round = 0;
    do {
      ASSERT_TRUE(model->Solve(reached, {}, &state_).status.ok()) << frame;
      ASSERT_LT(++round, kMostRounds) << frame;
    } while (history.Correct(state_.x_m));
    corrected += round > 1 ? 1 : 0;
    history.Commit(state_.x_m, state_.multipliers_N);
  }
  EXPECT_GT(corrected, 5);
}

/// A sequence begins as soft as the one before it in time has left the material.
TEST_F(HistoryStateTest, SofteningOutlivesASequence) {
  const auto model = With("", ", softening: {r: 2, m_J_m3: 20}");
  model->SetGravity(Eigen::Vector3d::Zero());
  const auto pulled_N = [&](double begin_s, double displacement_m) {
    HistoryState history(*model);
    state_ = model->RestState();
    double tension_N = 0.0;
    for (int frame = 0; frame <= 30; ++frame) {
      const double share = std::min(1.0, 0.05 * frame);
      tension_N = Follow(begin_s + 0.1 * frame, share * displacement_m, model.get(), &history)
                      .multipliers_N[0];
    }
    return tension_N;
  };
  const double virgin_N = pulled_N(0.0, 0.002);
  pulled_N(10.0, 0.004);
  const double softened_N = pulled_N(20.0, 0.002);
  EXPECT_LT(softened_N, 0.97 * virgin_N);
  EXPECT_NEAR(pulled_N(30.0, 0.002), softened_N, 1e-3 * softened_N);
  EXPECT_NEAR(pulled_N(0.0, 0.002), virgin_N, 1e-6 * virgin_N);  // an earlier time: from the start
}

/// Effects that vanish leave the tensions of a robot without them.
TEST_F(HistoryStateTest, VanishingEffectsChangeNothing) {
  const auto tensions_N = [&](const std::string& cable, const std::string& material) {
    const auto model = With(cable, material);
    HistoryState history(*model);
    state_ = model->RestState();
    Eigen::VectorXd tension_N(9);
    for (int frame = 0; frame < 9; ++frame) {
      const double displacement_m = 1e-3 * (frame <= 5 ? frame : 10 - frame);
      tension_N[frame] =
          Follow(0.1 * frame, displacement_m, model.get(), &history).multipliers_N[0];
    }
    return tension_N;
  };
  const Eigen::VectorXd plain_N = tensions_N("", "");
  const double most_N = 1e-6 * plain_N.maxCoeff();
  EXPECT_EQ(tensions_N(", play_m: 0, friction_coefficient: 0", ""), plain_N);
  EXPECT_LT((tensions_N(", play_m: 1e-11", "") - plain_N).cwiseAbs().maxCoeff(), most_N);
  EXPECT_LT((tensions_N(", friction_coefficient: 1e-8", "") - plain_N).cwiseAbs().maxCoeff(),
            most_N);
  EXPECT_LT((tensions_N("", ", creep: [{share: 1e-8, time_s: 1}]") - plain_N).cwiseAbs().maxCoeff(),
            most_N);
  EXPECT_LT((tensions_N("", ", softening: {r: 1e9, m_J_m3: 20}") - plain_N).cwiseAbs().maxCoeff(),
            most_N);
}

TEST_F(HistoryStateTest, EarlierTimesBeginASequence) {
  const auto model = With(", play_m: 0.002");
  HistoryState history(*model);
  history.Prepare(5.0, {Displace(0.004), {}});
  EXPECT_EQ(history.Prepare(1.0, {Displace(0.0045), {}})[0].value, 0.0045);
}

}  // namespace
}  // namespace palpate::robot
