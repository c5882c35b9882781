// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/touches/touch_plan.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "components/palpate/camera_place.hpp"
#include "components/palpate/new_robot/body_shape.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/core/statistics.hpp"

namespace palpate::command {

namespace {

using robot::ActuatorCommand;

/// Of a touch: how far along the body from what is fixed to the tip, and the least share of the
/// normal that points to the camera.
constexpr double kOnTheWay = 0.75;
constexpr double kFacing = 0.4;
constexpr double kLeastOnTheWay = 0.4;
/// Two balls at once are this many radii apart, so that neither touches the other.
constexpr double kApartRadii = 4.0;
/// Near what is fixed a push that moves the body as far would dent it.
constexpr double kMostForces = 2.0;
constexpr double kAwayRadii = 5.0;
constexpr double kNearRadii = 0.3;

/// A shape of the robot in balance, and how it is held there.
struct Posture {
  fem::StaticState state;
  std::vector<ActuatorCommand> commands;
};

/// A face on which a ball may press.
struct Place {
  Eigen::Vector3d rest_m = Eigen::Vector3d::Zero();  ///< undeformed
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, outward
  bool seen = false;                                 ///< by the camera
  double on_the_way = 0.0;  ///< 0: at what is fixed, 1: the farthest point of the body
};

Eigen::Vector3d FixedCentre_m(const robot::RobotBody& body) {
  Eigen::Vector3d sum_m = Eigen::Vector3d::Zero();
  int count = 0;
  for (Eigen::Index node = 0; node < body.fixed.cols(); ++node) {
    if (!body.fixed.col(node).all()) continue;
    sum_m += body.mesh.nodes_m.col(node);
    ++count;
  }
  return sum_m / std::max(count, 1);
}

/// The median edge of the surface.
double SurfaceEdge_m(const geometry::TriangleSurface& surface) {
  std::vector<double> edges_m;
  for (int face = 0; face < surface.TriangleCount(); ++face) {
    for (int corner = 0; corner < 3; ++corner) {
      edges_m.push_back(
          (surface.Corner(face, (corner + 1) % 3) - surface.Corner(face, corner)).norm());
    }
  }
  return Median(std::move(edges_m));
}

class Planner {
 public:
  explicit Planner(robot::RobotModel* model)
      : model_(*model),
        shape_(MeasureShape(model->body().mesh)),
        fixed_m_(FixedCentre_m(model->body())) {
    // Between the nodes of a face the surface knows no dent.
    constexpr double kDiagonals = 0.03, kEdges = 1.2;
    plan_.ball_radius_m = std::max(kDiagonals * shape_.diagonal_m,
                                   kEdges * SurfaceEdge_m(robot::ContactSurface(model->body())));
  }

  TouchPlan Plan() {
    const Posture rest = Rest();
    const std::optional<Posture> driven = Drive(rest);
    PlaceCamera(rest, driven);
    const std::vector<Place> places = PlacesOf(rest);
    const std::optional<Place> visible = Best(places, +1.0, {});
    if (!visible) {
      throw InputError("robot " + model_.body().name +
                       ": no place on the side of the camera that a ball can press; give a "
                       "scenario (--scenario)");
    }
    plan_.visible = Press(rest, *visible);
    if (const auto hidden = Best(places, -1.0, {})) plan_.hidden = Press(rest, *hidden);
    if (const auto second = Best(places, +1.0, *visible))
      plan_.second = Press(rest, *second, kMostForces * plan_.visible.force_N);
    if (driven) {
      if (const auto place = Best(PlacesOf(*driven), +1.0, {})) {
        plan_.driven = Press(*driven, *place);
      }
    }
    return plan_;
  }

 private:
  Posture Rest() {
    Posture rest{model_.RestState(), {}};
    for (const robot::ActuatorTraits& traits : model_.traits()) {
      rest.commands.push_back({traits.IsChamber() ? ActuatorCommand::Kind::kTension
                                                  : ActuatorCommand::Kind::kDisplacement,
                               0.0});
    }
    const Status status = model_.Solve(rest.commands, {}, &rest.state).status;
    if (!status.ok()) {
      throw InputError("robot " + model_.body().name +
                       ": no equilibrium under gravity: " + status.message());
    }
    return rest;
  }

  double Motion_m(const fem::StaticState& from, const fem::StaticState& to) const {
    const Eigen::VectorXd moved_m = to.x_m - from.x_m;
    return Eigen::Map<const Eigen::Matrix3Xd>(moved_m.data(), 3, moved_m.size() / 3)
        .colwise()
        .norm()
        .maxCoeff();
  }

  /// Actuators differ in their shares, so that a robot with several bends.
  static double ShareOf(int actuator) {
    constexpr double kGolden = 0.6180339887498949;
    const double x = kGolden * actuator;
    return 1.0 - 0.8 * (x - std::floor(x));
  }

  std::vector<ActuatorCommand> CommandsAt(const Posture& rest, double level) const {
    std::vector<ActuatorCommand> commands = rest.commands;
    for (int a = 0; a < model_.ActuatorCount(); ++a) {
      const robot::ActuatorTraits& traits = model_.traits(a);
      const double full = traits.IsChamber() ? traits.most_force_N : shape_.diagonal_m;
      commands[At(a)].value = level * ShareOf(a) * full;
    }
    return commands;
  }

  /// A posture away from `rest` by kDrivenMotion; nothing: no actuator moves the body.
  std::optional<Posture> Drive(const Posture& rest) {
    constexpr double kFirstLevel = 0.02;
    constexpr double kMostLevel = 0.5;  ///< of a chamber's largest pressure
    constexpr int kTrials = 6;
    const double wanted_m = kDrivenMotion * shape_.diagonal_m;
    std::optional<Posture> found;
    double level = model_.ActuatorCount() > 0 ? kFirstLevel : 0.0;
    for (int k = 0; k < kTrials && level > 0.0; ++k) {
      Posture posture{rest.state, CommandsAt(rest, level)};
      const bool solved = model_.Solve(posture.commands, {}, &posture.state).status.ok();
      const double motion_m = solved ? Motion_m(rest.state, posture.state) : 0.0;
      if (!solved || motion_m > 1.5 * wanted_m) {
        level *= 0.5;
        continue;
      }
      found = std::move(posture);
      if (motion_m > 0.8 * wanted_m || level >= kMostLevel) break;
      level = std::min(level * std::min(wanted_m / std::max(motion_m, 1e-9), 3.0), kMostLevel);
    }
    if (!found) return std::nullopt;
    for (int a = 0; a < model_.ActuatorCount(); ++a) {
      const robot::ActuatorTraits& traits = model_.traits(a);
      const double value = found->commands[At(a)].value;
      plan_.settings.push_back({traits.name, traits.IsChamber(),
                                traits.IsChamber() ? traits.ReportedForce(value) : value});
    }
    return found;
  }

  void PlaceCamera(const Posture& rest, const std::optional<Posture>& driven) {
    geometry::Box box = shape_.box;
    for (const Posture* posture : {&rest, driven ? &*driven : nullptr}) {
      if (posture == nullptr) continue;
      const Eigen::VectorXd& x_m = posture->state.x_m;
      const Eigen::Map<const Eigen::Matrix3Xd> nodes_m(x_m.data(), 3, x_m.size() / 3);
      const geometry::Box own = geometry::BoundingBox(nodes_m);
      box.lower_m = box.lower_m.cwiseMin(own.lower_m);
      box.upper_m = box.upper_m.cwiseMax(own.upper_m);
    }
    const Eigen::Vector3d gravity_m_s2 = model_.gravity_m_s2();
    const Eigen::Vector3d up = gravity_m_s2.norm() > 0.0
                                   ? Eigen::Vector3d(-gravity_m_s2.normalized())
                                   : Eigen::Vector3d::UnitZ().eval();
    view_ = ViewDirection(shape_.axes.col(0), up, shape_.centroid_m - fixed_m_);
    plan_.T_robot_camera = CameraPlace(box, view_, up);
  }

  std::vector<Place> PlacesOf(const Posture& posture) const {
    const robot::RobotBody& body = model_.body();
    const Eigen::VectorXd& x_m = posture.state.x_m;
    const geometry::TriangleSurface rest = robot::ContactSurface(body);
    const geometry::TriangleSurface moved{
        Eigen::Map<const Eigen::Matrix3Xd>(x_m.data(), 3, x_m.size() / 3), rest.triangles};
    std::vector<Place> places;
    double farthest_m = 0.0;
    for (int face = 0; face < moved.TriangleCount(); ++face) {
      Place place;
      for (int corner = 0; corner < 3; ++corner) {
        place.rest_m += rest.Corner(face, corner) / 3.0;
        place.position_m += moved.Corner(face, corner) / 3.0;
      }
      place.normal = geometry::TriangleNormal(moved, face);
      place.on_the_way = (place.rest_m - fixed_m_).norm();
      farthest_m = std::max(farthest_m, place.on_the_way);
      place.seen = place.normal.dot(view_) > 0.0 && IsSeen(moved, place);
      if (IsClear(moved, place)) places.push_back(place);
    }
    for (Place& place : places) place.on_the_way /= farthest_m;
    return places;
  }

  /// Whether the camera sees the place: no other face lies on its line of sight.
  bool IsSeen(const geometry::TriangleSurface& surface, const Place& place) const {
    const Eigen::Vector3d ray_m = plan_.T_robot_camera.translation() - place.position_m;
    const Eigen::Vector3d start_m = place.position_m + 1e-4 * shape_.diagonal_m * place.normal;
    for (int face = 0; face < surface.TriangleCount(); ++face) {
      Eigen::Matrix3d edges_m;
      edges_m << surface.Corner(face, 1) - surface.Corner(face, 0),
          surface.Corner(face, 2) - surface.Corner(face, 0), -ray_m;
      const Eigen::Vector3d hit = edges_m.inverse() * (start_m - surface.Corner(face, 0));
      if (hit.allFinite() && hit.x() >= 0.0 && hit.y() >= 0.0 && hit.x() + hit.y() <= 1.0 &&
          hit.z() > 0.0 && hit.z() < 1.0) {
        return false;
      }
    }
    return true;
  }

  /// Whether a ball comes to the place along the normal without meeting another part of the body.
  bool IsClear(const geometry::TriangleSurface& surface, const Place& place) const {
    const double radius_m = plan_.ball_radius_m;
    for (const int vertex : surface.triangles.reshaped()) {
      const Eigen::Vector3d off_m = surface.vertices_m.col(vertex) - place.position_m;
      const double along_m = off_m.dot(place.normal);
      const double aside_m = (off_m - along_m * place.normal).norm();
      if (along_m > 0.5 * radius_m && along_m < (kAwayRadii + 1.0) * radius_m &&
          aside_m < 1.2 * radius_m) {
        return false;
      }
    }
    return true;
  }

  /// The place that faces the camera (side 1) or turns away from it (-1) best, kOnTheWay to the
  /// tip; with `taken` one apart from it.
  std::optional<Place> Best(const std::vector<Place>& places, double side,
                            const std::optional<Place>& taken) const {
    std::optional<Place> best;
    double best_score = -std::numeric_limits<double>::infinity();
    for (const Place& place : places) {
      const double facing = side * place.normal.dot(view_);
      if (facing < kFacing || place.seen != (side > 0.0) || place.on_the_way < kLeastOnTheWay)
        continue;
      double score = facing - 2.0 * std::abs(place.on_the_way - kOnTheWay);
      if (taken) {
        const double apart_m = (place.position_m - taken->position_m).norm();
        if (apart_m < kApartRadii * plan_.ball_radius_m) continue;
        score = facing + 2.0 * apart_m / shape_.diagonal_m;
      }
      if (score <= best_score) continue;
      best_score = score;
      best = place;
    }
    return best;
  }

  /// The push that moves the body by its share of the diagonal, of at most `most_N`.
  Touch Press(const Posture& posture, const Place& place,
              double most_N = std::numeric_limits<double>::infinity()) {
    constexpr int kTrials = 8;
    const double wanted_m =
        (shape_.is_long() ? kLongTouchMotion : kTouchMotion) * shape_.diagonal_m;
    const double radius_m = plan_.ball_radius_m;
    const fem::SurfacePatch patch = model_.Patch(place.rest_m, 0.5 * radius_m);
    const Eigen::Vector3d start_m = patch.weights.Position(posture.state.x_m);
    const double modulus_Pa = model_.body().materials.front().youngs_modulus_Pa;
    Touch touch;
    double force_N = std::min(most_N, 1e-4 * modulus_Pa * radius_m * radius_m);
    Eigen::Vector3d pressed_m = start_m;
    for (int k = 0; k < kTrials; ++k) {
      fem::StaticState state = posture.state;
      const Status status =
          model_.Solve(posture.commands, {{patch.weights, -force_N * place.normal}}, &state).status;
      const Eigen::Vector3d moved_m = patch.weights.Position(state.x_m);
      const double motion_m = status.ok() ? Motion_m(posture.state, state) : 2.0 * wanted_m;
      if (motion_m > 1.3 * wanted_m) {
        force_N *= 0.6;
        continue;
      }
      pressed_m = moved_m;
      touch.force_N = force_N;
      if (motion_m > 0.85 * wanted_m || force_N >= most_N) break;
      force_N = std::min(most_N, force_N * std::min(wanted_m / std::max(motion_m, 1e-9), 10.0));
    }
    touch.away_m = start_m + kAwayRadii * radius_m * place.normal;
    touch.near_m = start_m + (1.0 + kNearRadii) * radius_m * place.normal;
    touch.pressed_m = pressed_m + radius_m * place.normal;
    return touch;
  }

  robot::RobotModel& model_;
  BodyShape shape_;
  Eigen::Vector3d fixed_m_;
  Eigen::Vector3d view_ = Eigen::Vector3d::UnitX();  ///< unit, from the body to the camera
  TouchPlan plan_;
};

}  // namespace

TouchPlan PlanTouches(robot::RobotModel* model) { return Planner(model).Plan(); }

}  // namespace palpate::command
