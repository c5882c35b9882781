// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/gige_vision/description_faults.hpp"

namespace palpate::gige_vision {
namespace {

struct Span {
  std::size_t begin = std::string::npos;
  std::size_t end = 0;  ///< after the line end
  bool found() const { return begin != std::string::npos; }
};

/// The node of this name: from its line to the line that closes it, both indented by 2 spaces.
Span FindNode(const std::string& xml, const std::string& name) {
  const std::size_t attribute = xml.find(" Name=\"" + name + "\"");
  if (attribute == std::string::npos) return {};
  const std::size_t begin = xml.rfind('\n', attribute) + 1;
  const std::size_t tag = begin + 3;
  const std::string close = "\n  </" + xml.substr(tag, attribute - tag) + ">\n";
  const std::size_t end = xml.find(close, attribute);
  return end == std::string::npos ? Span{} : Span{begin, end + close.size()};
}

void RemoveAll(const std::string& piece, std::string* text) {
  for (std::size_t at = text->find(piece); at != std::string::npos; at = text->find(piece, at)) {
    text->erase(at, piece.size());
  }
}

}  // namespace

std::vector<std::string> FeatureNames(const std::string& xml) {
  const std::string open = "<pFeature>";
  std::vector<std::string> names;
  for (std::size_t at = xml.find(open); at != std::string::npos; at = xml.find(open, at + 1)) {
    const std::size_t begin = at + open.size();
    const std::string name = xml.substr(begin, xml.find('<', begin) - begin);
    if (xml.find("<Category Name=\"" + name + "\"") == std::string::npos) names.push_back(name);
  }
  return names;
}

std::string WithNode(const std::string& xml, const std::string& name, const std::string& node) {
  const Span span = FindNode(xml, name);
  return span.found() ? xml.substr(0, span.begin) + node + xml.substr(span.end) : xml;
}

std::string WithoutFeature(const std::string& xml, const std::string& name) {
  std::string rest = WithNode(WithNode(xml, name, ""), name + "Reg", "");
  RemoveAll("    <pFeature>" + name + "</pFeature>\n", &rest);
  RemoveAll("    <pSelected>" + name + "</pSelected>\n", &rest);
  return rest;
}

std::string WithNodeType(const std::string& xml, const std::string& name, const std::string& type) {
  const Span span = FindNode(xml, name);
  if (!span.found()) return xml;
  std::string node = xml.substr(span.begin, span.end - span.begin);
  const std::string tag = node.substr(3, node.find(' ', 3) - 3);
  node.replace(node.rfind(tag), tag.size(), type);
  node.replace(3, tag.size(), type);
  return WithNode(xml, name, node);
}

}  // namespace palpate::gige_vision
