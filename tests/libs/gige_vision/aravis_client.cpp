// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/libs/gige_vision/aravis_client.hpp"

#include <chrono>
#include <stdexcept>

namespace palpate::gige_vision {
namespace {

/// Throws what Aravis complains about.
class Errors {
 public:
  ~Errors() { g_clear_error(&error_); }
  operator GError**() { return &error_; }
  void Check() const {
    if (error_ != nullptr) throw std::runtime_error(error_->message);
  }

 private:
  GError* error_ = nullptr;
};

constexpr int kSocketBuffer_B = 4 << 20;

}  // namespace

AravisClient::AravisClient(const std::string& name) {
  Errors errors;
  camera_ = arv_camera_new(name.c_str(), errors);
  errors.Check();
  if (camera_ == nullptr) throw std::runtime_error("no camera " + name);
}

AravisClient::~AravisClient() {
  g_clear_object(&stream_);
  g_clear_object(&camera_);
}

double AravisClient::Number(const std::string& feature) const {
  Errors errors;
  const double value = arv_camera_get_float(camera_, feature.c_str(), errors);
  errors.Check();
  return value;
}

std::int64_t AravisClient::Integer(const std::string& feature) const {
  Errors errors;
  const bool boolean = ARV_IS_GC_BOOLEAN(arv_device_get_feature(device(), feature.c_str()));
  const std::int64_t value = boolean ? arv_camera_get_boolean(camera_, feature.c_str(), errors)
                                     : arv_camera_get_integer(camera_, feature.c_str(), errors);
  errors.Check();
  return value;
}

std::string AravisClient::Text(const std::string& feature) const {
  Errors errors;
  const char* value = arv_camera_get_string(camera_, feature.c_str(), errors);
  errors.Check();
  return value != nullptr ? value : "";
}

void AravisClient::Set(const std::string& feature, std::int64_t value) {
  Errors errors;
  if (ARV_IS_GC_BOOLEAN(arv_device_get_feature(device(), feature.c_str()))) {
    arv_camera_set_boolean(camera_, feature.c_str(), value != 0, errors);
  } else {
    arv_camera_set_integer(camera_, feature.c_str(), value, errors);
  }
  errors.Check();
}

void AravisClient::Set(const std::string& feature, double value) {
  Errors errors;
  arv_camera_set_float(camera_, feature.c_str(), value, errors);
  errors.Check();
}

void AravisClient::Select(const std::string& selector, const std::string& entry) {
  Errors errors;
  arv_camera_set_string(camera_, selector.c_str(), entry.c_str(), errors);
  errors.Check();
}

void AravisClient::Run(const std::string& command) {
  Errors errors;
  arv_camera_execute_command(camera_, command.c_str(), errors);
  errors.Check();
}

void AravisClient::Start(int buffer_count) {
  Errors errors;
  stream_ = arv_camera_create_stream(camera_, nullptr, nullptr, errors);
  errors.Check();
  g_object_set(stream_, "socket-buffer", ARV_GV_STREAM_SOCKET_BUFFER_FIXED, "socket-buffer-size",
               kSocketBuffer_B, nullptr);
  const guint payload = arv_camera_get_payload(camera_, errors);
  errors.Check();
  for (int i = 0; i < buffer_count; ++i) {
    arv_stream_push_buffer(stream_, arv_buffer_new(payload, nullptr));
  }
  arv_camera_start_acquisition(camera_, errors);
  errors.Check();
}

void AravisClient::Stop() {
  Errors errors;
  arv_camera_stop_acquisition(camera_, errors);
  errors.Check();
  g_clear_object(&stream_);
}

bool AravisClient::Next(const std::function<void(ArvBuffer*)>& look, double deadline_s) {
  using std::chrono::steady_clock;
  const auto end = steady_clock::now() + std::chrono::duration<double>(deadline_s);
  while (steady_clock::now() < end) {
    ArvBuffer* buffer = arv_stream_timeout_pop_buffer(stream_, 200'000);
    if (buffer == nullptr) continue;
    const bool complete = arv_buffer_get_status(buffer) == ARV_BUFFER_STATUS_SUCCESS;
    if (complete) look(buffer);
    arv_stream_push_buffer(stream_, buffer);
    if (complete) return true;
  }
  return false;
}

}  // namespace palpate::gige_vision
