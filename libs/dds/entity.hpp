// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <dds/dds.h>

#include <string>
#include <utility>

#include "libs/core/error.hpp"

namespace palpate::dds {

/// DDS Security does not allow an entity.
class NotAllowed : public RunError {
 public:
  using RunError::RunError;
};

/// The handle that a dds_create_... call returned. Throws RunError ("cannot create WHAT: reason")
/// where it is an error code, NotAllowed where DDS Security says so.
dds_entity_t Created(dds_entity_t handle, const std::string& what);

/// Owns one DDS entity: deleted, with its children, when this goes out of scope.
class Entity {
 public:
  Entity() = default;
  /// Takes `handle` over. Throws RunError where it is an error code; `what` names the entity.
  Entity(dds_entity_t handle, const std::string& what) : handle_(Created(handle, what)) {}
  Entity(Entity&& other) noexcept : handle_(std::exchange(other.handle_, 0)) {}
  Entity& operator=(Entity&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  ~Entity() {
    if (handle_ > 0) dds_delete(handle_);
  }

  dds_entity_t handle() const { return handle_; }

 private:
  dds_entity_t handle_ = 0;
};

}  // namespace palpate::dds
