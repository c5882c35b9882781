// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "libs/robot/robot_body.hpp"
#include "libs/robot/robot_model.hpp"
#include "tests/support/robots.hpp"

namespace palpate::test_support {

/// Cables pulled in by up to 20 mm, and up to 2 N on a patch of the surface, reached from rest in
/// equal frames.
struct RandomLoading {
  int frames = 1;
  std::vector<double> cables_m;  ///< [cables]; 0: not driven
  Eigen::Vector3d point_m;       ///< on the undeformed surface
  Eigen::Vector3d force_N;
  double patch_radius_m = 0.005;

  /// The cables after frame k of 1 to `frames`.
  std::vector<robot::ActuatorCommand> Cables(int k) const {
    std::vector<robot::ActuatorCommand> commands;
    for (const double cable_m : cables_m) {
      if (cable_m > 0.0) {
        commands.push_back({robot::ActuatorCommand::Kind::kDisplacement, cable_m * k / frames});
      } else {
        commands.emplace_back();
      }
    }
    return commands;
  }
};

inline constexpr std::uint32_t kLoadingSeed = 20260101;

/// Loading `index` of the series: the same whenever and however many are made.
inline RandomLoading MakeRandomLoading(const robot::RobotModel& model, int index) {
  std::seed_seq seed{kLoadingSeed, static_cast<std::uint32_t>(index)};
  std::mt19937 engine(seed);
  const auto uniform = [&engine] { return static_cast<double>(engine()) / 4294967296.0; };
  RandomLoading loading;
  loading.frames = 1 + static_cast<int>(8.0 * uniform());
  for (int c = 0; c < model.ActuatorCount(); ++c) {
    const bool driven = uniform() < 0.5;
    const double cable_m = 0.020 * uniform();
    loading.cables_m.push_back(driven ? cable_m : 0.0);
  }
  const robot::RobotBody& body = model.body();
  const auto face =
      static_cast<Eigen::Index>(uniform() * static_cast<double>(body.boundary.FaceCount()));
  double a = uniform();
  double b = uniform();
  if (a + b > 1.0) {
    a = 1.0 - a;
    b = 1.0 - b;
  }
  const auto corners = body.boundary.faces.col(face);
  loading.point_m = (1.0 - a - b) * body.mesh.nodes_m.col(corners[0]) +
                    a * body.mesh.nodes_m.col(corners[1]) + b * body.mesh.nodes_m.col(corners[2]);
  const double z = 2.0 * uniform() - 1.0;
  const double turn = 2.0 * std::numbers::pi * uniform();
  const double across = std::sqrt(1.0 - z * z);
  loading.force_N =
      2.0 * uniform() * Eigen::Vector3d(across * std::cos(turn), across * std::sin(turn), z);
  return loading;
}

/// Which loadings a test runs: PALPATE_LOADINGS of them (else `by_default`), or the one that
/// PALPATE_LOADING names.
struct LoadingRange {
  int first = 0;
  int end = 0;
};

inline LoadingRange LoadingsToRun(int by_default) {
  if (const char* one = std::getenv("PALPATE_LOADING"); one != nullptr) {
    return {std::atoi(one), std::atoi(one) + 1};
  }
  const char* many = std::getenv("PALPATE_LOADINGS");
  return {0, many != nullptr ? std::atoi(many) : by_default};
}

/// How frames ended.
struct FrameTally {
  int converged = 0, budget = 0, diverged = 0;
  int most_exact_steps = 0;
  long exact_steps = 0;

  int frames() const { return converged + budget + diverged; }
  void Print(const std::string& name, int loadings) const {
    std::printf(
        "%s: seed %u, %d loadings (PALPATE_LOADINGS=n: so many; PALPATE_LOADING=k: that one), "
        "%d frames: %d converged, %d budget reached, %d diverged; %.2f exact steps a frame, at "
        "most %d\n",
        name.c_str(), kLoadingSeed, loadings, frames(), converged, budget, diverged,
        static_cast<double>(exact_steps) / std::max(1, frames()), most_exact_steps);
  }
};

}  // namespace palpate::test_support
