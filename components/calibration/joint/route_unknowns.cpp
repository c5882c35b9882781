// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/joint/route_unknowns.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <memory>
#include <utility>

#include "libs/core/index.hpp"
#include "libs/robot/eyelets.hpp"
#include "libs/robot/sensitivity/eyelet_gradient.hpp"
#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::calibration {

namespace {

constexpr const char* kLargeTension =
    "a recording with a large tension of this cable, with markers on the part that it moves";

class GuideUnknown final : public Unknown {
 public:
  GuideUnknown(int cable, std::string name, const Eigen::Vector3d& pull_point_m,
               const Eigen::Vector3d& direction, const GaussianPrior& prior)
      : Unknown(std::move(name), "m", prior, kLargeTension),
        cable_(cable),
        pull_point_m_(pull_point_m),
        direction_(direction) {}

  Status ApplyToModel(double value, robot::RobotModel* model) const override {
    // A point has two directions: only this component is set.
    const Eigen::Vector3d& now_m = model->cable(cable_).pull_point_m();
    const double off_m = value - direction_.dot(now_m - pull_point_m_);
    if (off_m != 0.0) model->SetPullPoint(cable_, now_m + off_m * direction_);
    return Status::Ok();
  }

  std::vector<Influence> InfluencesOn(const robot::RobotModel&, double, int,
                                      const FrameInputs&) const override {
    return Influence::One(robot::PullPointMove(cable_, direction_), 1.0);
  }

 private:
  int cable_;
  Eigen::Vector3d pull_point_m_;
  Eigen::Vector3d direction_;
};

class EyeletUnknown final : public Unknown {
 public:
  EyeletUnknown(int cable, int eyelet, std::string name, const Eigen::Vector3d& direction,
                const GaussianPrior& prior)
      : Unknown(std::move(name), "m", prior, kLargeTension),
        cable_(cable),
        eyelet_(eyelet),
        direction_(direction) {}

  Status ApplyToModel(double value, robot::RobotModel* model) const override {
    // An eyelet has two directions: only this component is set.
    const Eigen::Vector3d moved_m = robot::EyeletMoved_m(CableOf(*model), eyelet_);
    const double off_m = value - direction_.dot(moved_m);
    if (off_m == 0.0) return Status::Ok();
    return model->MoveEyelet(cable_, eyelet_, moved_m + off_m * direction_);
  }

  std::vector<Influence> InfluencesOn(const robot::RobotModel& model, double, int,
                                      const FrameInputs&) const override {
    const robot::BodyCable& cable = CableOf(model);
    const Eigen::Vector3d& now_m = cable.eyelets.at(At(eyelet_)).rest_m;
    return Influence::One(
        robot::EyeletMove(
            cable_, eyelet_,
            robot::EyeletWeightsAlong(model.locator(), now_m, cable.guide_radius_m, direction_)),
        model.body().scale);
  }

 private:
  const robot::BodyCable& CableOf(const robot::RobotModel& model) const {
    return model.body().cables.at(At(cable_));
  }

  int cable_;
  int eyelet_;
  Eigen::Vector3d direction_;
};

/// Near TiltAxes of `along`, orthogonal.
std::array<TiltAxis, 2> Across(const Eigen::Vector3d& along) {
  std::array<TiltAxis, 2> axes = TiltAxes(along);
  const Eigen::Vector3d square = along.normalized().cross(axes[0].direction);
  axes[1].direction = square.dot(axes[1].direction) < 0.0 ? Eigen::Vector3d(-square) : square;
  return axes;
}

}  // namespace

std::array<TiltAxis, 2> AcrossCable(const robot::RobotBody& body, int cable, int point) {
  const robot::BodyCable& path = body.cables.at(At(cable));
  const auto place_m = [&](int k) -> Eigen::Vector3d {
    return k == 0 ? path.pull_point_m : robot::EyeletPlace_m(path, body.scale, k - 1);
  };
  const int last = static_cast<int>(path.eyelets.size());
  return Across(place_m(std::min(point + 1, last)) - place_m(std::max(point - 1, 0)));
}

std::string RouteName(const std::string& cable_name, int point, const std::string& axis_name) {
  if (point == 0) return "cable_route:" + cable_name + ":" + axis_name;
  return "cable_eyelet:" + cable_name + ":" + std::to_string(point) + ":" + axis_name;
}

UnknownPtr RouteOf(const robot::RobotBody& body, int cable, int point, const TiltAxis& direction,
                   const GaussianPrior& prior) {
  const robot::BodyCable& path = body.cables.at(At(cable));
  std::string name = RouteName(path.name, point, direction.name);
  if (point == 0) {
    return std::make_unique<GuideUnknown>(cable, std::move(name), path.pull_point_m,
                                          direction.direction, prior);
  }
  return std::make_unique<EyeletUnknown>(cable, point - 1, std::move(name), direction.direction,
                                         prior);
}

}  // namespace palpate::calibration
