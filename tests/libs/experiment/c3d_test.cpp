// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <cmath>
#include <cstring>
#include <random>

#include "libs/core/file.hpp"
#include "libs/experiment/captured_markers.hpp"
#include "tests/libs/experiment/c3d_writer.hpp"
#include "tests/support/measured_data.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::experiment {
namespace {

using test_support::MessageOf;
using test_support::TestFolder;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

C3dContent TwoPoints() {
  C3dContent content;
  content.labels = {"tip", "Base - 1"};
  for (int i = 0; i < 20; ++i) {
    C3dContent::Point tip{
        .x = 10.0 + i, .y = -20.0, .z = 0.25 * i, .residual_steps = i, .cameras = 0x55};
    C3dContent::Point base{.x = -1.0, .y = 2.0, .z = 3.0};
    base.seen = i != 7;
    content.frames.push_back({tip, base});
  }
  return content;
}

CapturedMarkers ReadBytes(const std::string& bytes, const C3dOptions& options = {}) {
  const TestFolder folder;
  return ReadC3d(folder.Write("f.c3d", bytes), options);
}

std::string BytesRefusal(const std::string& bytes) {
  return MessageOf([&] { ReadBytes(bytes); });
}

struct Encoding {
  C3dProcessor processor;
  bool real_points;
};

class C3dEncoding : public testing::TestWithParam<Encoding> {};

TEST_P(C3dEncoding, HoldsTheSamePointsInEveryByteOrderAndNumberFormat) {
  C3dContent content = TwoPoints();
  content.processor = GetParam().processor;
  content.real_points = GetParam().real_points;
  content.analog_values_per_frame = 3;
  const CapturedMarkers captured = ReadBytes(WriteC3d(content));
  EXPECT_THAT(captured.tracks.names, ElementsAre("tip", "Base-1"));
  EXPECT_DOUBLE_EQ(captured.rate_Hz, 50.0);
  ASSERT_EQ(captured.tracks.frames.size(), 20u);
  for (std::size_t i = 0; i < 20; ++i) {
    const MarkerFrame& frame = captured.tracks.frames[i];
    const double n = static_cast<double>(i);
    EXPECT_DOUBLE_EQ(frame.t_s, n / 50.0);
    const Eigen::Vector3d expected_m(0.010 + 0.001 * n, -0.020, 0.00025 * n);
    ASSERT_TRUE(frame.positions_m[0].has_value());
    EXPECT_LT((*frame.positions_m[0] - expected_m).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_NEAR(captured.residuals_m[i][0].value(), n * 0.01e-3, 1e-11);
    EXPECT_EQ(captured.cameras[i][0], 0x55);
    EXPECT_EQ(frame.positions_m[1].has_value(), i != 7);
    EXPECT_EQ(captured.residuals_m[i][1].has_value(), i != 7);
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, C3dEncoding,
    testing::Values(Encoding{C3dProcessor::kIntel, true}, Encoding{C3dProcessor::kIntel, false},
                    Encoding{C3dProcessor::kDec, true}, Encoding{C3dProcessor::kDec, false},
                    Encoding{C3dProcessor::kMips, true}, Encoding{C3dProcessor::kMips, false}));

TEST(C3d, ConvertsMillimetresCentimetresAndMetres) {
  C3dContent content = TwoPoints();
  for (const auto& [unit, metres] : {std::pair{"mm", 1e-3}, {"cm", 1e-2}, {"m", 1.0}}) {
    content.unit = unit;
    const CapturedMarkers captured = ReadBytes(WriteC3d(content));
    EXPECT_NEAR(captured.tracks.frames[0].positions_m[0]->x(), 10.0 * metres, 1e-6 * metres);
    EXPECT_NEAR(captured.residuals_m[5][0].value(), 0.05 * metres, 1e-6 * metres);
  }
  content.unit = "furlong";
  EXPECT_THAT(BytesRefusal(WriteC3d(content)), HasSubstr("'furlong' is not known"));
}

TEST(C3d, RefusesToGuessAnAbsentUnit) {
  C3dContent content = TwoPoints();
  content.unit = std::nullopt;
  EXPECT_THAT(BytesRefusal(WriteC3d(content)), HasSubstr("unit of length"));
  const CapturedMarkers captured = ReadBytes(WriteC3d(content), {.unit_if_absent = "cm"});
  EXPECT_NEAR(captured.tracks.frames[0].positions_m[0]->x(), 0.1, 1e-9);
}

TEST(C3d, CountsMoreFramesThanSixteenBitsHold) {
  C3dContent content;
  content.labels = {"a"};
  content.real_points = false;
  content.frames.resize(70000);
  for (std::size_t i = 0; i < content.frames.size(); ++i) {
    content.frames[i] = {{.x = static_cast<double>(i % 300)}};
  }
  for (const bool trial : {true, false}) {
    content.trial_fields = trial;
    content.long_frames = !trial;
    const CapturedMarkers captured = ReadBytes(WriteC3d(content));
    ASSERT_EQ(captured.tracks.frames.size(), 70000u);
    EXPECT_NEAR(captured.tracks.frames[69999].positions_m[0]->x(), 1e-3 * (69999 % 300), 1e-8);
  }
}

TEST(C3d, ReadsLabelsBeyondTheFirstParameterAndNamesTheRest) {
  C3dContent content;
  for (int i = 0; i < 7; ++i) content.labels.push_back("p" + std::to_string(i));
  content.labels[4] = " ";
  content.labels[5] = "*12";
  content.labels_in_one_parameter = 3;
  content.frames.assign(2, std::vector<C3dContent::Point>(7));
  EXPECT_THAT(ReadBytes(WriteC3d(content)).tracks.names,
              ElementsAre("p0", "p1", "p2", "p3", "unlabelled_5", "unlabelled_6", "p6"));
}

TEST(C3d, SaysWhichOfTwoFrameRatesCounts) {
  std::string bytes = WriteC3d(TwoPoints());
  constexpr std::size_t kRateOfHeader = 20;
  const auto set_rate = [&](float rate_Hz) {
    std::memcpy(bytes.data() + kRateOfHeader, &rate_Hz, sizeof(rate_Hz));
  };
  set_rate(25.0F);
  const CapturedMarkers captured = ReadBytes(bytes);
  EXPECT_EQ(captured.rate_Hz, 50.0);
  EXPECT_THAT(captured.notes, ElementsAre(HasSubstr("POINT:RATE, 50 Hz; the header has 25 Hz")));
  set_rate(0.0F);
  EXPECT_THAT(ReadBytes(bytes).notes, IsEmpty());
}

TEST(C3d, PointsOfOneLabelGetNumbersWhereBothAreSeen) {
  C3dContent content = TwoPoints();
  content.labels = {"side", "side"};
  const CapturedMarkers captured = ReadBytes(WriteC3d(content));
  EXPECT_THAT(captured.tracks.names, ElementsAre("side_1", "side_2"));
  EXPECT_THAT(captured.notes, ElementsAre(HasSubstr("label 'side' is given to 2 points")));
}

TEST(C3d, LeavesPointsOutThatNoFrameSees) {
  C3dContent content = TwoPoints();
  content.labels = {"side", "side"};
  for (auto& frame : content.frames) frame[1].seen = false;
  const CapturedMarkers captured = ReadBytes(WriteC3d(content));
  EXPECT_THAT(captured.tracks.names, ElementsAre("side"));
  EXPECT_THAT(captured.notes, ElementsAre(HasSubstr("no frame sees")));
  for (auto& frame : content.frames) frame[0].seen = false;
  EXPECT_THAT(BytesRefusal(WriteC3d(content)), HasSubstr("no frame sees a marker"));
}

TEST(C3d, LeavesModelOutputsOut) {
  C3dContent content = TwoPoints();
  content.labels = {"tip", "KneeAngles"};
  content.angles = {"KneeAngles"};
  const CapturedMarkers captured = ReadBytes(WriteC3d(content));
  EXPECT_THAT(captured.tracks.names, ElementsAre("tip"));
  EXPECT_NEAR(captured.tracks.frames[3].positions_m[0]->x(), 0.013, 1e-9);
  EXPECT_THAT(captured.notes, ElementsAre(HasSubstr("KneeAngles")));
}

TEST(C3d, LeavesModelOutputsOutThatNoParameterLists) {
  C3dContent content = TwoPoints();
  content.labels = {"tip", "LKneeAngles"};
  content.type_groups = {"Angles", "AngleUnits"};
  CapturedMarkers captured = ReadBytes(WriteC3d(content));
  EXPECT_THAT(captured.tracks.names, ElementsAre("tip"));
  EXPECT_THAT(captured.notes, ElementsAre(HasSubstr("left out, as model outputs")));
  content.type_groups.clear();
  content.labels = {"tip", "hip_power"};
  content.power_unit = "W";
  captured = ReadBytes(WriteC3d(content));
  EXPECT_THAT(captured.tracks.names, ElementsAre("tip"));
  EXPECT_THAT(captured.notes, ElementsAre(HasSubstr("left out, as model outputs")));
}

TEST(C3d, SaysThatAMarkerReadsLikeAModelOutput) {
  C3dContent content = TwoPoints();
  content.labels = {"Rectangle", "LKneeAngles"};
  const CapturedMarkers captured = ReadBytes(WriteC3d(content));
  EXPECT_THAT(captured.tracks.names, ElementsAre("Rectangle", "LKneeAngles"));
  EXPECT_THAT(captured.notes, ElementsAre(AllOf(HasSubstr("taken as positions"),
                                                HasSubstr("outputs: LKneeAngles;"))));
}

TEST(C3d, EndsTheParametersWithTheirSection) {
  for (const auto processor : {C3dProcessor::kIntel, C3dProcessor::kMips}) {
    C3dContent content = TwoPoints();
    content.processor = processor;
    content.last_link_leads_nowhere = true;
    EXPECT_EQ(ReadBytes(WriteC3d(content)).tracks.frames.size(), 20u);
  }
}

TEST(C3d, TakesTheHeaderWhereAParameterIsZeroOrItsGroupHasNoName) {
  C3dContent content = TwoPoints();
  content.data_start_is_zero = true;
  EXPECT_EQ(ReadBytes(WriteC3d(content)).tracks.frames.size(), 20u);
  content.data_start_is_zero = false;
  content.point_group_is_named = false;
  EXPECT_THAT(ReadBytes(WriteC3d(content)).tracks.names, ElementsAre("tip", "Base-1"));
}

TEST(C3d, PassesOverAnotherGroupThatIsGivenTwice) {
  C3dContent content = TwoPoints();
  content.processing = {1.0, 2.0};
  EXPECT_EQ(ReadBytes(WriteC3d(content)).tracks.frames.size(), 20u);
}

TEST(C3d, CountsTimeFromTheFirstFrameOfTheFile) {
  C3dContent content = TwoPoints();
  content.first_frame = 301;
  content.trial_fields = true;
  const CapturedMarkers captured = ReadBytes(WriteC3d(content));
  EXPECT_EQ(captured.tracks.frames.size(), 20u);
  EXPECT_EQ(captured.tracks.frames[0].t_s, 0.0);
}

TEST(C3d, RefusesAFileThatIsNoneOrContradictsItselfWithTheByte) {
  const std::string good = WriteC3d(TwoPoints());
  const auto with = [&](std::size_t offset, char value) {
    std::string bytes = good;
    bytes.at(offset) = value;
    return BytesRefusal(bytes);
  };
  EXPECT_THAT(with(1, 0), AllOf(HasSubstr("f.c3d: at byte 1:"), HasSubstr("no C3D file")));
  EXPECT_THAT(with(0, 0), HasSubstr("at byte 0:"));
  EXPECT_THAT(with(515, 90), AllOf(HasSubstr("at byte 515:"), HasSubstr("processor type 90")));
  EXPECT_THAT(with(2, 3), HasSubstr("POINT:USED is 2, the header has 3"));
  EXPECT_THAT(with(8, 25), HasSubstr("POINT:FRAMES is 20, the header has 25"));
  EXPECT_THAT(with(15, 0x3c), HasSubstr("disagree whether points are integers"));
  EXPECT_THAT(with(16, 9), HasSubstr("POINT:DATA_START"));
  EXPECT_THAT(BytesRefusal(""), HasSubstr("at byte 0:"));
}

TEST(C3d, TakesNanForAPointThatWasNotSeen) {
  std::string bytes = WriteC3d(TwoPoints());
  const std::size_t data = bytes.size() - 1024;  // 20 frames of 32 bytes fill two blocks
  std::memcpy(bytes.data() + data, "\x00\x00\xc0\x7f", 4);
  const CapturedMarkers captured = ReadBytes(bytes);
  EXPECT_FALSE(captured.tracks.frames[0].positions_m[0].has_value());
  EXPECT_TRUE(captured.tracks.frames[1].positions_m[0].has_value());
}

TEST(C3d, RefusesAPointThatIsInfinite) {
  std::string bytes = WriteC3d(TwoPoints());
  const std::size_t data = bytes.size() - 1024;
  std::memcpy(bytes.data() + data, "\x00\x00\x80\x7f", 4);
  EXPECT_THAT(BytesRefusal(bytes),
              AllOf(HasSubstr("at byte " + std::to_string(data)), HasSubstr("coordinate")));
}

TEST(C3d, RefusesEveryFileThatIsCutShort) {
  C3dContent content = TwoPoints();
  content.frames.resize(16);  // fills the block: no padding that could be cut unnoticed
  const std::string bytes = WriteC3d(content);
  EXPECT_NO_THROW(ReadBytes(bytes));
  for (std::size_t size = 0; size < bytes.size(); size += 7) {
    EXPECT_THAT(BytesRefusal(bytes.substr(0, size)), HasSubstr("at byte")) << size;
  }
  EXPECT_THAT(BytesRefusal(bytes.substr(0, bytes.size() - 1)), HasSubstr("16 frames"));
}

// A damaged file is read or refused, but never crashes the program.
TEST(C3d, SurvivesFlippedBits) {
  const TestFolder folder;
  std::mt19937 random(20260401);
  int refused = 0;
  for (const bool real_points : {true, false}) {
    C3dContent content = TwoPoints();
    content.real_points = real_points;
    const std::string good = WriteC3d(content);
    std::uniform_int_distribution<std::size_t> any_byte(0, good.size() - 1);
    std::uniform_int_distribution<int> any_bit(0, 7);
    for (int round = 0; round < 1500; ++round) {
      std::string bytes = good;
      for (int flip = 0; flip <= round % 4; ++flip) {
        const int bit = 1 << any_bit(random);
        char& byte = bytes[any_byte(random)];
        byte = static_cast<char>(byte ^ bit);
      }
      try {
        ReadC3d(folder.Write("f.c3d", bytes));
      } catch (const InputError&) {
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 300);
}

class MeasuredBeam : public testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(MeasuredBeam, C3dAndItsCsvHoldTheSame) {
  const auto folder = test_support::MeasuredDataFolder() / "silicone_beam";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  const CapturedMarkers c3d = ReadC3d(folder / GetParam().first);
  const CapturedMarkers csv = ReadCapturedCsv(folder / GetParam().second);
  EXPECT_EQ(c3d.tracks.names, csv.tracks.names);
  EXPECT_THAT(c3d.tracks.names,
              ElementsAre("Tip-1", "Tip-2", "Tip-3", "Base-1", "Base-2", "Base-3"));
  EXPECT_EQ(c3d.rate_Hz, 100.0);
  EXPECT_NEAR(csv.rate_Hz, 100.0, 1e-6);
  ASSERT_EQ(c3d.tracks.frames.size(), csv.tracks.frames.size());
  for (std::size_t i = 0; i < c3d.tracks.frames.size(); ++i) {
    EXPECT_NEAR(c3d.tracks.frames[i].t_s, csv.tracks.frames[i].t_s, 1e-9);
    for (std::size_t marker = 0; marker < 6; ++marker) {
      const auto& a = c3d.tracks.frames[i].positions_m[marker];
      const auto& b = csv.tracks.frames[i].positions_m[marker];
      ASSERT_TRUE(a.has_value() && b.has_value());
      EXPECT_LE((*a - *b).cwiseAbs().maxCoeff(), 0.5001e-6);
      EXPECT_NEAR(*c3d.residuals_m[i][marker], *csv.residuals_m[i][marker], 0.5001e-6);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Recordings, MeasuredBeam,
                         testing::Values(std::pair{"beam_gravity_V2_a.c3d", "gravity_a.csv"},
                                         std::pair{"beam_load52_V2_a.c3d", "load52g_a.csv"}));

}  // namespace
}  // namespace palpate::experiment
