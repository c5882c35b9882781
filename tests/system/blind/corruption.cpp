// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/blind/corruption.hpp"

#include <algorithm>
#include <sstream>
#include <utility>
#include <vector>

#include "libs/core/check.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/fem/mesh_io/read_mesh.hpp"
#include "libs/fem/mesh_io/write_vtu.hpp"
#include "libs/scenario/random.hpp"

namespace palpate::blind {

namespace {

namespace fs = std::filesystem;
using scenario::Random;

/// A moment of markers.csv: its stamp, and of each marker "name,x,y,z".
struct Moment {
  std::string stamp;
  std::vector<std::string> rows;
};

struct MarkerFile {
  std::string head;
  std::vector<Moment> moments;
};

MarkerFile ReadMarkerFile(const fs::path& file) {
  std::istringstream lines(ReadFile(file));
  MarkerFile markers;
  std::getline(lines, markers.head);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t comma = line.find(',');
    const std::string stamp = line.substr(0, comma);
    if (markers.moments.empty() || markers.moments.back().stamp != stamp) {
      markers.moments.push_back({.stamp = stamp, .rows = {}});
    }
    markers.moments.back().rows.push_back(line.substr(comma + 1));
  }
  if (markers.moments.size() < 10) throw RunError(file.string() + ": has hardly any moments");
  return markers;
}

void WriteMarkerFile(const MarkerFile& markers, const fs::path& file) {
  std::string text = markers.head + "\n";
  for (const Moment& moment : markers.moments) {
    for (const std::string& row : moment.rows) text += moment.stamp + "," + row + "\n";
  }
  WriteFile(file, text);
}

void ShuffleStamps(Random* random, MarkerFile* markers) {
  auto& moments = markers->moments;
  for (std::size_t left = moments.size(); left > 1; --left) {
    std::swap(moments[left - 1].stamp, moments[random->Below(left)].stamp);
  }
}

/// From a fifth of the recording on.
void Freeze(MarkerFile* markers) {
  auto& moments = markers->moments;
  const std::size_t last = moments.size() / 5;
  for (std::size_t i = last + 1; i < moments.size(); ++i) moments[i].rows = moments[last].rows;
}

/// As a spreadsheet writes what it cannot compute: in a tenth of all moments, of one marker.
void PutErrorWords(Random* random, MarkerFile* markers) {
  const std::size_t row = random->Below(markers->moments.front().rows.size());
  for (std::size_t i = random->Below(10); i < markers->moments.size(); i += 10) {
    std::string& text = markers->moments[i].rows.at(row);
    text = text.substr(0, text.find(',')) + ",#VALUE!,#VALUE!,#VALUE!";
  }
}

fs::path DrawRecording(const fs::path& experiment, Random* random) {
  std::vector<fs::path> moving;
  for (const auto& entry : fs::directory_iterator(experiment / "recordings")) {
    const bool rests = ReadFile(entry.path() / "recording.yaml").find("kind: rest") == 0;
    if (!rests) moving.push_back(entry.path());
  }
  std::sort(moving.begin(), moving.end());
  return moving.at(random->Below(moving.size()));
}

std::vector<fs::path> DepthImages(const fs::path& recording) {
  std::vector<fs::path> images;
  for (const auto& entry : fs::directory_iterator(recording / "depth")) {
    images.push_back(entry.path());
  }
  const auto stamp = [](const fs::path& image) { return std::stoll(image.stem().string()); };
  std::sort(images.begin(), images.end(),
            [&](const fs::path& a, const fs::path& b) { return stamp(a) < stamp(b); });
  if (images.size() < 10) throw RunError(recording.string() + ": has hardly any pictures");
  return images;
}

/// Of depth images, what Corruption says of markers; a file that is cut short is no picture.
void CorruptPictures(Corruption corruption, Random* random, const fs::path& recording) {
  const std::vector<fs::path> images = DepthImages(recording);
  std::vector<std::string> bytes;
  for (const fs::path& image : images) bytes.push_back(ReadFile(image));
  const std::size_t last = images.size() / 5;
  for (std::size_t left = bytes.size(); left > 1; --left) {
    if (corruption != Corruption::kShuffledStamps) break;
    std::swap(bytes[left - 1], bytes[random->Below(left)]);
  }
  for (std::size_t i = 0; i < images.size(); ++i) {
    if (corruption == Corruption::kFrozenMarkers && i > last) bytes[i] = bytes[last];
    if (corruption == Corruption::kNotANumber && i % 3 == 1) bytes[i].resize(bytes[i].size() / 2);
    WriteFile(images[i], bytes[i]);
  }
}

void Enlarge(double factor, robot::Box* box) {
  box->lower_m *= factor;
  box->upper_m *= factor;
}

/// Names, material and cables stay.
fs::path WriteEnlarged(double factor, robot::RobotDescription robot, const fs::path& folder) {
  const fem::TetMesh mesh = fem::ReadMesh(robot.mesh.file, robot.mesh.metres_per_unit);
  const Eigen::Matrix3Xd nodes_m = factor * mesh.nodes_m;
  robot.mesh.file = folder / "other_robot.vtu";
  robot.mesh.metres_per_unit = 1.0;
  robot.mesh.translate_m *= factor;
  fem::WriteVtu(robot.mesh.file, mesh, nodes_m.reshaped());
  for (robot::Box& box : robot.fixed) Enlarge(factor, &box);
  for (auto& region : robot.regions) Enlarge(factor, &region.box);
  for (auto& cable : robot.cables) cable.path_m *= factor;
  for (auto& marker : robot.markers) marker.position_m *= factor;
  const fs::path file = folder / "other_robot.yaml";
  robot::WriteRobotFile(robot, file);
  return file;
}

}  // namespace

void Corrupt(Corruption corruption, std::uint64_t seed, const fs::path& experiment) {
  if (corruption == Corruption::kNone || corruption == Corruption::kOtherRobot) return;
  Random random(seed, "corruption");
  const fs::path recording = DrawRecording(experiment, &random);
  if (corruption == Corruption::kMissingActuation) {
    PALPATE_CHECK(fs::remove(recording / "actuation.csv"), recording.string());
    return;
  }
  if (!fs::exists(recording / "markers.csv")) {
    CorruptPictures(corruption, &random, recording);
    return;
  }
  MarkerFile markers = ReadMarkerFile(recording / "markers.csv");
  if (corruption == Corruption::kShuffledStamps) ShuffleStamps(&random, &markers);
  if (corruption == Corruption::kFrozenMarkers) Freeze(&markers);
  if (corruption == Corruption::kNotANumber) PutErrorWords(&random, &markers);
  WriteMarkerFile(markers, recording / "markers.csv");
}

fs::path OtherRobotFile(std::uint64_t seed, const robot::RobotDescription& robot,
                        const fs::path& folder) {
  constexpr double kLarger = 1.4;
  if (Random(seed, "other robot").Below(2) == 0) return robot.file.parent_path() / "beam.yaml";
  return WriteEnlarged(kLarger, robot, folder);
}

}  // namespace palpate::blind
