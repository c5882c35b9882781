// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/model/disagreement.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace palpate::perception {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const double kNothing = std::numeric_limits<double>::quiet_NaN();

TEST(Disagreement, NamesTheFactorOfAWrongUnit) {
  EXPECT_THAT(Disagreement({}, 0.1, {}),
              AllOf(HasSubstr("its depths are 10 times too near"),
                    HasSubstr("is unit_m of camera.yaml 10 times too small")));
  EXPECT_THAT(Disagreement({}, 1000.0, {}),
              AllOf(HasSubstr("1000 times too far"), HasSubstr("times too large")));
  EXPECT_THAT(Disagreement({.agree = 3, .seen = 40, .hidden = 2}, 5.0, {}),
              HasSubstr("5 times too far"));
}

TEST(Disagreement, SaysWhatIsWrongInsteadOfTheUnit) {
  EXPECT_THAT(Disagreement({}, kNothing, {}), HasSubstr("no pixel has a depth where"));
  EXPECT_THAT(Disagreement({}, 1.1, {}), HasSubstr("out of range, min_z_m 0.1 to max_z_m"));
  EXPECT_THAT(Disagreement({.hidden = 500}, 0.8, {}), HasSubstr("hides all of its 500 pixels"));
  EXPECT_THAT(Disagreement({.agree = 300, .seen = 2000}, 1.0, {}),
              AllOf(HasSubstr("only 300 of 2000"), HasSubstr("is the camera's pose right?")));
  EXPECT_THAT(Disagreement({.agree = 10, .seen = 2000}, 1.0, {}),
              AllOf(HasSubstr("10 of 2000"), HasSubstr("at least 200 must")));
}

/// "11 of 11 pixels do" cannot stand behind "does not agree".
TEST(Disagreement, NeverContradictsItself) {
  for (const std::int64_t seen : {0, 1, 11, 199, 200, 1000}) {
    for (const std::int64_t agree : {std::int64_t{0}, seen / 10, seen / 2, seen}) {
      if (agree >= Config{}.model.min_robot_pixels && 4 * agree >= seen) continue;  // agrees
      for (const std::int64_t hidden : {0, 7, 3000}) {
        const std::string text = Disagreement({agree, seen, hidden}, 1.0, {});
        SCOPED_TRACE(text);
        const std::string all = std::to_string(seen) + " of " + std::to_string(seen) + " ";
        const bool says_none = text.find("does not agree") != std::string::npos;
        EXPECT_FALSE(says_none && text.find(all) != std::string::npos);
        EXPECT_THAT(text, Not(HasSubstr("0 of 0")));
      }
    }
  }
  EXPECT_THAT(Disagreement({.agree = 11, .seen = 11}, 1.0, {}),
              AllOf(HasSubstr("too few pixels show the robot: 11 of 11"), HasSubstr("at least 200"),
                    HasSubstr("bring the camera nearer")));
}

TEST(NothingInRange, TellsNoDepthFromDepthOutOfRange) {
  EXPECT_EQ(NothingInRange({.invalid_depth = 100}, kNothing, {}),
            "no pixel of the depth image has a value");
  EXPECT_THAT(NothingInRange({.out_of_range = 100}, kNothing, {}),
              AllOf(HasSubstr("min_z_m 0.1"), HasSubstr("is the unit of depth right")));
  EXPECT_THAT(NothingInRange({.out_of_range = 100}, 0.1, {}),
              HasSubstr("its depths are 10 times too near"));
}

}  // namespace
}  // namespace palpate::perception
