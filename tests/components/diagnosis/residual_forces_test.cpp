// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/residual_forces.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "tests/components/diagnosis/hidden_faults.hpp"

namespace palpate::diagnosis {
namespace {

constexpr double kResidualForce_N = 0.1;
constexpr int kAxis = 1;  ///< sideways, world frame

class ResidualForcesOfOneForce : public HiddenFaults {
 protected:
  /// As it stands where `faults` were named.
  Selection Named(const Fitter& fitter, const std::vector<int>& faults) const {
    Selection selection;
    selection.null_model = fitter.Complete(fitter.AsBuilt());
    selection.best = faults.empty() ? selection.null_model
                                    : fitter.Complete(fitter.Refine(faults, selection.null_model));
    selection.goodness_of_fit.passed = !faults.empty();
    return selection;
  }
  /// The world's axis along which it pushes, in the robot's frame of that recording.
  Eigen::Vector3d Direction(const std::string& recording) const {
    const auto found =
        std::find_if(observed_.recordings.begin(), observed_.recordings.end(),
                     [&](const ObservedRecording& one) { return one.name == recording; });
    return found->base_rotation.transpose().col(kAxis);
  }
};

TEST_F(ResidualForcesOfOneForce, PushTheWayItDoes) {
  Measure({{"permanent_force", "body", kResidualForce_N, kAxis}});
  const Fitter fitter(observed_, body_, hypotheses_, {}, 1);
  const ResidualForces forces = FindResidualForces(observed_, hypotheses_, Named(fitter, {}));
  ASSERT_GT(forces.place_m.cols(), 0);
  ASSERT_EQ(forces.before_N.cols(), forces.place_m.cols());
  const Eigen::Vector3d sum_N = forces.before_N.rowwise().sum();
  const Eigen::Vector3d direction = Direction(forces.recording);
  // Tolerances may have done some of it, and small forces are possible more than large ones.
  EXPECT_GT(sum_N.dot(direction), 0.3 * kResidualForce_N) << "seed " << kSeed;
  // Along the beam hardly anything moves it, and hardly anything is known.
  const Eigen::Vector3d across = direction.cross(Eigen::Vector3d::UnitX());
  EXPECT_GT(sum_N.dot(direction), 1.5 * std::abs(sum_N.dot(across)))
      << sum_N.transpose() << ", seed " << kSeed;
}

TEST_F(ResidualForcesOfOneForce, AreGoneOnceItIsNamed) {
  Measure({});
  const ResidualForces of_noise = FindResidualForces(
      observed_, hypotheses_, Named(Fitter(observed_, body_, hypotheses_, {}, 1), {}));
  Measure({{"permanent_force", "body", kResidualForce_N, kAxis}});
  const Fitter fitter(observed_, body_, hypotheses_, {}, 1);
  const int force = Number("permanent_force", "body");
  const ResidualForces forces = FindResidualForces(observed_, hypotheses_, Named(fitter, {force}));
  const Eigen::Vector3d direction = Direction(forces.recording);
  const double before_N = forces.before_N.rowwise().sum().dot(direction);
  const double after_N = forces.after_N.rowwise().sum().dot(direction);
  EXPECT_LT(std::abs(after_N), 0.2 * before_N) << "seed " << kSeed;
  EXPECT_LT(forces.after_N.norm(), 1.2 * of_noise.after_N.norm()) << "as of a healthy robot";
}

TEST_F(ResidualForcesOfOneForce, AreLookedForInTheRecordingThatLeavesMost) {
  Measure({});
  Sample& sample = observed_.samples[observed_.samples.size() / 2];
  sample.position_m.array() += 20.0 * kSigma_m;
  const Fitter fitter(observed_, body_, hypotheses_, {}, 1);
  const auto recording = static_cast<std::size_t>(sample.recording);
  EXPECT_EQ(FindResidualForces(observed_, hypotheses_, Named(fitter, {})).recording,
            observed_.recordings[recording].name);
}

TEST_F(ResidualForcesOfOneForce, AreNoneWhereForcesAreNotBelievedIn) {
  Measure({});
  const HypothesisSet without(
      MakeFaultModels({.body = body_, .observed = observed_}, {"permanent_force"}), {});
  const Fitter fitter(observed_, body_, without, {}, 1);
  EXPECT_EQ(FindResidualForces(observed_, without, Named(fitter, {})).place_m.cols(), 0);
}

}  // namespace
}  // namespace palpate::diagnosis
