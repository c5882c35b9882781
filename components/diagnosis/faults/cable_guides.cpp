// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <array>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "components/diagnosis/faults/makers.hpp"
#include "libs/core/index.hpp"
#include "libs/robot/sensitivity/eyelet_gradient.hpp"
#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::diagnosis {

namespace {

/// As far as a cable may plausibly run beside its place in the robot file.
constexpr double kFarthestGuides_m = 0.02;

/// The eyelets of a cable sit elsewhere in the body, all by the same vector: the channel of the
/// cable is misplaced. The point that it is pulled from is where the file has it (CableRouting).
/// The actuator is zeroed with the eyelets there.
class CableGuides final : public FaultModel {
 public:
  CableGuides(const robot::BodyCable& cable, int index)
      : FaultModel({"cable_routing", {"cable:" + cable.name}},
                   "place of the eyelets of cable " + cable.name + " in the body",
                   {Shift("dx_m"), Shift("dy_m"), Shift("dz_m")}),
        index_(index),
        radius_m_(cable.guide_radius_m) {
    for (const fem::BodyPoint& eyelet : cable.eyelets) rest_m_.push_back(eyelet.rest_m);
  }

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    robot::BodyCable& cable = hypothesis->body.cables[At(index_)];
    for (std::size_t e = 0; e < rest_m_.size(); ++e) {
      const fem::BodyPoint moved = hypothesis->places->EmbedBall(rest_m_[e] + z, radius_m_);
      fem::BodyPoint& eyelet = cable.eyelets[e];
      eyelet.weights = moved.weights;
      eyelet.cell = moved.cell;
      eyelet.rest_m = moved.weights.Position(hypothesis->body.mesh.nodes_m.reshaped());
    }
  }

  bool Extend(const Eigen::VectorXd& z, robot::RobotDescription* robot,
              robot::CalibrationFile* /*calibration*/) const override {
    Eigen::Matrix3Xd& path_m = robot->cables[At(index_)].path_m;
    path_m.rightCols(path_m.cols() - 1).colwise() += Eigen::Vector3d(z);
    return true;
  }

  robot::ParameterPtr OnBody(int parameter, const Eigen::VectorXd& z,
                             const FaultContext& at) const override {
    const bool by_tension = at.observed.timeline.by_tension[At(index_)];
    const robot::BodyCable& cable = at.hypothesis.body.cables[At(index_)];
    const std::shared_ptr<const EyeletDirections> directions =
        DirectionsAt(z, at.hypothesis.places);
    auto sum = std::make_unique<SumOfParameters>();
    double longer = 0.0;  // the path at which the actuator was zeroed, per metre of the shift
    Eigen::Vector3d before_m = cable.pull_point_m;
    Eigen::Vector3d before_along = Eigen::Vector3d::Zero();
    for (std::size_t e = 0; e < rest_m_.size(); ++e) {
      const fem::InterpolationWeights& along = directions->along[At(parameter)][e];
      const Eigen::Vector3d here_m = cable.eyelets[e].weights.Position(at.hypothesis.assembled_m);
      const Eigen::Vector3d here_along = along.Position(at.hypothesis.assembled_m);
      longer += (here_m - before_m).normalized().dot(here_along - before_along);
      before_m = here_m;
      before_along = here_along;
      sum->Add(1.0, robot::EyeletMove(index_, static_cast<int>(e), along, robot::CableZero::kKept));
    }
    if (by_tension) return sum;
    Eigen::VectorXd change_m = Eigen::VectorXd::Zero(std::ssize(at.hypothesis.body.cables));
    change_m[index_] = -longer;
    sum->Add(1.0, CommandChange(std::move(change_m)));
    return sum;
  }

 private:
  /// How the eyelets' weights change along x, y and z, [3][eyelets].
  struct EyeletDirections {
    Eigen::VectorXd shift_m;
    std::shared_ptr<const fem::PointLocator> places;
    std::array<std::vector<fem::InterpolationWeights>, 3> along;
  };

  /// Kept: all samples of a hypothesis need the same, from several threads.
  std::shared_ptr<const EyeletDirections> DirectionsAt(
      const Eigen::VectorXd& shift_m,
      const std::shared_ptr<const fem::PointLocator>& places) const {
    const std::lock_guard lock(mutex_);
    if (kept_ && kept_->places == places && kept_->shift_m == shift_m) return kept_;
    auto directions = std::make_shared<EyeletDirections>();
    directions->shift_m = shift_m;
    directions->places = places;
    for (int axis = 0; axis < 3; ++axis) {
      for (const Eigen::Vector3d& rest_m : rest_m_) {
        directions->along[At(axis)].push_back(robot::EyeletWeightsAlong(
            *places, rest_m + shift_m, radius_m_, Eigen::Vector3d::Unit(axis)));
      }
    }
    kept_ = directions;
    return directions;
  }

  static FaultParameter Shift(const std::string& name) {
    return {.name = name, .tolerance = 3e-4, .fault = 4e-3, .plausible = kFarthestGuides_m};
  }

  int index_;
  double radius_m_;
  std::vector<Eigen::Vector3d> rest_m_;  ///< [eyelets] where the robot file has them
  mutable std::mutex mutex_;
  mutable std::shared_ptr<const EyeletDirections> kept_;
};

}  // namespace

void MakeCableGuides(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  for (std::size_t c = 0; c < inputs.body.cables.size(); ++c) {
    if (inputs.body.cables[c].eyelets.size() < 2) continue;  // a knot, and no channel
    faults->push_back(std::make_unique<CableGuides>(inputs.body.cables[c], static_cast<int>(c)));
  }
}

}  // namespace palpate::diagnosis
