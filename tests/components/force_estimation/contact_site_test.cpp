// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/contact_site.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "libs/core/error.hpp"

namespace palpate::force_estimation {
namespace {

std::string RefusalOf(const std::vector<std::string>& texts) {
  try {
    ParseContactSites(texts);
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing was refused";
}

TEST(ContactSite, ReadsPlacePatchAndDirection) {
  const auto sites = ParseContactSites(
      {" tip : 0, 0.015,0.03", "hand: 1e-2, -2, 3, 0.005", "w: 0, 0, 1, 0.002 along 0, 3, -4"});
  ASSERT_EQ(sites.size(), 3U);
  EXPECT_EQ(sites[0].name, "tip");
  EXPECT_EQ(sites[0].position_m, Eigen::Vector3d(0.0, 0.015, 0.03));
  EXPECT_EQ(sites[0].patch_radius_m, 0.0);
  EXPECT_TRUE(sites[0].direction.isZero());
  EXPECT_EQ(sites[1].position_m, Eigen::Vector3d(0.01, -2.0, 3.0));
  EXPECT_EQ(sites[1].patch_radius_m, 0.005);
  EXPECT_EQ(sites[2].patch_radius_m, 0.002);
  EXPECT_LT((sites[2].direction - Eigen::Vector3d(0.0, 0.6, -0.8)).norm(), 1e-15);
  EXPECT_TRUE(ParseContactSites({}).empty());
}

TEST(ContactSite, RefusesWhatIsNoSite) {
  using testing::AllOf;
  using testing::HasSubstr;
  EXPECT_THAT(RefusalOf({"0, 0, 0"}), AllOf(HasSubstr("has no name"), HasSubstr("the form is")));
  EXPECT_THAT(RefusalOf({" : 0, 0, 0"}), HasSubstr("has no name"));
  EXPECT_THAT(RefusalOf({"a: 0, 0"}), HasSubstr("has 2 numbers"));
  EXPECT_THAT(RefusalOf({"a: 0, 0, 0, 0, 0"}), HasSubstr("has 5 numbers"));
  EXPECT_THAT(RefusalOf({"a: 0, x, 0"}), HasSubstr("holds 'x'"));
  EXPECT_THAT(RefusalOf({"a: 0, nan, 0"}), HasSubstr("not a finite number"));
  EXPECT_THAT(RefusalOf({"a: 0,, 0"}), HasSubstr("not a finite number"));
  EXPECT_THAT(RefusalOf({"a:"}), HasSubstr("not a finite number"));
  EXPECT_THAT(RefusalOf({"a: 0, 0, 0, -1"}), HasSubstr("negative patch radius"));
  EXPECT_THAT(RefusalOf({"a: 0, 0, 0 along 0, 0, 0"}), HasSubstr("length zero"));
  EXPECT_THAT(RefusalOf({"a: 0, 0, 0 along 0, 1"}), HasSubstr("without three components"));
  EXPECT_THAT(RefusalOf({"a: 0, 0, 0", "b: 0, 0, 1", "a: 1, 0, 0"}),
              HasSubstr("'a' is given twice"));
}

}  // namespace
}  // namespace palpate::force_estimation
