// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/make_segmenter.hpp"

#include "components/perception/color/color_segmenter.hpp"
#include "components/perception/model/model_segmenter.hpp"
#include "libs/core/error.hpp"

namespace palpate::perception {

std::unique_ptr<Segmenter> MakeSegmenter(const Config& config) {
  if (config.segmentation == "model") return std::make_unique<ModelSegmenter>(config);
  if (config.segmentation == "color") return std::make_unique<ColorSegmenter>(config);
  throw InputError("segmentation is '" + config.segmentation + "'; must be model or color");
}

}  // namespace palpate::perception
