// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/perception/node/convert.hpp"
#include "components/perception/node/frame_pairing.hpp"
#include "libs/dds/participant.hpp"

namespace palpate::perception {

/// The writers of the node: both clouds, markers where their detection is on, reports and contacts
/// of each frame, in this order, under its stamp. With further cameras the clouds are joined, and
/// each of them has a report of its own. All calls come from the node's loop.
class Outputs {
 public:
  /// `with_markers`: without, /perception/markers is left to a motion-capture bridge. `cameras`:
  /// names of those beside the first.
  Outputs(dds::Participant& participant, bool with_markers,
          const std::vector<std::string>& cameras = {});

  void Publish(const FrameOutcome& outcome, FrameSet::Time taken);
  /// Sends the last frame's messages again where they are of this stamp.
  void Repeat(std::int64_t stamp_ns);

  std::optional<std::int64_t> last_stamp_ns() const { return last_stamp_ns_; }
  std::uint64_t published() const { return report_writer_.sent_count(); }
  std::uint64_t failed() const { return failed_; }  ///< messages that DDS did not take
  std::uint32_t readers() const { return contact_writer_.matched(); }
  /// From having a whole frame to publishing, s; the list is cleared by each call.
  std::vector<double> TakeLatencies();

 private:
  /// The report of a camera beside the first.
  struct FurtherReport {
    dds::Writer<idl::palpate_msgs::PerceptionReport> writer;
    std::string depth_frame;
    dds::Message<idl::palpate_msgs::PerceptionReport> message = {};
  };

  void MakeReports(const FrameOutcome& outcome, FrameSet::Time taken);
  void Send();

  dds::Writer<idl::sensor_msgs::PointCloud2> robot_writer_;
  dds::Writer<idl::sensor_msgs::PointCloud2> object_writer_;
  std::optional<dds::Writer<idl::palpate_msgs::MarkerArray3>> marker_writer_;
  dds::Writer<idl::palpate_msgs::PerceptionReport> report_writer_;
  dds::Writer<idl::palpate_msgs::ContactArray> contact_writer_;
  std::vector<FurtherReport> further_;
  dds::Message<idl::sensor_msgs::PointCloud2> robot_;
  dds::Message<idl::sensor_msgs::PointCloud2> object_;
  dds::Message<idl::palpate_msgs::MarkerArray3> markers_;
  dds::Message<idl::palpate_msgs::PerceptionReport> report_;
  dds::Message<idl::palpate_msgs::ContactArray> contacts_;
  std::shared_ptr<dds::RosClock> clock_;
  std::optional<std::int64_t> last_stamp_ns_;
  std::uint64_t counter_ = 0;
  std::uint64_t failed_ = 0;
  std::vector<double> latencies_s_;
};

}  // namespace palpate::perception
