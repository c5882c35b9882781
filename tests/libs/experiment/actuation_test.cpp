// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/actuation.hpp"

#include "tests/support/test_folder.hpp"

namespace palpate::experiment {
namespace {

using test_support::MessageOf;
using test_support::TestFolder;
using testing::AllOf;
using testing::HasSubstr;

std::string ActuationRefusal(const std::string& content) {
  const TestFolder folder;
  const auto file = folder.Write("actuation.csv", content);
  return MessageOf([&] { ReadActuation(file); });
}

TEST(Actuation, MovesLinearlyBetweenRowsAndHoldsOutside) {
  const TestFolder folder;
  const Actuation actuation = ReadActuation(
      folder.Write("actuation.csv", "t_s,north.displacement_m,east.tension_N\n0,0,1\n2,0.01,3\n"));
  const ActuatorColumn* north = actuation.Find("north", ActuatorQuantity::kDisplacement);
  const ActuatorColumn* east = actuation.Find("east", ActuatorQuantity::kTension);
  ASSERT_TRUE(north != nullptr && east != nullptr);
  EXPECT_EQ(actuation.Find("north", ActuatorQuantity::kTension), nullptr);
  EXPECT_DOUBLE_EQ(actuation.ValueAt(*north, 0.5), 0.0025);
  EXPECT_DOUBLE_EQ(actuation.ValueAt(*east, 1.5), 2.5);
  EXPECT_DOUBLE_EQ(actuation.ValueAt(*north, 2.0), 0.01);
  EXPECT_DOUBLE_EQ(actuation.ValueAt(*east, -5.0), 1.0);
  EXPECT_DOUBLE_EQ(actuation.ValueAt(*east, 50.0), 3.0);
}

TEST(Actuation, BridgesAMissingSampleFromItsNeighboursAndNeverReadsItAsZero) {
  const TestFolder folder;
  const Actuation actuation = ReadActuation(
      folder.Write("actuation.csv", "t_s,a.displacement_m\n0,\n1,0.010\n2,\n3,\n4,0.040\n5,\n"));
  const ActuatorColumn& column = actuation.columns.at(0);
  EXPECT_FALSE(column.samples.at(2).has_value());
  EXPECT_DOUBLE_EQ(actuation.ValueAt(column, 2.0), 0.020);
  EXPECT_DOUBLE_EQ(actuation.ValueAt(column, 3.5), 0.035);
  EXPECT_DOUBLE_EQ(actuation.ValueAt(column, 0.0), 0.010);
  EXPECT_DOUBLE_EQ(actuation.ValueAt(column, 5.0), 0.040);
}

TEST(Actuation, ReadsBackExactlyWhatItWrote) {
  const TestFolder folder;
  const Actuation first = ReadActuation(folder.Write(
      "a.csv", "b.tension_N,t_s,a.displacement_m\n,0.1,1e-3\n0.30000000000000004,0.7,\n"));
  WriteActuation(first, folder.path() / "b.csv");
  const Actuation second = ReadActuation(folder.path() / "b.csv");
  EXPECT_EQ(second.t_s, first.t_s);
  ASSERT_EQ(second.columns.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(second.columns[i].Header(), first.columns[i].Header());
    EXPECT_EQ(second.columns[i].samples, first.columns[i].samples);
  }
}

TEST(Actuation, RefusesAColumnInAnotherUnitAndNamesTheRightOne) {
  EXPECT_THAT(ActuationRefusal("t_s,north.displacement_mm\n0,1\n"),
              AllOf(HasSubstr("actuation.csv:1:5"), HasSubstr("metres are expected"),
                    HasSubstr("'north.displacement_m'")));
  EXPECT_THAT(ActuationRefusal("t_s,north.tension_mN\n0,1\n"),
              AllOf(HasSubstr("newtons are expected"), HasSubstr("'north.tension_N'")));
  EXPECT_THAT(ActuationRefusal("t_ms,north.tension_N\n0,1\n"),
              AllOf(HasSubstr(":1:1"), HasSubstr("seconds are expected"), HasSubstr("'t_s'")));
}

TEST(Actuation, RefusesAnUnknownOrDoubledOrMissingColumn) {
  EXPECT_THAT(ActuationRefusal("t_s,north.displacment_m\n0,1\n"),
              AllOf(HasSubstr(":1:5"), HasSubstr("did you mean 'north.displacement_m'")));
  EXPECT_THAT(ActuationRefusal("t_s,north\n0,1\n"), HasSubstr("unknown column 'north'"));
  EXPECT_THAT(ActuationRefusal("t_s,a.tension_N,a.tension_N\n0,1,2\n"),
              AllOf(HasSubstr(":1:17"), HasSubstr("given twice")));
  EXPECT_THAT(ActuationRefusal("a.tension_N\n1\n"), HasSubstr("'t_s' is missing"));
  EXPECT_THAT(ActuationRefusal("t_s\n1\n"), HasSubstr("no column for a cable"));
}

TEST(Actuation, TakesAColumnWithoutAnyValueForACableThatWasNotDriven) {
  const TestFolder folder;
  const Actuation actuation =
      ReadActuation(folder.Write("actuation.csv", "t_s,a.tension_N,b.tension_N\n0,,1\n1,,1\n"));
  EXPECT_EQ(actuation.Find("a", ActuatorQuantity::kTension), nullptr);
  EXPECT_NE(actuation.Find("b", ActuatorQuantity::kTension), nullptr);
}

TEST(Actuation, RefusesWhatIsNoFiniteNumber) {
  for (const std::string bad : {"nan", "inf", "1,5", "0x3", "1 N", "--1"}) {
    EXPECT_THAT(ActuationRefusal("t_s,a.tension_N\n0,1\n1," + bad + "\n"),
                HasSubstr("actuation.csv:3:"))
        << bad;
  }
  EXPECT_THAT(ActuationRefusal("t_s,a.tension_N\nnan,1\n"), HasSubstr("actuation.csv:2:1"));
  EXPECT_THAT(ActuationRefusal("t_s,a.tension_N\n,1\n"), HasSubstr("must not be empty"));
}

TEST(Actuation, RefusesTimeThatDoesNotRise) {
  EXPECT_THAT(ActuationRefusal("t_s,a.tension_N\n0,1\n2,1\n1,1\n"),
              AllOf(HasSubstr("actuation.csv:4:1"), HasSubstr("time must rise")));
  EXPECT_THAT(ActuationRefusal("t_s,a.tension_N\n0,1\n0,1\n"),
              AllOf(HasSubstr("actuation.csv:3:1"), HasSubstr("second sample")));
}

TEST(Actuation, RefusesValuesThatNoCableCanHave) {
  EXPECT_THAT(ActuationRefusal("t_s,a.tension_N\n0,-0.5\n"),
              AllOf(HasSubstr(":2:3"), HasSubstr("cannot push")));
  EXPECT_THAT(ActuationRefusal("t_s,a.displacement_m\n0,10\n"), HasSubstr("millimetres?"));
}

TEST(Actuation, RefusesAFileWithoutRowsOrOutOfShape) {
  EXPECT_THAT(ActuationRefusal(""), HasSubstr("empty"));
  EXPECT_THAT(ActuationRefusal("t_s,a.tension_N\n"), HasSubstr("no row"));
  EXPECT_THAT(ActuationRefusal("t_s,a.tension_N\n0,1,2\n"),
              AllOf(HasSubstr(":2:1"), HasSubstr("3 fields"), HasSubstr("2")));
  EXPECT_THAT(ActuationRefusal("t_s,a.tension_N\n0\n"), HasSubstr("1 fields"));
  EXPECT_THAT(MessageOf([] { ReadActuation("/nowhere/actuation.csv"); }),
              HasSubstr("/nowhere/actuation.csv"));
}

}  // namespace
}  // namespace palpate::experiment
