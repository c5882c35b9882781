// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "libs/core/file.hpp"
#include "libs/experiment/captured_markers.hpp"
#include "libs/experiment/cloud/cloud_convention.hpp"
#include "libs/experiment/cloud/pcd.hpp"
#include "libs/experiment/cloud/ply.hpp"
#include "tests/libs/experiment/c3d_writer.hpp"
#include "tests/support/memory_limit.hpp"
#include "tests/support/mutations.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::experiment {
namespace {

struct ValidFile {
  std::string name;
  std::string bytes;
};

C3dContent SomePoints(C3dProcessor processor) {
  C3dContent content;
  content.processor = processor;
  content.labels = {"tip", "KneeAngles"};
  content.angles = {"KneeAngles"};
  content.frames.assign(5, {{.x = 1.0, .y = 2.0, .z = 3.0}, {.x = 90.0}});
  return content;
}

std::vector<ValidFile> ValidFiles(const test_support::TestFolder& folder) {
  PointCloud cloud;
  cloud.width = 3;
  cloud.points_m = Eigen::Matrix3Xd::Constant(3, 3, 0.5);
  cloud.colors_rgb.assign(9, 100);
  WritePly(cloud, folder / "c.ply");
  WritePcd(cloud, folder / "c.pcd");
  return {
      {"a.c3d", WriteC3d(SomePoints(C3dProcessor::kIntel))},
      {"b.c3d", WriteC3d(SomePoints(C3dProcessor::kMips))},
      {"c.ply", ReadFile(folder / "c.ply")},
      {"c.pcd", ReadFile(folder / "c.pcd")},
      {"d.csv",
       "Format Version,1.23,Export Frame Rate,100,Length Units,Meters\n\n,Type,Marker,Marker,"
       "Marker\n,Name,a,a,a\n,,Position,Position,Position\nFrame,Time (Seconds),X,Y,Z\n"
       "0,0.0,1,2,3\n1,0.01,1,2,3\n"},
      {"e.csv",
       "Trajectories\n100\n,,a\nFrame,Sub Frame,X,Y,Z\n,,mm,mm,mm\n1,0,1,2,3\n2,0,1,2,3\n"},
      {"f.tsv",
       "NO_OF_FRAMES\t1\nFREQUENCY\t50\nDATA_INCLUDED\t3D\nMARKER_NAMES\ta\n1\t2\t3\n4\t5\t6\n"},
      {"g.trc",
       "PathFileType\t4\nDataRate\tUnits\n100\tm\nFrame#\tTime\ta\n\t\tX1\tY1\tZ1\n"
       "1\t0.1\t1\t2\t3\n2\t0.2\t1\t2\t3\n"},
      {"h.csv", "t_s;marker;x_m;y_m;z_m\n0,0;a;0,1;0,2;0,3\n0,1;a;NaN;NaN;NaN\n"}};
}

void ReadOne(const std::filesystem::path& file) {
  if (file.extension() == ".ply" || file.extension() == ".pcd") {
    PointCloud cloud = ReadPointCloud(file);
    if (const auto convention = ConventionOf(cloud)) ToOpticalFrame(*convention, &cloud);
  } else {
    ReadCapture(file);
  }
}

void ReadOrRefuse(int rounds, unsigned seed) {
  const test_support::TestFolder folder;
  const test_support::MemoryLimit limit(test_support::kReaderLimit_bytes);
  test_support::Mutations mutations(seed);
  int refused = 0, read = 0;
  for (const ValidFile& file : ValidFiles(folder)) {
    EXPECT_NO_THROW(ReadOne(folder.Write(file.name, file.bytes))) << file.name;
    for (int round = 0; round < rounds; ++round) {
      try {
        ReadOne(folder.Write(file.name, mutations.Of(file.bytes)));
        ++read;
      } catch (const InputError&) {
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, rounds);
  EXPECT_GT(read, rounds / 10);
}

TEST(MutatedFiles, AreReadOrRefused) { ReadOrRefuse(100, 20261128); }

TEST(MutatedFiles, AreReadOrRefusedInManyRounds) { ReadOrRefuse(20000, 7); }

}  // namespace
}  // namespace palpate::experiment
