// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/mesh_io/stl_reader.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/core/index.hpp"
#include "libs/core/text.hpp"

namespace palpate::fem {

namespace {

constexpr std::size_t kHeaderBytes = 80;
constexpr std::size_t kCountBytes = 4;
constexpr std::size_t kTriangleBytes = 50;
constexpr std::size_t kNormalBytes = 12;

static_assert(std::endian::native == std::endian::little, "binary STL is little endian");

/// Gathers corners as vertices of a surface.
class StlVertices {
 public:
  void Add(const std::array<double, 3>& corner) {
    const auto [entry, is_new] = index_.try_emplace(corner, static_cast<int>(places_.size()));
    if (is_new) places_.push_back(corner);
    corners_.push_back(entry->second);
  }

  geometry::TriangleSurface Surface(double metres_per_unit) const {
    geometry::TriangleSurface surface;
    surface.vertices_m.resize(3, ToIndex(places_.size()));
    for (std::size_t v = 0; v < places_.size(); ++v) {
      surface.vertices_m.col(ToIndex(v)) =
          metres_per_unit * Eigen::Map<const Eigen::Vector3d>(places_[v].data());
    }
    surface.triangles =
        Eigen::Map<const Eigen::Matrix3Xi>(corners_.data(), 3, ToIndex(corners_.size() / 3));
    return surface;
  }

  std::size_t CornerCount() const { return corners_.size(); }

 private:
  std::map<std::array<double, 3>, int> index_;
  std::vector<std::array<double, 3>> places_;
  std::vector<int> corners_;
};

std::uint32_t CountOf(const std::string& bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + kHeaderBytes, sizeof(count));
  return count;
}

/// Headers of binary files may begin with "solid", too: their size tells.
bool IsBinary(const std::string& bytes) {
  if (bytes.size() < kHeaderBytes + kCountBytes) return false;
  return bytes.size() == kHeaderBytes + kCountBytes + kTriangleBytes * CountOf(bytes);
}

StlVertices ReadBinary(const std::filesystem::path& file, const std::string& bytes) {
  StlVertices vertices;
  const std::uint32_t count = CountOf(bytes);
  for (std::uint32_t t = 0; t < count; ++t) {
    const char* corners =
        bytes.data() + kHeaderBytes + kCountBytes + kTriangleBytes * t + kNormalBytes;
    std::array<float, 9> values{};
    std::memcpy(values.data(), corners, sizeof(values));
    for (std::size_t k = 0; k < values.size(); k += 3) {
      std::array<double, 3> corner{};
      for (std::size_t i = 0; i < 3; ++i) {
        corner[i] = static_cast<double>(values[k + i]) + 0.0;  // -0 becomes 0
        if (std::isfinite(corner[i])) continue;
        throw InputError(file.string() + ": triangle " + std::to_string(t) +
                         ": a coordinate is not finite");
      }
      vertices.Add(corner);
    }
  }
  return vertices;
}

StlVertices ReadAscii(const std::filesystem::path& file, const std::string& bytes) {
  StlVertices vertices;
  std::istringstream lines(bytes);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word != "vertex") continue;
    std::array<double, 3> corner{};
    for (double& coordinate : corner) {
      if (words >> word && ParseFinite(word, &coordinate)) {
        coordinate += 0.0;  // -0 becomes 0
        continue;
      }
      throw InputError(SourceLocation{file.string(), number, 1},
                       "a vertex needs three finite numbers");
    }
    vertices.Add(corner);
  }
  return vertices;
}

}  // namespace

geometry::TriangleSurface ReadStl(const std::filesystem::path& file, double metres_per_unit) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw InputError(file.string() + ": surface file not found");
  }
  const std::string bytes = ReadFile(file);
  if (!IsBinary(bytes) && !bytes.starts_with("solid")) {
    throw InputError(file.string() +
                     ": is no STL, or is cut off: an ASCII file begins with 'solid', the size of a "
                     "binary one goes with its number of triangles");
  }
  const StlVertices vertices = IsBinary(bytes) ? ReadBinary(file, bytes) : ReadAscii(file, bytes);
  if (vertices.CornerCount() == 0) throw InputError(file.string() + ": holds no triangle");
  if (vertices.CornerCount() % 3 != 0) {
    throw InputError(file.string() + ": the last triangle is cut off");
  }
  return vertices.Surface(metres_per_unit);
}

}  // namespace palpate::fem
