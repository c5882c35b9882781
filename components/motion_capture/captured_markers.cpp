// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/motion_capture/captured_markers.hpp"

#include "libs/core/error.hpp"

namespace palpate::motion_capture {

namespace {

constexpr char kAllMarkers[] = "all";

}  // namespace

MarkerMap::MarkerMap(const Eigen::Isometry3d& T_robot_mocap, const std::vector<std::string>& rename,
                     bool with_unlabelled)
    : T_robot_mocap_(T_robot_mocap), with_unlabelled_(with_unlabelled) {
  for (const std::string& rule : rename) {
    const std::size_t assign = rule.find(":=");
    if (assign == rule.npos || assign == 0 || assign + 2 == rule.size()) {
      throw InputError("rename: '" + rule + "' must be written as SET-1:=NAME");
    }
    if (!names_.emplace(rule.substr(0, assign), rule.substr(assign + 2)).second) {
      throw InputError("rename: '" + rule.substr(0, assign) + "' has two names");
    }
  }
}

CapturedMarker MarkerMap::Mapped(const std::string& name, const Eigen::Vector3f& position_m) const {
  const auto known = names_.find(name);
  CapturedMarker marker{known == names_.end() ? name : known->second, std::nullopt};
  // NatNet has zeros for a marker that is not seen.
  const bool seen = position_m.allFinite() && !position_m.isZero(0.0f);
  if (seen) marker.position_m = T_robot_mocap_ * position_m.cast<double>();
  return marker;
}

std::vector<CapturedMarker> MarkerMap::Map(const NatNetFrame& frame) const {
  std::vector<CapturedMarker> markers;
  for (const NatNetMarkerSet& set : frame.sets) {
    if (set.name == kAllMarkers) continue;
    for (std::size_t i = 0; i < set.positions_m.size(); ++i) {
      markers.push_back(Mapped(set.name + "-" + std::to_string(i + 1), set.positions_m[i]));
    }
  }
  if (!with_unlabelled_) return markers;
  for (const Eigen::Vector3f& position_m : frame.unlabelled_m) {
    markers.push_back(Mapped("", position_m));
  }
  return markers;
}

}  // namespace palpate::motion_capture
