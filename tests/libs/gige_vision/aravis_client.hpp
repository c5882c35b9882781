// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <arv.h>

#include <functional>
#include <memory>
#include <string>

namespace palpate::gige_vision {

/// Aravis, as independent witness of what the device says and sends.
class AravisClient {
 public:
  /// `name`: an address or an id; throws std::runtime_error with Aravis' words.
  explicit AravisClient(const std::string& name);
  ~AravisClient();
  AravisClient(const AravisClient&) = delete;
  AravisClient& operator=(const AravisClient&) = delete;

  ArvDevice* device() const { return arv_camera_get_device(camera_); }
  ArvStream* stream() const { return stream_; }

  double Number(const std::string& feature) const;
  std::int64_t Integer(const std::string& feature) const;
  std::string Text(const std::string& feature) const;  ///< of texts and enumerations
  void Set(const std::string& feature, std::int64_t value);
  void Set(const std::string& feature, double value);
  void Select(const std::string& selector, const std::string& entry);
  void Run(const std::string& command);

  void Start(int buffer_count = 8);
  void Stop();
  /// The next complete buffer, which goes back to the stream after `look`; false where none came.
  bool Next(const std::function<void(ArvBuffer*)>& look, double deadline_s = 20.0);

 private:
  ArvCamera* camera_ = nullptr;
  ArvStream* stream_ = nullptr;
};

}  // namespace palpate::gige_vision
