// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/monitor/model_gap.hpp"

#include <cmath>
#include <limits>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"

namespace palpate::force_estimation {

namespace {

void Add(ModelGapPart& part, double squares_m2, double variances_m2) {
  part.residual_rms_m += squares_m2;
  part.noise_rms_m += variances_m2;
  ++part.sample_count;
}

void FinishPart(ModelGapPart& part, int coordinates) {
  if (part.sample_count == 0) return;
  const double numbers = static_cast<double>(coordinates) * part.sample_count;
  part.residual_rms_m = std::sqrt(part.residual_rms_m / numbers);
  part.noise_rms_m = std::sqrt(part.noise_rms_m / numbers);
}

std::vector<ModelGapPart> EmptyParts(const std::vector<std::string>& names) {
  std::vector<ModelGapPart> parts;
  for (const std::string& name : names) parts.push_back({name, 0.0, 0.0, 0});
  return parts;
}

std::vector<fem::BodyPoint> PointsOfMarkers(const robot::RobotBody& body) {
  std::vector<fem::BodyPoint> points;
  for (const robot::BodyMarker& marker : body.markers) points.push_back(marker.point);
  return points;
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

ModelGapParts::ModelGapParts(const robot::RobotBody& body,
                             const std::vector<fem::BodyPoint>& points)
    : region_names_{"body"} {
  region_names_.insert(region_names_.end(), body.region_names.begin(), body.region_names.end());
  for (const robot::BodyCable& cable : body.cables) cable_names_.push_back(cable.name);
  for (const fem::BodyPoint& point : points) {
    const auto cell = static_cast<size_t>(point.cell);
    region_of_point_.push_back(static_cast<size_t>(body.material_of_cell[cell]));
    if (!body.cables.empty()) cable_of_point_.push_back(NearestCable(body, point.rest_m));
  }
}

ModelGapReport ModelGapParts::Begin() const {
  return {{}, EmptyParts(region_names_), EmptyParts(cable_names_)};
}

void ModelGapParts::Add(std::size_t point, double squares_m2, double variances_m2,
                        ModelGapReport* report) const {
  force_estimation::Add(report->whole, squares_m2, variances_m2);
  force_estimation::Add(report->regions[region_of_point_[point]], squares_m2, variances_m2);
  if (cable_of_point_.empty()) return;
  force_estimation::Add(report->cables[cable_of_point_[point]], squares_m2, variances_m2);
}

void ModelGapParts::Finish(int coordinates, ModelGapReport* report) {
  FinishPart(report->whole, coordinates);
  for (ModelGapPart& part : report->regions) FinishPart(part, coordinates);
  for (ModelGapPart& part : report->cables) FinishPart(part, coordinates);
}

ModelGapMeter::ModelGapMeter(const robot::RobotBody& body, double default_sigma_m, double bias_m)
    : default_sigma_m_(default_sigma_m), bias_m_(bias_m), parts_(body, PointsOfMarkers(body)) {}

ModelGapReport ModelGapMeter::Measure(const MarkerFrame& frame,
                                      const ForceEstimate& estimate) const {
  ModelGapReport report = parts_.Begin();
  const bool fitted = estimate.status.ok() || estimate.status.code() == StatusCode::kNoContact;
  for (size_t m = 0; fitted && m < frame.markers.size(); ++m) {
    const MarkerObservation& marker = frame.markers[m];
    if (!marker.valid) continue;
    const Eigen::Vector3d residual_m = estimate.marker_residual_m.segment<3>(ToIndex(3 * m));
    double variances_m2 = 3.0 * bias_m_ * bias_m_;
    for (const double sigma_m : marker.sigma_m) {
      variances_m2 += std::pow(sigma_m > 0.0 ? sigma_m : default_sigma_m_, 2);
    }
    parts_.Add(m, residual_m.squaredNorm(), variances_m2, &report);
  }
  ModelGapParts::Finish(3, &report);
  return report;
}

ModelGapReport FeatureGapMeter::Measure(const std::vector<FeatureReport>& features,
                                        const Status& status) const {
  ModelGapReport report = parts_.Begin();
  const bool fitted = status.ok() || status.code() == StatusCode::kNoContact;
  PALPATE_CHECK(features.size() == parts_.PointCount(), features.size(), parts_.PointCount());
  for (size_t f = 0; fitted && f < features.size(); ++f) {
    const FeatureReport& feature = features[f];
    if (feature.state != correspondence::MatchState::kMatched) continue;
    parts_.Add(f, feature.residual_m * feature.residual_m, feature.sigma_m * feature.sigma_m,
               &report);
  }
  ModelGapParts::Finish(1, &report);
  return report;
}

}  // namespace palpate::force_estimation
