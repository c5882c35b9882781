// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include "libs/core/config_node.hpp"

namespace palpate::python {

/// Keyword arguments as a settings tree, so that they are checked by the rules, and refused in the
/// words, of settings files. `name` takes the place of the file in messages. Values are bool, int,
/// float, str, and lists and dicts of these.
ConfigNode TreeOf(const pybind11::kwargs& keywords, const std::string& name);

}  // namespace palpate::python
