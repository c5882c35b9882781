// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numeric>
#include <random>
#include <vector>

#include "components/force_estimation/shape/hidden_search.hpp"
#include "libs/geometry/surface_sampling.hpp"
#include "libs/rgbd/surface_view.hpp"
#include "tests/components/force_estimation/test_bodies.hpp"

namespace palpate::force_estimation {

/// A robot of which a camera sees feature points along their normals, and pushes at places that it
/// does not see, solved to equilibrium.
class HiddenScene {
 public:
  static constexpr double kSigma_m = 1e-4;
  static constexpr double kRadius_m = 0.006;

  struct Push {
    Eigen::Vector3d place_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d force_N = Eigen::Vector3d::Zero();
    double normal_N = 0.0;  ///< inward
  };

  HiddenScene(const robot::RobotDescription& robot, const Eigen::Vector3d& eye_m,
              const Eigen::Vector3d& looks_at_m)
      : model{robot::BuildRobotBody(robot)},
        commands(static_cast<size_t>(model.ActuatorCount())),
        free{model.RestState()},
        search{std::make_unique<HiddenSearch>(model, ShapeConfig{.contact_radius_m = kRadius_m},
                                              ScaleOf(model.body()))},
        eye_m_{eye_m},
        looks_at_m_{looks_at_m} {
    const fem::StaticResult result = model.Solve(commands, {}, &free);
    EXPECT_TRUE(result.status.ok()) << result.status.message();
    Look();
    LookAtFeatures();
    LookForHiddenPlaces();
  }

  /// The search starts from the body without contacts.
  Status Respond() { return RespondAbout(free, {}); }

  /// The first of the feature points, from all sides.
  void LookAtAllFeatures(size_t count) {
    rows.clear();
    for (size_t f = 0; f < count; ++f) {
      rows.push_back(
          robot::RowOfPoint(model.body().feature_points.at(f).weights,
                            model.body().feature_normals.col(static_cast<Eigen::Index>(f))));
    }
  }

  /// A place of the surface that the camera does not see, and a push there.
  Push RandomPush(double least_N, double most_N, double friction, std::mt19937& random) const {
    std::uniform_int_distribution<size_t> pick(0, hidden_m.size() - 1);
    std::uniform_real_distribution<double> size_N(least_N, most_N);
    std::normal_distribution<double> side;
    const Eigen::Vector3d place_m = hidden_m[pick(random)];
    const Eigen::Vector3d normal = model.Patch(place_m, kRadius_m).normal;
    Eigen::Vector3d tangent(side(random), side(random), side(random));
    tangent = (tangent - tangent.dot(normal) * normal).normalized();
    const double normal_N = size_N(random);
    return {place_m, normal_N * (friction * tangent - normal), normal_N};
  }

  /// How the rows change under pushes, at the equilibrium [m].
  Eigen::VectorXd Motion_m(const std::vector<Push>& pushes) {
    fem::StaticState state;
    return Solve(pushes, &state);
  }

  /// The same, and the search then looks about that equilibrium.
  Eigen::VectorXd MoveTo(const std::vector<Push>& pushes) {
    fem::StaticState state;
    const Eigen::VectorXd motion_m = Solve(pushes, &state);
    EXPECT_TRUE(RespondAbout(state, pushes).ok());
    return motion_m;
  }

  /// [rows x 3] of unit forces there, m/N, about what Respond or MoveTo came to.
  Eigen::MatrixX3d ResponseAt(const Eigen::Vector3d& place_m) const {
    return responses.To(model.Patch(place_m, kRadius_m).weights);
  }

  /// What the features show of the pushes, with noise.
  Unexplained Observe(const std::vector<Push>& pushes, std::mt19937& random) {
    Unexplained data = Noise(random);
    data.residual_m += Motion_m(pushes);
    return data;
  }

  Unexplained Noise(std::mt19937& random) const {
    const auto m = static_cast<Eigen::Index>(rows.size());
    Unexplained data{.residual_m = Eigen::VectorXd(m),
                     .weight = Eigen::VectorXd::Constant(m, 1.0 / (kSigma_m * kSigma_m)),
                     .known = Eigen::MatrixXd(m, 0),
                     .responses = &responses,
                     .row = std::vector<int>(rows.size())};
    std::iota(data.row.begin(), data.row.end(), 0);
    std::normal_distribution<double> noise(0.0, kSigma_m);
    for (double& residual_m : data.residual_m) residual_m = noise(random);
    return data;
  }

  robot::RobotModel model;
  std::vector<robot::ActuatorCommand> commands;
  fem::StaticState free;
  std::vector<robot::ObservationRow> rows;
  ObservationJacobian responses;          ///< of `rows`, about what Respond or MoveTo came to
  std::vector<Eigen::Vector3d> hidden_m;  ///< places, at rest
  std::unique_ptr<HiddenSearch> search;

 private:
  std::vector<robot::DeadLoad> Loads(const std::vector<Push>& pushes) const {
    std::vector<robot::DeadLoad> loads;
    for (const Push& push : pushes) {
      loads.push_back(LoadAt(model, push.place_m, kRadius_m, push.force_N));
    }
    return loads;
  }
  Eigen::VectorXd Solve(const std::vector<Push>& pushes, fem::StaticState* state) {
    *state = free;
    const fem::StaticResult result = model.Solve(commands, Loads(pushes), state);
    EXPECT_TRUE(result.status.ok()) << result.status.message();
    Eigen::VectorXd motion_m(static_cast<Eigen::Index>(rows.size()));
    for (size_t i = 0; i < rows.size(); ++i) {
      motion_m[static_cast<Eigen::Index>(i)] = rows[i].Value(state->x_m) - rows[i].Value(free.x_m);
    }
    return motion_m;
  }
  Status RespondAbout(const fem::StaticState& state, const std::vector<Push>& pushes) {
    Eigen::VectorXd force_N = Eigen::VectorXd::Zero(state.x_m.size());
    model.AddWeight(force_N);
    for (const robot::DeadLoad& load : Loads(pushes)) {
      for (size_t k = 0; k < load.weights.nodes.size(); ++k) {
        force_N.segment<3>(3 * load.weights.nodes[k]) += load.weights.weights[k] * load.force_N;
      }
    }
    Status status = model.linearisation().Update(state.x_m, state.multipliers_N, force_N);
    if (!status.ok()) return status;
    search->SetShape(state.x_m);
    responses.Clear();
    return responses.Add(model, rows, state.x_m, commands, state.multipliers_N);
  }
  Eigen::Vector3d InCamera_m(const Eigen::Vector3d& point_m) const {
    Eigen::Matrix3d axes;  // in rows
    axes.row(2) = (looks_at_m_ - eye_m_).normalized();
    axes.row(0) = axes.row(2).cross(Eigen::RowVector3d::UnitZ()).normalized();
    axes.row(1) = axes.row(2).cross(axes.row(0));
    return axes * (point_m - eye_m_);
  }
  void Look() {
    Eigen::Matrix3Xd vertices_m(3, model.body().mesh.NodeCount());
    for (Eigen::Index n = 0; n < vertices_m.cols(); ++n) {
      vertices_m.col(n) = InCamera_m(free.x_m.segment<3>(3 * n));
    }
    view_.Look(vertices_m, model.body().boundary.CornerTriangles());
  }
  /// Whether the camera sees the surface there.
  bool Seen(const Eigen::Vector3d& point_m, const Eigen::Vector3d& normal) const {
    constexpr double kGrazing = 0.05;
    constexpr double kClose_m = 0.006;
    const Eigen::Vector3d in_camera_m = InCamera_m(point_m);
    const Eigen::Vector2d pixel_px = rgbd::Project(view_.camera(), in_camera_m);
    const float z_m = view_.Z_m(static_cast<int>(std::lround(pixel_px.x())),
                                static_cast<int>(std::lround(pixel_px.y())));
    return normal.dot((eye_m_ - point_m).normalized()) > kGrazing &&
           in_camera_m.z() < static_cast<double>(z_m) + kClose_m;
  }
  void LookAtFeatures() {
    const robot::RobotBody& body = model.body();
    for (size_t f = 0; f < body.feature_points.size(); ++f) {
      const fem::InterpolationWeights& point = body.feature_points[f].weights;
      const Eigen::Vector3d normal = body.feature_normals.col(static_cast<Eigen::Index>(f));
      if (Seen(point.Position(free.x_m), normal)) rows.push_back(robot::RowOfPoint(point, normal));
    }
  }
  void LookForHiddenPlaces() {
    const robot::RobotBody& body = model.body();
    const geometry::SurfaceSamples samples =
        geometry::SampleByArea(fem::RestSurface(body.mesh, body.boundary), 1500);
    for (int s = 0; s < samples.Count(); ++s) {
      const Eigen::Vector3d place_m = samples.positions_m.col(s);
      if (!Seen(place_m, samples.normals.col(s)) && !NearHeldNode(place_m)) {
        hidden_m.push_back(place_m);
      }
    }
  }
  bool NearHeldNode(const Eigen::Vector3d& place_m) const {
    const robot::RobotBody& body = model.body();
    for (Eigen::Index n = 0; n < body.fixed.cols(); ++n) {
      const double distance_m = (body.mesh.nodes_m.col(n) - place_m).norm();
      if (body.fixed.col(n).any() && distance_m < 2.5 * kRadius_m) return true;
    }
    return false;
  }

  Eigen::Vector3d eye_m_, looks_at_m_;
  rgbd::SurfaceView view_{rgbd::CameraModel{
      .width_px = 320, .height_px = 240, .fx_px = 300, .fy_px = 300, .cx_px = 160, .cy_px = 120}};
};

}  // namespace palpate::force_estimation
