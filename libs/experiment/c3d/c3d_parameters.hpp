// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "libs/experiment/c3d/c3d_bytes.hpp"

namespace palpate::experiment {

/// The parameter section of a C3D file: named values, e.g. POINT:RATE. Names compare without case.
class C3dParameters {
 public:
  /// Reads the section that begins at `offset` and sets the processor of `bytes` from it. The last
  /// parameter's link may lead anywhere outside of the section. A parameter of a group without a
  /// record is passed over, but for those that only POINT has. Throws InputError with the byte
  /// offset for an unknown processor or type, or a parameter that does not end before the file
  /// does.
  C3dParameters(C3dBytes& bytes, std::size_t offset);

  bool Has(const std::string& name) const { return entries_.contains(name); }
  /// Names that are given twice with different values are refused when they are asked for.
  ///
  /// All values of a numeric parameter. Integers are unsigned 16-bit, which is how every count is
  /// meant. Empty where the parameter is absent; InputError where it is text.
  std::vector<double> Numbers(const std::string& name) const;
  /// The first value; nullopt where absent or empty; InputError where it is not finite.
  std::optional<double> Number(const std::string& name) const;
  /// All strings of a text parameter without outer blanks; empty where it is absent.
  std::vector<std::string> Texts(const std::string& name) const;
  /// Offset of the values of the parameter; 0: absent.
  std::size_t OffsetOf(const std::string& name) const;

 private:
  enum class Type : std::int8_t { kText = -1, kByte = 1, kInt16 = 2, kReal = 4 };

  struct Entry {
    Type type = Type::kByte;
    std::vector<std::size_t> dimensions;
    std::size_t count = 0;   // product of the dimensions
    std::size_t offset = 0;  // of the values
    bool ambiguous = false;  // another parameter of this name has other values
  };

  struct RawEntry {
    int group = 0;
    std::string name;
    Entry value;
  };

  std::size_t ReadItem(std::size_t offset);
  Entry ReadValue(std::size_t offset) const;
  std::size_t EndOfSection(std::size_t offset) const;
  void NameUnnamedPointGroup();
  void NameEntries();
  bool SameValues(const Entry& a, const Entry& b) const;
  const Entry* Find(const std::string& name) const;

  const C3dBytes& bytes_;
  std::map<int, std::string> groups_;     // by number, > 0
  std::vector<RawEntry> raw_entries_;     // in the order of the file
  std::map<std::string, Entry> entries_;  // "GROUP:NAME"
};

}  // namespace palpate::experiment
