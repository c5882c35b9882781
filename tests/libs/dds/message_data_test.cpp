// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/message_data.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <string>
#include <vector>

#include "libs/dds/falsify.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/dds/topics.hpp"

namespace palpate::dds {
namespace {

using std::mt19937_64;

Message<idl::palpate_msgs::ContactArray> OneContact() {
  Message<idl::palpate_msgs::ContactArray> contacts;
  SetHeader(contacts->header, 1'000'000'007, "camera");
  contacts->counter = 7;
  Resize(contacts->contacts, 2);
  for (auto& contact : Elements(contacts->contacts)) {
    SetText(contact.name, "contact_1");
    contact.position_m = {0.1, 0.2, 0.3};
    contact.point_count = 11;
    contact.position_covariance_m2[8] = 1e-6;
  }
  return contacts;
}

Message<idl::sensor_msgs::Image> DepthImage(std::uint16_t depth) {
  Message<idl::sensor_msgs::Image> image;
  SetText(image->encoding, "16UC1");
  const std::vector<std::uint8_t> bytes{static_cast<std::uint8_t>(depth & 0xFF),
                                        static_cast<std::uint8_t>(depth >> 8), 0, 0};
  SetNumbers(image->data, bytes.data(), bytes.size());
  return image;
}

TEST(MessageData, ACopyHasAllAndSharesNothing) {
  auto contacts = OneContact();
  std::size_t size = 0;
  const auto copy = CopyOf(*contacts, &size);
  SetText(contacts->contacts._buffer[1].name, "changed");
  contacts->contacts._buffer[1].position_m.x = 0.0;
  EXPECT_GT(size, 2 * sizeof(double) * 15);
  EXPECT_EQ(StampNs(copy->header.stamp), 1'000'000'007);
  ASSERT_EQ(copy->contacts._length, 2u);
  EXPECT_EQ(Text(copy->contacts._buffer[1].name), "contact_1");
  EXPECT_EQ(copy->contacts._buffer[1].position_m.x, 0.1);
  EXPECT_EQ(copy->contacts._buffer[1].position_covariance_m2[8], 1e-6);
}

TEST(MessageData, GarbleReplacesNumbersAndNothingElse) {
  auto contacts = OneContact();
  mt19937_64 random(1);
  Garble(&random, &*contacts);
  EXPECT_EQ(StampNs(contacts->header.stamp), 1'000'000'007);
  EXPECT_EQ(contacts->counter, 7u);
  for (const auto& contact : Elements(contacts->contacts)) {
    EXPECT_EQ(Text(contact.name), "contact_1");
    EXPECT_EQ(contact.point_count, 11u);
    EXPECT_NE(contact.position_m.x, 0.1);
    EXPECT_NE(contact.position_m.z, 0.3);
    EXPECT_NE(contact.position_covariance_m2[0], 0.0);
    EXPECT_NE(contact.position_covariance_m2[8], 1e-6);
  }
}

TEST(MessageData, GarbleReplacesPixels) {
  auto image = DepthImage(4000);
  mt19937_64 random(1);
  const auto before = CopyOf(*image);
  Garble(&random, &*image);
  EXPECT_EQ(Text(image->encoding), "16UC1");
  EXPECT_NE(std::vector(image->data._buffer, image->data._buffer + 4),
            std::vector(before->data._buffer, before->data._buffer + 4));
}

/// Garbles a message of each type that is written on a topic, with one element in its sequences.
template <typename T>
void ExpectGarbled(const Topic<T>& topic, Message<T> message = {}) {
  SCOPED_TRACE(std::string(topic.name));
  mt19937_64 random(1);
  Garble(&random, &*message);
  const auto copy = CopyOf(*message);
  (void)copy;
}

TEST(MessageData, EveryTypeOfData) {
  ExpectGarbled(kDepthCameraInfoTopic);
  ExpectGarbled(kFrameInfoTopic);
  ExpectGarbled(kCameraSetupTopic);
  ExpectGarbled(kPerceptionReportTopic);
  ExpectGarbled(kContactsTopic, OneContact());
  ExpectGarbled(kJointStatesTopic);
  ExpectGarbled(kForcesTopic);
  ExpectGarbled(kWrenchTopic);
  ExpectGarbled(kWrenchesTopic);
  ExpectGarbled(kMeshTopic);
  ExpectGarbled(kCalibrationStatusTopic);
  ExpectGarbled(kBenchStateTopic);
  ExpectGarbled(kRobotDescriptionTopic);

  Message<idl::palpate_msgs::Calibration> calibration;
  Resize(calibration->drives, 1);
  calibration->drives._buffer[0].offset_m = 0.001;
  Resize(calibration->cable_routes, 1);
  ExpectGarbled(kCalibrationTopic, std::move(calibration));

  Message<idl::palpate_msgs::ModelGap> gap;
  Resize(gap->regions, 1);
  ExpectGarbled(kModelGapTopic, std::move(gap));

  Message<idl::palpate_msgs::MeshState> state;
  const std::vector<float> positions_m(300, 0.5F);
  SetNumbers(state->positions_m, positions_m.data(), positions_m.size());
  ExpectGarbled(kMeshStateTopic, std::move(state));
}

TEST(Falsify, ScalesDepthAndLeavesInvalidPixels) {
  auto image = DepthImage(4000);
  Falsify(&*image);
  EXPECT_EQ(image->data._buffer[0] + 256 * image->data._buffer[1], 4200);
  EXPECT_EQ(image->data._buffer[2] + 256 * image->data._buffer[3], 0);
  auto deep = DepthImage(65000);
  Falsify(&*deep);
  EXPECT_EQ(deep->data._buffer[0] + 256 * deep->data._buffer[1], 65535);
}

TEST(Falsify, ShiftsPositions) {
  auto contacts = OneContact();
  Falsify(&*contacts);
  EXPECT_NEAR(contacts->contacts._buffer[1].position_m.x, 0.12, 1e-12);
  EXPECT_EQ(contacts->contacts._buffer[1].position_m.y, 0.2);
  Message<idl::sensor_msgs::JointState> joints;
  const std::vector<double> displacements_m{0.001, std::nan("")};
  SetNumbers(joints->position, displacements_m.data(), displacements_m.size());
  Falsify(&*joints);
  EXPECT_NEAR(joints->position._buffer[0], 0.003, 1e-12);
  EXPECT_TRUE(std::isnan(joints->position._buffer[1]));
}

}  // namespace
}  // namespace palpate::dds
