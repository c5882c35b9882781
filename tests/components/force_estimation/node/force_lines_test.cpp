// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/node/force_lines.hpp"

#include <gmock/gmock.h>

namespace palpate::force_estimation {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

ContactForce Contact(const std::string& name, double size_N, Status status = Status::Ok()) {
  ContactForce contact;
  contact.status = std::move(status);
  contact.name = name;
  contact.position_m = {0.012, -0.005, 0.080};
  contact.force_N = {0.0, 0.0, -size_N};
  contact.ci95_N = 0.04;
  return contact;
}

ForceEstimate Frame(std::vector<ContactForce> contacts) {
  ForceEstimate estimate;
  estimate.status = contacts.empty() ? Status(StatusCode::kNoContact, "") : Status::Ok();
  estimate.contacts = std::move(contacts);
  return estimate;
}

TEST(ForceLines, NothingIsSaidWhereNoForceIs) {
  ForceLines lines(10.0);
  EXPECT_THAT(lines.Take(11.0), IsEmpty());
  lines.Add(Frame({}));
  lines.Add(Frame({Contact("ball", 0.3, {StatusCode::kUnobservable, "why"})}));
  EXPECT_THAT(lines.Take(12.0), IsEmpty());
}

TEST(ForceLines, AnIntervalHasOneLineWithTheLastValuesAndCounts) {
  ForceLines lines(10.0);
  lines.Add(Frame({}));
  lines.Add(Frame({Contact("ball", 0.3)}));
  lines.Add(Frame({Contact("ball", 0.521), Contact("wall", 0.1, {StatusCode::kHidden, "why"})}));
  EXPECT_THAT(lines.Take(10.5),
              ElementsAre("forces: ball 0.521 +- 0.040 N at (12, -5, 80) mm in 2 of 3 frames; "
                          "wall 0.100 +- 0.040 N at (12, -5, 80) mm (hidden) in 1 of 3 frames; "
                          "6.0 frames/s"));
}

TEST(ForceLines, AForceThatEndsIsSaidOnceWithItsLargestValue) {
  ForceLines lines(10.0);
  lines.Add(Frame({Contact("ball", 0.6)}));
  lines.Add(Frame({Contact("ball", 0.4)}));
  ASSERT_EQ(lines.Take(11.0).size(), 1u);
  lines.Add(Frame({Contact("ball", 0.5)}));
  ASSERT_EQ(lines.Take(12.0).size(), 1u);
  lines.Add(Frame({}));
  EXPECT_THAT(lines.Take(13.0), ElementsAre("force 'ball' ended after 2.0 s, at most 0.600 N"));
  lines.Add(Frame({}));
  EXPECT_THAT(lines.Take(14.0), IsEmpty());
}

TEST(ForceLines, WithoutUsableFramesNoForceEnds) {
  ForceLines lines(10.0);
  lines.Add(Frame({Contact("ball", 0.6)}));
  ASSERT_EQ(lines.Take(11.0).size(), 1u);
  EXPECT_THAT(lines.Take(12.0), IsEmpty());
  ForceEstimate failed = Frame({});
  failed.status = {StatusCode::kNotConverged, "why"};
  lines.Add(failed);
  EXPECT_THAT(lines.Take(13.0), IsEmpty());
  lines.Add(Frame({}));
  EXPECT_THAT(lines.Take(14.0), ElementsAre("force 'ball' ended after 3.0 s, at most 0.600 N"));
}

}  // namespace
}  // namespace palpate::force_estimation
