// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>

#include "components/view/node/page_feed.hpp"
#include "components/view/robot/known_robot.hpp"

namespace palpate::view {

/// Shows a robot file by itself: the undeformed body, where it is held, and its cables.
class RobotSource {
 public:
  /// Both must outlive this.
  RobotSource(const KnownRobot& robot, PageFeed* feed);

  /// Feeds the shape; to be called once a second, since a shape that stays away is stale.
  /// `stamp_ns` since the epoch.
  void Show(std::int64_t stamp_ns);

 private:
  const KnownRobot& robot_;
  PageFeed* feed_;
  bool has_told_mesh_ = false;
  std::uint64_t counter_ = 0;
};

}  // namespace palpate::view
