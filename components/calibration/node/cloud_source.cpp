// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/node/cloud_source.hpp"

#include <algorithm>
#include <utility>

#include "libs/dds/camera_topics.hpp"
#include "libs/dds/depth_picture.hpp"
#include "libs/dds/geometry_messages.hpp"
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
                         CloudEvents events, const std::vector<std::string>& cameras)
    : allow_contacts_(allow_contacts),
      events_(std::move(events)),
      clouds_(participant.CreateReader(dds::kRobotCloudTopic)),
      reports_(participant.CreateReader(dds::kPerceptionReportTopic)) {
  loop.Attach(clouds_, [this] { TakeClouds(); });
  loop.Attach(reports_, [this] { TakeReports(reports_, std::nullopt); });
  for (const std::string& camera : cameras) {
    const std::size_t number = further_.size();
    further_.push_back(std::make_unique<dds::Reader<idl::palpate_msgs::PerceptionReport>>(
        participant.CreateReader(dds::kFurtherPerceptionReportTopic, {}, camera)));
    loop.Attach(*further_.back(), [this, number] { TakeReports(*further_[number], number); });
  }
}

std::vector<const dds::Endpoint*> CloudSource::further_reports() const {
  std::vector<const dds::Endpoint*> readers;
  for (const auto& reader : further_) readers.push_back(reader.get());
  return readers;
}

bool CloudSource::Parts::is_complete() const {
  return cloud && report && std::all_of(further.begin(), further.end(), [](const auto& of_camera) {
           return of_camera.has_value();
         });
}

CloudSource::Parts& CloudSource::PartsAt(std::int64_t stamp_ns) {
  if (pending_.size() >= kMostPending && !pending_.contains(stamp_ns)) {
    pending_.erase(pending_.begin());
  }
  Parts& parts = pending_[stamp_ns];
  parts.further.resize(further_.size());
  return parts;
}

void CloudSource::TakeClouds() {
  for (const auto& message : clouds_.Take()) {
    ++received_;
    const std::int64_t stamp_ns = dds::StampNs(message.header.stamp);
    Parts& parts = PartsAt(stamp_ns);
    parts.status = CheckFrame(message.header);
    dds::JoinedCloud& cloud = parts.cloud.emplace();
    if (parts.status.ok()) {
      parts.status = further_.empty() ? dds::FromPointCloud2(message, &cloud.points)
                                      : dds::FromJoinedPointCloud2(message, &cloud);
    }
    PassOn(stamp_ns);
  }
}

/// `further`: number of the camera beside the first; nullopt: the report of the whole frame.
void CloudSource::TakeReports(dds::Reader<idl::palpate_msgs::PerceptionReport>& reader,
                              std::optional<std::size_t> further) {
  for (const auto& message : reader.Take()) {
    const std::int64_t stamp_ns = dds::StampNs(message.header.stamp);
    const bool ok = dds::Text(message.status) == ToString(StatusCode::kOk);
    Parts& parts = PartsAt(stamp_ns);
    Report& report = (further ? parts.further[*further] : parts.report).emplace();
    report = {std::string(dds::Text(message.device)),
              ok ? Status::Ok()
                 : Status(StatusCode::kNoRobotSeen,
                          "perception reports " + std::string(dds::Text(message.status)) + ", " +
                              std::string(dds::Text(message.reason))),
              message.contacts,
              dds::ToPicture(message.picture),
              {}};
    Eigen::Isometry3d T_first_camera;
    if (dds::FromPose(message.camera_in_first, &T_first_camera)) {
      report.T_first_camera = T_first_camera;
    }
    PassOn(stamp_ns);
  }
}

/// The clouds of all cameras. Without further ones in the settings they are the first's alone.
Status CloudSource::Split(const Parts& parts, SeenCloud* seen) const {
  if (further_.empty()) {
    seen->cloud = parts.cloud->points;
    return Status::Ok();
  }
  std::vector<Eigen::Isometry3d> T_camera_first;
  for (const std::optional<Report>& report : parts.further) {
    if (!report->T_first_camera) {
      return {StatusCode::kInvalidInput,
              further_[T_camera_first.size()]->ros_name() + ": camera_in_first is no pose"};
    }
    T_camera_first.push_back(report->T_first_camera->inverse());
  }
  std::vector<rgbd::SensedCloud> clouds;
  const Status status = dds::SplitCloud(*parts.cloud, T_camera_first, &clouds);
  if (!status.ok()) return {status.code(), "/perception/robot_cloud: " + status.message()};
  if (clouds.front().Count() == 0) {
    return {StatusCode::kNoRobotSeen, "the first camera does not see the robot"};
  }
  seen->cloud = std::move(clouds.front());
  for (std::size_t k = 0; k < parts.further.size(); ++k) {
    seen->further.push_back({std::move(clouds[k + 1]), parts.further[k]->picture});
  }
  return Status::Ok();
}

void CloudSource::PassOn(std::int64_t stamp_ns) {
  if (!pending_.at(stamp_ns).is_complete()) return;
  const Parts whole = std::move(pending_.extract(stamp_ns).mapped());
  const Report& report = *whole.report;
  if (std::exchange(device_, report.device) != report.device) events_.other_camera(report.device);
  if (!whole.status.ok()) return events_.refused(whole.status);
  if (!report.status.ok()) return events_.refused(report.status);
  if (report.contacts > 0 && !allow_contacts_) {
    return events_.refused({StatusCode::kInvalidInput, "perception detects a contact"});
  }
  SeenCloud seen{.stamp_ns = stamp_ns, .cloud = {}, .picture = report.picture, .further = {}};
  if (Status status = Split(whole, &seen); !status.ok()) return events_.refused(status);
  events_.seen(std::move(seen));
}

}  // namespace palpate::calibration
