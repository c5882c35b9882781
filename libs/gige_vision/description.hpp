// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "libs/gige_vision/feature.hpp"

namespace palpate::gige_vision {

/// The GenICam description (GenApi schema 1.1) of a device with these features: for each feature
/// one node with its name and, but for texts, one register node named <name>Reg; a category for
/// each name of a category, all under Root.
std::string DescribeFeatures(const FeatureTable& table, const std::string& vendor,
                             const std::string& model);

}  // namespace palpate::gige_vision
