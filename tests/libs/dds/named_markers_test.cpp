// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/named_markers.hpp"

#include <gmock/gmock.h>

#include "libs/dds/message.hpp"
#include "palpate_msgs/msg/Marker3.hpp"
#include "tests/support/not_a_number.hpp"

namespace palpate::dds {
namespace {

using ::testing::HasSubstr;

const std::vector<std::string> kNames{"m1", "m2", "m3"};

Message<idl::palpate_msgs::MarkerArray3> TwoMarkers() {
  Message<idl::palpate_msgs::MarkerArray3> message;
  Resize(message->markers, 2);
  auto* markers = message->markers._buffer;
  SetText(markers[0].name, "m3");
  markers[0].position_m = {0.1, 0.2, 0.3};
  markers[0].sigma_m = {1e-4, 2e-4, 3e-4};
  markers[0].valid = true;
  SetText(markers[1].name, "m1");
  markers[1].position_m = {kNaN, 0.0, 0.0};
  return message;
}

template <typename Change>
std::string MarkersRefusalAfter(const Change& change) {
  auto message = TwoMarkers();
  change(message->markers._buffer[0]);
  std::vector<NamedMarker> markers;
  const Status status = FromMarkers(*message, kNames, &markers);
  EXPECT_TRUE(status.ok() || status.code() == StatusCode::kInvalidInput);
  return status.message();
}

TEST(NamedMarkers, AreThoseThatWereSeen) {
  std::vector<NamedMarker> markers(5);
  ASSERT_TRUE(FromMarkers(*TwoMarkers(), kNames, &markers).ok());
  ASSERT_EQ(markers.size(), 1u);
  EXPECT_EQ(markers[0].index, 2u);
  EXPECT_EQ(markers[0].position_m, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(markers[0].sigma_m, Eigen::Vector3d(1e-4, 2e-4, 3e-4));
  EXPECT_TRUE(markers[0].covariance_m2.isApprox(
      Eigen::Matrix3d(Eigen::Vector3d(1e-8, 4e-8, 9e-8).asDiagonal()), 1e-12));
}

TEST(NamedMarkers, HaveTheCovarianceThatComesWithThem) {
  auto message = TwoMarkers();
  Eigen::Matrix3d covariance_m2;
  covariance_m2 << 4e-8, 1e-8, -2e-8, 1e-8, 9e-8, 3e-8, -2e-8, 3e-8, 25e-8;
  Eigen::Map<Eigen::Matrix3d>(message->markers._buffer[0].covariance_m2) = covariance_m2;
  std::vector<NamedMarker> markers;
  ASSERT_TRUE(FromMarkers(*message, kNames, &markers).ok());
  EXPECT_EQ(markers[0].covariance_m2, covariance_m2);
  EXPECT_TRUE(markers[0].sigma_m.isApprox(Eigen::Vector3d(2e-4, 3e-4, 5e-4), 1e-12));
}

TEST(NamedMarkers, MayBeWithoutANameWhereThatIsAllowed) {
  auto message = TwoMarkers();
  for (int k : {0, 1}) SetText(message->markers._buffer[k].name, "");
  message->markers._buffer[1].position_m.x = 0.4;
  message->markers._buffer[1].valid = true;
  std::vector<NamedMarker> markers;
  EXPECT_THAT(FromMarkers(*message, kNames, &markers).message(), HasSubstr("unknown marker ''"));
  ASSERT_TRUE(FromMarkersWithOrWithoutNames(*message, kNames, &markers).ok());
  ASSERT_EQ(markers.size(), 2u);
  EXPECT_FALSE(markers[0].index || markers[1].index);
  EXPECT_EQ(markers[1].position_m.x(), 0.4);
  SetText(message->markers._buffer[1].name, "m33");
  EXPECT_THAT(FromMarkersWithOrWithoutNames(*message, kNames, &markers).message(),
              HasSubstr("did you mean 'm3'"));
  SetText(message->markers._buffer[1].name, "m2");
  ASSERT_TRUE(FromMarkersWithOrWithoutNames(*message, kNames, &markers).ok());
  EXPECT_FALSE(markers[0].index);
  EXPECT_EQ(markers[1].index, 1u);
}

TEST(NamedMarkers, AreRefusedWhereTheyCannotBeUsed) {
  using Marker = idl::palpate_msgs::Marker3;
  EXPECT_EQ(MarkersRefusalAfter([](Marker&) {}), "");
  EXPECT_THAT(MarkersRefusalAfter([](Marker& m) { SetText(m.name, "m33"); }),
              HasSubstr("unknown marker 'm33' (did you mean 'm3'?)"));
  EXPECT_THAT(MarkersRefusalAfter([](Marker& m) { SetText(m.name, "m1"); }),
              HasSubstr("'m1' comes twice"));
  EXPECT_THAT(MarkersRefusalAfter([](Marker& m) { m.position_m.y = kNaN; }),
              HasSubstr("'m3' is not finite"));
  EXPECT_THAT(MarkersRefusalAfter([](Marker& m) { m.sigma_m.y = kNaN; }),
              HasSubstr("'m3' is not finite"));
  EXPECT_THAT(MarkersRefusalAfter([](Marker& m) { m.sigma_m.y = -1.0; }),
              HasSubstr("'m3' is not finite"));
  for (const double off : {kNaN, 1e-3}) {  // of no symmetric matrix
    EXPECT_THAT(MarkersRefusalAfter([&](Marker& m) { m.covariance_m2[1] = off; }),
                HasSubstr("covariance_m2 of marker 'm3' is no covariance"));
  }
  EXPECT_THAT(MarkersRefusalAfter([](Marker& m) { m.covariance_m2[0] = 1e-6; }),
              HasSubstr("no covariance"));
}

}  // namespace
}  // namespace palpate::dds
