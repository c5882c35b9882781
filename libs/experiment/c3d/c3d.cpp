// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <cmath>
#include <map>

#include "libs/core/index.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/c3d/c3d_bytes.hpp"
#include "libs/experiment/c3d/c3d_layout.hpp"
#include "libs/experiment/captured_markers.hpp"

namespace palpate::experiment {

namespace {

// One point of one frame: x, y, z and a fourth word that holds the cameras (high byte) and the
// residual (low byte) together, negative where the point was not seen. In files of reals the
// fourth word is that same integer written as a real.
struct Sample {
  std::optional<Eigen::Vector3d> position_m;
  double residual_m = 0.0;
  std::uint8_t cameras = 0;
};

class SampleReader {
 public:
  SampleReader(const C3dBytes& bytes, const C3dLayout& layout) : bytes_(bytes), layout_(layout) {}

  Sample Read(std::size_t offset) const {
    Sample sample;
    if (HoldsNan(offset)) return sample;
    const int word = ReadFourthWord(offset + 3 * layout_.value_size());
    if (word < 0) return sample;
    sample.position_m = Eigen::Vector3d::Zero();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      (*sample.position_m)[ToIndex(axis)] = ReadCoordinate(offset + axis * layout_.value_size());
    }
    sample.cameras = static_cast<std::uint8_t>(word >> 8);
    sample.residual_m = (word & 0xff) * layout_.scale * layout_.metres_per_unit;
    return sample;
  }

 private:
  // Whether one of the four words is no number: so some programs write what was not seen.
  bool HoldsNan(std::size_t offset) const {
    for (std::size_t word = 0; layout_.real_points && word < 4; ++word) {
      if (std::isnan(bytes_.Real(offset + word * layout_.value_size()))) return true;
    }
    return false;
  }

  int ReadFourthWord(std::size_t offset) const {
    if (!layout_.real_points) return bytes_.Int16(offset);
    const double word = bytes_.Real(offset);
    if (word < 0.0) return -1;
    if (!(word <= 32767.0)) {
      bytes_.Refuse(offset, "residual and cameras of a point are no 16-bit number");
    }
    return static_cast<int>(word);
  }

  double ReadCoordinate(std::size_t offset) const {
    const double value =
        layout_.real_points ? bytes_.Real(offset) : bytes_.Int16(offset) * layout_.scale;
    const double coordinate_m = value * layout_.metres_per_unit;
    if (!(std::abs(coordinate_m) <= kLargestCoordinate_m)) {
      bytes_.Refuse(offset, "a coordinate is not within " + FormatNumber(kLargestCoordinate_m) +
                                " m of the origin");
    }
    return coordinate_m;
  }

  const C3dBytes& bytes_;
  const C3dLayout& layout_;
};

bool IsEverSeen(const C3dLayout& layout, const SampleReader& reader, std::size_t point) {
  for (std::size_t frame = 0; frame < layout.frame_count; ++frame) {
    if (reader.Read(layout.OffsetOf(frame, point)).position_m) return true;
  }
  return false;
}

// The points that are positions and that a frame sees; of the others a note.
std::vector<std::size_t> PointsToKeep(const C3dBytes& bytes, const C3dLayout& layout,
                                      const SampleReader& reader, CapturedMarkers* captured) {
  std::vector<std::size_t> points;
  std::vector<std::string> unseen;
  for (std::size_t point = 0; point < layout.point_count; ++point) {
    if (!layout.is_length[point]) continue;
    if (IsEverSeen(layout, reader, point)) {
      points.push_back(point);
    } else {
      unseen.push_back(layout.labels[point] + " (point " + std::to_string(point + 1) + ")");
    }
  }
  if (points.empty()) bytes.Refuse(layout.data_offset, "no frame sees a marker");
  if (!unseen.empty()) {
    captured->notes.push_back("left out, as no frame sees them: " + Excerpt(Listed(unseen)));
  }
  return points;
}

// Two points of one label would be one marker: both get a number, so that neither is taken for it.
void NamePoints(const std::vector<std::size_t>& points, const C3dLayout& layout,
                CapturedMarkers* captured) {
  std::map<std::string, int> count_of_label, number_of_label;
  for (const std::size_t point : points) ++count_of_label[layout.labels[point]];
  for (const std::size_t point : points) {
    const std::string& label = layout.labels[point];
    std::string name = label;
    while (count_of_label[label] > 1 && (name == label || count_of_label.contains(name))) {
      name = label + "_" + std::to_string(++number_of_label[label]);
    }
    captured->tracks.names.push_back(name);
  }
  for (const auto& [label, count] : count_of_label) {
    if (count == 1) continue;
    captured->notes.push_back("label '" + label + "' is given to " + std::to_string(count) +
                              " points, which are called " + label + "_1, " + label +
                              "_2: rename the right one (--rename " + label + "_1=" + label +
                              "), or leave them out (--markers)");
  }
}

}  // namespace

CapturedMarkers ReadC3d(const std::filesystem::path& file, const C3dOptions& options) {
  C3dBytes bytes(file);
  const C3dLayout layout = ReadC3dLayout(bytes, options);
  const SampleReader reader(bytes, layout);
  CapturedMarkers captured;
  captured.rate_Hz = layout.rate_Hz;
  captured.notes = layout.notes;
  const std::vector<std::size_t> points = PointsToKeep(bytes, layout, reader, &captured);
  NamePoints(points, layout, &captured);
  captured.tracks.names_where.assign(points.size(), SourceLocation{file.string()});
  captured.tracks.frames.resize(layout.frame_count);
  captured.residuals_m.resize(layout.frame_count);
  captured.cameras.resize(layout.frame_count);
  for (std::size_t i = 0; i < layout.frame_count; ++i) {
    MarkerFrame& frame = captured.tracks.frames[i];
    frame.t_s = static_cast<double>(i) / layout.rate_Hz;
    for (const std::size_t point : points) {
      const Sample sample = reader.Read(layout.OffsetOf(i, point));
      frame.positions_m.push_back(sample.position_m);
      captured.residuals_m[i].push_back(sample.position_m ? std::optional<double>(sample.residual_m)
                                                          : std::nullopt);
      captured.cameras[i].push_back(sample.cameras);
    }
  }
  return captured;
}

}  // namespace palpate::experiment
