// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <arv.h>

#include <memory>
#include <string>

namespace palpate::capture {

struct Unref {
  void operator()(void* object) const { g_object_unref(object); }
};
/// Owns one reference to a GObject.
template <typename T>
using GObjectPtr = std::unique_ptr<T, Unref>;

/// Takes what a GLib function reports through its last argument.
class GErrorHolder {
 public:
  GErrorHolder() = default;
  ~GErrorHolder() { g_clear_error(&error_); }
  GErrorHolder(const GErrorHolder&) = delete;
  GErrorHolder& operator=(const GErrorHolder&) = delete;

  /// For one call; forgets what was there.
  GError** Take() {
    g_clear_error(&error_);
    return &error_;
  }
  bool ok() const { return error_ == nullptr; }
  std::string text() const { return error_ != nullptr ? error_->message : ""; }

 private:
  GError* error_ = nullptr;
};

}  // namespace palpate::capture
