// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/view/config.hpp"
#include "libs/dds/node_settings.hpp"

namespace palpate::view {

using NodeConfig = dds::WithNodeSettings<Config>;

}  // namespace palpate::view
