// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "libs/experiment/c3d/c3d_bytes.hpp"
#include "libs/experiment/c3d/c3d_parameters.hpp"
#include "libs/experiment/captured_markers.hpp"

namespace palpate::experiment {

inline constexpr std::size_t kC3dBlockSize = 512;

/// Place and encoding of the points in a C3D file.
struct C3dLayout {
  std::size_t point_count = 0;
  std::size_t frame_count = 0;
  std::size_t analog_values_per_frame = 0;  ///< all channels and sub-samples
  std::size_t data_offset = 0;              ///< bytes
  bool real_points = false;                 ///< 4-byte reals, else 2-byte integers times scale
  double scale = 0.0;                       ///< > 0, file units per integer step and residual step
  double rate_Hz = 0.0;
  double metres_per_unit = 1.0;
  std::vector<std::string> labels;  ///< point_count of them; two may be equal
  std::vector<bool> is_length;      ///< [point_count] false: an angle, a force, ...
  std::vector<std::string> notes;

  std::size_t value_size() const { return real_points ? 4 : 2; }
  std::size_t frame_size() const {
    return (4 * point_count + analog_values_per_frame) * value_size();
  }
  /// Of the four words of a point in a frame, both counted from 0.
  std::size_t OffsetOf(std::size_t frame, std::size_t point) const {
    return data_offset + frame * frame_size() + point * 4 * value_size();
  }
};

/// Reads header and parameters and checks that they agree and that all frames lie in the file.
/// Sets the processor of `bytes`. Throws InputError with the byte offset.
C3dLayout ReadC3dLayout(C3dBytes& bytes, const C3dOptions& options);

}  // namespace palpate::experiment
