// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/experiment/experiment.hpp"

namespace palpate::player {

/// Two recordings with two markers at 10 Hz, seen from the robot frame. "a" has cables: north by
/// displacement, south by tension, rows at 0 and 0.25 s; its first two frames are a reference.
inline experiment::Experiment SampleExperiment() {
  using experiment::ActuatorQuantity;
  experiment::Recording a;
  a.name = "a";
  a.markers.emplace();
  a.markers->names = {"m1", "m2"};
  for (int i = 0; i < 4; ++i) {
    const double t_s = 0.1 * i;
    a.markers->frames.push_back({t_s, {Eigen::Vector3d(t_s, 1, 2), Eigen::Vector3d(0, t_s, 0)}, 0});
  }
  a.markers->frames[2].positions_m[1].reset();
  a.actuation.emplace();
  a.actuation->t_s = {0.0, 0.25};
  a.actuation->columns = {{"north", ActuatorQuantity::kDisplacement, {0.0, 0.010}, {}},
                          {"south", ActuatorQuantity::kTension, {2.0, 2.0}, {}}};
  a.reference = experiment::Reference{{0.0, 0.15}, experiment::ReferenceShape::kEquilibrium};

  experiment::Recording b = a;
  b.name = "b";
  b.actuation.reset();
  b.reference.reset();

  experiment::Experiment experiment;
  experiment.folder = "sample";
  experiment.markers_sigma_m = Eigen::Vector3d(1e-4, 2e-4, 3e-4);
  experiment.recordings = {a, b};
  return experiment;
}

}  // namespace palpate::player
