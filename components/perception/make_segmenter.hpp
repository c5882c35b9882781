// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <memory>

#include "components/perception/config.hpp"
#include "components/perception/segmenter.hpp"

namespace palpate::perception {

/// The one that Config::segmentation names. Throws InputError for settings that do not fit.
std::unique_ptr<Segmenter> MakeSegmenter(const Config& config);

}  // namespace palpate::perception
