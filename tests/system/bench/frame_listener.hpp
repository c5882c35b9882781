// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "libs/dds/stamp.hpp"
#include "libs/rgbd/rgbd_frame.hpp"
#include "tests/libs/dds/test_participant.hpp"

namespace palpate::system_test {

/// Subscribes to what palpate-capture publishes, and to the truth of the virtual bench.
class FrameListener {
 public:
  using Clock = std::chrono::steady_clock;

  /// What came of one frame set.
  struct FrameSet {
    std::optional<rgbd::DepthImage> depth;
    std::optional<rgbd::ColorImage> color;
    bool has_info = false;
    std::uint32_t epoch = 0;
    std::uint64_t frame_id = 0;  ///< the camera's
    Clock::time_point arrival;   ///< of its last part
    bool complete() const { return depth && color && has_info; }
  };
  using FrameSets = std::map<std::int64_t, FrameSet>;  ///< by stamp
  struct Report {
    Clock::time_point arrival;
    std::string status;
    std::string reason;
  };

  FrameListener();

  /// Pictures older than the last few are emptied.
  const FrameSets& frames() const { return frames_; }
  /// Stamps of the states that the virtual robot published.
  const std::set<std::int64_t>& states() const { return states_; }
  /// Of the component `capture`, newest last.
  const std::vector<Report>& reports() const { return reports_; }

  std::size_t CompleteCount() const;
  std::uint32_t LastEpoch() const;
  Clock::time_point LastArrival() const;
  void Forget();

  template <typename Condition>
  bool WaitFor(const Condition& condition, std::chrono::seconds at_most) {
    return node_.loop.DispatchUntil(condition, Clock::now() + at_most);
  }
  void ListenFor(std::chrono::milliseconds duration) {
    node_.loop.DispatchUntil([] { return false; }, Clock::now() + duration);
  }

 private:
  void TakeDepth();
  void TakeColor();
  void TakeInfo();
  void TakeStates();
  void TakeStatus();
  FrameSet& SetOf(const idl::std_msgs::Header& header);

  dds::TestNode node_;
  dds::Reader<idl::sensor_msgs::Image> depth_;
  dds::Reader<idl::sensor_msgs::Image> color_;
  dds::Reader<idl::palpate_msgs::FrameInfo> info_;
  dds::Reader<idl::palpate_msgs::MeshState> mesh_states_;
  dds::Reader<idl::palpate_msgs::ComponentStatus> status_;
  FrameSets frames_;
  std::set<std::int64_t> states_;
  std::vector<Report> reports_;
};

}  // namespace palpate::system_test
