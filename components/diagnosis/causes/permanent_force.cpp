// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/causes/makers.hpp"

#include "components/diagnosis/causes/placed_force.hpp"

namespace palpate::diagnosis {

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

void MakePermanentForce(const CauseWorld& world, std::vector<FaultModelPtr>* causes) {
  AddAtPlaces<PermanentForce>(world, causes);
}

}  // namespace palpate::diagnosis
