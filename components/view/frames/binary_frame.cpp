// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/frames/binary_frame.hpp"

#include <bit>
#include <cstring>
#include <utility>

namespace palpate::view {

namespace {

static_assert(std::endian::native == std::endian::little, "arrays are sent as they are in memory");

constexpr std::size_t kAlignment = 8;

std::size_t RoundUp(std::size_t size) { return (size + kAlignment - 1) / kAlignment * kAlignment; }

}  // namespace

BinaryFrame::BinaryFrame(std::string_view kind, nlohmann::json fields)
    : fields_(std::move(fields)) {
  fields_["kind"] = kind;
  fields_["arrays"] = nlohmann::json::object();
}

void BinaryFrame::Add(const std::string& name, const char* type, const void* values,
                      std::size_t length, std::size_t bytes) {
  const std::size_t offset = RoundUp(arrays_.size());
  fields_["arrays"][name] = {{"type", type}, {"offset", offset}, {"length", length}};
  arrays_.resize(offset, '\0');
  arrays_.append(static_cast<const char*>(values), bytes);
}

void BinaryFrame::Add(const std::string& name, std::span<const float> values) {
  Add(name, "float32", values.data(), values.size(), values.size_bytes());
}

void BinaryFrame::Add(const std::string& name, std::span<const std::uint32_t> values) {
  Add(name, "uint32", values.data(), values.size(), values.size_bytes());
}

void BinaryFrame::Add(const std::string& name, std::span<const std::uint8_t> values) {
  Add(name, "uint8", values.data(), values.size(), values.size_bytes());
}

std::string BinaryFrame::Bytes() const {
  std::string json = JsonText(fields_);
  std::uint32_t size = 0;
  json.resize(RoundUp(sizeof(size) + json.size()) - sizeof(size), ' ');
  size = static_cast<std::uint32_t>(json.size());
  std::string bytes(sizeof(size), '\0');
  std::memcpy(bytes.data(), &size, sizeof(size));
  bytes.reserve(sizeof(size) + json.size() + arrays_.size());
  bytes += json;
  bytes += arrays_;
  return bytes;
}

std::string JsonText(const nlohmann::json& fields) {
  return fields.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace palpate::view
