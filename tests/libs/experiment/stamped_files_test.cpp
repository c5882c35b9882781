// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/stamped_files.hpp"

#include "tests/support/test_folder.hpp"

namespace palpate::experiment {
namespace {

using test_support::MessageOf;
using test_support::TestFolder;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

std::optional<std::int64_t> Seconds_ns(std::string_view text) {
  std::int64_t t_ns = -1;
  return ParseSeconds_ns(text, &t_ns) ? std::optional(t_ns) : std::nullopt;
}

TEST(StampedFiles, SecondsAreReadWithoutTheRoundingOfADouble) {
  EXPECT_EQ(Seconds_ns("1305031453.374112"), 1305031453374112000);
  EXPECT_EQ(Seconds_ns("899.011149430"), 899011149430);
  EXPECT_EQ(Seconds_ns("3"), 3000000000);
  EXPECT_EQ(Seconds_ns("0.0000000016"), 2);
}

// As numpy.savetxt writes them.
TEST(StampedFiles, SecondsMayHaveAnExponent) {
  EXPECT_EQ(Seconds_ns("0.000000000000000000e+00"), 0);
  EXPECT_EQ(Seconds_ns("3.333333333333333287e-02"), 33333333);
  EXPECT_EQ(Seconds_ns("6.666666666666666574e-02"), 66666667);
  EXPECT_EQ(Seconds_ns("1.305031453374112e+09"), 1305031453374112000);
  EXPECT_EQ(Seconds_ns("1E1"), 10000000000);
}

TEST(StampedFiles, RefusesWhatIsNoTime) {
  for (const char* text : {"", "-1", "1e", "1e99", "1.5.2", "x", "1,5", "e5", "99999999999"}) {
    EXPECT_EQ(Seconds_ns(text), std::nullopt) << text;
  }
}

class StampedFolder : public testing::Test {
 protected:
  std::vector<std::int64_t> Times_ns(const std::vector<std::string>& names,
                                     std::optional<double> rate_Hz = {}) {
    for (const std::string& name : names) folder_.Write("clouds/" + name, "x");
    std::vector<std::int64_t> times_ns;
    for (const StampedFile& file : ListStampedFiles(
             folder_ / "clouds",
             {.extensions = {".ply"}, .skip_others = false, .frame_rate_Hz = rate_Hz})) {
      times_ns.push_back(file.t_ns);
    }
    return times_ns;
  }

  TestFolder folder_;
};

TEST_F(StampedFolder, NamesAreNanosecondsOrSecondsWithAPoint) {
  EXPECT_THAT(Times_ns({"2000000000.ply", "1500000000.PLY", "1.25.ply"}),
              ElementsAre(1250000000, 1500000000, 2000000000));
}

TEST_F(StampedFolder, NumbersOfFramesAreRefused) {
  EXPECT_THAT(MessageOf([&] {
                Times_ns({"0001.ply", "0002.ply", "0003.ply"});
              }),
              AllOf(HasSubstr("0001.ply to 0003.ply look like numbers of frames"),
                    HasSubstr("frame_rate_Hz")));
}

TEST_F(StampedFolder, OtherUnitsOfTimeAreNamed) {
  const auto message = [](const std::vector<std::string>& names) {
    const TestFolder folder;
    for (const std::string& name : names) folder.Write(name, "x");
    return MessageOf([&] {
      ListStampedFiles(folder.path(),
                       {.extensions = {".ply"}, .skip_others = false, .frame_rate_Hz = {}});
    });
  };
  EXPECT_THAT(message({"1712000000.ply", "1712000001.ply"}),
              AllOf(HasSubstr("look like seconds"), HasSubstr("frame_rate_Hz: 1)")));
  EXPECT_THAT(message({"1712000000000.ply", "1712000000033.ply"}),
              AllOf(HasSubstr("look like milliseconds"), HasSubstr("frame_rate_Hz: 1000)")));
  EXPECT_THAT(message({"1712000000000000.ply", "1712000000033333.ply"}),
              AllOf(HasSubstr("look like microseconds"), HasSubstr("frame_rate_Hz: 1000000)")));
  EXPECT_THAT(message({"1712000000000000.ply", "1712000000200000.ply", "1712000000400000.ply"}),
              AllOf(HasSubstr("look like microseconds"), HasSubstr("frame_rate_Hz: 1000000)")));
}

TEST_F(StampedFolder, NumbersOfFramesHaveTimesWithARate) {
  EXPECT_THAT(Times_ns({"frame_0000.ply", "frame_0003.ply"}, 30.0), ElementsAre(0, 100000000));
}

TEST_F(StampedFolder, ASingleFrameNumberIsRefusedAndTimeZeroIsNot) {
  EXPECT_THAT(Times_ns({"0.ply"}), ElementsAre(0));
  const TestFolder other;
  other.Write("000001.ply", "x");
  EXPECT_THAT(MessageOf([&] {
                ListStampedFiles(
                    other.path(),
                    {.extensions = {".ply"}, .skip_others = false, .frame_rate_Hz = {}});
              }),
              HasSubstr("numbers of frames"));
}

TEST_F(StampedFolder, SaysWhichNamesAreWanted) {
  EXPECT_THAT(MessageOf([&] { Times_ns({"scan.ply"}); }),
              AllOf(HasSubstr("scan.ply"), HasSubstr("nanoseconds"), HasSubstr("frame_rate_Hz")));
}

TEST_F(StampedFolder, RefusesOtherEndingsAndTwoOfOneTime) {
  EXPECT_THAT(MessageOf([&] {
                Times_ns({"1.5.ply", "1500000000.ply"});
              }),
              HasSubstr("has the same time as"));
  EXPECT_THAT(MessageOf([&] { Times_ns({"1000000000.xyz"}); }), HasSubstr("must end in .ply"));
}

}  // namespace
}  // namespace palpate::experiment
