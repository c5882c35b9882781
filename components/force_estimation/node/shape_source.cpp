// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/node/shape_source.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "components/force_estimation/node/convert.hpp"
#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/core/seconds.hpp"
#include "libs/dds/camera_topics.hpp"
#include "libs/dds/cloud_messages.hpp"
#include "libs/dds/depth_picture.hpp"
#include "libs/dds/geometry_messages.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/geometry/frames.hpp"

namespace palpate::force_estimation {

namespace {

constexpr double kNsPerSecond = 1e9;

}  // namespace

ShapeSource::ShapeSource(dds::Participant& participant, dds::WaitSet& loop,
                         const std::optional<Eigen::Isometry3d>& T_robot_camera, TakeArrival take,
                         const std::vector<dds::FurtherCamera>& cameras)
    : FrameSource(std::move(take)),
      T_robot_camera_(T_robot_camera),
      clouds_(participant.CreateReader(dds::kRobotCloudTopic)),
      reports_(participant.CreateReader(dds::kPerceptionReportTopic)),
      contacts_(participant.CreateReader(dds::kContactsTopic)),
      clock_(participant.clock()) {
  loop.Attach(clouds_, [this] { TakeClouds(); });
  loop.Attach(reports_, [this] { TakeReports(reports_, std::nullopt); });
  loop.Attach(contacts_, [this] { TakeContacts(); });
  for (const dds::FurtherCamera& camera : cameras) {
    const std::size_t number = further_.size();
    PALPATE_CHECK(camera.T_robot_camera.has_value(), camera.name);
    further_.push_back(std::make_unique<Further>(
        Further{camera.name, *camera.T_robot_camera,
                participant.CreateReader(dds::kFurtherPerceptionReportTopic, {}, camera.name)}));
    loop.Attach(further_.back()->reports,
                [this, number] { TakeReports(further_[number]->reports, number); });
  }
  if (T_robot_camera) return;
  transforms_.emplace(Transforms{participant.CreateReader(dds::kTfStaticTopic),
                                 participant.CreateReader(dds::kTfTopic)});
  loop.Attach(transforms_->at_rest, [this] { TakeTransforms(transforms_->at_rest); });
  loop.Attach(transforms_->moving, [this] { TakeTransforms(transforms_->moving); });
}

void ShapeSource::ExpectInputs(dds::InputMonitor& inputs) const {
  const std::string publisher = "palpate-perception";
  inputs.Expect(clouds_, publisher);
  inputs.Expect(reports_, publisher);
  inputs.Expect(contacts_, publisher);
  for (const auto& camera : further_) inputs.Expect(camera->reports, publisher);
}

uint32_t ShapeSource::incompatible_qos() const {
  uint32_t count = clouds_.counters().incompatible_qos + reports_.counters().incompatible_qos +
                   contacts_.counters().incompatible_qos;
  for (const auto& camera : further_) count += camera->reports.counters().incompatible_qos;
  return count;
}

bool ShapeSource::Parts::is_complete() const {
  const bool all = std::all_of(further.begin(), further.end(),
                               [](const auto& of_camera) { return of_camera.has_value(); });
  return cloud && report && contacts && all;
}

/// Incomplete frames are dropped: they were taken from the old camera pose.
void ShapeSource::SetCalibration(const robot::CalibrationFile& calibration) {
  for (const auto& further : further_) {
    for (const robot::CalibratedCamera& camera : calibration.cameras) {
      if (camera.name != further->name) continue;
      further->T_robot_camera = camera.pose.T_robot_camera;
      further->depth_bias = camera.depth_bias;
    }
  }
  if (!calibration.pose) return;
  T_robot_camera_ = calibration.pose->T_robot_camera;
  is_calibrated_ = true;
  depth_bias_ = calibration.depth_bias;
  dropped_ += pending_.size();
  pending_.clear();
}

/// nullptr for parts of the last frame that was handed over.
ShapeSource::Parts* ShapeSource::PartsAt(int64_t stamp_ns) {
  if (last_ && stamp_ns == last_->stamp_ns) return nullptr;
  const auto found = std::find_if(pending_.begin(), pending_.end(),
                                  [&](const Parts& parts) { return parts.stamp_ns == stamp_ns; });
  if (found != pending_.end()) return &*found;
  if (pending_.size() == kMostPending) {
    pending_.pop_front();
    ++dropped_;
  }
  Parts& parts = pending_.emplace_back();
  parts.stamp_ns = stamp_ns;
  parts.further.resize(further_.size());
  return &parts;
}

void ShapeSource::TakeClouds() {
  for (const auto& message : clouds_.Take()) {
    Parts* parts = PartsAt(dds::StampNs(message.header.stamp));
    if (!parts) continue;
    Status status = dds::CheckFrameId(message.header, geometry::kCameraDepthOpticalFrame);
    if (status.ok()) status = FromCloud(message, &parts->cloud.emplace());
    if (status.ok()) status = CheckIsNew(message, parts->cloud->points);
    if (!status.ok()) {
      parts->cloud.emplace();
      parts->status = {status.code(), "/perception/robot_cloud: " + status.message()};
    }
  }
  HandOverComplete();
}

Status ShapeSource::FromCloud(const idl::sensor_msgs::PointCloud2& message,
                              dds::JoinedCloud* cloud) const {
  if (further_.empty()) return dds::FromPointCloud2(message, &cloud->points);
  return dds::FromJoinedPointCloud2(message, cloud);
}

/// By the poses of perception when it joined them: a calibration may have come since.
void ShapeSource::SplitCloud(Parts* parts) const {
  if (further_.empty()) {
    parts->clouds.push_back(std::move(parts->cloud->points));
    return;
  }
  std::vector<Eigen::Isometry3d> T_camera_first;
  for (const std::optional<Report>& report : parts->further) {
    T_camera_first.push_back(report->T_first_camera.inverse());
  }
  const Status status = dds::SplitCloud(*parts->cloud, T_camera_first, &parts->clouds);
  if (!status.ok()) {
    parts->status = {status.code(), "/perception/robot_cloud: " + status.message()};
  }
}

/// Points that come again under a new stamp are no measurement: forces of them would be those of
/// the past.
Status ShapeSource::CheckIsNew(const idl::sensor_msgs::PointCloud2& message,
                               const rgbd::SensedCloud& points) {
  if (points.Count() == 0) return Status::Ok();
  const auto sum_m = static_cast<double>(points.points_m.row(2).mean());
  const std::string_view bytes(reinterpret_cast<const char*>(message.data._buffer),
                               message.data._length);
  if (!repetition_.IsRepeated(bytes, sum_m)) return Status::Ok();
  return {StatusCode::kStale,
          "the points are those before, bit for bit, under a new stamp: perception is stuck"};
}

/// `further`: number of the camera beside the first; nullopt: the report of the whole frame.
void ShapeSource::TakeReports(dds::Reader<idl::palpate_msgs::PerceptionReport>& reader,
                              std::optional<std::size_t> further) {
  for (const auto& message : reader.Take()) {
    const int64_t stamp_ns = dds::StampNs(message.header.stamp);
    Parts* parts = PartsAt(stamp_ns);
    if (!parts) continue;
    std::optional<Report>& report = further ? parts->further[*further] : parts->report;
    report = Report{{stamp_ns, message.epoch, std::string(dds::Text(message.device)),
                     dds::ToPicture(message.picture)},
                    message.frame_counter,
                    StatusOfPerception(message),
                    message.age_s,
                    {},
                    Eigen::Isometry3d::Identity()};
    Status status = FromTexture(message, &report->texture);
    if (further && !dds::FromPose(message.camera_in_first, &report->T_first_camera)) {
      status = {StatusCode::kInvalidInput, "camera_in_first is no pose"};
    }
    if (!status.ok()) {
      parts->status = {status.code(), reader.ros_name() + ": " + status.message()};
    }
  }
  HandOverComplete();
}

void ShapeSource::TakeContacts() {
  for (const auto& message : contacts_.Take()) {
    Parts* parts = PartsAt(dds::StampNs(message.header.stamp));
    if (!parts) {
      HandOver({.frame = RepeatedFrame{last_head_}, .counts = false});
      continue;
    }
    Status status = dds::CheckFrameId(message.header, geometry::kCameraDepthOpticalFrame);
    if (status.ok()) {
      status = FromContactArray(message, T_robot_camera_.value_or(Eigen::Isometry3d::Identity()),
                                &parts->contacts.emplace());
    }
    if (!status.ok()) {
      parts->contacts.emplace();
      parts->status = {status.code(), "/perception/contacts: " + status.message()};
    }
  }
  HandOverComplete();
}

/// Perception, which segments by the same pose, refuses the frames of a camera that moves.
void ShapeSource::TakeTransforms(dds::Reader<idl::tf2_msgs::TFMessage>& reader) {
  for (const auto& message : reader.Take()) {
    // One that is none leaves the camera where the others have it.
    (void)transforms_->tree.Add(message);
  }
  if (is_calibrated_) return;
  const auto T_robot_camera = transforms_->tree.Find(
      std::string(geometry::kRobotFrame), std::string(geometry::kCameraDepthOpticalFrame));
  if (T_robot_camera) T_robot_camera_ = T_robot_camera;
}

/// Hands over complete frames in the order in which they came. Those before a complete one lost a
/// part.
void ShapeSource::HandOverComplete() {
  for (size_t i = 0; i < pending_.size(); ++i) {
    Parts& parts = pending_[i];
    if (!parts.is_complete()) continue;
    Parts complete = std::move(parts);
    dropped_ += i;
    pending_.erase(pending_.begin(), pending_.begin() + ToIndex(i) + 1);
    HandOver(ArrivalOf(std::move(complete)));
    i = static_cast<size_t>(-1);
  }
}

FrameArrival ShapeSource::ArrivalOf(Parts parts) {
  SplitCloud(&parts);
  const Report& report = *parts.report;
  FrameArrival arrival;
  arrival.sequence = SequenceOf(report.origin);
  arrival.delay_s = NsToSeconds(clock_->NowOfFrames_ns() - parts.stamp_ns) - report.age_s;
  last_head_ = {parts.stamp_ns, report.frame_counter, report.origin.device,
                dds::WaitSet::Clock::now()};
  const Status status = Check(parts);
  if (status.ok()) {
    arrival.frame = InputOf(std::move(parts));
  } else {
    arrival.frame = RefusedFrame{last_head_, status};
  }
  return arrival;
}

/// State does not hold for another camera, or for one that was started again from the beginning. It
/// holds for one that was reopened: its epoch rises.
std::optional<SequenceStart> ShapeSource::SequenceOf(const Origin& origin) {
  const bool back = last_ && origin.stamp_ns <= last_->stamp_ns;
  const bool unrelated =
      !last_ || origin.device != last_->device || (back && origin.epoch <= last_->epoch);
  last_ = origin;
  if (unrelated) repetition_.Forget();
  if (!back && !unrelated) return std::nullopt;
  return SequenceStart{back, unrelated};
}

Status ShapeSource::Check(const Parts& parts) const {
  if (!parts.status.ok()) return parts.status;
  if (!T_robot_camera_) {
    return {StatusCode::kNoCalibration,
            "where the camera stands is not known: no camera_pose is set, nothing has come on "
            "/calibration, and /tf and /tf_static do not join 'robot' with "
            "'camera_depth_optical_frame'"};
  }
  for (std::size_t k = 0; k < further_.size(); ++k) {
    if (!further_[k]->depth_bias || !parts.further[k]->perception.ok()) continue;
    const Status status =
        robot::CheckDepthPicture(*further_[k]->depth_bias, parts.further[k]->origin.picture);
    if (!status.ok()) {
      return {status.code(), "camera '" + further_[k]->name + "': " + status.message()};
    }
  }
  // Perception has seen the robot where any camera does.
  const bool is_seen = further_.empty() || parts.clouds.front().Count() > 0;
  if (!depth_bias_ || !parts.report->perception.ok() || !is_seen) return Status::Ok();
  return robot::CheckDepthPicture(*depth_bias_, parts.report->origin.picture);
}

FrameInput ShapeSource::InputOf(Parts parts) const {
  FrameInput input;
  input.head = last_head_;
  auto& shape = input.frame.emplace<PerceivedShape>();
  shape.perception = parts.report->perception;
  shape.frame.t_s = static_cast<double>(parts.stamp_ns) / kNsPerSecond;
  shape.frame.views.resize(1 + further_.size());
  shape.frame.views[0].T_robot_camera = *T_robot_camera_;
  shape.frame.views[0].texture = std::move(parts.report->texture);
  for (std::size_t k = 0; k < further_.size(); ++k) {
    shape.frame.views[k + 1].T_robot_camera = further_[k]->T_robot_camera;
    shape.frame.views[k + 1].texture = std::move(parts.further[k]->texture);
  }
  for (std::size_t k = 0; k < shape.frame.views.size(); ++k) {
    shape.frame.views[k].cloud = std::move(parts.clouds[k]);
  }
  shape.frame.epoch = parts.report->origin.epoch;
  shape.frame.contacts = std::move(*parts.contacts);
  return input;
}

}  // namespace palpate::force_estimation
