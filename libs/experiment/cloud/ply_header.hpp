// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "libs/experiment/cloud/scalar.hpp"

namespace palpate::experiment {

enum class PlyFormat { kAscii, kLittle, kBig };

struct PlyProperty {
  std::string name;
  Scalar scalar;
  bool list = false;
  Scalar count;  ///< of a list: how its length is stored
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::kAscii;
  std::vector<PlyElement> elements;  ///< in the order of the data
  std::uint64_t columns = 0;         ///< `obj_info num_cols`; 0: unknown
  std::uint64_t rows = 0;
  int lines = 0;
};

/// Takes the header, up to and with end_header, from the front of `rest`. Throws InputError with
/// file:line.
PlyHeader TakePlyHeader(const std::string& file, std::string_view* rest);

}  // namespace palpate::experiment
