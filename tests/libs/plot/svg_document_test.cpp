// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/plot/svg_document.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tinyxml2.h>

namespace palpate::plot {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string WithGroup(const std::string& name) {
  SvgDocument svg(100, 50, name);
  svg.BeginGroup("inside", {0, 0}, 10, 10);
  svg.EndGroup();
  return svg.Element();
}

TEST(SvgDocument, PicturesOfOnePageShareNoId) {
  EXPECT_THAT(WithGroup("first_"), HasSubstr("id=\"first_clip0\""));
  EXPECT_THAT(WithGroup("first_"), HasSubstr("url(#first_clip0)"));
  EXPECT_THAT(WithGroup("second_"), Not(HasSubstr("first_")));
}

TEST(SvgDocument, IsAFileOrAnElementOfAPage) {
  SvgDocument svg(100, 50);
  svg.Text({1, 2}, "<&>", {});
  EXPECT_EQ(svg.Element().rfind("<svg ", 0), 0U);
  EXPECT_EQ(svg.Finish(), "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" + svg.Element());
  tinyxml2::XMLDocument read;
  EXPECT_EQ(read.Parse(svg.Finish().c_str()), tinyxml2::XML_SUCCESS);
}

TEST(SvgDocument, AnArrowEndsWhereItPoints) {
  SvgDocument svg(100, 50);
  svg.Arrow({10, 20}, {40, 20}, 5.0, {});
  EXPECT_THAT(svg.Element(), HasSubstr("x2=\"35.00\" y2=\"20.00\""));
  EXPECT_THAT(svg.Element(), HasSubstr("points=\"40.00,20.00 35.00,"));
  SvgDocument none(100, 50);
  none.Arrow({10, 20}, {10, 20}, 5.0, {});
  EXPECT_THAT(none.Element(), Not(HasSubstr("<line")));
  EXPECT_THAT(none.Element(), Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace palpate::plot
