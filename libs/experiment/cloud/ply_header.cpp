// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/cloud/ply_header.hpp"

#include <map>

#include "libs/core/error.hpp"
#include "libs/experiment/cloud/cloud_builder.hpp"

namespace palpate::experiment {

namespace {

using Kind = Scalar::Kind;

const std::map<std::string_view, Scalar> kTypes = {
    {"char", {Kind::kSigned, 1}},     {"int8", {Kind::kSigned, 1}},
    {"uchar", {Kind::kUnsigned, 1}},  {"uint8", {Kind::kUnsigned, 1}},
    {"short", {Kind::kSigned, 2}},    {"int16", {Kind::kSigned, 2}},
    {"ushort", {Kind::kUnsigned, 2}}, {"uint16", {Kind::kUnsigned, 2}},
    {"int", {Kind::kSigned, 4}},      {"int32", {Kind::kSigned, 4}},
    {"uint", {Kind::kUnsigned, 4}},   {"uint32", {Kind::kUnsigned, 4}},
    {"float", {Kind::kFloat, 4}},     {"float32", {Kind::kFloat, 4}},
    {"double", {Kind::kFloat, 8}},    {"float64", {Kind::kFloat, 8}},
};

class HeaderParser {
 public:
  HeaderParser(const std::string& file, std::string_view* rest) : file_(file), rest_(*rest) {}

  PlyHeader Parse() {
    if (!rest_.starts_with("ply\n") && !rest_.starts_with("ply\r\n")) {
      throw InputError(SourceLocation{file_}, "is no PLY file");
    }
    TakeLine(&rest_);
    header_.lines = 1;
    for (bool ended = false; !ended;) {
      if (rest_.empty()) throw InputError(SourceLocation{file_}, "has no line 'end_header'");
      std::string_view line = TakeLine(&rest_);
      ++header_.lines;
      ended = TakeHeaderLine(line);
    }
    if (!format_seen_) throw InputError(SourceLocation{file_}, "has no line 'format'");
    return std::move(header_);
  }

 private:
  [[noreturn]] void Refuse(const std::string& message) const {
    throw InputError(SourceLocation{file_, header_.lines}, message);
  }

  bool TakeHeaderLine(std::string_view line) {
    const std::string_view key = TakeWord(&line);
    if (key == "end_header") return true;
    if (key == "format") {
      TakeFormat(line);
    } else if (key == "element") {
      PlyElement element;
      element.name = TakeWord(&line);
      element.count = Count(line);
      header_.elements.push_back(std::move(element));
    } else if (key == "property") {
      TakeProperty(line);
    } else if (key == "obj_info") {
      TakeInfo(line);
    } else if (key != "comment" && !key.empty()) {
      Refuse("'" + std::string(key.substr(0, 20)) + "' is no line of a PLY header");
    }
    return false;
  }

  void TakeFormat(std::string_view line) {
    const std::string_view word = TakeWord(&line);
    if (word == "ascii") {
      header_.format = PlyFormat::kAscii;
    } else if (word == "binary_little_endian") {
      header_.format = PlyFormat::kLittle;
    } else if (word == "binary_big_endian") {
      header_.format = PlyFormat::kBig;
    } else {
      Refuse("a format is ascii, binary_little_endian or binary_big_endian");
    }
    format_seen_ = true;
  }

  std::uint64_t Count(std::string_view line) const {
    std::uint64_t count = 0;
    if (!ParseCount(TakeWord(&line), kMostPoints, &count)) {
      Refuse("a whole number up to " + std::to_string(kMostPoints) + " is expected");
    }
    return count;
  }

  Scalar Type(std::string_view word) const {
    const auto type = kTypes.find(word);
    if (type == kTypes.end()) Refuse("there is no type '" + std::string(word.substr(0, 20)) + "'");
    return type->second;
  }

  void TakeProperty(std::string_view line) {
    if (header_.elements.empty()) Refuse("a property before the first element");
    PlyProperty property;
    std::string_view word = TakeWord(&line);
    property.list = word == "list";
    if (property.list) {
      property.count = Type(TakeWord(&line));
      if (property.count.kind == Kind::kFloat) Refuse("the length of a list is a whole number");
      word = TakeWord(&line);
    }
    property.scalar = Type(word);
    property.name = TakeWord(&line);
    if (property.name.empty()) Refuse("a property without a name");
    header_.elements.back().properties.push_back(std::move(property));
  }

  void TakeInfo(std::string_view line) {
    const std::string_view what = TakeWord(&line);
    std::uint64_t count = 0;
    if (!ParseCount(TakeWord(&line), kMostPoints, &count)) return;  // whatever it is about
    if (what == "num_cols") header_.columns = count;
    if (what == "num_rows") header_.rows = count;
  }

  const std::string& file_;
  std::string_view& rest_;
  bool format_seen_ = false;
  PlyHeader header_;
};

}  // namespace

PlyHeader TakePlyHeader(const std::string& file, std::string_view* rest) {
  return HeaderParser(file, rest).Parse();
}

}  // namespace palpate::experiment
