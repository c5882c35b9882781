// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/gige_vision/description.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "libs/core/text.hpp"

namespace palpate::gige_vision {
namespace {

using Kind = Feature::Kind;

std::string Escaped(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&': escaped += "&amp;"; break;
      case '<': escaped += "&lt;"; break;
      case '>': escaped += "&gt;"; break;
      case '"': escaped += "&quot;"; break;
      default: escaped += c;
    }
  }
  return escaped;
}

/// A letter or digit for each character: GenICam's names know no others.
std::string Identifier(const std::string& text) {
  std::string name;
  for (const char c : text) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    name += plain ? c : '_';
  }
  return name;
}

std::string Hex(std::uint32_t value) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "0x%08X", static_cast<unsigned>(value));
  return text.data();
}

std::string Element(const std::string& tag, const std::string& content) {
  return "    <" + tag + ">" + Escaped(content) + "</" + tag + ">\n";
}

const char* NodeTag(Kind kind) {
  switch (kind) {
    case Kind::kInteger: return "Integer";
    case Kind::kFloat: return "Float";
    case Kind::kBoolean: return "Boolean";
    case Kind::kEnumeration: return "Enumeration";
    case Kind::kCommand: return "Command";
    case Kind::kText: return "StringReg";
  }
  return "";
}

/// Ours are "Custom".
std::string NameSpace(const std::string& name) {
  return name.rfind("Palpate", 0) == 0 ? " NameSpace=\"Custom\"" : " NameSpace=\"Standard\"";
}

std::string Opened(const std::string& tag, const Feature& feature) {
  return "  <" + tag + " Name=\"" + feature.name + "\"" + NameSpace(feature.name) + ">\n";
}

std::string Number(const Feature& feature, double value) {
  return feature.kind == Kind::kInteger ? std::to_string(std::llround(value)) : FormatNumber(value);
}

std::string Limits(const Feature& feature) {
  if (!feature.ranged) return "";
  std::string text = Element("Min", Number(feature, feature.min));
  text += feature.max_feature.empty() ? Element("Max", Number(feature, feature.max))
                                      : Element("pMax", feature.max_feature);
  if (feature.kind == Kind::kInteger) text += Element("Inc", Number(feature, feature.increment));
  return text;
}

std::string EntryNodes(const Feature& feature) {
  std::string text;
  for (const auto& [name, value] : feature.entries) {
    text += "    <EnumEntry Name=\"" + name + "\"" + NameSpace(feature.name) + ">\n  " +
            Element("Value", std::to_string(value)) + "    </EnumEntry>\n";
  }
  return text;
}

std::string Selected(const Feature& feature, const FeatureTable& table) {
  std::string text;
  for (const Feature& other : table) {
    if (other.selector == feature.name) text += Element("pSelected", other.name);
  }
  return text;
}

std::string AddressNodes(const Feature& feature) {
  const bool write_only = feature.kind == Kind::kCommand && feature.lowest_bit < 0;
  const char* access = write_only ? "WO" : feature.writable ? "RW" : "RO";
  std::string text = Element("Address", Hex(feature.address)) +
                     Element("Length", std::to_string(feature.size)) +
                     Element("AccessMode", access) + Element("pPort", "Device");
  if (feature.changing || !feature.selector.empty() || feature.bootstrap) {
    text += Element("Cachable", "NoCache");
  }
  return text;
}

std::string RegisterNode(const Feature& feature) {
  const bool masked = feature.lowest_bit >= 0;
  const char* tag = feature.kind == Kind::kFloat ? "FloatReg" : masked ? "MaskedIntReg" : "IntReg";
  std::string text =
      "  <" + std::string(tag) + " Name=\"" + feature.name + "Reg\">\n" + AddressNodes(feature);
  if (masked) {  // big-endian registers count their bits from the greatest
    text += Element("LSB", std::to_string(31 - feature.lowest_bit)) +
            Element("MSB", std::to_string(31 - feature.highest_bit));
  }
  if (feature.kind != Kind::kFloat) text += Element("Sign", "Unsigned");
  return text + Element("Endianess", "BigEndian") + "  </" + tag + ">\n";
}

std::string FeatureNodes(const Feature& feature, const FeatureTable& table) {
  const std::string tag = NodeTag(feature.kind);
  std::string text = Opened(tag, feature);
  if (!feature.tip.empty()) text += Element("ToolTip", feature.tip);
  text += Element("Visibility", "Beginner");
  if (feature.locked) text += Element("pIsLocked", "TLParamsLocked");
  if (feature.kind == Kind::kText) return text + AddressNodes(feature) + "  </" + tag + ">\n";
  text += EntryNodes(feature) + Element("pValue", feature.name + "Reg");
  if (feature.kind == Kind::kCommand) {
    text += Element("CommandValue", std::to_string(feature.command_value));
  } else if (feature.kind == Kind::kBoolean) {
    text += Element("OnValue", "1") + Element("OffValue", "0");
  }
  if (feature.kind == Kind::kInteger || feature.kind == Kind::kFloat) text += Limits(feature);
  if (!feature.unit.empty()) text += Element("Unit", feature.unit);
  return text + Selected(feature, table) + "  </" + tag + ">\n" + RegisterNode(feature);
}

std::string CategoryNodes(const FeatureTable& table) {
  std::vector<std::string> categories;
  for (const Feature& feature : table) {
    if (std::find(categories.begin(), categories.end(), feature.category) == categories.end()) {
      categories.push_back(feature.category);
    }
  }
  std::string text = "  <Category Name=\"Root\" NameSpace=\"Standard\">\n";
  for (const std::string& category : categories) text += Element("pFeature", category);
  text += "  </Category>\n";
  for (const std::string& category : categories) {
    text += "  <Category Name=\"" + category + "\"" + NameSpace(category) + ">\n";
    for (const Feature& feature : table) {
      if (feature.category == category) text += Element("pFeature", feature.name);
    }
    text += "  </Category>\n";
  }
  return text;
}

}  // namespace

std::string DescribeFeatures(const FeatureTable& table, const std::string& vendor,
                             const std::string& model) {
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<RegisterDescription ModelName=\"" +
      Identifier(model) + "\" VendorName=\"" + Identifier(vendor) +
      "\" StandardNameSpace=\"GEV\" SchemaMajorVersion=\"1\" SchemaMinorVersion=\"1\""
      " SchemaSubMinorVersion=\"0\" MajorVersion=\"1\" MinorVersion=\"0\" SubMinorVersion=\"0\""
      " ProductGuid=\"6b1f0a52-3a52-4f0e-9d0c-4a6c0e2f7c11\""
      " VersionGuid=\"0d7c2c3e-61d5-4b7a-8f51-9a2d5b0c3e44\" ToolTip=\"\""
      " xmlns=\"http://www.genicam.org/GenApi/Version_1_1\""
      " xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\""
      " xsi:schemaLocation=\"http://www.genicam.org/GenApi/Version_1_1"
      " http://www.genicam.org/GenApi/GenApiSchema_Version_1_1.xsd\">\n";
  text += CategoryNodes(table);
  for (const Feature& feature : table) text += FeatureNodes(feature, table);
  return text + "  <Port Name=\"Device\" NameSpace=\"Standard\"/>\n</RegisterDescription>\n";
}

}  // namespace palpate::gige_vision
