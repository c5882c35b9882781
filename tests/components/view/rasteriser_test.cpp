// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/picture/rasteriser.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate::view {
namespace {

const Lighting kLamps{Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitZ()};

std::array<Vertex, 3> FlatTriangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                   const Eigen::Vector3d& c, const Color& color) {
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  return {Vertex{a, none, color}, {b, none, color}, {c, none, color}};
}

double CoveredArea_px2(const Rasteriser& rasteriser, int width, int height) {
  double area = 0.0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      area += rasteriser.Coverage(x, y);
    }
  }
  return area;
}

TEST(Rasteriser, CoversTheAreaOfATriangle) {
  Rasteriser rasteriser(100, 80, 3, palette::kPaper);
  rasteriser.DrawTriangle(
      FlatTriangle({10.2, 11.7, 0.0}, {88.1, 20.3, 0.0}, {31.4, 70.9, 0.0}, palette::kInk), kLamps);
  const double area = 0.5 * std::abs((88.1 - 10.2) * (70.9 - 11.7) - (20.3 - 11.7) * (31.4 - 10.2));
  // The error is that of the samples along the border, of about 230 px: 0.1 % of the area is 2 px2.
  EXPECT_NEAR(CoveredArea_px2(rasteriser, 100, 80), area, 0.002 * area);
}

TEST(Rasteriser, CoversTheSameWhicheverWayATriangleTurns) {
  Rasteriser one(40, 40, 2, palette::kPaper);
  Rasteriser other(40, 40, 2, palette::kPaper);
  const Eigen::Vector3d a(3, 4, 0), b(35, 9, 0), c(12, 33, 0);
  one.DrawTriangle(FlatTriangle(a, b, c, palette::kInk), kLamps);
  other.DrawTriangle(FlatTriangle(a, c, b, palette::kInk), kLamps);
  EXPECT_EQ(one.Resolve().rgb, other.Resolve().rgb);
}

TEST(Rasteriser, ShowsTheNearerTriangleInEitherOrder) {
  const auto near_red = FlatTriangle({0, 0, 2.0}, {40, 0, 2.0}, {0, 40, 2.0}, Color{1.0, 0.0, 0.0});
  const auto far_blue = FlatTriangle({0, 0, 1.0}, {40, 0, 1.0}, {0, 40, 1.0}, Color{0.0, 0.0, 1.0});
  for (const bool near_first : {true, false}) {
    Rasteriser rasteriser(40, 40, 1, palette::kPaper);
    rasteriser.DrawTriangle(near_first ? near_red : far_blue, kLamps);
    rasteriser.DrawTriangle(near_first ? far_blue : near_red, kLamps);
    const Image image = rasteriser.Resolve();
    EXPECT_EQ(image.Pixel(10, 10)[0], 255);
    EXPECT_EQ(image.Pixel(10, 10)[2], 0);
  }
}

TEST(Rasteriser, SplitsCrossingTrianglesWhereTheyCross) {
  // Nearness x against nearness 20: they cross at x = 20 px.
  Rasteriser rasteriser(40, 40, 1, palette::kPaper);
  rasteriser.DrawTriangle(
      FlatTriangle({0, -40, 0}, {40, -40, 40}, {20, 120, 20}, Color{1.0, 0.0, 0.0}), kLamps);
  rasteriser.DrawTriangle(
      FlatTriangle({0, -40, 20}, {40, -40, 20}, {20, 120, 20}, Color{0.0, 0.0, 1.0}), kLamps);
  const Image image = rasteriser.Resolve();
  EXPECT_EQ(image.Pixel(18, 10)[2], 255);
  EXPECT_EQ(image.Pixel(22, 10)[0], 255);
}

TEST(Rasteriser, CutsOffWhatLiesOutside) {
  Rasteriser rasteriser(20, 20, 2, palette::kPaper);
  rasteriser.DrawTriangle(FlatTriangle({-1e6, -1e6, 0}, {1e6, -1e6, 0}, {0, 1e6, 0}, palette::kInk),
                          kLamps);
  rasteriser.DrawLine({-1e9, 10, 1}, {1e9, 10, 1}, 3.0, palette::kInk, 1.0);
  rasteriser.DrawLine({-50, -50, 1}, {-40, -40, 1}, 3.0, palette::kInk, 1.0);
  EXPECT_DOUBLE_EQ(CoveredArea_px2(rasteriser, 20, 20), 400.0);
}

TEST(Rasteriser, DrawsALineOfItsWidth) {
  Rasteriser rasteriser(60, 60, 4, palette::kPaper);
  rasteriser.DrawLine({10, 12, 0}, {50, 42, 0}, 6.0, palette::kInk, 1.0);
  const double area = 6.0 * 50.0 + M_PI * 9.0;  // a strip and two half discs
  EXPECT_NEAR(CoveredArea_px2(rasteriser, 60, 60), area, 0.01 * area);
}

TEST(Rasteriser, LaysAVeilOnlyOverWhatIsBehindIt) {
  Rasteriser body(20, 20, 1, Color{1.0, 1.0, 1.0});
  Rasteriser veil(20, 20, 1, Color{1.0, 1.0, 1.0});
  body.DrawTriangle(FlatTriangle({0, 0, 5}, {20, 0, 5}, {0, 20, 5}, Color{1.0, 1.0, 1.0}), kLamps);
  veil.DrawTriangle(FlatTriangle({-1, -1, 1}, {60, -1, 1}, {-1, 60, 1}, Color{}), kLamps);
  body.Overlay(veil, 0.5);
  const Image image = body.Resolve();
  EXPECT_EQ(image.Pixel(2, 2)[0], 255);
  EXPECT_EQ(image.Pixel(18, 18)[0], 128);
}

}  // namespace
}  // namespace palpate::view
