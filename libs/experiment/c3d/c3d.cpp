// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <cmath>

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
  int ReadFourthWord(std::size_t offset) const {
    if (!layout_.real_points) return bytes_.Int16(offset);
    const double word = bytes_.Real(offset);
    if (!(word >= -32768.0 && word <= 32767.0)) {
      bytes_.Refuse(offset, "residual and cameras of a point are no 16-bit number");
    }
    return word < 0.0 ? -1 : static_cast<int>(word);
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

}  // namespace

CapturedMarkers ReadC3d(const std::filesystem::path& file, const C3dOptions& options) {
  C3dBytes bytes(file);
  const C3dLayout layout = ReadC3dLayout(bytes, options);
  const SampleReader reader(bytes, layout);
  CapturedMarkers captured;
  captured.rate_Hz = layout.rate_Hz;
  captured.tracks.names = layout.labels;
  captured.tracks.names_where.assign(layout.point_count, SourceLocation{file.string()});
  captured.tracks.frames.resize(layout.frame_count);
  captured.residuals_m.resize(layout.frame_count);
  captured.cameras.resize(layout.frame_count);
  for (std::size_t i = 0; i < layout.frame_count; ++i) {
    MarkerFrame& frame = captured.tracks.frames[i];
    frame.t_s = static_cast<double>(i) / layout.rate_Hz;
    for (std::size_t point = 0; point < layout.point_count; ++point) {
      const std::size_t offset =
          layout.data_offset + i * layout.frame_size() + point * 4 * layout.value_size();
      const Sample sample = reader.Read(offset);
      frame.positions_m.push_back(sample.position_m);
      captured.residuals_m[i].push_back(sample.position_m ? std::optional<double>(sample.residual_m)
                                                          : std::nullopt);
      captured.cameras[i].push_back(sample.cameras);
    }
  }
  return captured;
}

}  // namespace palpate::experiment
