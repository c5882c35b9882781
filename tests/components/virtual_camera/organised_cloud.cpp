// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/components/virtual_camera/organised_cloud.hpp"

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace palpate::virtual_camera {

namespace {

// LZF (M. Lehmann): a control byte below 32 announces literals, else a copy from before.
std::string Expand(const std::string& packed, std::size_t size) {
  std::string out;
  out.reserve(size);
  const auto byte = [&packed](std::size_t i) {
    return static_cast<std::size_t>(static_cast<unsigned char>(packed.at(i)));
  };
  for (std::size_t i = 0; i < packed.size();) {
    const std::size_t control = byte(i++);
    if (control < 32) {
      out.append(packed, i, control + 1);
      i += control + 1;
      continue;
    }
    std::size_t length = control >> 5;
    if (length == 7) length += byte(i++);
    const std::size_t distance = ((control & 31) << 8) + byte(i++) + 1;
    if (distance > out.size()) throw std::runtime_error("LZF: copies from before the beginning");
    for (std::size_t k = 0; k < length + 2; ++k) out.push_back(out[out.size() - distance]);
  }
  if (out.size() != size) throw std::runtime_error("LZF: wrong size");
  return out;
}

struct Header {
  std::vector<std::string> fields;
  std::vector<std::size_t> sizes;
  int width = 0;
  int height = 0;
};

Header ReadHeader(std::istream& file) {
  Header header;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key == "FIELDS") {
      header.fields.assign(std::istream_iterator<std::string>(words), {});
    } else if (key == "SIZE") {
      header.sizes.assign(std::istream_iterator<std::size_t>(words), {});
    } else if (key == "WIDTH") {
      words >> header.width;
    } else if (key == "HEIGHT") {
      words >> header.height;
    } else if (key == "DATA") {
      words >> key;
      if (key != "binary_compressed") throw std::runtime_error("PCD: not binary_compressed");
      return header;
    }
  }
  throw std::runtime_error("PCD: no DATA");
}

}  // namespace

rgbd::RangeImage ReadOrganisedCloud(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const Header header = ReadHeader(file);
  std::uint32_t sizes[2] = {};
  file.read(reinterpret_cast<char*>(sizes), sizeof(sizes));
  std::string packed(sizes[0], '\0');
  file.read(packed.data(), static_cast<std::streamsize>(packed.size()));
  const std::string data = Expand(packed, sizes[1]);
  // Field after field, each for all points.
  rgbd::RangeImage range(header.width, header.height);
  std::size_t offset = 0;
  for (std::size_t i = 0; i < header.fields.size() && header.fields[i] != "z"; ++i) {
    offset += header.sizes.at(i) * range.values.size();
  }
  if (offset + 4 * range.values.size() > data.size()) throw std::runtime_error("PCD: no z");
  std::memcpy(range.values.data(), data.data() + offset, 4 * range.values.size());
  for (float& z : range.values) z = z == 0.0F ? std::nanf("") : std::abs(z);
  return range;
}

}  // namespace palpate::virtual_camera
