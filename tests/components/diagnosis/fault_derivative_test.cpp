// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <optional>
#include <set>

#include "tests/components/diagnosis/fault_derivatives.hpp"

namespace palpate::diagnosis {
namespace {

/// The last cable is driven by its tension.
experiment::Experiment WithATension(experiment::Experiment experiment) {
  constexpr double kPerMetre_N = 100.0;
  for (experiment::Recording& recording : experiment.recordings) {
    experiment::ActuatorColumn& last = recording.actuation->columns.back();
    last.quantity = experiment::ActuatorQuantity::kTension;
    for (std::optional<double>& sample : last.samples) sample = kPerMetre_N * sample.value();
  }
  return experiment;
}

/// Another fault, which says by a share too much what it does to the body.
class SaysTooMuch final : public FaultModel {
 public:
  SaysTooMuch(const FaultModel& right, double share)
      : FaultModel(right.name(), right.words(), right.parameters()), right_(right), share_(share) {}
  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    right_.Apply(z, hypothesis);
  }
  robot::ParameterPtr OnBody(int parameter, const Eigen::VectorXd& z,
                             const FaultContext& at) const override {
    robot::ParameterPtr said = right_.OnBody(parameter, z, at);
    return said == nullptr ? nullptr : Scaled(1.0 + share_, std::move(said));
  }

 private:
  const FaultModel& right_;
  double share_;
};

class CauseDerivativesOfTet10AndTension : public FaultDerivatives {
 protected:
  CauseDerivativesOfTet10AndTension()
      : FaultDerivatives(SmallRobot(fem::ElementType::kTet10),
                         WithATension(SmallExperiment(SmallRobot(fem::ElementType::kTet10)))) {}
};

TEST_F(FaultDerivatives, AreThoseOfApplyWhereTheRobotIsAsItsFileHasIt) {
  ExpectDerivativesAsBuilt();
}

TEST_F(CauseDerivativesOfTet10AndTension, AreThoseOfApplyWhereTheRobotIsAsItsFileHasIt) {
  ExpectDerivativesAsBuilt();
}

/// Proof that these tests can fail.
TEST_F(FaultDerivatives, AreCaughtWhereTheySayALittleTooMuch) {
  constexpr double kTooMuch = 0.01;
  constexpr double kTolerance = 2e-3;
  for (const std::string id : {"youngs_modulus", "regional_stiffness", "density", "geometry_scale",
                               "rest_twist", "payload", "permanent_force", "plastic_set"}) {
    const auto right =
        std::find_if(causes_.begin(), causes_.end(),
                     [&](const FaultModelPtr& cause) { return cause->name().id == id; });
    ASSERT_NE(right, causes_.end()) << id;
    const SaysTooMuch wrong(**right, kTooMuch);
    const FaultModelList one{&wrong};
    const Eigen::VectorXd z = Eigen::VectorXd::Zero(std::ssize(wrong.parameters()));
    const FaultParameter& first = wrong.parameters().front();
    const Mismatch worst = Compare(first.fault * Analytic(one, z).col(0),
                                   first.fault * Difference(one, z, 0, first), 1e-3);
    EXPECT_GT(worst.relative, kTolerance) << id;
  }
}

TEST_F(FaultDerivatives, AreOfEveryCauseOfTheCatalogue) {
  // chamber_faults_test.cpp
  const std::set<std::string> of_chambers = {"leak",          "slow_valve",    "blocked_valve",
                                             "pressure_gain", "pressure_zero", "swapped_tubes",
                                             "thin_wall"};
  for (const std::string& id : SearchedFaults()) {
    if (of_chambers.contains(id)) continue;
    EXPECT_TRUE(std::any_of(causes_.begin(), causes_.end(), [&](const FaultModelPtr& cause) {
      return cause->name().id == id;
    })) << id;
  }
}

/// What energies answer is left out there: up to twice the softening.
TEST_F(FaultDerivatives, AreThoseOfApplyWhereABodySoftensTooLittleForRuns) {
  const Eigen::Vector2d z(0.015, 0.7);
  constexpr double kAnswer = 0.05;
  for (const FaultModelPtr& cause : causes_) {
    if (cause->name().id != "mullins") continue;
    ASSERT_FALSE(cause->NeedsSimulation(z));
    ExpectDerivative(*cause, z, kAnswer, LeastShare("mullins"));
  }
}

TEST_F(FaultDerivatives, AreThoseOfApplyWhereTheFaultIsThere) {
  constexpr double kShare = 0.31;  // of the fault sigma; no kink of the actuators' play lies there
  constexpr double kTolerance = 2e-3;
  /// What the base turns by when its sample changes is left out: of the order of what the
  /// compliance of this body is changed by, here 0.4 %.
  constexpr double kToleranceOfBase = 1e-2;
  /// Differences over a step, of runs whose pasts are settled so far: of what it does as a whole.
  constexpr double kToleranceOfRuns = 0.08;
  for (const FaultModelPtr& cause : causes_) {
    const std::string& id = cause->name().id;
    Eigen::VectorXd z(std::ssize(cause->parameters()));
    for (Eigen::Index p = 0; p < z.size(); ++p) {
      z[p] = kShare * cause->parameters()[static_cast<std::size_t>(p)].fault;
    }
    if (id == "hidden_obstacle") z[0] = 1.0;
    ExpectDerivative(*cause, z,
                     cause->NeedsSimulation(z) ? kToleranceOfRuns
                     : id == "base_compliance" ? kToleranceOfBase
                                               : kTolerance,
                     cause->NeedsSimulation(z) ? 1.0 : 1e-3);
  }
}

TEST_F(FaultDerivatives, AreThoseOfApplyWhereEndsOfCablesGiveWayLessThanTheMesh) {
  constexpr double kTolerance = 2e-3;
  const auto ends = std::find_if(causes_.begin(), causes_.end(),
                                 [](const auto& one) { return one->name().id == "cable_ends"; });
  ASSERT_NE(ends, causes_.end());
  ExpectDerivative(**ends, Eigen::VectorXd::Constant(1, -1.5), kTolerance);
}

TEST_F(FaultDerivatives, AreThoseOfApplyWhereAllOfARobotIsALittleOff) {
  FaultModelList all;
  for (const FaultModelPtr& cause : causes_) {
    const std::string& id = cause->name().id;
    if (id != "stiffening" && id != "hidden_obstacle") all.push_back(cause.get());
  }
  const auto parameter_of = [&](const FaultModel& cause, Eigen::Index p) {
    return cause.parameters()[static_cast<std::size_t>(p)];
  };
  // Faults that bend the undeformed body are differentiated as if alone, and an actuator's play and
  // lag have kinks at single frames: per cents of per cents of the shape, and one frame in fifty.
  constexpr double kTolerance = 0.03;
  Eigen::VectorXd z(ParameterCount(all));
  Eigen::Index first = 0;
  for (const FaultModel* cause : all) {
    for (Eigen::Index p = 0; p < std::ssize(cause->parameters()); ++p) {
      // What creep's past adds to the others' derivatives is left out: of the order of g.
      const bool creeps = cause->name().id == "viscoelastic_creep";
      z[first++] = creeps ? 0.0 : parameter_of(*cause, p).tolerance;
    }
  }
  const Eigen::MatrixXd analytic = Analytic(all, z);
  first = 0;
  for (const FaultModel* cause : all) {
    for (Eigen::Index p = 0; p < std::ssize(cause->parameters()); ++p, ++first) {
      const FaultParameter parameter = parameter_of(*cause, p);
      ExpectAlike(parameter.fault * analytic.col(first),
                  parameter.fault * Difference(all, z, first, parameter), kTolerance,
                  cause->words() + ", " + parameter.name, LeastShare(cause->name().id));
    }
  }
}

TEST_F(FaultDerivatives, AreThoseOfApplyBehindACameraThatMeasuresWrongly) {
  // Five fault sigmas: what a camera makes of a motion then is 5 to 10 % off. The bias of surfaces
  // seen askew stays 0: by what the body's surface turns is left out.
  constexpr double kSigmas = 5.0;
  constexpr double kTolerance = 2e-3;
  const std::vector<std::string> with_error = {"depth_scale", "intrinsics", "lens_distortion",
                                               "warm_up_drift"};
  const std::vector<std::string> behind = {"density", "extrinsics", "camera_moved",
                                           "marker_misplacement", "depth_incidence_bias"};
  const auto is_one_of = [](const FaultModel& cause, const std::vector<std::string>& ids) {
    return std::find(ids.begin(), ids.end(), cause.name().id) != ids.end();
  };
  FaultModelList both;
  std::vector<double> z;
  for (const FaultModelPtr& cause : causes_) {
    const bool errs = is_one_of(*cause, with_error);
    if (!errs && !is_one_of(*cause, behind)) continue;
    both.push_back(cause.get());
    for (const FaultParameter& parameter : cause->parameters()) {
      z.push_back(errs && parameter.name != "tau_s" ? kSigmas * parameter.fault : 0.0);
    }
  }
  const Eigen::VectorXd at = Eigen::Map<Eigen::VectorXd>(z.data(), std::ssize(z));
  const Eigen::MatrixXd analytic = Analytic(both, at);
  Eigen::Index column = 0;
  for (const FaultModel* cause : both) {
    for (const FaultParameter& parameter : cause->parameters()) {
      ExpectAlike(parameter.fault * analytic.col(column),
                  parameter.fault * Difference(both, at, column, parameter), kTolerance,
                  cause->words() + ", " + parameter.name);
      ++column;
    }
  }
}

/// Every recording begins with the body held undeformed, and its markers count from there.
experiment::Experiment OfDisplacements(experiment::Experiment experiment) {
  for (experiment::Recording& recording : experiment.recordings) {
    const double begin_s = recording.markers->frames.front().t_s;
    recording.reference = experiment::Reference{{begin_s, begin_s + 0.5}};
  }
  return experiment;
}

class FaultDerivativesOfDisplacements : public FaultDerivatives {
 protected:
  FaultDerivativesOfDisplacements()
      : FaultDerivatives(SmallRobot(), OfDisplacements(SmallExperiment(SmallRobot()))) {}
};

TEST_F(FaultDerivativesOfDisplacements, AreThoseOfApplyWhereTheCameraIsElsewhere) {
  constexpr double kTolerance = 2e-3;
  constexpr double kShare = 0.31;
  for (const FaultModelPtr& cause : causes_) {
    if (cause->name().id != "extrinsics" && cause->name().id != "camera_moved") continue;
    Eigen::VectorXd z(std::ssize(cause->parameters()));
    for (Eigen::Index p = 0; p < z.size(); ++p) {
      z[p] = kShare * cause->parameters()[static_cast<std::size_t>(p)].fault;
    }
    ExpectDerivative(*cause, z, kTolerance);
  }
}

/// A pose that is off by a translation shifts the shape that the body was held in as well.
TEST_F(FaultDerivativesOfDisplacements, DoNotChangeByATranslationOfTheCamera) {
  int poses = 0;
  for (const FaultModelPtr& cause : causes_) {
    if (cause->name().id != "extrinsics" && cause->name().id != "camera_moved") continue;
    ++poses;
    Eigen::VectorXd z = Eigen::VectorXd::Zero(6);
    z.head<3>() << 0.004, -0.003, 0.002;
    const FaultModelList one{cause.get()};
    const Eigen::VectorXd as_given_m = Markers(one, Eigen::VectorXd::Zero(6));
    EXPECT_LT((Markers(one, z) - as_given_m).cwiseAbs().maxCoeff(), 1e-12) << cause->words();
    EXPECT_EQ(Analytic(one, z).leftCols(3).cwiseAbs().maxCoeff(), 0.0) << cause->words();
    z.tail<3>() << 0.0, 0.02, 0.0;
    EXPECT_GT((Markers(one, z) - as_given_m).cwiseAbs().maxCoeff(), 1e-5) << cause->words();
  }
  EXPECT_GE(poses, 2);
}

TEST_F(FaultDerivatives, OfStiffeningAreThoseOfABodyOfAnotherModulus) {
  FaultModelList two;
  for (const FaultModelPtr& cause : causes_) {
    const std::string& id = cause->name().id;
    if (id == "youngs_modulus" || id == "stiffening") two.push_back(cause.get());
  }
  ASSERT_EQ(two.size(), 2U);
  const Eigen::VectorXd z = Eigen::Vector2d(0.4, 0.5);
  const Eigen::MatrixXd analytic = Analytic(two, z);
  for (Eigen::Index p = 0; p < 2; ++p) {
    const FaultModel& cause = *two[static_cast<std::size_t>(p)];
    ExpectAlike(analytic.col(p), Difference(two, z, p, cause.parameters()[0]), 2e-3, cause.words());
  }
}

TEST_F(FaultDerivatives, AreOfTheMeanOverASampleInWhichACableGetsTaut) {
  // The middle alone is 12 % off for the modulus in the ramp, and 26 % in the tilted recording.
  constexpr double kTolerance = 0.04;
  const ObservedExperiment means = Observe(SmallExperiment(body_), body_, {.most_samples = 14});
  const Simulator simulator(means, 1);
  for (const FaultModelPtr& cause : causes_) {
    const CauseName& name = cause->name();
    if (name.id != "youngs_modulus" && name.id != "cable_gain" && name.id != "density") continue;
    const FaultModelList one{cause.get()};
    const auto markers_m = [&](double z, bool differentiate) {
      const ModelHypothesis hypothesis =
          HypothesisWith(nominal_, one, Eigen::VectorXd::Constant(1, z));
      Simulation run = simulator.Run(hypothesis, nullptr);
      if (differentiate) {
        simulator.Differentiate(hypothesis, one, Eigen::VectorXd::Constant(1, z), {true}, nominal_,
                                &run);
      }
      Eigen::VectorXd all(each_ * std::ssize(run.samples));
      for (Eigen::Index s = 0; s < std::ssize(run.samples); ++s) {
        const SimulatedSample& sample = run.samples[static_cast<std::size_t>(s)];
        all.segment(each_ * s, each_) =
            differentiate ? Eigen::VectorXd(sample.jacobian_m) : sample.seen_m;
      }
      return all;
    };
    const double h = kStep * cause->parameters()[0].fault;
    const Eigen::VectorXd difference = (markers_m(h, false) - markers_m(-h, false)) / (2.0 * h);
    const Eigen::VectorXd analytic = markers_m(0.0, true);
    ExpectAlike(cause->parameters()[0].fault * analytic, cause->parameters()[0].fault * difference,
                kTolerance, cause->words());
  }
}

TEST_F(FaultDerivatives, AndSimulationsDoNotDependOnWhereTheyStart) {
  // A cable that yields keeps where it was; the others must follow their actuators all the same.
  const auto find = [&](const std::string& id, const std::string& where) -> const FaultModel* {
    for (const FaultModelPtr& cause : causes_) {
      if (cause->name().id == id && cause->name().where.front() == where) return cause.get();
    }
    return nullptr;
  };
  const FaultModelList causes{find("cable_elasticity", "cable:up"),
                              find("cable_offset", "cable:aside")};
  ASSERT_NE(causes[0], nullptr);
  ASSERT_NE(causes[1], nullptr);
  const ModelHypothesis before = HypothesisWith(nominal_, causes, Eigen::Vector2d(1e-3, -5e-4));
  const ModelHypothesis after = HypothesisWith(nominal_, causes, Eigen::Vector2d(2e-3, 1e-3));
  const Simulation start = simulator_.Run(before);
  const Simulation cold = simulator_.Run(after);
  const Simulation warm = simulator_.Run(after, &start);
  ASSERT_TRUE(cold.status.ok() && warm.status.ok());
  for (std::size_t s = 0; s < cold.samples.size(); ++s) {
    EXPECT_LT((cold.samples[s].markers_m() - warm.samples[s].markers_m()).cwiseAbs().maxCoeff(),
              1e-7)
        << "sample " << s;
  }
}

}  // namespace
}  // namespace palpate::diagnosis
