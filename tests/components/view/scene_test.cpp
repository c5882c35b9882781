// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/picture/scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "components/view/picture/png.hpp"
#include "components/view/picture/surface_edges.hpp"
#include "libs/core/error.hpp"
#include "tests/support/not_a_number.hpp"

namespace palpate::view {
namespace {

Surface Cube() {
  Surface cube;
  cube.points_m.resize(3, 8);
  for (int i = 0; i < 8; ++i) {
    cube.points_m.col(i) << 0.1 * (i & 1), 0.1 * (i >> 1 & 1), 0.1 * (i >> 2 & 1);
  }
  cube.triangles.resize(3, 12);
  cube.triangles << 0, 0, 4, 4, 0, 0, 2, 2, 0, 0, 1, 1,  //
      2, 3, 5, 7, 1, 5, 6, 7, 4, 6, 3, 7,                //
      3, 1, 7, 6, 5, 4, 7, 3, 6, 2, 7, 5;
  return cube;
}

Scene SmallScene() {
  Scene scene;
  scene.width_px = 480;
  scene.height_px = 360;
  scene.samples_per_px = 2;
  Surface cube = Cube();
  cube.scalars = cube.points_m.row(2).transpose();
  scene.surfaces.push_back(cube);
  Surface ghost = Cube();
  ghost.points_m.array() += 0.02;
  scene.ghosts.push_back(ghost);
  scene.tubes.push_back({cube.points_m.leftCols(2)});
  scene.arrows.push_back({{0.1, 0.1, 0.1}, {0.0, 0.0, 0.06}, false, palette::kEstimate, "0.5 N"});
  scene.points.push_back({Points::Shape::kBall, Eigen::Vector3d(0.1, 0.0, 0.1)});
  scene.points.push_back({Points::Shape::kCross, Eigen::Vector3d(0.1, 0.0, 0.1)});
  scene.blocks.push_back({{0.05, 0.05, -0.01}, Eigen::Vector3d(0.06, 0.06, 0.01).asDiagonal()});
  scene.floor_z_m = -0.05;
  scene.color_bar = ColorBar{"displacement (mm)", 0.1, 1000.0};
  scene.title = "A cube";
  return scene;
}

int CountPixels(const Image& image, const Color& color) {
  int count = 0;
  for (int y = 0; y < image.height_px; ++y) {
    for (int x = 0; x < image.width_px; ++x) {
      const std::uint8_t* pixel = image.Pixel(x, y);
      count +=
          pixel[0] == ToByte(color.r) && pixel[1] == ToByte(color.g) && pixel[2] == ToByte(color.b);
    }
  }
  return count;
}

int CountDifferences(const Image& a, const Image& b) {
  int count = 0;
  for (std::size_t i = 0; i < a.rgb.size(); i += 3) {
    count += a.rgb[i] != b.rgb[i] || a.rgb[i + 1] != b.rgb[i + 1] || a.rgb[i + 2] != b.rgb[i + 2];
  }
  return count;
}

void ExpectRefused(const Scene& scene, const std::string& message) {
  try {
    RenderScene(scene);
    ADD_FAILURE() << "not refused: " << message;
  } catch (const RunError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr(message));
  }
}

TEST(Scene, GivesTheSameBytesTwice) {
  EXPECT_EQ(RenderScene(SmallScene()).rgb, RenderScene(SmallScene()).rgb);
}

TEST(Scene, KeepsTheBorderOfThePictureWhite) {
  const Image image = RenderScene(SmallScene());
  for (int x = 0; x < image.width_px; ++x) {
    for (const int y : {0, 1, image.height_px - 2, image.height_px - 1}) {
      ASSERT_EQ(image.Pixel(x, y)[1], 255) << x << ' ' << y;
    }
  }
  for (int y = 0; y < image.height_px; ++y) {
    for (const int x : {0, 1, image.width_px - 2, image.width_px - 1}) {
      ASSERT_EQ(image.Pixel(x, y)[1], 255) << x << ' ' << y;
    }
  }
}

TEST(Scene, IsNotBlank) {
  const Image image = RenderScene(SmallScene());
  const int pixels = image.width_px * image.height_px;
  EXPECT_LT(CountPixels(image, palette::kPaper), 0.95 * pixels);
  EXPECT_GT(CountPixels(image, palette::kPaper), 0.4 * pixels);
}

TEST(Scene, WritesLabelAndTitle) {
  const Image image = RenderScene(SmallScene());
  Scene scene = SmallScene();
  scene.arrows[0].label.clear();
  EXPECT_GT(CountDifferences(image, RenderScene(scene)), 40);
  scene = SmallScene();
  scene.title = " ";
  EXPECT_GT(CountDifferences(image, RenderScene(scene)), 40);
}

TEST(Scene, ColorsBySizeOfTheScalar) {
  Scene scene = SmallScene();
  scene.ghosts.clear();
  scene.arrows.clear();
  Scene other = scene;
  other.surfaces[0].scalars.setZero();
  EXPECT_NE(RenderScene(scene).rgb, RenderScene(other).rgb);
}

TEST(Scene, ShowsAHiddenMarkerAsARing) {
  Scene scene = SmallScene();
  scene.points = {{Points::Shape::kBall, Eigen::Vector3d(0.05, 0.09, 0.05)}};
  scene.points[0].radius_m = 0.008;
  const Image behind = RenderScene(scene);
  scene.points.clear();
  EXPECT_NE(behind.rgb, RenderScene(scene).rgb);
}

TEST(Scene, RefusesAnEmptyScene) {
  Scene scene;
  ExpectRefused(scene, "nothing in it");
  scene.surfaces.emplace_back();
  ExpectRefused(scene, "nothing in it");
}

TEST(Scene, RefusesNaNAnywhere) {
  Scene scene = SmallScene();
  scene.surfaces[0].points_m(1, 3) = kNaN;
  ExpectRefused(scene, "point 3 of a surface is not finite");
  scene = SmallScene();
  scene.surfaces[0].scalars(2) = kNaN;
  ExpectRefused(scene, "a scalar of a surface is not finite");
  scene = SmallScene();
  scene.points[0].name = "markers";
  scene.points[0].points_m(0, 0) = kNaN;
  ExpectRefused(scene, "point 0 of 'markers' is not finite");
  scene = SmallScene();
  scene.arrows[0].vector_m.x() = kNaN;
  ExpectRefused(scene, "arrow '0.5 N' is not finite");
  scene = SmallScene();
  scene.tubes[0].points_m(0, 1) = std::numeric_limits<double>::infinity();
  ExpectRefused(scene, "a tube is not finite");
  scene = SmallScene();
  scene.color_bar->maximum = kNaN;
  ExpectRefused(scene, "maximum above 0");
  scene = SmallScene();
  scene.floor_z_m = kNaN;
  ExpectRefused(scene, "floor");
  scene = SmallScene();
  scene.view.elevation_deg = 90.0;
  ExpectRefused(scene, "elevation");
}

TEST(Scene, RefusesTrianglesAndScalarsThatDoNotFit) {
  Scene scene = SmallScene();
  scene.surfaces[0].triangles(2, 5) = 8;
  ExpectRefused(scene, "triangle 5 of a surface names a point that is not there (8 points)");
  scene = SmallScene();
  scene.surfaces[0].scalars.resize(5);
  scene.surfaces[0].scalars.setZero();
  ExpectRefused(scene, "5 scalars for 8 points");
  scene = SmallScene();
  scene.width_px = 100000;
  ExpectRefused(scene, "100000 x 360 px");
}

TEST(SurfaceEdges, FindsTheTwelveCreasesOfACube) {
  const Surface cube = Cube();
  const Camera camera = Camera::Fit({}, {{{0.05, 0.05, 0.05}, 0.1}}, {0, 0, 100, 100});
  const SurfaceEdges edges = FindEdges(cube.points_m, cube.triangles, camera);
  EXPECT_EQ(edges.all.cols(), 18);
  EXPECT_EQ(edges.outlines.cols(), 12);
  EXPECT_LT((edges.corner_normals.col(0) + Eigen::Vector3d::UnitZ()).norm(), 1e-12);
}

TEST(Png, ReadsBackAsItWasWritten) {
  const Image image = RenderScene(SmallScene());
  const auto path = std::filesystem::path(testing::TempDir()) / "view_test_scene.png";
  WritePng(path, image);
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_file(&png, path.c_str()));
  png.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> rgb(PNG_IMAGE_SIZE(png));
  ASSERT_TRUE(png_image_finish_read(&png, nullptr, rgb.data(), 0, nullptr));
  EXPECT_EQ(png.width, 480U);
  EXPECT_EQ(rgb, image.rgb);
  std::filesystem::remove(path);
}

TEST(Png, SaysWhereItCannotWrite) {
  const Image image = Image::Filled(64, 64, palette::kPaper);
  try {
    WritePng("/no/such/folder/scene.png", image);
    FAIL();
  } catch (const RunError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("/no/such/folder/scene.png"));
    EXPECT_THAT(error.what(), testing::HasSubstr("No such file or directory"));
  }
}

TEST(Png, NoticesAFullDisk) {
  if (!std::filesystem::exists("/dev/full")) {
    GTEST_SKIP() << "no /dev/full here";
  }
  try {
    WritePng("/dev/full", RenderScene(SmallScene()));
    FAIL();
  } catch (const RunError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("No space left on device"));
  }
}

}  // namespace
}  // namespace palpate::view
