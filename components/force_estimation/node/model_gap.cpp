// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/node/model_gap.hpp"

#include <cmath>
#include <limits>

namespace palpate::force_estimation {

namespace {

/// Sums squares while it is filled; Finish() makes them root mean squares.
void AddMarker(ModelGapPart& part, const Eigen::Vector3d& residual_m, double variance_m2) {
  part.residual_rms_m += residual_m.squaredNorm();
  part.noise_rms_m += variance_m2;
  ++part.marker_count;
}

void Finish(ModelGapPart& part) {
  if (part.marker_count == 0) return;
  part.residual_rms_m = std::sqrt(part.residual_rms_m / (3.0 * part.marker_count));
  part.noise_rms_m = std::sqrt(part.noise_rms_m / (3.0 * part.marker_count));
}

std::vector<ModelGapPart> EmptyParts(const std::vector<std::string>& names) {
  std::vector<ModelGapPart> parts;
  for (const std::string& name : names) parts.push_back({name, 0.0, 0.0, 0});
  return parts;
}

size_t NearestCable(const robot::RobotBody& body, const Eigen::Vector3d& point_m) {
  size_t nearest = 0;
  double least_m = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < body.cables.size(); ++i) {
    const double distance_m = (body.cables[i].eyelets.back().rest_m - point_m).norm();
    if (distance_m >= least_m) continue;
    least_m = distance_m;
    nearest = i;
  }
  return nearest;
}

}  // namespace

ModelGapMeter::ModelGapMeter(const robot::RobotBody& body, double default_sigma_m, double bias_m)
    : default_sigma_m_(default_sigma_m), bias_m_(bias_m), region_names_{"body"} {
  region_names_.insert(region_names_.end(), body.region_names.begin(), body.region_names.end());
  for (const robot::BodyCable& cable : body.cables) cable_names_.push_back(cable.name);
  for (const robot::BodyMarker& marker : body.markers) {
    const auto cell = static_cast<size_t>(marker.point.cell);
    region_of_marker_.push_back(static_cast<size_t>(body.material_of_cell[cell]));
    if (!body.cables.empty()) {
      cable_of_marker_.push_back(NearestCable(body, marker.point.rest_m));
    }
  }
}

ModelGapReport ModelGapMeter::Measure(const MarkerFrame& frame,
                                      const ForceEstimate& estimate) const {
  ModelGapReport report{{}, EmptyParts(region_names_), EmptyParts(cable_names_)};
  const bool fitted = estimate.status.ok() || estimate.status.code() == StatusCode::kNoContact;
  for (size_t m = 0; fitted && m < frame.markers.size(); ++m) {
    const MarkerObservation& marker = frame.markers[m];
    if (!marker.valid) continue;
    const Eigen::Vector3d residual_m =
        estimate.marker_residual_m.segment<3>(static_cast<Eigen::Index>(3 * m));
    double variance_m2 = 3.0 * bias_m_ * bias_m_;
    for (const double sigma_m : marker.sigma_m) {
      variance_m2 += std::pow(sigma_m > 0.0 ? sigma_m : default_sigma_m_, 2);
    }
    AddMarker(report.whole, residual_m, variance_m2);
    AddMarker(report.regions[region_of_marker_[m]], residual_m, variance_m2);
    if (!cable_of_marker_.empty()) {
      AddMarker(report.cables[cable_of_marker_[m]], residual_m, variance_m2);
    }
  }
  Finish(report.whole);
  for (ModelGapPart& part : report.regions) Finish(part);
  for (ModelGapPart& part : report.cables) Finish(part);
  return report;
}

}  // namespace palpate::force_estimation
