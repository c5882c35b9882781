// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <string_view>
#include <utility>

namespace palpate {

/// Why a result may or may not be used.
enum class StatusCode {
  kNotRun,                  ///< nothing was computed yet: what every result starts as
  kOk,                      ///< may be used
  kNotConverged,            ///< iterations or load steps used up
  kBudgetReached,           ///< a frame's time or steps were used up before it converged
  kNotPositiveDefinite,     ///< the stiffness matrix has no Cholesky factor here
  kInverted,                ///< an element turned inside out
  kTensionLimit,            ///< a cable's displacement needs more than its max_tension_N
  kUnobservable,            ///< the measurements do not determine the unknown
  kTangentialUnobservable,  ///< they determine it along the surface normal only
  kNoContact,               ///< nothing beyond the noise
  kHidden,                  ///< not seen by the camera
  kNoCalibration,
  kStale,         ///< inputs too old
  kNoRobotSeen,   ///< no usable measurement in this frame
  kInvalidInput,  ///< NaN, wrong frame, wrong size
  kUncertain,     ///< beyond the noise, but its size is not well known
};

/// The word for `code` in CSV files, messages and logs, e.g. "ok", "not_converged".
std::string_view ToString(StatusCode code);

/// Outcome of a computation that must not throw. Starts as a failure.
/// Making an ok status, and a failure with an empty message, allocates nothing.
class [[nodiscard]] Status {
 public:
  Status() = default;
  Status(StatusCode code, std::string message) : code_(code), message_(std::move(message)) {}

  static Status Ok() { return Status(StatusCode::kOk, {}); }

  bool ok() const { return code_ == StatusCode::kOk; }
  StatusCode code() const { return code_; }
  const std::string& message() const { return message_; }

 private:
  StatusCode code_ = StatusCode::kNotRun;
  std::string message_;
};

}  // namespace palpate
