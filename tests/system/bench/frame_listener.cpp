// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/bench/frame_listener.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

namespace palpate::system_test {

namespace {

constexpr std::size_t kKeptPictures = 4;

template <typename Image>
Image ToImage(const idl::sensor_msgs::Image& message, const char* encoding) {
  EXPECT_EQ(dds::Text(message.encoding), encoding);
  Image image(static_cast<int>(message.width), static_cast<int>(message.height));
  const std::size_t bytes = image.values.size() * sizeof(image.values[0]);
  EXPECT_EQ(message.data._length, bytes);
  if (message.data._length == bytes) std::memcpy(image.values.data(), message.data._buffer, bytes);
  return image;
}

}  // namespace

FrameListener::FrameListener()
    : node_("frame_listener"),
      depth_(node_.participant.CreateReader(dds::kDepthImageTopic)),
      color_(node_.participant.CreateReader(dds::kColorImageTopic)),
      info_(node_.participant.CreateReader(dds::kFrameInfoTopic)),
      mesh_states_(node_.participant.CreateReader(dds::kTrueMeshStateTopic)),
      status_(node_.participant.CreateReader(dds::kComponentStatusTopic)) {
  node_.loop.Attach(depth_, [this] { TakeDepth(); });
  node_.loop.Attach(color_, [this] { TakeColor(); });
  node_.loop.Attach(info_, [this] { TakeInfo(); });
  node_.loop.Attach(mesh_states_, [this] { TakeStates(); });
  node_.loop.Attach(status_, [this] { TakeStatus(); });
}

std::size_t FrameListener::CompleteCount() const {
  return static_cast<std::size_t>(std::count_if(
      frames_.begin(), frames_.end(), [](const auto& entry) { return entry.second.complete(); }));
}

std::uint32_t FrameListener::LastEpoch() const {
  const auto told = std::find_if(frames_.rbegin(), frames_.rend(),
                                 [](const auto& entry) { return entry.second.has_info; });
  return told == frames_.rend() ? 0 : told->second.epoch;
}

FrameListener::Clock::time_point FrameListener::LastArrival() const {
  return frames_.empty() ? Clock::time_point() : frames_.rbegin()->second.arrival;
}

void FrameListener::Forget() {
  frames_.clear();
  states_.clear();
  reports_.clear();
}

FrameListener::FrameSet& FrameListener::SetOf(const idl::std_msgs::Header& header) {
  FrameSet& set = frames_[dds::StampNs(header.stamp)];
  set.arrival = Clock::now();
  if (frames_.size() > kKeptPictures) {
    FrameSet& old = std::prev(frames_.end(), kKeptPictures + 1)->second;
    if (old.depth) old.depth.emplace();
    if (old.color) old.color.emplace();
  }
  return set;
}

void FrameListener::TakeDepth() {
  for (const auto& message : depth_.Take()) {
    SetOf(message.header).depth = ToImage<rgbd::DepthImage>(message, "16UC1");
  }
}

void FrameListener::TakeColor() {
  for (const auto& message : color_.Take()) {
    SetOf(message.header).color = ToImage<rgbd::ColorImage>(message, "rgb8");
  }
}

void FrameListener::TakeInfo() {
  for (const auto& message : info_.Take()) {
    FrameSet& set = SetOf(message.header);
    set.has_info = true;
    set.epoch = message.epoch;
    set.frame_id = message.frame_id;
  }
}

void FrameListener::TakeStates() {
  for (const auto& message : mesh_states_.Take()) {
    states_.insert(dds::StampNs(message.header.stamp));
  }
}

void FrameListener::TakeStatus() {
  for (const auto& message : status_.Take()) {
    if (dds::Text(message.component_name) != "capture") continue;
    reports_.push_back({Clock::now(), std::string(dds::Text(message.status)),
                        std::string(dds::Text(message.reason))});
  }
}

}  // namespace palpate::system_test
