// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/node/cloud_source.hpp"

#include <utility>

#include "libs/dds/cloud_messages.hpp"
#include "libs/dds/depth_picture.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/geometry/frames.hpp"

namespace palpate::calibration {

namespace {

Status CheckFrame(const idl::std_msgs::Header& header) {
  const Status status = dds::CheckFrameId(header, geometry::kCameraDepthOpticalFrame);
  if (status.ok()) return status;
  return {status.code(), "/perception/robot_cloud: " + status.message()};
}

}  // namespace

CloudSource::CloudSource(dds::Participant& participant, dds::WaitSet& loop, bool allow_contacts,
                         CloudEvents events)
    : allow_contacts_(allow_contacts),
      events_(std::move(events)),
      clouds_(participant.CreateReader(dds::kRobotCloudTopic)),
      reports_(participant.CreateReader(dds::kPerceptionReportTopic)) {
  loop.Attach(clouds_, [this] { TakeClouds(); });
  loop.Attach(reports_, [this] { TakeReports(); });
}

CloudSource::Parts& CloudSource::PartsAt(std::int64_t stamp_ns) {
  if (pending_.size() >= kMostPending && !pending_.contains(stamp_ns)) {
    pending_.erase(pending_.begin());
  }
  return pending_[stamp_ns];
}

void CloudSource::TakeClouds() {
  for (const auto& message : clouds_.Take()) {
    ++received_;
    const std::int64_t stamp_ns = dds::StampNs(message.header.stamp);
    Parts& parts = PartsAt(stamp_ns);
    parts.status = CheckFrame(message.header);
    rgbd::SensedCloud& cloud = parts.cloud.emplace();
    if (parts.status.ok()) parts.status = dds::FromPointCloud2(message, &cloud);
    PassOn(stamp_ns);
  }
}

void CloudSource::TakeReports() {
  for (const auto& message : reports_.Take()) {
    const std::int64_t stamp_ns = dds::StampNs(message.header.stamp);
    const bool ok = dds::Text(message.status) == ToString(StatusCode::kOk);
    PartsAt(stamp_ns).report =
        Report{std::string(dds::Text(message.device)),
               ok ? Status::Ok()
                  : Status(StatusCode::kNoRobotSeen,
                           "perception reports " + std::string(dds::Text(message.status)) + ", " +
                               std::string(dds::Text(message.reason))),
               message.contacts, dds::ToPicture(message.picture)};
    PassOn(stamp_ns);
  }
}

void CloudSource::PassOn(std::int64_t stamp_ns) {
  if (!pending_.at(stamp_ns).cloud || !pending_.at(stamp_ns).report) return;
  Parts whole = std::move(pending_.extract(stamp_ns).mapped());
  const Report& report = *whole.report;
  if (std::exchange(device_, report.device) != report.device) events_.other_camera(report.device);
  if (!whole.status.ok()) return events_.refused(whole.status);
  if (!report.status.ok()) return events_.refused(report.status);
  if (report.contacts > 0 && !allow_contacts_) {
    return events_.refused({StatusCode::kInvalidInput, "perception detects a contact"});
  }
  events_.seen({stamp_ns, std::move(*whole.cloud), report.picture});
}

}  // namespace palpate::calibration
