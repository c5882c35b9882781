// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/outputs.hpp"

#include <utility>

#include "components/perception/node/convert_markers.hpp"
#include "libs/core/seconds.hpp"
#include "libs/dds/camera_topics.hpp"
#include "libs/dds/cloud_messages.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/geometry/frames.hpp"

namespace palpate::perception {

Outputs::Outputs(dds::Participant& participant, bool with_markers,
                 const std::vector<std::string>& cameras)
    : robot_writer_(participant.CreateWriter(dds::kRobotCloudTopic)),
      object_writer_(participant.CreateWriter(dds::kObjectCloudTopic)),
      report_writer_(participant.CreateWriter(dds::kPerceptionReportTopic)),
      contact_writer_(participant.CreateWriter(dds::kContactsTopic)),
      clock_(participant.clock()) {
  if (with_markers) marker_writer_.emplace(participant.CreateWriter(dds::kMarkersTopic));
  for (const std::string& camera : cameras) {
    const dds::CameraTopics topics = dds::TopicsOf(camera);
    further_.push_back({participant.CreateWriter(topics.report, {}, camera), topics.depth_frame});
  }
}

void Outputs::Publish(const FrameOutcome& outcome, FrameSet::Time taken) {
  const auto frame_id = geometry::kCameraDepthOpticalFrame;
  if (outcome.cameras.size() == 1) {
    const SegmentedFrame& frame = outcome.observation.views[0].frame;
    robot_ = dds::ToPointCloud2(frame.robot, outcome.stamp_ns, frame_id);
    object_ = dds::ToPointCloud2(frame.object, outcome.stamp_ns, frame_id);
  } else {
    robot_ = dds::ToJoinedPointCloud2(JoinedRobotCloud(outcome), outcome.stamp_ns, frame_id);
    object_ = dds::ToJoinedPointCloud2(JoinedObjectCloud(outcome), outcome.stamp_ns, frame_id);
  }
  markers_ = ToMarkerArray(outcome.observation.views[0].markers, outcome.stamp_ns);
  contacts_ = ToContactArray(outcome);
  last_stamp_ns_ = outcome.stamp_ns;
  MakeReports(outcome, taken);
  latencies_s_.push_back(report_->latency_s);
  Send();
}

void Outputs::MakeReports(const FrameOutcome& outcome, FrameSet::Time taken) {
  report_ = ToReport(outcome);
  report_->age_s = NsToSeconds(clock_->NowOfFrames_ns() - outcome.stamp_ns);
  report_->latency_s = SecondsSince(taken);
  for (std::size_t k = 0; k < further_.size(); ++k) {
    further_[k].message = ToReportOf(outcome, k + 1, further_[k].depth_frame);
    further_[k].message->age_s = report_->age_s;
    further_[k].message->latency_s = report_->latency_s;
  }
}

void Outputs::Repeat(std::int64_t stamp_ns) {
  if (last_stamp_ns_ == stamp_ns) Send();
}

void Outputs::Send() {
  report_->counter = contacts_->counter = markers_->counter = counter_++;
  failed_ += robot_writer_.Write(robot_) ? 0 : 1;
  failed_ += object_writer_.Write(object_) ? 0 : 1;
  if (marker_writer_) failed_ += marker_writer_->Write(markers_) ? 0 : 1;
  for (FurtherReport& further : further_) {
    further.message->counter = report_->counter;
    failed_ += further.writer.Write(further.message) ? 0 : 1;
  }
  failed_ += report_writer_.Write(report_) ? 0 : 1;
  failed_ += contact_writer_.Write(contacts_) ? 0 : 1;
}

std::vector<double> Outputs::TakeLatencies() { return std::exchange(latencies_s_, {}); }

}  // namespace palpate::perception
