// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/named_markers.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "libs/dds/message.hpp"
#include "palpate_msgs/msg/Marker3.hpp"

namespace palpate::dds {
namespace {

using ::testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
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
  markers[1].position_m = {kNan, 0.0, 0.0};
  return message;
}

template <typename Change>
std::string RefusalAfter(const Change& change) {
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
}

TEST(NamedMarkers, AreRefusedWhereTheyCannotBeUsed) {
  using Marker = idl::palpate_msgs::Marker3;
  EXPECT_EQ(RefusalAfter([](Marker&) {}), "");
  EXPECT_THAT(RefusalAfter([](Marker& m) { SetText(m.name, "m33"); }),
              HasSubstr("unknown marker 'm33' (did you mean 'm3'?)"));
  EXPECT_THAT(RefusalAfter([](Marker& m) { SetText(m.name, "m1"); }),
              HasSubstr("'m1' comes twice"));
  EXPECT_THAT(RefusalAfter([](Marker& m) { m.position_m.y = kNan; }),
              HasSubstr("'m3' is not finite"));
  EXPECT_THAT(RefusalAfter([](Marker& m) { m.sigma_m.y = kNan; }), HasSubstr("'m3' is not finite"));
  EXPECT_THAT(RefusalAfter([](Marker& m) { m.sigma_m.y = -1.0; }), HasSubstr("'m3' is not finite"));
}

}  // namespace
}  // namespace palpate::dds
