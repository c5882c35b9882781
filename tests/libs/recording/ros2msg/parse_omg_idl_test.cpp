// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include "libs/recording/ros2msg/message_definition.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::recording {
namespace {

using testing::HasSubstr;

constexpr char kIdl[] = R"(module a {
enum Color {
  @value(0) RED,
  @value(1) GREEN
};
};
module a {
typedef double Row[3];
};
module a {
module b {
@final
struct Point_ {
  @key
  unsigned long long id;
  a::Row xyz;
};
};
};
@appendable
struct Thing : a::b::Point_ {
  a::Color color;
  sequence<a::b::Point_, 4> points;
  string<16> name;
  float matrix[3][4];
  sequence<octet> data;
};
)";

TEST(OmgIdl, GivesTheFieldsOfStructsByTheirFullNames) {
  const Definitions definitions = ParseOmgIdl(kIdl);
  const std::vector<Field> base{{"uint64", "id", Repeat::kOne, 0},
                                {"float64", "xyz", Repeat::kFixed, 3}};
  EXPECT_EQ(definitions.at("a::b::Point_").fields, base);
  std::vector<Field> all = base;
  all.push_back({"int32", "color", Repeat::kOne, 0});
  all.push_back({"a::b::Point_", "points", Repeat::kSequence, 0});
  all.push_back({"string", "name", Repeat::kOne, 0});
  all.push_back({"float32", "matrix", Repeat::kFixed, 12});
  all.push_back({"uint8", "data", Repeat::kSequence, 0});
  EXPECT_EQ(definitions.at("Thing").fields, all);
}

TEST(OmgIdl, RefusesWhatIsNotRead) {
  const auto refusal = [](const std::string& text) {
    return test_support::MessageOf([&] { (void)ParseOmgIdl(text); });
  };
  EXPECT_THAT(refusal("@mutable\nstruct A { long a; };"), HasSubstr("mutable"));
  EXPECT_THAT(refusal("struct A { @optional long a; };"), HasSubstr("optional"));
  EXPECT_THAT(refusal("struct A { sequence<sequence<long>> a; };"), HasSubstr("nested sequences"));
  EXPECT_THAT(refusal("struct A { Other a; };"), HasSubstr("unknown type 'Other'"));
  EXPECT_THAT(refusal("struct A { long a; "), HasSubstr("ends early"));
  EXPECT_THAT(refusal("};"), HasSubstr("closes more than it opens"));
  EXPECT_THAT(refusal("struct A { long a[x]; };"), HasSubstr("for a number"));
}

}  // namespace
}  // namespace palpate::recording
