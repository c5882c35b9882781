// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/outputs.hpp"

#include <utility>

#include "components/perception/node/convert_markers.hpp"
#include "libs/core/seconds.hpp"
#include "libs/dds/cloud_messages.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/geometry/frames.hpp"

namespace palpate::perception {

Outputs::Outputs(dds::Participant& participant, bool with_markers)
    : robot_writer_(participant.CreateWriter(dds::kRobotCloudTopic)),
      object_writer_(participant.CreateWriter(dds::kObjectCloudTopic)),
      report_writer_(participant.CreateWriter(dds::kPerceptionReportTopic)),
      contact_writer_(participant.CreateWriter(dds::kContactsTopic)),
      clock_(participant.clock()) {
  if (with_markers) marker_writer_.emplace(participant.CreateWriter(dds::kMarkersTopic));
}

void Outputs::Publish(const FrameOutcome& outcome, FrameSet::Time taken) {
  const auto frame_id = geometry::kCameraDepthOpticalFrame;
  const SegmentedFrame& frame = outcome.observation.frame;
  robot_ = dds::ToPointCloud2(frame.robot, outcome.stamp_ns, frame_id);
  object_ = dds::ToPointCloud2(frame.object, outcome.stamp_ns, frame_id);
  markers_ = ToMarkerArray(outcome.observation.markers, outcome.stamp_ns);
  report_ = ToReport(outcome);
  contacts_ = ToContactArray(outcome);
  last_stamp_ns_ = outcome.stamp_ns;
  report_->age_s = NsToSeconds(clock_->NowOfFrames_ns() - outcome.stamp_ns);
  report_->latency_s = SecondsSince(taken);
  latencies_s_.push_back(report_->latency_s);
  Send();
}

void Outputs::Repeat(std::int64_t stamp_ns) {
  if (last_stamp_ns_ == stamp_ns) Send();
}

void Outputs::Send() {
  report_->counter = contacts_->counter = markers_->counter = counter_++;
  failed_ += robot_writer_.Write(robot_) ? 0 : 1;
  failed_ += object_writer_.Write(object_) ? 0 : 1;
  if (marker_writer_) failed_ += marker_writer_->Write(markers_) ? 0 : 1;
  failed_ += report_writer_.Write(report_) ? 0 : 1;
  failed_ += contact_writer_.Write(contacts_) ? 0 : 1;
}

std::vector<double> Outputs::TakeLatencies() { return std::exchange(latencies_s_, {}); }

}  // namespace palpate::perception
