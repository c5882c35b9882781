// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/driver_streams.hpp"

#include <algorithm>
#include <utility>

#include "components/perception/node/convert_driver.hpp"
#include "components/perception/node/image_size.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/seconds.hpp"
#include "libs/core/text.hpp"
#include "libs/dds/driver_topics.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/geometry/pose_text.hpp"

namespace palpate::perception {

namespace {

using Clock = std::chrono::steady_clock;

// A driver has one epoch: what changes is read from its messages.
constexpr std::uint32_t kEpoch = 1;

/// The row of `name` with the QoS that drivers offer: never latched.
dds::TopicSettings DriverQos(const dds::TopicTable& table, std::string_view name,
                             const CameraConfig& config) {
  dds::TopicSettings qos = table.At(name);
  qos.durability = dds::Durability::kVolatile;
  qos.reliability = config.reliability == "reliable" ? dds::Reliability::kReliable
                                                     : dds::Reliability::kBestEffort;
  qos.deadline_s.reset();
  return qos;
}

std::optional<Eigen::Isometry3d> GivenPose(const CameraConfig& config) {
  if (config.T_depth_color.empty()) return std::nullopt;
  return geometry::ReadPose(app::ParseYaml(config.T_depth_color, "camera.T_depth_color"));
}

}  // namespace

std::vector<std::string> WithTransports(std::vector<std::string> rules) {
  const std::size_t given = rules.size();
  for (std::size_t i = 0; i < given; ++i) {
    const std::size_t sign = rules[i].find(":=");
    const std::string from = rules[i].substr(0, sign);
    if (!from.starts_with("/camera")) continue;
    const bool depth = from.ends_with("/depth/image_raw");
    if (!depth && !from.ends_with("/color/image_raw")) continue;
    const std::string transport = depth ? "/compressedDepth" : "/compressed";
    const std::string packed = from + transport + ":=";
    const bool known = std::any_of(rules.begin(), rules.end(), [&](const std::string& rule) {
      return rule.starts_with(packed);
    });
    if (!known) rules.push_back(packed + rules[i].substr(sign + 2) + transport);
  }
  return rules;
}

DriverStreams::DriverStreams(dds::Participant& participant, dds::WaitSet& loop,
                             const CameraConfig& config, double wait_s, double largest_z_m,
                             StreamEvents events, const std::string& camera)
    : config_(config),
      of_(dds::TopicsOf(camera)),
      wait_s_(wait_s),
      largest_z_m_(largest_z_m),
      events_(std::move(events)),
      depth_infos_(ReaderOf(participant, of_.depth_lens)),
      transforms_(participant.CreateReader(dds::kTfStaticTopic)),
      moving_transforms_(participant.CreateReader(dds::kTfTopic)),
      camera_(GivenPose(config), config.baseline_m),
      pairing_(FromSeconds(wait_s), config.pairing_tolerance_s) {
  const bool packed = config.transport == "compressed";
  if (packed) {
    packed_depths_.emplace(ReaderOf(participant, of_.packed_depth));
  } else {
    depths_.emplace(ReaderOf(participant, of_.depth));
  }
  camera_.depth().image_topic = depths().ros_name();
  camera_.depth().info_topic = depth_infos_.ros_name();
  loop.Attach(depths(), [this] { TakeDepth(); });
  loop.Attach(depth_infos_, [this] { TakeInfos(); });
  loop.Attach(transforms_, [this] { TakeInfos(); });
  loop.Attach(moving_transforms_, [this] { TakeInfos(); });
  if (!config.use_color) return;
  if (packed) {
    packed_colors_.emplace(ReaderOf(participant, of_.packed_color));
  } else {
    colors_.emplace(ReaderOf(participant, of_.color));
  }
  color_infos_.emplace(ReaderOf(participant, of_.color_lens));
  camera_.color().image_topic = colors()->ros_name();
  camera_.color().info_topic = color_infos_->ros_name();
  loop.Attach(*colors(), [this] { TakeColor(); });
  loop.Attach(*color_infos_, [this] { TakeInfos(); });
}

template <typename T>
dds::Reader<T> DriverStreams::ReaderOf(dds::Participant& participant,
                                       const dds::Topic<T>& topic) const {
  const dds::TopicSettings qos = DriverQos(participant.table(), topic.name, config_);
  return participant.CreateReaderAs(topic, qos, {}, of_.name);
}

const dds::Endpoint& DriverStreams::depths() const {
  if (packed_depths_) return *packed_depths_;
  return *depths_;
}

const dds::Endpoint* DriverStreams::colors() const {
  if (packed_colors_) return &*packed_colors_;
  return colors_ ? &*colors_ : nullptr;
}

void DriverStreams::ExpectInputs(dds::InputMonitor& inputs) {
  const auto expect = [&](const dds::Endpoint& reader) {
    inputs.Expect(reader,
                  dds::InputName{.publisher = "the camera's driver (under another name: --remap)",
                                 .qos_setting = "camera.reliability"});
  };
  expect(depths());
  expect(depth_infos_);
  if (colors() == nullptr) return;
  expect(*colors());
  expect(*color_infos_);
}

void DriverStreams::TakeInfos() {
  for (const auto& message : transforms_.Take()) (void)camera_.AddTransforms(message);
  for (const auto& message : moving_transforms_.Take()) (void)camera_.AddTransforms(message);
  for (const auto& message : depth_infos_.Take()) camera_.depth().SetInfo(message);
  if (!color_infos_) return;
  for (const auto& message : color_infos_->Take()) camera_.color().SetInfo(message);
}

template <typename Message>
void DriverStreams::AddDepth(const Message& message) {
  CountDepth();
  FrameSet set;
  set.stamp_ns = dds::StampNs(message.header.stamp);
  if (set.stamp_ns == pairing_.last_stamp_ns()) return events_.repeated(set.stamp_ns);
  camera_.depth().frame = dds::Text(message.header.frame_id);
  const Status status = FromDriverDepth(message, config_.depth_unit_m, largest_z_m_,
                                        &set.depth.emplace(), &depth_unit_m_);
  if (!status.ok()) set.status = {status.code(), depths().ros_name() + ": " + status.message()};
  set.facts = {counter_++, kEpoch, 0};
  pairing_.AddDepth(std::move(set), Clock::now());
}

void DriverStreams::TakeDepth() {
  TakeInfos();
  if (depths_) {
    for (const auto& message : depths_->Take()) AddDepth(message);
  } else {
    for (const auto& message : packed_depths_->Take()) AddDepth(message);
  }
  events_.changed();
}

template <typename Message>
void DriverStreams::AddColor(const Message& message) {
  camera_.color().frame = dds::Text(message.header.frame_id);
  rgbd::ColorImage image;
  Status status = FromDriverColor(message, &image);
  if (!status.ok()) status = {status.code(), colors()->ros_name() + ": " + status.message()};
  pairing_.AddColor(dds::StampNs(message.header.stamp), std::move(image), status);
}

void DriverStreams::TakeColor() {
  TakeInfos();
  if (colors_) {
    for (const auto& message : colors_->Take()) AddColor(message);
  } else {
    for (const auto& message : packed_colors_->Take()) AddColor(message);
  }
  events_.changed();
}

/// Not of a camera that has no colour: nobody publishes it, and none has come before.
bool DriverStreams::AwaitsColor() const {
  return colors() != nullptr && (colors()->matched() > 0 || !camera_.color().frame.empty());
}

/// Drivers publish the first camera_info just after its image.
bool DriverStreams::AwaitsInfo() const {
  return !camera_.depth().lens || (AwaitsColor() && !camera_.color().lens);
}

std::optional<FrameSet> DriverStreams::Take(Time now) {
  const auto overdue = pairing_.NextOverdue();
  if (AwaitsInfo() && overdue && now < *overdue) return std::nullopt;
  return pairing_.Take(AwaitsColor(), now);
}

Status DriverStreams::Examine(const FrameSet& set, rgbd::RgbdCamera* camera) {
  if (!set.status.ok()) return set.status;
  const Status known = camera_.CameraOf(set.color.has_value(), depth_unit_m_, camera);
  if (!known.ok()) return known;
  if (Status size = CheckDepthSize(*set.depth, camera->depth); !size.ok()) return size;
  if (set.color) return CheckColorSize(*set.color, camera->color);
  if (!AwaitsColor()) return Status::Ok();
  const auto tolerance_ns = pairing_.tolerance_ns();
  return {StatusCode::kStale,
          tolerance_ns
              ? "nothing on " + colors()->ros_name() + " within " +
                    FormatNumber(1e-6 * static_cast<double>(*tolerance_ns)) +
                    " ms of this stamp (camera.pairing_tolerance_s)"
              : "nothing on " + colors()->ros_name() + " within " + FormatNumber(wait_s_) + " s"};
}

}  // namespace palpate::perception
