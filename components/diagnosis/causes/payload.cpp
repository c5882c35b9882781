// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/causes/makers.hpp"

#include <algorithm>

#include "components/diagnosis/causes/placed_force.hpp"

namespace palpate::diagnosis {

namespace {

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

void MakePayload(const CauseWorld& world, std::vector<FaultModelPtr>* causes) {
  AddAtPlaces<Payload>(world, causes);
}

}  // namespace palpate::diagnosis
