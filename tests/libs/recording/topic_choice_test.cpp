// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/recording/topic_choice.hpp"

#include <gtest/gtest.h>

namespace palpate::recording {
namespace {

TEST(TopicChoice, AStarStandsForAnyCharacters) {
  EXPECT_TRUE(Matches("/camera/depth/image_raw", "/camera/*"));
  EXPECT_TRUE(Matches("/camera/depth/image_raw", "*/image_raw"));
  EXPECT_TRUE(Matches("/camera/depth/image_raw", "/camera/*/image_*"));
  EXPECT_TRUE(Matches("/forces", "/forces"));
  EXPECT_TRUE(Matches("/forces", "*"));
  EXPECT_FALSE(Matches("/forces", "/force"));
  EXPECT_FALSE(Matches("/forces", "/forces/*"));
  EXPECT_FALSE(Matches("", "/*"));
}

TEST(TopicChoice, WithoutNamesAllButTheExcludedAreChosen) {
  const TopicChoice all{{}, {"/camera/*"}};
  EXPECT_TRUE(all.Includes("/forces"));
  EXPECT_FALSE(all.Includes("/camera/depth/image_raw"));
  const TopicChoice some{{"/forces*", "/camera/*"}, {"*image_raw"}};
  EXPECT_TRUE(some.Includes("/forces/contact1/wrench"));
  EXPECT_TRUE(some.Includes("/camera/depth/camera_info"));
  EXPECT_FALSE(some.Includes("/camera/depth/image_raw"));
  EXPECT_FALSE(some.Includes("/robot/mesh"));
}

}  // namespace
}  // namespace palpate::recording
