// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/c3d/c3d_parameters.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>

namespace palpate::experiment {

namespace {

constexpr std::size_t kSectionHeaderSize = 4;  // two bytes unused, block count, processor
constexpr std::size_t kBlockSize = 512;
constexpr std::size_t kHeaderDataBlock = 16;  // offset of the number of the first block of data

std::string UpperCase(std::string_view text) {
  std::string upper(text);
  std::transform(upper.begin(), upper.end(), upper.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return upper;
}

std::string Trimmed(std::string_view text) {
  const auto is_padding = [](char c) { return c == ' ' || c == '\0' || c == '\t'; };
  while (!text.empty() && is_padding(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_padding(text.back())) text.remove_suffix(1);
  return std::string(text);
}

}  // namespace

C3dParameters::C3dParameters(C3dBytes& bytes, std::size_t offset) : bytes_(bytes) {
  bytes.Require(offset, kSectionHeaderSize, "the parameter section");
  const std::uint8_t processor = bytes.Byte(offset + 3);
  if (processor < 84 || processor > 86) {
    bytes.Refuse(offset + 3, "processor type " + std::to_string(processor) +
                                 " is not known (84 Intel, 85 DEC, 86 SGI/MIPS)");
  }
  bytes.set_processor(static_cast<C3dProcessor>(processor));
  const std::size_t end = EndOfSection(offset);
  std::size_t next = offset + kSectionHeaderSize;
  while (next != 0 && next < end) next = ReadItem(next);
  NameUnnamedPointGroup();
  NameEntries();
}

// Where the section must have ended: behind its blocks, or where the data begin, whichever is
// farther, as either number may be wrong; at the end of the file where neither is told.
std::size_t C3dParameters::EndOfSection(std::size_t offset) const {
  const std::size_t blocks = bytes_.Byte(offset + 2);
  const std::size_t data_block = bytes_.Uint16(kHeaderDataBlock);
  const std::size_t by_count = blocks == 0 ? 0 : offset + blocks * kBlockSize;
  const std::size_t by_data = data_block == 0 ? 0 : (data_block - 1) * kBlockSize;
  const std::size_t end = std::max(by_count, by_data);
  return end <= offset ? bytes_.size() : end;
}

// Reads the group or parameter at `offset`; returns where the next begins, 0 after the last.
// Layout: length of the name (negative: locked), number of the group (negative: this is the group
// itself), name, distance from here to the next item, then the value.
std::size_t C3dParameters::ReadItem(std::size_t offset) {
  const auto name_size = static_cast<std::size_t>(std::abs(int{bytes_.SignedByte(offset)}));
  if (name_size == 0) return 0;
  const int group = bytes_.SignedByte(offset + 1);
  const std::string name = UpperCase(bytes_.Text(offset + 2, name_size));
  const std::size_t link = offset + 2 + name_size;
  const std::size_t distance = bytes_.Uint16(link);
  if (distance == 1) bytes_.Refuse(link, "the next parameter overlaps this one");
  if (group < 0) {
    groups_[-group] = name;
  } else {
    raw_entries_.push_back({group, name, ReadValue(link + 2)});
  }
  return distance == 0 ? 0 : link + distance;
}

C3dParameters::Entry C3dParameters::ReadValue(std::size_t offset) const {
  const int type = bytes_.SignedByte(offset);
  if (type != -1 && type != 1 && type != 2 && type != 4) {
    bytes_.Refuse(offset, "parameter type " + std::to_string(type) + " is not known");
  }
  Entry entry;
  entry.type = static_cast<Type>(type);
  const std::size_t dimension_count = bytes_.Byte(offset + 1);
  entry.count = 1;
  for (std::size_t i = 0; i < dimension_count; ++i) {
    entry.dimensions.push_back(bytes_.Byte(offset + 2 + i));
    entry.count *= entry.dimensions.back();
    if (entry.count > bytes_.size()) bytes_.Refuse(offset + 2 + i, "more values than the file");
  }
  entry.offset = offset + 2 + dimension_count;
  const auto value_size = static_cast<std::size_t>(std::abs(type));
  bytes_.Require(entry.offset, entry.count * value_size, "a parameter");
  return entry;
}

// A file may lack the record of a group. POINT shows itself: no other group has DATA_START.
void C3dParameters::NameUnnamedPointGroup() {
  for (const auto& [number, name] : groups_) {
    if (name == "POINT") return;
  }
  for (const RawEntry& raw : raw_entries_) {
    if (raw.name == "DATA_START" && !groups_.contains(raw.group)) groups_[raw.group] = "POINT";
  }
}

void C3dParameters::NameEntries() {
  for (const RawEntry& raw : raw_entries_) {
    const auto group = groups_.find(raw.group);
    if (group == groups_.end()) continue;
    const auto [entry, is_new] = entries_.emplace(group->second + ":" + raw.name, raw.value);
    if (!is_new && !SameValues(entry->second, raw.value)) entry->second.ambiguous = true;
  }
}

bool C3dParameters::SameValues(const Entry& a, const Entry& b) const {
  const auto size = [](const Entry& entry) {
    return entry.count * static_cast<std::size_t>(std::abs(static_cast<int>(entry.type)));
  };
  return a.type == b.type && a.dimensions == b.dimensions &&
         bytes_.Text(a.offset, size(a)) == bytes_.Text(b.offset, size(b));
}

const C3dParameters::Entry* C3dParameters::Find(const std::string& name) const {
  const auto entry = entries_.find(name);
  if (entry == entries_.end()) return nullptr;
  if (entry->second.ambiguous) {
    bytes_.Refuse(entry->second.offset,
                  "parameter " + name + " is given twice, with different values");
  }
  return &entry->second;
}

std::size_t C3dParameters::OffsetOf(const std::string& name) const {
  const Entry* entry = Find(name);
  return entry == nullptr ? 0 : entry->offset;
}

std::vector<double> C3dParameters::Numbers(const std::string& name) const {
  std::vector<double> values;
  const Entry* entry = Find(name);
  if (entry == nullptr) return values;
  for (std::size_t i = 0; i < entry->count; ++i) {
    switch (entry->type) {
      case Type::kText: bytes_.Refuse(entry->offset, "parameter " + name + " must be a number");
      case Type::kByte: values.push_back(bytes_.Byte(entry->offset + i)); break;
      case Type::kInt16: values.push_back(bytes_.Uint16(entry->offset + 2 * i)); break;
      case Type::kReal: values.push_back(bytes_.Real(entry->offset + 4 * i)); break;
    }
  }
  return values;
}

std::optional<double> C3dParameters::Number(const std::string& name) const {
  const std::vector<double> values = Numbers(name);
  if (values.empty()) return std::nullopt;
  if (!std::isfinite(values.front())) {
    bytes_.Refuse(OffsetOf(name), "parameter " + name + " is not finite");
  }
  return values.front();
}

std::vector<std::string> C3dParameters::Texts(const std::string& name) const {
  std::vector<std::string> texts;
  const Entry* entry = Find(name);
  if (entry == nullptr || entry->count == 0) return texts;
  if (entry->type != Type::kText) {
    bytes_.Refuse(entry->offset, "parameter " + name + " must be text");
  }
  const std::size_t length = entry->dimensions.empty() ? 1 : entry->dimensions.front();
  for (std::size_t i = 0; i < entry->count; i += length) {
    texts.push_back(Trimmed(bytes_.Text(entry->offset + i, length)));
  }
  return texts;
}

}  // namespace palpate::experiment
