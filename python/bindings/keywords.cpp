// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "python/bindings/keywords.hpp"

#include "libs/core/error.hpp"

namespace py = pybind11;

namespace palpate::python {

namespace {

ConfigNode NodeOf(py::handle value, const std::string& path, const SourceLocation& where) {
  ConfigNode node;
  node.path = path;
  node.where = where;
  node.key_where = where;
  if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
    node.kind = ConfigNode::Kind::kList;
    int index = 0;
    for (const py::handle item : value) {
      node.items.push_back(NodeOf(item, path + "[" + std::to_string(index++) + "]", where));
    }
    return node;
  }
  if (py::isinstance<py::dict>(value)) {
    node.kind = ConfigNode::Kind::kMap;
    for (const auto& [key, item] : py::reinterpret_borrow<py::dict>(value)) {
      const auto word = key.cast<std::string>();
      node.entries.push_back({word, NodeOf(item, path + "." + word, where)});
    }
    return node;
  }
  node.kind = ConfigNode::Kind::kScalar;
  node.quoted = py::isinstance<py::str>(value);
  if (py::isinstance<py::bool_>(value)) {
    node.text = value.cast<bool>() ? "true" : "false";
  } else {
    node.text = py::str(value).cast<std::string>();
  }
  return node;
}

}  // namespace

ConfigNode TreeOf(const py::kwargs& keywords, const std::string& name) {
  ConfigNode root;
  root.kind = ConfigNode::Kind::kMap;
  root.where.file = name;
  for (const auto& [key, value] : keywords) {
    const auto word = key.cast<std::string>();
    root.entries.push_back({word, NodeOf(value, word, root.where)});
  }
  return root;
}

}  // namespace palpate::python
