// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/named_markers.hpp"

#include <Eigen/Cholesky>

#include "libs/core/names.hpp"
#include "libs/dds/geometry_messages.hpp"
#include "libs/dds/invalid_message.hpp"
#include "palpate_msgs/msg/Marker3.hpp"

namespace palpate::dds {

namespace {

using Covariance = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// Of rounding in whoever sends it.
constexpr double kAsymmetry = 1e-9;

bool IsCovariance(const Eigen::Matrix3d& matrix) {
  const double largest = matrix.lpNorm<Eigen::Infinity>();
  return matrix.allFinite() &&
         (matrix - matrix.transpose()).lpNorm<Eigen::Infinity>() <= kAsymmetry * largest &&
         Eigen::LLT<Eigen::Matrix3d>(matrix).info() == Eigen::Success;
}

/// `called`: the marker, for messages.
Status ReadPlace(const idl::palpate_msgs::Marker3& message, const std::string& called,
                 NamedMarker* marker) {
  marker->position_m = ToVector(message.position_m);
  marker->sigma_m = ToVector(message.sigma_m);
  if (!marker->position_m.allFinite() || !marker->sigma_m.allFinite() ||
      marker->sigma_m.minCoeff() < 0.0) {
    return Invalid("position or sigma of " + called + " is not finite");
  }
  marker->covariance_m2 = Eigen::Map<const Covariance>(message.covariance_m2);
  if (marker->covariance_m2.isZero(0.0)) {
    marker->covariance_m2 = marker->sigma_m.cwiseAbs2().asDiagonal();
    return Status::Ok();
  }
  if (!IsCovariance(marker->covariance_m2)) {
    return Invalid("covariance_m2 of " + called + " is no covariance");
  }
  marker->sigma_m = marker->covariance_m2.diagonal().cwiseSqrt();
  return Status::Ok();
}

Status Read(const idl::palpate_msgs::MarkerArray3& message, const std::vector<std::string>& names,
            bool names_are_needed, std::vector<NamedMarker>* markers) {
  markers->clear();
  std::vector<bool> came(names.size(), false);
  for (const auto& marker : Elements(message.markers)) {
    NamedMarker seen;
    std::string called = "a marker without a name";
    if (const auto name = Text(marker.name); names_are_needed || !name.empty()) {
      seen.index = IndexOf(name, names);
      if (!seen.index) return Invalid(Unknown("marker", name, names));
      called = "marker '" + names[*seen.index] + "'";
      if (came[*seen.index]) return Invalid(called + " comes twice");
      came[*seen.index] = true;
    }
    if (!marker.valid) continue;
    if (Status status = ReadPlace(marker, called, &seen); !status.ok()) return status;
    markers->push_back(seen);
  }
  return Status::Ok();
}

}  // namespace

Status FromMarkers(const idl::palpate_msgs::MarkerArray3& message,
                   const std::vector<std::string>& names, std::vector<NamedMarker>* markers) {
  return Read(message, names, true, markers);
}

Status FromMarkersWithOrWithoutNames(const idl::palpate_msgs::MarkerArray3& message,
                                     const std::vector<std::string>& names,
                                     std::vector<NamedMarker>* markers) {
  return Read(message, names, false, markers);
}

}  // namespace palpate::dds
