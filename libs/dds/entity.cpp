// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/entity.hpp"

#include "libs/core/error.hpp"

namespace palpate::dds {

dds_entity_t Created(dds_entity_t handle, const std::string& what) {
  if (handle < 0) {
    throw RunError("cannot create " + what + ": " + dds_strretcode(-handle));
  }
  return handle;
}

}  // namespace palpate::dds
