// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "components/force_estimation/pipeline/pipeline.hpp"

namespace palpate::force_estimation {

/// Inputs and outputs of a scripted pipeline, shared between it and the test.
class Script {
 public:
  struct Call {
    int pipeline = 0;  ///< which one, from 1
    PerceivedShape shape;
    double youngs_modulus_Pa = 0.0;  ///< of the model's body
  };

  /// Update does not return while it is held.
  void Hold(bool hold) {
    const std::lock_guard lock(mutex_);
    hold_ = hold;
    changed_.notify_all();
  }
  std::vector<Call> calls() const {
    const std::lock_guard lock(mutex_);
    return calls_;
  }
  /// What comes with the next answers.
  void SetDrift(const DriftReport& drift) {
    const std::lock_guard lock(mutex_);
    drift_ = drift;
  }
  /// Postures that pipelines were told to expect.
  std::vector<Eigen::VectorXd> expected() const {
    const std::lock_guard lock(mutex_);
    return expected_;
  }
  void SetBiasFramesToCome(int frames) {
    const std::lock_guard lock(mutex_);
    bias_frames_to_come_ = frames;
  }
  void SetContactName(const std::string& name) {
    const std::lock_guard lock(mutex_);
    contact_name_ = name;
  }
  PipelineMaker Maker() {
    return [this](robot::RobotModel& model) { return std::make_unique<Scripted>(*this, model); };
  }

 private:
  /// One force of as many newtons as the cloud has points.
  class Scripted : public Pipeline {
   public:
    Scripted(Script& script, robot::RobotModel& model) : script_(script), model_(model) {
      const std::lock_guard lock(script_.mutex_);
      number_ = ++script_.made_;
    }
    void Expect(const Eigen::VectorXd& x_m) override {
      const std::lock_guard lock(script_.mutex_);
      script_.expected_.push_back(x_m);
    }
    const PipelineResult& Update(PipelineFrame frame) override {
      std::unique_lock lock(script_.mutex_);
      const auto& shape = std::get<PerceivedShape>(frame);
      script_.calls_.push_back({number_, shape, model_.body().materials.front().youngs_modulus_Pa});
      script_.changed_.wait(lock, [this] { return !script_.hold_; });
      result_.state_is_known = true;
      result_.state = Status::Ok();
      result_.drift = script_.drift_;
      result_.bias_frames_to_come = script_.bias_frames_to_come_;
      result_.estimate.status = Status::Ok();
      result_.estimate.x_m = model_.RestState().x_m;
      ContactForce contact;
      contact.status = Status::Ok();
      contact.name = script_.contact_name_;
      contact.force_N.z() = static_cast<double>(shape.frame.views[0].cloud.Count());
      result_.estimate.contacts = {contact};
      return result_;
    }

   private:
    Script& script_;
    robot::RobotModel& model_;
    int number_ = 0;
    PipelineResult result_;
  };

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool hold_ = false;
  DriftReport drift_;
  int bias_frames_to_come_ = 0;
  std::string contact_name_ = "contact_1";
  int made_ = 0;
  std::vector<Call> calls_;
  std::vector<Eigen::VectorXd> expected_;
};

}  // namespace palpate::force_estimation
