// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <bit>
#include <cmath>

#include "libs/core/file.hpp"
#include "libs/experiment/cloud/lzf.hpp"
#include "libs/experiment/cloud/pcd.hpp"
#include "libs/experiment/cloud/ply.hpp"
#include "libs/experiment/cloud/point_cloud.hpp"
#include "tests/support/measured_data.hpp"
#include "tests/support/not_a_number.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::experiment {
namespace {

using test_support::MessageOf;
using test_support::TestFolder;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;
using testing::StartsWith;

namespace fs = std::filesystem;

PointCloud Small() {
  PointCloud cloud;
  cloud.width = 3;
  cloud.height = 2;
  cloud.points_m.resize(3, 6);
  cloud.points_m << 0.5, 1.25, kNaN, -3, 4, 5,  //
      0, 0.125, kNaN, 1, 2, 3,                  //
      1, 2, kNaN, 4, 5, 6;
  for (std::uint8_t i = 0; i < 18; ++i) {
    cloud.colors_rgb.push_back(static_cast<std::uint8_t>(250 - 13 * i));
  }
  return cloud;
}

/// Equal, NaN where NaN.
void ExpectSame(const PointCloud& a, const PointCloud& b) {
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  ASSERT_EQ(a.points_m.cols(), b.points_m.cols());
  for (Eigen::Index i = 0; i < a.points_m.size(); ++i) {
    const double x = a.points_m.data()[i], y = b.points_m.data()[i];
    EXPECT_TRUE(x == y || (std::isnan(x) && std::isnan(y))) << i << ": " << x << " " << y;
  }
  EXPECT_EQ(a.colors_rgb, b.colors_rgb);
}

std::string Bytes(std::initializer_list<int> values) {
  std::string bytes;
  for (const int value : values) bytes.push_back(static_cast<char>(value));
  return bytes;
}

std::string Float(float value, bool big = false) {
  std::string bytes;
  const auto bits = std::bit_cast<std::uint32_t>(value);
  for (int i = 0; i < 4; ++i) {
    bytes.push_back(static_cast<char>(bits >> (big ? 24 - 8 * i : 8 * i) & 0xff));
  }
  return bytes;
}

PointCloud ReadText(const std::string& name, const std::string& content) {
  const TestFolder folder;
  return ReadPointCloud(folder.Write(name, content));
}

std::string Refusal(const std::string& name, const std::string& content) {
  return MessageOf([&] { ReadText(name, content); });
}

const std::string kPcd =
    "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n"
    "WIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ascii\n1 2 3\nnan 5 6\n";

std::string PcdWith(const std::string& old, const std::string& fresh) {
  std::string text = kPcd;
  return text.replace(text.find(old), old.size(), fresh);
}

TEST(Lzf, UnpacksLiteralsAndCopies) {
  std::string out;
  ASSERT_TRUE(UnpackLzf(Bytes({2, 'a', 'b', 'c'}), 3, &out));
  EXPECT_EQ(out, "abc");
  ASSERT_TRUE(UnpackLzf(Bytes({2, 'a', 'b', 'c', 0x20, 2}), 6, &out));  // 3 bytes from 3 back
  EXPECT_EQ(out, "abcabc");
  ASSERT_TRUE(UnpackLzf(Bytes({0, 'x', 0xe0, 4, 0}), 14, &out));  // 13 of the byte before
  EXPECT_EQ(out, std::string(14, 'x'));
}

TEST(Lzf, RefusesWhatIsNoStreamOfThatSize) {
  std::string out;
  EXPECT_FALSE(UnpackLzf(Bytes({2, 'a', 'b', 'c'}), 4, &out));  // too little
  EXPECT_FALSE(UnpackLzf(Bytes({2, 'a', 'b', 'c'}), 2, &out));  // too much
  EXPECT_FALSE(UnpackLzf(Bytes({5, 'a', 'b'}), 6, &out));       // literals cut short
  EXPECT_FALSE(UnpackLzf(Bytes({0, 'a', 0x20}), 4, &out));      // copy cut short
  EXPECT_FALSE(UnpackLzf(Bytes({0, 'a', 0xe0, 1}), 11, &out));  // long copy cut short
  EXPECT_FALSE(UnpackLzf(Bytes({0, 'a', 0x20, 1}), 4, &out));   // from before the beginning
  EXPECT_FALSE(UnpackLzf(Bytes({0, 'a', 0x20, 0}), 3, &out));   // copy beyond the end
  EXPECT_FALSE(UnpackLzf("", std::size_t{1} << 40, &out));      // without taking the memory
}

TEST(Pcd, ReadsBackWhatItWrites) {
  const TestFolder folder;
  PointCloud cloud = Small();
  WritePcd(cloud, folder.path() / "a.pcd");
  ExpectSame(ReadPcd(folder.path() / "a.pcd"), cloud);
  cloud.colors_rgb.clear();
  WritePcd(cloud, folder.path() / "b.pcd");
  ExpectSame(ReadPcd(folder.path() / "b.pcd"), cloud);
}

TEST(Pcd, ReadsTextWithHolesAndSkipsOtherFields) {
  const PointCloud cloud = ReadText("a.pcd", kPcd);
  EXPECT_EQ(cloud.width, 2);
  EXPECT_FALSE(cloud.organised());
  EXPECT_EQ(cloud.points_m.col(0), Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE(cloud.points_m.col(1).array().isNaN().all());
  const PointCloud labelled = ReadText(
      "b.pcd",
      "FIELDS label normal x y z rgba\nSIZE 4 4 8 8 8 4\nTYPE U F F F F U\nCOUNT 1 3 1 1 1 1\n"
      "WIDTH 1\nHEIGHT 1\nDATA ascii\n7 0 0 1 -1.5e-1 2 3 4279250984\n");
  EXPECT_EQ(labelled.points_m.col(0), Eigen::Vector3d(-0.15, 2, 3));
  EXPECT_THAT(labelled.colors_rgb, ElementsAre(0x10, 0x30, 0x28));  // 0xFF103028
}

TEST(Pcd, ReadsAColourPackedInAFloatOfText) {
  const float packed = std::bit_cast<float>(std::uint32_t{0x00aa5501});
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.9g", static_cast<double>(packed));
  const PointCloud cloud =
      ReadText("a.pcd",
               "FIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F F\nWIDTH 1\nHEIGHT 1\nDATA "
               "ascii\n1 2 3 " +
                   std::string(text.data()) + "\n");
  EXPECT_THAT(cloud.colors_rgb, ElementsAre(0xaa, 0x55, 0x01));
}

TEST(Pcd, ReadsColoursInFieldsOfTheirOwn) {
  const std::string head =
      "FIELDS x y z r g b\nSIZE 4 4 4 1 1 1\nTYPE F F F U U U\nWIDTH 1\nHEIGHT 1\nDATA ";
  EXPECT_THAT(ReadText("a.pcd", head + "ascii\n1 2 3 10 20 255\n").colors_rgb,
              ElementsAre(10, 20, 255));
  const std::string binary(12, '\0');
  EXPECT_THAT(ReadText("a.pcd", head + "binary\n" + binary + "\x0a\x14\xff").colors_rgb,
              ElementsAre(10, 20, 255));
}

TEST(Pcd, ReadsAColourPackedInAnIntegerOfTextUnderAnyType) {
  for (const std::string type : {"F", "U", "I"}) {
    const PointCloud cloud =
        ReadText("a.pcd", "FIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F " + type +
                              "\nWIDTH 3\nHEIGHT 1\nDATA ascii\n1 2 3 11162881\n"
                              "1 2 3 4289352961\n1 2 3 nan\n");
    EXPECT_THAT(cloud.colors_rgb, ElementsAre(0xaa, 0x55, 0x01, 0xaa, 0x55, 0x01, 0, 0, 0)) << type;
  }
}

TEST(Pcd, ReadsCompressedPointsFieldByField) {
  const std::string points = Float(1) + Float(4) + Float(2) + Float(5) + Float(3) + Float(6);
  std::string packed = Bytes({23}) + points;  // one literal run
  const std::string header =
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nHEIGHT 2\nPOINTS 2\nDATA "
      "binary_compressed\n";
  const std::string sizes = Bytes({25, 0, 0, 0, 24, 0, 0, 0});
  const PointCloud cloud = ReadText("a.pcd", header + sizes + packed);
  EXPECT_EQ(cloud.height, 2);
  EXPECT_EQ(cloud.points_m.col(0), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(cloud.points_m.col(1), Eigen::Vector3d(4, 5, 6));
  EXPECT_THAT(Refusal("b.pcd", header + sizes + packed.substr(0, 20)),
              HasSubstr("is cut short: 20 of at least 25 bytes"));
  EXPECT_THAT(Refusal("b.pcd", header + sizes.substr(0, 5)), HasSubstr("is cut short"));
  EXPECT_THAT(Refusal("b.pcd", header + Bytes({25, 0, 0, 0, 23, 0, 0, 0}) + packed),
              HasSubstr("are 23 bytes, the header says 24"));
  packed[0] = 22;
  EXPECT_THAT(Refusal("b.pcd", header + sizes + packed), HasSubstr("points are damaged"));
}

TEST(Pcd, RefusesBrokenHeaders) {
  EXPECT_THAT(Refusal("a.pcd", "hello\n"), HasSubstr("a.pcd:1: 'hello' is no line"));
  EXPECT_THAT(Refusal("a.pcd", ""), HasSubstr("is no PCD file"));
  EXPECT_THAT(Refusal("a.pcd", PcdWith("FIELDS x y z", "FIELDS x y q")), HasSubstr("single 'z'"));
  EXPECT_THAT(Refusal("a.pcd", PcdWith("SIZE 4 4 4", "SIZE 4 4")), HasSubstr("a.pcd:4: one value"));
  EXPECT_THAT(Refusal("a.pcd", PcdWith("SIZE 4 4 4", "SIZE 4 4 4 4")), HasSubstr("more values"));
  EXPECT_THAT(Refusal("a.pcd", PcdWith("SIZE 4 4 4", "SIZE 4 2 4")), HasSubstr("field 'y'"));
  EXPECT_THAT(Refusal("a.pcd", PcdWith("TYPE F F F", "TYPE F F X")), HasSubstr("F, U or I"));
  EXPECT_THAT(Refusal("a.pcd", PcdWith("COUNT 1 1 1", "COUNT 1 1 -1")), HasSubstr("whole number"));
  EXPECT_THAT(Refusal("a.pcd", PcdWith("WIDTH 2", "WIDTH 3")), HasSubstr("is 3, POINTS is 2"));
  EXPECT_THAT(Refusal("a.pcd", PcdWith("WIDTH 2", "WIDTH 99000000")), HasSubstr("64000000"));
  EXPECT_THAT(Refusal("a.pcd", PcdWith("DATA ascii", "DATA hex")), HasSubstr("DATA is ascii"));
}

TEST(Pcd, RefusesAViewpointThatIsNotTheCamera) {
  for (const char* camera : {"0 0 0 -1 0 0 0", "0 0 0 0 1 0 0"}) {
    EXPECT_EQ(ReadText("a.pcd", PcdWith("0 0 0 1 0 0 0", camera)).points_m(2, 0), 3.0) << camera;
  }
  for (const char* other : {"0 0 0.5 1 0 0 0", "0 0 0 0.5 0.5 0 0", "0 0 0 0 0 1 0"}) {
    EXPECT_THAT(Refusal("a.pcd", PcdWith("0 0 0 1 0 0 0", other)),
                HasSubstr("a.pcd:9: the VIEWPOINT is not the camera"));
  }
  EXPECT_THAT(Refusal("a.pcd", PcdWith("0 0 0 1 0 0 0", "0 0 0 nan 0 0 0")), HasSubstr("seven"));
  EXPECT_THAT(Refusal("a.pcd", PcdWith("0 0 0 1 0 0 0", "0 0 0 1")), HasSubstr("seven"));
}

TEST(Pcd, RefusesPointsThatAreNot) {
  EXPECT_THAT(Refusal("a.pcd", PcdWith("nan 5 6", "nan 5 b")), HasSubstr("a.pcd:13: 'b' is no"));
  EXPECT_THAT(Refusal("a.pcd", PcdWith("nan 5 6", "1e99 5")), HasSubstr("fewer values"));
  EXPECT_THAT(Refusal("a.pcd", PcdWith("nan 5 6", "1 5 6 7")), HasSubstr("more values"));
  EXPECT_THAT(Refusal("a.pcd", PcdWith("nan 5 6\n", "")), HasSubstr("cut short"));
  EXPECT_THAT(Refusal("a.pcd", PcdWith("DATA ascii\n1 2 3\nnan 5 6\n",
                                       "DATA binary\n" + std::string(23, 'x'))),
              HasSubstr("is cut short: 23 of at least 24 bytes"));
}

TEST(Ply, ReadsBackWhatItWrites) {
  const TestFolder folder;
  PointCloud cloud = Small();
  WritePly(cloud, folder.path() / "a.ply");
  ExpectSame(ReadPly(folder.path() / "a.ply"), cloud);
  cloud.colors_rgb.clear();
  cloud.width = 6;
  cloud.height = 1;
  WritePly(cloud, folder.path() / "b.ply");
  ExpectSame(ReadPly(folder.path() / "b.ply"), cloud);
}

const std::string kPlyHead =
    "comment by hand\nelement camera 1\nproperty list uchar short sizes\nproperty double f\n"
    "element vertex 2\nproperty float x\nproperty uchar red\nproperty float y\n"
    "property list uint8 int32 seen_by\nproperty uchar green\nproperty uchar blue\n"
    "property double z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";

TEST(Ply, ReadsTextAndSkipsWhatItDoesNotNeed) {
  const PointCloud cloud = ReadText("a.ply", "ply\nformat ascii 1.0\n" + kPlyHead +
                                                 "2 640 480 525\n1.5 10 2 1 77 20 30 3\n"
                                                 "-1 255 nan 0 0 1 2\n3 0 1 1\n");
  ASSERT_EQ(cloud.points_m.cols(), 2);
  EXPECT_EQ(cloud.points_m.col(0), Eigen::Vector3d(1.5, 2, 3));
  EXPECT_TRUE(cloud.points_m.col(1).array().isNaN().all());
  EXPECT_THAT(cloud.colors_rgb, ElementsAre(10, 20, 30, 255, 0, 1));
}

std::string ColoredPly(const std::string& type, const std::string& first,
                       const std::string& second) {
  std::string head = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\n";
  head += "property float y\nproperty float z\n";
  for (const char* channel : {"red", "green", "blue"}) {
    head += "property " + type + " " + channel + "\n";
  }
  return head + "end_header\n1 2 3 " + first + "\n4 5 6 " + second + "\n";
}

TEST(Ply, ReadsColoursOfEveryType) {
  const auto colors = [](const std::string& type, const std::string& a, const std::string& b) {
    return ReadText("a.ply", ColoredPly(type, a, b)).colors_rgb;
  };
  EXPECT_THAT(colors("float", "0 0.5 1", "0.2 nan 0"), ElementsAre(0, 128, 255, 51, 0, 0));
  EXPECT_THAT(colors("double", "0 127.5 1", "255 1 0"), ElementsAre(0, 128, 1, 255, 1, 0));
  EXPECT_THAT(colors("ushort", "0 257 65535", "514 0 0"), ElementsAre(0, 1, 255, 2, 0, 0));
  EXPECT_THAT(colors("int", "0 1 255", "2 0 0"), ElementsAre(0, 1, 255, 2, 0, 0));
  EXPECT_THAT(Refusal("a.ply", ColoredPly("float", "0 0 300", "0 0 0")),
              HasSubstr("a colour is 300: from 0 to 255"));
  EXPECT_THAT(Refusal("a.ply", ColoredPly("int", "0 -2 0", "0 0 0")), HasSubstr("colour is -2"));
}

TEST(Ply, KnowsTheNamesThatProgramsGiveColours) {
  const std::string rows = "end_header\n1 2 3 10 20 30\n";
  for (const std::string prefix : {"", "diffuse_"}) {
    std::string head = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n";
    head += "property float y\nproperty float z\n";
    for (const char* channel : {"red", "green", "blue"}) {
      const std::string name = prefix.empty() ? std::string(1, *channel) : prefix + channel;
      head += "property uchar " + name + "\n";
    }
    EXPECT_THAT(ReadText("a.ply", head + rows).colors_rgb, ElementsAre(10, 20, 30)) << prefix;
  }
}

TEST(Ply, TakesTheLineEndThatAnEditorLeavesBehindBytes) {
  const std::string head =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\n"
      "property float y\nproperty float z\nend_header\n";
  const std::string point = Float(1, false) + Float(2, false) + Float(3, false);
  EXPECT_EQ(ReadText("a.ply", head + point + "\n").points_m.col(0), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(ReadText("a.ply", head + point + "\r\n").points_m.cols(), 1);
  EXPECT_THAT(Refusal("a.ply", head + point + "\n\n\n"), HasSubstr("3 bytes are left"));
}

TEST(Ply, ReadsBytesInEitherOrder) {
  for (const bool big : {false, true}) {
    const auto order = [&](std::string little) {
      return big ? std::string(little.rbegin(), little.rend()) : little;
    };
    const std::string two = order(Bytes({2, 0, 0, 0, 0, 0, 0, 0x40}).substr(6));
    const std::string f = order(Bytes({0, 0, 0, 0, 0, 0, 0xf0, 0x3f}));  // 1.0
    const std::string z = order(Bytes({0, 0, 0, 0, 0, 0, 0x08, 0x40}));  // 3.0
    const std::string item = order(Bytes({77, 0, 0, 0}));
    const std::string vertex =
        Float(1.5, big) + Bytes({10}) + Float(2, big) + Bytes({1}) + item + Bytes({20, 30}) + z;
    const PointCloud cloud =
        ReadText("a.ply", std::string("ply\nformat ") +
                              (big ? "binary_big_endian" : "binary_little_endian") + " 1.0\n" +
                              kPlyHead + Bytes({1}) + two + f + vertex + vertex + Bytes({0}));
    EXPECT_EQ(cloud.points_m.col(1), Eigen::Vector3d(1.5, 2, 3)) << big;
    EXPECT_THAT(cloud.colors_rgb, ElementsAre(10, 20, 30, 10, 20, 30));
  }
}

TEST(Ply, RefusesBrokenHeaders) {
  const std::string start = "ply\nformat ascii 1.0\n";
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  EXPECT_THAT(Refusal("a.ply", "plY\n"), HasSubstr("is no PLY file"));
  EXPECT_THAT(Refusal("a.ply", start), HasSubstr("no line 'end_header'"));
  EXPECT_THAT(Refusal("a.ply", "ply\nelement vertex 0\n" + xyz + "end_header\n"),
              HasSubstr("no line 'format'"));
  EXPECT_THAT(Refusal("a.ply", "ply\nformat text 1.0\n"), HasSubstr("a.ply:2: a format is"));
  EXPECT_THAT(Refusal("a.ply", start + "elements\n"), HasSubstr("'elements' is no line"));
  EXPECT_THAT(Refusal("a.ply", start + "element vertex -1\n"), HasSubstr("a.ply:3: a whole"));
  EXPECT_THAT(Refusal("a.ply", start + "property float x\n"), HasSubstr("before the first"));
  EXPECT_THAT(Refusal("a.ply", start + "element v 1\nproperty half x\n"), HasSubstr("type 'half'"));
  EXPECT_THAT(Refusal("a.ply", start + "element v 1\nproperty float\n"),
              HasSubstr("without a name"));
  EXPECT_THAT(Refusal("a.ply", start + "element v 1\nproperty list float int x\n"),
              HasSubstr("whole number"));
  EXPECT_THAT(Refusal("a.ply", start + "element face 0\nend_header\n"), HasSubstr("'vertex'"));
  EXPECT_THAT(Refusal("a.ply", start + "element vertex 0\nproperty float x\nend_header\n"),
              HasSubstr("no properties x, y and z"));
}

TEST(Ply, RefusesDataThatTheHeaderDoesNotDescribe) {
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  const std::string colors = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  const std::string header = "element vertex 2\n" + xyz + colors + "end_header\n";
  EXPECT_THAT(Refusal("a.ply",
                      "ply\nformat binary_little_endian 1.0\n" + header + std::string(2 * 16, 'x')),
              HasSubstr("2 bytes are left after the last element"))
      << "a colour packed into four bytes, as PCL writes it";
  const std::string text = "ply\nformat ascii 1.0\n" + header + "1 2 3 10 20 30\n4 5 6 7 8 9";
  EXPECT_EQ(ReadText("a.ply", text + "\n\n").points_m.cols(), 2);
  EXPECT_THAT(Refusal("a.ply", text + " 7\n"), HasSubstr("a.ply:12: the line has more values"));
  EXPECT_THAT(Refusal("a.ply", text + "\n1 2 3\n"), HasSubstr("left after the last element"));
}

TEST(Ply, RefusesPointsThatAreNot) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float "
      "z\nend_header\n";
  EXPECT_THAT(Refusal("a.ply", head + "1 2 3\n1 2 q\n"), HasSubstr("a.ply:9: 'q' is no number"));
  EXPECT_THAT(Refusal("a.ply", head + "1 2 3\n1 2\n"), HasSubstr("too few values"));
  EXPECT_THAT(Refusal("a.ply", head + "1.00000 2 3\n"), HasSubstr("is cut short"));
  const TestFolder folder;
  WritePly(Small(), folder.path() / "whole.ply");
  const std::string whole = ReadFile(folder.path() / "whole.ply");
  EXPECT_THAT(Refusal("a.ply", whole.substr(0, whole.size() - 1)), HasSubstr("is cut short"));
  EXPECT_THAT(Refusal("a.ply",
                      "ply\nformat binary_little_endian 1.0\nelement vertex 60000000\n"
                      "property float x\nproperty float y\nproperty float z\nend_header\n"),
              HasSubstr("is cut short"));
}

TEST(PointCloudFiles, SaysThatTheDiskIsFull) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  EXPECT_THAT(MessageOf<RunError>([] { WritePcd(Small(), "/dev/full"); }), HasSubstr("No space"));
  EXPECT_THAT(MessageOf<RunError>([] { WritePly(Small(), "/dev/full"); }), HasSubstr("No space"));
}

TEST(PointCloudFiles, RefusesOtherFiles) {
  EXPECT_THAT(Refusal("a.xyz", "1 2 3\n"), HasSubstr("a.xyz: is no point cloud"));
}

struct RealCloud {
  const char* file;
  double valid_share;
  bool colored;
};

class RealClouds : public testing::TestWithParam<RealCloud> {};

TEST_P(RealClouds, HaveTheShareOfPointsThatTheirReadmeTells) {
  const fs::path file = test_support::MeasuredDataFolder() / "rgbd_clouds" / GetParam().file;
  if (!fs::exists(file)) GTEST_SKIP() << file << " is not here";
  const PointCloud cloud = ReadPcd(file);
  EXPECT_EQ(cloud.width, 640);
  EXPECT_EQ(cloud.height, 480);
  const auto valid = cloud.points_m.row(0).array().isFinite().count();
  EXPECT_NEAR(static_cast<double>(valid) / 307200.0, GetParam().valid_share, 0.005);
  EXPECT_EQ(cloud.colors_rgb.empty(), !GetParam().colored);
}

INSTANTIATE_TEST_SUITE_P(Kinect, RealClouds,
                         testing::Values(RealCloud{"milk_cartoon_all_small_clorox.pcd", 0.79, true},
                                         RealCloud{"test31.pcd", 0.56, true},
                                         RealCloud{"capture0001.pcd", 0.81, false}));

}  // namespace
}  // namespace palpate::experiment
