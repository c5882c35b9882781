// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "components/view/frames/binary_frame.hpp"
#include "components/view/frames/page_request.hpp"
#include "components/view/frames/page_surface.hpp"
#include "components/view/frames/surface_residual.hpp"

namespace palpate::view {
namespace {

using Json = nlohmann::json;
using testing::ElementsAre;
using testing::SizeIs;

/// As the page reads it.
template <typename T>
std::vector<T> ArrayIn(const std::string& bytes, const std::string& name) {
  std::uint32_t json_size = 0;
  std::memcpy(&json_size, bytes.data(), sizeof(json_size));
  const Json array = Json::parse(bytes.substr(4, json_size)).at("arrays").at(name);
  const std::size_t begin = 4 + json_size + array.at("offset").get<std::size_t>();
  EXPECT_EQ(begin % 8, 0U);
  std::vector<T> values(array.at("length").get<std::size_t>());
  std::memcpy(values.data(), bytes.data() + begin, values.size() * sizeof(T));
  return values;
}

TEST(BinaryFrame, IsReadBackAtMultiplesOfEight) {
  for (int padding = 0; padding < 9; ++padding) {
    BinaryFrame frame("cloud", {{"text", std::string(static_cast<std::size_t>(padding), 'x')}});
    frame.Add("rgb", std::vector<std::uint8_t>{1, 2, 3});
    frame.Add("points_m", std::vector<float>{0.5F, -1.0F, 2.0F});
    frame.Add("triangles", std::vector<std::uint32_t>{7, 8});
    const std::string bytes = frame.Bytes();
    EXPECT_THAT(ArrayIn<std::uint8_t>(bytes, "rgb"), ElementsAre(1, 2, 3));
    EXPECT_THAT(ArrayIn<float>(bytes, "points_m"), ElementsAre(0.5F, -1.0F, 2.0F));
    EXPECT_THAT(ArrayIn<std::uint32_t>(bytes, "triangles"), ElementsAre(7U, 8U));
  }
}

TEST(BinaryFrame, MakesNullOfWhatIsNotFinite) {
  const Json read = Json::parse(JsonText({{"a", std::nan("")}, {"b", HUGE_VAL}, {"c", "\xff"}}));
  EXPECT_TRUE(read.at("a").is_null());
  EXPECT_TRUE(read.at("b").is_null());
}

TEST(PageSurface, HasTheNodesOfTheSurfaceOnly) {
  Eigen::Matrix3Xd nodes_m(3, 5);
  nodes_m << 0, 1, 2, 3, 4,  //
      0, 0, 0, 0, 0,         //
      9, 9, 9, 9, 9;
  Eigen::Matrix3Xi triangles(3, 2);
  triangles << 4, 1,  //
      1, 4,           //
      3, 0;
  const PageSurface surface = MakePageSurface("hash", nodes_m, triangles);
  EXPECT_THAT(surface.nodes, ElementsAre(4, 1, 3, 0));
  EXPECT_THAT(surface.triangles, ElementsAre(0U, 1U, 2U, 1U, 0U, 3U));
  const std::vector<float> moved_m = PositionsOf(surface, (2.0 * nodes_m).cast<float>());
  EXPECT_FLOAT_EQ(moved_m[0], 8.0F);
  EXPECT_FLOAT_EQ(moved_m[11], 18.0F);
}

/// A square of two triangles in the plane z = 0, seen from above.
struct Square {
  std::vector<float> positions_m{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  std::vector<std::uint32_t> triangles{0, 1, 2, 0, 2, 3};
};

TEST(SurfaceResidual, IsTheDistanceAlongTheNormalToTheNearestPoint) {
  const Square square;
  Eigen::Matrix3Xf points_m(3, 3);
  points_m.col(0) << 0.001F, 0.0F, 0.003F;  // above node 0, and beside it
  points_m.col(1) << 0.0F, 0.0F, 0.004F;    // farther
  points_m.col(2) << 1.0F, 0.0F, -0.002F;   // below node 1
  const std::vector<float> residual_m =
      SurfaceResidual(square.positions_m, square.triangles, points_m, 0.005F);
  ASSERT_THAT(residual_m, SizeIs(4));
  EXPECT_NEAR(residual_m[0], 0.003F, 1e-7F);
  EXPECT_NEAR(residual_m[1], -0.002F, 1e-7F);
  EXPECT_TRUE(std::isnan(residual_m[2]));
  EXPECT_TRUE(std::isnan(residual_m[3]));
}

TEST(SurfaceResidual, IsUnknownWithoutACloud) {
  const Square square;
  for (const float residual_m :
       SurfaceResidual(square.positions_m, square.triangles, Eigen::Matrix3Xf(3, 0), 0.005F)) {
    EXPECT_TRUE(std::isnan(residual_m));
  }
}

TEST(SurfaceResidual, FindsWhatASearchOfAllPointsFinds) {
  const Square square;
  constexpr float kRadius_m = 0.3F;
  Eigen::Matrix3Xf points_m(3, 500);
  unsigned state = 1;
  for (float& value : points_m.reshaped()) {
    state = state * 1664525U + 1013904223U;
    value = 1.6F * static_cast<float>(state >> 8) / 16777216.0F - 0.3F;
  }
  const std::vector<float> residual_m =
      SurfaceResidual(square.positions_m, square.triangles, points_m, kRadius_m);
  for (Eigen::Index node = 0; node < 4; ++node) {
    const Eigen::Map<const Eigen::Vector3f> at_m(square.positions_m.data() + 3 * node);
    Eigen::Index nearest = 0;
    const float distance_m =
        std::sqrt((points_m.colwise() - at_m).colwise().squaredNorm().minCoeff(&nearest));
    ASSERT_LT(distance_m, kRadius_m);
    EXPECT_NEAR(residual_m[static_cast<std::size_t>(node)], points_m(2, nearest), 1e-6F);
  }
}

TEST(PageRequest, IsReadByKind) {
  EXPECT_EQ(std::get<ProbeRequest>(ParsePageRequest(R"({"kind":"probe","vertex":7})")).vertex, 7U);
  EXPECT_TRUE(std::get<RecordRequest>(ParsePageRequest(R"({"kind":"record","on":true})")).on);
  const auto play =
      std::get<PlayRequest>(ParsePageRequest(R"({"kind":"play","paused":true,"rate":2})"));
  EXPECT_TRUE(play.paused);
  EXPECT_DOUBLE_EQ(play.rate, 2.0);
  EXPECT_DOUBLE_EQ(
      std::get<SeekRequest>(ParsePageRequest(R"({"kind":"seek","position_s":1.5})")).position_s,
      1.5);
  EXPECT_FALSE(std::get<SubscribeRequest>(
                   ParsePageRequest(R"({"kind":"subscribe","images":false,"clouds":true})"))
                   .images);
}

TEST(PageRequest, IsRefusedWithTheReason) {
  for (const std::string text :
       {"", "null", "[]", "{", R"({"kind":7})", R"({"kind":"launch"})",
        R"({"kind":"probe","vertex":-1})", R"({"kind":"probe","vertex":4294967296})",
        R"({"kind":"probe"})", R"({"kind":"record","on":"yes"})",
        R"({"kind":"play","paused":false,"rate":0})", R"({"kind":"seek","position_s":-1})",
        R"({"kind":"seek","position_s":1e999})", R"({"kind":"subscribe","images":1,"clouds":1})"}) {
    const PageRequest request = ParsePageRequest(text);
    ASSERT_TRUE(std::holds_alternative<BadRequest>(request)) << text;
    EXPECT_FALSE(std::get<BadRequest>(request).reason.empty()) << text;
  }
  EXPECT_TRUE(std::holds_alternative<BadRequest>(
      ParsePageRequest(R"({"kind":"record","on":true})" + std::string(kMostRequestBytes, ' '))));
}

}  // namespace
}  // namespace palpate::view
