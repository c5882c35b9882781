// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "components/palpate/topics/message_value.hpp"
#include "components/palpate/topics/sliding_window.hpp"
#include "libs/core/error.hpp"
#include "tests/components/palpate/recordings/cdr_writer.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::command {
namespace {

using testing::HasSubstr;

const recording::Definitions& Types() {
  static const recording::Definitions kTypes = recording::ParseRos2msg(
      "t/Sample",
      "std_msgs/Header header\nbool on\nfloat64[2] pair\nfloat32[] values\nstring[] names\n"
      "t/Point[] points\nuint8[] none\nint64 large\n"
      "================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n"
      "================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n"
      "================\nMSG: t/Point\nfloat64 x\nstring label\n");
  return kTypes;
}

/// One message of that type, in either byte order.
std::string Sample(Cdr::Order order = Cdr::Order::kLittle) {
  Cdr cdr(order);
  cdr.Header(12, 5, "robot").Put(std::uint8_t{1}).Array<double>({0.5, -3.0});
  cdr.List<float>({1.0f, 0.1f, 2.0f}).Put(std::uint32_t{2}).Text("a").Text("true");
  cdr.Put(std::uint32_t{1}).Put(1e-5).Text("it's: b");
  cdr.Put(std::uint32_t{0}).Put(std::int64_t{-9007199254740993});
  return cdr.bytes();
}

MessageValue Decoded(const std::string& cdr) {
  const auto value = DecodeMessage(cdr, "t/msg/Sample", Types());
  EXPECT_TRUE(value);
  return value.value_or(MessageValue());
}

constexpr char kYaml[] = R"(header:
  stamp:
    sec: 12
    nanosec: 5
  frame_id: robot
on: true
pair:
- 0.5
- -3.0
values:
- 1.0
- 0.10000000149011612
- 2.0
names:
- a
- 'true'
points:
- x: 1.0e-05
  label: 'it''s: b'
none: []
large: -9007199254740993
)";

TEST(MessageText, IsTheYamlOfRos2ForBothByteOrders) {
  for (const auto order : {Cdr::Order::kLittle, Cdr::Order::kBig}) {
    const std::string cdr = Sample(order);
    EXPECT_EQ(YamlText(Decoded(cdr), {}), kYaml);
  }
}

TEST(MessageText, CutsListsAndTextsAsRos2Does) {
  const std::string cdr = Sample();
  const std::string text = YamlText(Decoded(cdr), {.truncate_length = 2});
  EXPECT_THAT(text, HasSubstr("values:\n- 1.0\n- 0.10000000149011612\n- '...'\n"));
  EXPECT_THAT(text, HasSubstr("frame_id: ro...\n"));
  EXPECT_THAT(text, HasSubstr("names:\n- a\n- tr...\n"));
}

TEST(MessageText, NamesListsAndTextsInTheirPlace) {
  const std::string cdr = Sample();
  const std::string text = YamlText(Decoded(cdr), {.no_lists = true, .no_texts = true});
  EXPECT_THAT(text, HasSubstr("pair: '<array type: double[2]>'\n"));
  EXPECT_THAT(text, HasSubstr("values: '<sequence type: float, length: 3>'\n"));
  EXPECT_THAT(text, HasSubstr("points: '<sequence type: t/msg/Point, length: 1>'\n"));
  EXPECT_THAT(text, HasSubstr("frame_id: '<string length: <5>>'\n"));
}

TEST(MessageText, IsOneLineOfValuesAsCsv) {
  const std::string cdr = Sample();
  EXPECT_EQ(CsvText(Decoded(cdr), {}),
            "12,5,robot,True,0.5,-3.0,1.0,0.10000000149011612,2.0,a,true,1e-05,it's: b,"
            "-9007199254740993\n");
}

TEST(MessageText, IsOneJsonObject) {
  const std::string cdr = Sample();
  const auto json = nlohmann::json::parse(JsonText(Decoded(cdr), {}));
  EXPECT_EQ(json.at("header").at("stamp").at("sec"), 12);
  EXPECT_EQ(json.at("values").size(), 3u);
  EXPECT_EQ(json.at("large"), -9007199254740993);
  EXPECT_EQ(json.at("points").at(0).at("label"), "it's: b");
}

TEST(MessageText, SelectsFieldsAndItems) {
  const std::string cdr = Sample();
  const MessageValue message = Decoded(cdr);
  EXPECT_EQ(YamlText(SelectField(message, "header.stamp"), {}), "sec: 12\nnanosec: 5\n");
  EXPECT_EQ(YamlText(SelectField(message, "points[0].x"), {}), "1.0e-05\n");
  EXPECT_EQ(YamlText(SelectField(message, "values[1]"), {}), "0.10000000149011612\n");
  EXPECT_EQ(YamlText(SelectField(message, "names"), {}), "- a\n- 'true'\n");
}

TEST(MessageText, RefusesFieldsThatAreNone) {
  const std::string cdr = Sample();
  const MessageValue message = Decoded(cdr);
  const auto refusal = [&](const std::string& path) {
    return test_support::MessageOf([&] { (void)SelectField(message, path); });
  };
  EXPECT_THAT(refusal("heder.stamp"), HasSubstr("no field 'heder' (did you mean 'header'?)"));
  EXPECT_THAT(refusal("points[4].x"), HasSubstr("no item [4] of 1"));
  EXPECT_THAT(refusal("on[0]"), HasSubstr("this is no list"));
  EXPECT_THAT(refusal("points[0"), HasSubstr("a.b[0].c"));
}

TEST(MessageText, DoesNotDecodeWhatIsCutOrUnknown) {
  const std::string cdr = Sample();
  EXPECT_FALSE(DecodeMessage(cdr.substr(0, cdr.size() - 12), "t/msg/Sample", Types()));
  EXPECT_FALSE(DecodeMessage(cdr, "t/msg/Other", Types()));
  // A length of four thousand million names.
  std::string damaged = Cdr().Header(1, 2, "f").bytes();
  damaged.append(64, '\xFF');
  EXPECT_FALSE(DecodeMessage(damaged, "t/msg/Sample", Types()));
}

TEST(MessageText, WritesNumbersAsPythonDoes) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(PythonNumber(1.0), "1.0");
  EXPECT_EQ(PythonNumber(0.1), "0.1");
  EXPECT_EQ(PythonNumber(0.0001), "0.0001");
  EXPECT_EQ(PythonNumber(1e-5), "1e-05");
  EXPECT_EQ(PythonNumber(1e15), "1000000000000000.0");
  EXPECT_EQ(PythonNumber(1e16), "1e+16");
  EXPECT_EQ(PythonNumber(-infinity), "-inf");
  EXPECT_EQ(PythonNumber(std::numeric_limits<double>::quiet_NaN()), "nan");
}

TEST(MessageText, QuotesTextsThatYamlWouldReadAsSomethingElse) {
  for (const char* plain : {"robot", "a b", "a:b", "-x", "x#y", "palpate_msgs/msg/Force"}) {
    EXPECT_EQ(YamlScalar(plain), plain);
  }
  for (const char* other : {"", "12", "1.5", "1e5", "no", "null", "- a", "a: b", "a #b", "*x",
                            "x:", "[1]", "2026-01-31"}) {
    EXPECT_EQ(YamlScalar(other), "'" + std::string(other) + "'");
  }
  EXPECT_EQ(YamlScalar("two\nlines"), "\"two\\nlines\"");
}

TEST(SlidingWindow, HasTheStatisticsOfTheLastValues) {
  SlidingWindow window(3);
  EXPECT_EQ(window.Statistics().count, 0u);
  for (const double value : {100.0, 1.0, 2.0, 3.0}) window.Add(value);
  const WindowStatistics statistics = window.Statistics();
  EXPECT_EQ(statistics.count, 3u);
  EXPECT_DOUBLE_EQ(statistics.mean, 2.0);
  EXPECT_EQ(statistics.min, 1.0);
  EXPECT_EQ(statistics.max, 3.0);
  EXPECT_DOUBLE_EQ(statistics.standard_deviation, std::sqrt(2.0 / 3.0));
}

TEST(SlidingWindow, IsToldInTheLinesOfRos2) {
  EXPECT_EQ(
      RateLines({.mean = 0.1, .min = 0.09, .max = 0.11, .standard_deviation = 1e-4, .count = 7}),
      "average rate: 10.000\n\tmin: 0.090s max: 0.110s std dev: 0.00010s window: 7\n");
  EXPECT_EQ(
      DelayLines({.mean = 0.002, .min = 0.001, .max = 0.003, .standard_deviation = 0, .count = 2}),
      "average delay: 0.002\n\tmin: 0.001s max: 0.003s std dev: 0.00000s window: 2\n");
  EXPECT_EQ(BandwidthLines(2.5e6, {.mean = 1e6, .min = 5e5, .max = 2e6, .count = 4}),
            "2.50 MB/s from 4 messages\n\tMessage size mean: 1.00 MB min: 0.50 MB max: 2.00 MB\n");
  EXPECT_EQ(BandwidthLines(240.0, {.mean = 24.0, .min = 24.0, .max = 24.0, .count = 10}),
            "240 B/s from 10 messages\n\tMessage size mean: 24 B min: 24 B max: 24 B\n");
}

}  // namespace
}  // namespace palpate::command
