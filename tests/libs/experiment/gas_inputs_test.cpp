// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/gas_inputs.hpp"

#include "tests/support/test_folder.hpp"

namespace palpate::experiment {
namespace {

using test_support::MessageOf;
using test_support::TestFolder;
using testing::AllOf;
using testing::HasSubstr;

ActuationWithGas ReadGas(const std::string& content) {
  const TestFolder folder;
  return ReadActuationWithGas(folder.Write("actuation.csv", content));
}

std::string GasRefusal(const std::string& content) {
  return MessageOf([&] { ReadGas(content); });
}

std::string NamesRefusal(const std::string& content) {
  const ActuationWithGas inputs = ReadGas(content);
  return MessageOf([&] { CheckGas(inputs, {"north"}, {"bend", "twist"}); });
}

TEST(GasInputs, MoveLinearlyBetweenTheFieldsThatAreGivenBesideOtherColumns) {
  const ActuationWithGas inputs =
      ReadGas("bend.air_m3,t_s,twist.pressure_Pa\n0,0,1e3\n,1,2e3\n4e-6,2,3e3\n");
  ASSERT_EQ(inputs.gas.size(), 1U);
  EXPECT_EQ(inputs.actuation.columns.size(), 1U);
  const GasColumn* bend = inputs.FindGas("bend");
  ASSERT_NE(bend, nullptr);
  EXPECT_EQ(inputs.FindGas("twist"), nullptr);
  EXPECT_DOUBLE_EQ(inputs.AirAt_m3(*bend, 1.0), 2e-6);
  EXPECT_DOUBLE_EQ(inputs.AirAt_m3(*bend, 9.0), 4e-6);
  EXPECT_FALSE(bend->air_m3.at(1).has_value());
}

TEST(GasInputs, AColumnWithoutAnyValueIsAChamberThatIsNotClosed) {
  EXPECT_TRUE(ReadGas("t_s,bend.air_m3\n0,\n1,\n").gas.empty());
}

TEST(GasInputs, RefuseOtherUnitsAndWhatIsNoAmountWithItsPlace) {
  EXPECT_THAT(GasRefusal("t_s,bend.air_ml\n0,1\n"),
              AllOf(HasSubstr("actuation.csv:1:5"), HasSubstr("'bend.air_m3'")));
  EXPECT_THAT(GasRefusal("t_s,bend.air_m3\n0,2\n"),
              AllOf(HasSubstr("actuation.csv:2:3"), HasSubstr("millilitres?")));
  EXPECT_THAT(GasRefusal("t_s,bend.air_m3\n0,0\n1,nan\n"), HasSubstr("actuation.csv:3:3"));
  EXPECT_THAT(GasRefusal("t_s,bend.air_m3,bend.air_m3\n0,0,0\n"), HasSubstr("given twice"));
}

TEST(GasInputs, RefuseWhatIsNoChamberOrHasAnotherInputToo) {
  EXPECT_THAT(NamesRefusal("t_s,north.air_m3\n0,0\n"),
              AllOf(HasSubstr("actuation.csv:1:5"), HasSubstr("holds no gas")));
  EXPECT_THAT(NamesRefusal("t_s,bent.air_m3\n0,0\n"), HasSubstr("did you mean 'bend'"));
  EXPECT_THAT(NamesRefusal("t_s,bend.volume_m3,bend.air_m3\n0,0,0\n"),
              AllOf(HasSubstr("actuation.csv:1:20"), HasSubstr("'bend.volume_m3'")));
  EXPECT_NO_THROW(
      CheckGas(ReadGas("t_s,twist.volume_m3,bend.air_m3\n0,0,0\n"), {}, {"bend", "twist"}));
}

TEST(GasInputs, ARecordingHasNone) {
  const TestFolder folder;
  const auto file = folder.Write("actuation.csv", "t_s,bend.air_m3\n0,0\n");
  EXPECT_THAT(MessageOf([&] { ReadActuation(file); }),
              AllOf(HasSubstr("actuation.csv:1:5"), HasSubstr("bend.pressure_Pa"),
                    HasSubstr("palpate solve alone")));
}

}  // namespace
}  // namespace palpate::experiment
