// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/csv_table.hpp"

#include "tests/support/test_folder.hpp"

namespace palpate::experiment {
namespace {

using test_support::MessageOf;
using test_support::TestFolder;
using testing::AllOf;
using testing::HasSubstr;

CsvTable ParseTable(const std::string& content) {
  const TestFolder folder;
  return CsvTable::Read(folder.Write("t.csv", content));
}

TEST(CsvTable, UnderstandsByteOrderMarksWindowsLinesBlanksAndQuotes) {
  const CsvTable table = ParseTable("\xEF\xBB\xBF\"a\", b \r\n 1 ,\"x\"\r\n2,\r\n\r\n");
  EXPECT_EQ(table.header(), (std::vector<std::string>{"a", "b"}));
  ASSERT_EQ(table.rows(), 2u);
  EXPECT_EQ(table.Number(0, 0), 1.0);
  EXPECT_EQ(table.Text(0, 1), "x");
  EXPECT_EQ(table.OptionalNumber(1, 1), std::nullopt);
}

TEST(CsvTable, KnowsLineAndColumnOfEachField) {
  const CsvTable table = ParseTable("a,b\n10,20\n300,x");
  EXPECT_EQ(table.Where(0, 1).line, 2);
  EXPECT_EQ(table.Where(0, 1).column, 4);
  EXPECT_EQ(table.Where(1, 1).line, 3);
  EXPECT_EQ(table.Where(1, 1).column, 5);
  EXPECT_THAT(MessageOf([&] { static_cast<void>(table.Number(1, 1)); }),
              AllOf(HasSubstr("t.csv:3:5"), HasSubstr("b 'x'")));
}

TEST(CsvTable, KeepsItsFieldsWhenMoved) {
  CsvTable first = ParseTable("a\n7");
  const CsvTable second = std::move(first);
  EXPECT_EQ(second.Number(0, 0), 7.0);
}

TEST(CsvTable, RefusesAnEmptyLineInTheMiddle) {
  EXPECT_THAT(MessageOf([] { ParseTable("a,b\n1,2\n\n3,4\n"); }), HasSubstr("t.csv:3:1"));
}

TEST(CsvTable, RefusesQuotesThatItCannotTakeApart) {
  EXPECT_THAT(MessageOf([] { ParseTable("a,b\n1\"5\",2\n"); }), HasSubstr("t.csv:2:1"));
}

TEST(CsvTable, ReadsSemicolonsWithDecimalCommasAndTabs) {
  const CsvTable semicolons = ParseTable("t_s;x_m\n0;1,5\n0,25;-2e-3\n");
  EXPECT_EQ(semicolons.Number(0, 1), 1.5);
  EXPECT_EQ(semicolons.Number(1, 0), 0.25);
  EXPECT_EQ(semicolons.Number(1, 1), -2e-3);
  EXPECT_EQ(ParseTable("t_s\tx_m\n0\t1.5\n").Number(0, 1), 1.5);
  EXPECT_THAT(MessageOf([] { ParseTable("t_s;x_m\n0,5;1.500\n").Number(0, 1); }),
              HasSubstr("x_m '1.500'"));
  EXPECT_THAT(MessageOf([] { ParseTable("t_s;x_m\n0;1;2\n"); }), HasSubstr("separated by ';'"));
}

TEST(CsvTable, NanIsAMissingSampleOnlyWhereOneIsAskedFor) {
  const CsvTable table = ParseTable("x_m\nNaN\n");
  EXPECT_EQ(table.OptionalSample(0, 0), std::nullopt);
  EXPECT_THAT(MessageOf([&] { table.OptionalNumber(0, 0); }), HasSubstr("not a finite number"));
}

TEST(CsvTable, RefusesAFolder) {
  const TestFolder folder;
  EXPECT_THAT(MessageOf([&] { CsvTable::Read(folder.path()); }), HasSubstr("cannot be read"));
}

}  // namespace
}  // namespace palpate::experiment
