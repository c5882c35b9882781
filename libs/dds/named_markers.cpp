// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/named_markers.hpp"

#include <utility>

#include "libs/core/names.hpp"
#include "libs/dds/geometry_messages.hpp"

namespace palpate::dds {

namespace {

Status Invalid(std::string reason) { return {StatusCode::kInvalidInput, std::move(reason)}; }

}  // namespace

Status FromMarkers(const idl::palpate_msgs::MarkerArray3& message,
                   const std::vector<std::string>& names, std::vector<NamedMarker>* markers) {
  markers->clear();
  std::vector<bool> came(names.size(), false);
  for (const auto& marker : Elements(message.markers)) {
    const auto index = IndexOf(Text(marker.name), names);
    if (!index) return Invalid(Unknown("marker", Text(marker.name), names));
    if (came[*index]) return Invalid("marker '" + names[*index] + "' comes twice");
    came[*index] = true;
    if (!marker.valid) continue;
    const NamedMarker seen{*index, ToVector(marker.position_m), ToVector(marker.sigma_m)};
    if (!seen.position_m.allFinite() || !seen.sigma_m.allFinite() ||
        seen.sigma_m.minCoeff() < 0.0) {
      return Invalid("position or sigma of marker '" + names[*index] + "' is not finite");
    }
    markers->push_back(seen);
  }
  return Status::Ok();
}

}  // namespace palpate::dds
