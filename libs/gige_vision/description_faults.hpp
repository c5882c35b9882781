// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

namespace palpate::gige_vision {

/// Faults for DescriptionFaults::edit_xml, in texts that DescribeFeatures has made.

/// The names of all features, in their order.
std::vector<std::string> FeatureNames(const std::string& xml);

/// Without this feature: its node and register are gone, and so are categories' and selectors'
/// references to it. Unchanged where there is none of that name.
std::string WithoutFeature(const std::string& xml, const std::string& name);

/// With another node in its place (any text).
std::string WithNode(const std::string& xml, const std::string& name, const std::string& node);

/// With another node type: its tag changed ("Integer" for "Float"), all else as it was.
std::string WithNodeType(const std::string& xml, const std::string& name, const std::string& type);

}  // namespace palpate::gige_vision
