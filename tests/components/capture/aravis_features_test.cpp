// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

// What a maker's description says is read as it means it, by Aravis' fake camera.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "components/capture/aravis/aravis_camera.hpp"
#include "components/capture/genicam/features.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::capture {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

/// Aravis' fake camera with more nodes in its description.
class DescribedCamera : public testing::Test {
 protected:
  void Open(const std::string& nodes) {
    CameraTarget target;
    target.fake = true;
    std::string reason;
    camera_ = AravisCamera::Open(target, "", &reason);
    ASSERT_NE(camera_, nullptr) << reason;
    std::string xml = camera_->Description();
    const std::size_t end = xml.rfind("</RegisterDescription>");
    ASSERT_NE(end, std::string::npos);
    target.fake_description = folder_.Write("description.xml", xml.insert(end, nodes)).string();
    camera_ = AravisCamera::Open(target, "", &reason);
    ASSERT_NE(camera_, nullptr) << reason;
    ASSERT_TRUE(features().Set("Width", std::int64_t{256}).ok());
    ASSERT_TRUE(features().Set("Height", std::int64_t{99}).ok());
  }
  Features& features() { return camera_->features(); }

  test_support::TestFolder folder_;
  std::unique_ptr<AravisCamera> camera_;
};

std::string Knife(const std::string& kind, const std::string& name, const std::string& formula) {
  return "<" + kind + " Name=\"" + name +
         "\"><pVariable Name=\"W\">Width</pVariable><pVariable Name=\"H\">Height</pVariable>"
         "<Formula>" +
         formula + "</Formula></" + kind + ">";
}

TEST_F(DescribedCamera, FunctionsOfRealNumbersInFormulasOfIntegersAreEvaluated) {
  Open(Knife("IntSwissKnife", "RoundedHalf", "ROUND(W/2)") +
       Knife("IntSwissKnife", "Packed", "CEIL(W*H*1.5)") +
       "<Float Name=\"Scan3dPrincipalPointU\"><pValue>RoundedHalf</pValue></Float>"
       "<Integer Name=\"Payload\"><pValue>Packed</pValue></Integer>");
  EXPECT_EQ(features().Number("Scan3dPrincipalPointU"), 128.0);
  EXPECT_EQ(features().Integer("Payload"), 38016);
  EXPECT_THAT(features().Notes(),
              Contains(AllOf(HasSubstr("Scan3dPrincipalPointU by a formula"), HasSubstr("128"))));
}

TEST_F(DescribedCamera, AFormulaOfAFormulaThatFailsIsEvaluatedToo) {
  Open(Knife("IntSwissKnife", "Lines", "FLOOR(H/2.0)") +
       "<IntSwissKnife Name=\"Size\"><pVariable Name=\"L\">Lines</pVariable>"
       "<Constant Name=\"C\">3</Constant><Formula>L*C+1</Formula></IntSwissKnife>");
  EXPECT_EQ(features().Integer("Size"), 49 * 3 + 1);
}

TEST_F(DescribedCamera, WhatCannotBeEvaluatedCountsAsNotTold) {
  Open(Knife("IntSwissKnife", "Unknown", "CEIL(W/(H-99))"));
  EXPECT_EQ(features().Number("Unknown"), std::nullopt);
  EXPECT_EQ(features().Integer("Unknown"), std::nullopt);
  EXPECT_THAT(features().Notes(), Contains(HasSubstr("counts as not told")));
}

TEST_F(DescribedCamera, SoundFormulasAreLeftToAravis) {
  Open(Knife("SwissKnife", "Real", "ROUND(W/2)") + Knife("IntSwissKnife", "Area", "W*H"));
  EXPECT_EQ(features().Number("Real"), 128.0);
  EXPECT_EQ(features().Integer("Area"), 256 * 99);
  EXPECT_THAT(features().Notes(), IsEmpty());
}

TEST_F(DescribedCamera, WhatIsNotImplementedIsNotThere) {
  const std::string no = "<Integer Name=\"No\"><Value>0</Value></Integer>";
  Open(no +
       "<Float Name=\"Scan3dBaseline\"><pIsImplemented>No</pIsImplemented><Value>3</Value></Float>"
       "<Enumeration Name=\"DepthFormat\">"
       "<EnumEntry Name=\"Coord3D_C16\"><pIsImplemented>No</pIsImplemented><Value>1</Value>"
       "</EnumEntry><EnumEntry Name=\"Coord3D_ABC16\"><Value>2</Value></EnumEntry>"
       "<Value>2</Value></Enumeration>");
  EXPECT_FALSE(features().Has("Scan3dBaseline"));
  EXPECT_EQ(features().Number("Scan3dBaseline"), std::nullopt);
  EXPECT_THAT(features().Choices("DepthFormat"),
              testing::ElementsAre(Pair("Coord3D_ABC16", std::int64_t{2})));
}

TEST_F(DescribedCamera, ARealNumberThatAnIntegerStandsBehindIsRounded) {
  Open(
      "<Integer Name=\"Ticks\"><Value>0</Value></Integer>"
      "<Float Name=\"Exposure\"><pValue>Ticks</pValue></Float>");
  const double exposure_us = 0.0157 * 1e6;
  ASSERT_LT(exposure_us, 15700.0) << "the case is about a product that is too small";
  ASSERT_TRUE(features().Set("Exposure", exposure_us).ok());
  EXPECT_EQ(features().Integer("Ticks"), 15700);
  ASSERT_TRUE(features().Set("Exposure", 12.6).ok());
  EXPECT_EQ(features().Integer("Ticks"), 13);
  ASSERT_TRUE(features().Set("Exposure", 12.4).ok());
  EXPECT_EQ(features().Integer("Ticks"), 12);
}

}  // namespace
}  // namespace palpate::capture
