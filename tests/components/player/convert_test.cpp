// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/player/node/convert.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "libs/dds/stamp.hpp"

namespace palpate::player {
namespace {

Event EventWith(std::vector<CableInput> cables) {
  Event event{"a", 1.25, std::move(cables), MarkerSet{}};
  event.markers->counter = 7;
  event.markers->reference = MarkerReference::kUndeformed;
  event.markers->markers = {{"m1", Eigen::Vector3d(0.1, 0.2, 0.3), Eigen::Vector3d(1, 2, 3)},
                            {"m2", std::nullopt, Eigen::Vector3d(1, 2, 3)}};
  return event;
}

TEST(PlayerConvert, MarkersKeepNameFramePlaceNoiseAndReference) {
  const auto message = ToMarkerArray(EventWith({}), 1'250'000'000);
  EXPECT_EQ(dds::Text(message->header.frame_id), "robot");
  EXPECT_EQ(dds::StampNs(message->header.stamp), 1'250'000'000);
  EXPECT_EQ(message->counter, 7u);
  EXPECT_EQ(dds::Text(message->recording), "a");
  EXPECT_EQ(message->reference_shape, palpate_msgs_msg_MarkerArray3_Constants_REFERENCE_UNDEFORMED);
  ASSERT_EQ(message->markers._length, 2u);
  const auto* markers = message->markers._buffer;
  EXPECT_EQ(dds::Text(markers[0].name), "m1");
  EXPECT_TRUE(markers[0].valid);
  EXPECT_EQ(markers[0].position_m.y, 0.2);
  EXPECT_EQ(markers[0].sigma_m.z, 3.0);
  EXPECT_FALSE(markers[1].valid);
}

TEST(PlayerConvert, TheErrorOfThePoseGoesOutWithTheMarkers) {
  Event event = EventWith({});
  EXPECT_EQ(ToMarkerArray(event, 0)->pose_translation_sigma_m, 0.0);
  event.markers->pose_error = {.translation_m = 0.001, .rotation_rad = 0.002};
  event.markers->pose_about_m.z() = 0.5;
  const auto message = ToMarkerArray(event, 0);
  EXPECT_EQ(message->pose_about_m.z, 0.5);
  EXPECT_EQ(message->pose_translation_sigma_m, 0.001);
  EXPECT_EQ(message->pose_rotation_sigma_rad, 0.002);
}

TEST(PlayerConvert, APointThatNobodyNamedGoesOutWithoutAName) {
  Event event = EventWith({});
  event.markers->markers[0].name = std::string(experiment::kUnlabelledPrefix) + "1";
  const auto message = ToMarkerArray(event, 0);
  ASSERT_EQ(message->markers._length, 2u);
  EXPECT_EQ(dds::Text(message->markers._buffer[0].name), "");
  EXPECT_TRUE(message->markers._buffer[0].valid);
  EXPECT_EQ(dds::Text(message->markers._buffer[1].name), "m2");
}

TEST(PlayerConvert, CameraCoordinatesGoUnderTheCamerasFrame) {
  Event event = EventWith({});
  event.markers->frame = experiment::MeasurementFrame::kCamera;
  EXPECT_EQ(dds::Text(ToMarkerArray(event, 0)->header.frame_id), "camera_depth_optical_frame");
}

TEST(PlayerConvert, AnInputThatNoCableHasIsEmptyAndOneThatSomeHaveIsNanForTheOthers) {
  const auto same = ToJointState(EventWith({{"n", 0.01, {}}, {"s", 0.02, {}}}), 0);
  ASSERT_EQ(same->name._length, 2u);
  EXPECT_EQ(dds::Text(same->name._buffer[1]), "s");
  ASSERT_EQ(same->position._length, 2u);
  EXPECT_EQ(same->position._buffer[1], 0.02);
  EXPECT_EQ(same->effort._length, 0u);
  EXPECT_EQ(same->velocity._length, 0u);

  const auto mixed = ToJointState(EventWith({{"n", 0.01, {}}, {"s", {}, 3.0}}), 0);
  EXPECT_EQ(mixed->position._buffer[0], 0.01);
  EXPECT_TRUE(std::isnan(mixed->position._buffer[1]));
  EXPECT_TRUE(std::isnan(mixed->effort._buffer[0]));
  EXPECT_EQ(mixed->effort._buffer[1], 3.0);
}

TEST(PlayerConvert, StampsAreTheRecordedTimeOnTopOfTheStart) {
  EXPECT_EQ(StampOf(EventWith({}), 0.0), 1'250'000'000);
  EXPECT_EQ(StampOf(EventWith({}), 1.7e9), 1'700'000'001'250'000'000);
}

}  // namespace
}  // namespace palpate::player
