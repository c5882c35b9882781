// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/scenario/effect_places.hpp"

#include <algorithm>

namespace palpate::scenario {

namespace {

using Where = std::vector<std::string>;

std::vector<Where> Each(const std::string& prefix, const std::vector<std::string>& names) {
  std::vector<Where> places;
  for (const std::string& name : names) places.push_back({prefix + name});
  return places;
}

/// Of an effect on two actuators either of which may come first.
bool IsSymmetric(const EffectKind& kind) { return kind.parameters.empty(); }

std::vector<Where> Pairs(const EffectKind& kind, const std::string& prefix,
                         const std::vector<std::string>& names) {
  std::vector<Where> pairs;
  for (std::size_t a = 0; a < names.size(); ++a) {
    for (std::size_t b = IsSymmetric(kind) ? a + 1 : 0; b < names.size(); ++b) {
      if (a != b) pairs.push_back({prefix + names[a], prefix + names[b]});
    }
  }
  return pairs;
}

}  // namespace

bool IsOfTwo(Place place) { return place == Place::kTwoCables || place == Place::kTwoChambers; }

std::string DescribePlace(Place place) {
  switch (place) {
    case Place::kBody: return "body";
    case Place::kBase: return "base";
    case Place::kCamera: return "camera";
    case Place::kRegion: return "region:<name>";
    case Place::kCable: return "cable:<name>";
    case Place::kTwoCables: return "[cable:<name>, cable:<another name>]";
    case Place::kChamber: return "chamber:<name>";
    case Place::kTwoChambers: return "[chamber:<name>, chamber:<another name>]";
    case Place::kMarker: return "marker:<name>";
  }
  return {};
}

std::vector<Where> PlacesOn(const EffectKind& kind, const RobotNames& robot) {
  switch (kind.place) {
    case Place::kBody:
    case Place::kBase:
    case Place::kCamera: return {{DescribePlace(kind.place)}};
    case Place::kRegion: return Each("region:", robot.regions);
    case Place::kCable: return Each("cable:", robot.cables);
    case Place::kMarker: return Each("marker:", robot.markers);
    case Place::kTwoCables: return Pairs(kind, "cable:", robot.cables);
    case Place::kChamber: return Each("chamber:", robot.chambers);
    case Place::kTwoChambers: return Pairs(kind, "chamber:", robot.chambers);
  }
  return {};
}

bool SamePlace(const EffectKind& kind, const Where& a, const Where& b) {
  return IsSymmetric(kind) ? std::is_permutation(a.begin(), a.end(), b.begin(), b.end()) : a == b;
}

}  // namespace palpate::scenario
