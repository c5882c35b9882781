// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <Eigen/Core>
#include <algorithm>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "components/diagnosis/faults/makers.hpp"
#include "libs/core/index.hpp"
#include "libs/fem/embedding.hpp"
#include "libs/robot/sensitivity/eyelet_gradient.hpp"

namespace palpate::diagnosis {

namespace {

/// Loads at an unknown place are searched near points spread over the body. Prior standard
/// deviation of each coordinate about such a point, m.
constexpr double kPlaceSigma_m = 0.012;

/// A coordinate of such a place, near `near_m`.
FaultParameter PlaceParameter(const std::string& name, double near_m) {
  return {.name = name, .nominal = near_m, .fault = kPlaceSigma_m, .qualifies = true};
}

struct CandidatePlaces {
  std::vector<Eigen::Vector3d> point_m;  ///< of the undeformed body
  std::shared_ptr<const fem::PointLocator> locator;
};

/// Up to 32 feature points of the body that are far from its fixed nodes, where a force moves
/// little.
CandidatePlaces PlacesFor(const CatalogueInputs& inputs) {
  constexpr std::size_t kMost = 32;
  constexpr double kFarFromBase = 0.25;  // of the body's reach from the middle of its base
  CandidatePlaces places;
  places.locator = std::make_shared<fem::PointLocator>(inputs.body.mesh);
  const Eigen::Vector3d middle_m = MiddleOfBase(inputs.body);
  Eigen::VectorXd least_m(std::ssize(inputs.body.feature_points));
  for (Eigen::Index k = 0; k < least_m.size(); ++k) {
    const auto& rest_m = inputs.body.feature_points[At(k)].rest_m;
    least_m[k] = std::numeric_limits<double>::infinity();
    for (int node = 0; node < inputs.body.mesh.NodeCount(); ++node) {
      if (!inputs.body.fixed.col(node).all()) continue;
      least_m[k] = std::min(least_m[k], (rest_m - inputs.body.mesh.nodes_m.col(node)).norm());
    }
  }
  const double reach_m =
      (inputs.body.mesh.nodes_m.colwise() - middle_m).colwise().norm().maxCoeff();
  for (Eigen::Index k = 0; k < least_m.size() && places.point_m.size() < kMost; ++k) {
    if (least_m[k] < kFarFromBase * reach_m) continue;
    places.point_m.push_back(inputs.body.feature_points[At(k)].rest_m);
  }
  return places;
}

/// Adds a fault of this kind, made of a point and the locator, for each candidate place.
template <typename PlacedFault>
void AddAtPlaces(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  const CandidatePlaces places = PlacesFor(inputs);
  for (const Eigen::Vector3d& point_m : places.point_m) {
    faults->push_back(std::make_unique<PlacedFault>(point_m, places.locator));
  }
}

/// Effect of moving the point at which `force_N` acts along `axis` through the undeformed body.
robot::ParameterPtr MovedForce(const fem::PointLocator& locator, const Eigen::Vector3d& point_m,
                               int axis, const Eigen::Vector3d& force_N) {
  return PointForce(robot::EyeletWeightsAlong(locator, point_m, 0.0, Eigen::Vector3d::Unit(axis)),
                    force_N);
}

class Payload final : public FaultModel {
 public:
  Payload(const Eigen::Vector3d& near_m, std::shared_ptr<const fem::PointLocator> locator)
      : FaultModel({"payload", {"body"}}, "a mass on the body",
                   {{.name = "mass_kg", .fault = 0.03, .least = 0.0},
                    PlaceParameter("x_m", near_m.x()),
                    PlaceParameter("y_m", near_m.y()),
                    PlaceParameter("z_m", near_m.z())}),
        near_m_(near_m),
        locator_(std::move(locator)) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->masses.push_back(
        {locator_->Embed(near_m_ + z.tail<3>()).weights, std::max(0.0, z[0])});
  }

  robot::ParameterPtr OnBody(int parameter, const Eigen::VectorXd& z,
                             const FaultContext& at) const override {
    const Eigen::Vector3d gravity_m_s2 = GravityIn(at.hypothesis, at.recording());
    const Eigen::Vector3d point_m = near_m_ + z.tail<3>();
    if (parameter == 0) return PointForce(locator_->Embed(point_m).weights, gravity_m_s2);
    if (z[0] <= 0.0) return nullptr;
    return MovedForce(*locator_, point_m, parameter - 1, z[0] * gravity_m_s2);
  }

 private:
  Eigen::Vector3d near_m_;
  std::shared_ptr<const fem::PointLocator> locator_;
};

}  // namespace

void MakePayload(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  AddAtPlaces<Payload>(inputs, faults);
}

namespace {

/// Fixed in the world: in the robot's frame it turns when the base is tilted.
class PermanentForce final : public FaultModel {
 public:
  PermanentForce(const Eigen::Vector3d& near_m, std::shared_ptr<const fem::PointLocator> locator)
      : FaultModel({"permanent_force", {"body"}}, "a force on the body",
                   {{.name = "fx_N", .fault = 0.15},
                    {.name = "fy_N", .fault = 0.15},
                    {.name = "fz_N", .fault = 0.15},
                    PlaceParameter("x_m", near_m.x()),
                    PlaceParameter("y_m", near_m.y()),
                    PlaceParameter("z_m", near_m.z())}),
        near_m_(near_m),
        locator_(std::move(locator)) {}

  /// A mass is a force downwards: both turn with a tilted base alike.
  std::string SpecialCase() const override { return "payload"; }
  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->forces.push_back({locator_->Embed(near_m_ + z.tail<3>()).weights, z.head<3>()});
  }

  robot::ParameterPtr OnBody(int parameter, const Eigen::VectorXd& z,
                             const FaultContext& at) const override {
    const Eigen::Matrix3d R_robot_world = at.recording().base_rotation.transpose();
    const Eigen::Vector3d point_m = near_m_ + z.tail<3>();
    if (parameter < 3) {
      return PointForce(locator_->Embed(point_m).weights, R_robot_world.col(parameter));
    }
    if (z.head<3>().isZero()) return nullptr;
    return MovedForce(*locator_, point_m, parameter - 3, R_robot_world * z.head<3>());
  }

 private:
  Eigen::Vector3d near_m_;
  std::shared_ptr<const fem::PointLocator> locator_;
};

}  // namespace

void MakePermanentForce(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  AddAtPlaces<PermanentForce>(inputs, faults);
}

}  // namespace palpate::diagnosis
