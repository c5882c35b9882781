// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <vector>

#include "components/force_estimation/node/frame_estimator.hpp"

namespace palpate::force_estimation {

/// What the stand-in for the estimator was asked, shared between it and the test.
class Script {
 public:
  struct Call {
    int estimator = 0;  ///< which one, from 1
    SeenShape seen;
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
  FrameEstimatorMaker Maker() {
    return [this](robot::RobotModel& model) { return std::make_unique<Scripted>(*this, model); };
  }

 private:
  /// One force of as many newtons as the cloud has points.
  class Scripted : public FrameEstimator {
   public:
    Scripted(Script& script, robot::RobotModel& model) : script_(script), model_(model) {
      const std::lock_guard lock(script_.mutex_);
      number_ = ++script_.made_;
    }
    FrameResult Update(FrameInput& input) override {
      std::unique_lock lock(script_.mutex_);
      const auto& seen = std::get<SeenShape>(input.frame);
      script_.calls_.push_back({number_, seen, model_.body().materials.front().youngs_modulus_Pa});
      script_.changed_.wait(lock, [this] { return !script_.hold_; });
      FrameResult result{input.head, {}, {}, true, Status::Ok(), script_.drift_};
      result.estimate.status = Status::Ok();
      result.estimate.x_m = model_.RestState().x_m;
      ContactForce contact;
      contact.status = Status::Ok();
      contact.name = "contact_1";
      contact.force_N.z() = static_cast<double>(seen.frame.cloud.Count());
      result.estimate.contacts = {contact};
      return result;
    }

   private:
    Script& script_;
    robot::RobotModel& model_;
    int number_ = 0;
  };

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool hold_ = false;
  DriftReport drift_;
  int made_ = 0;
  std::vector<Call> calls_;
};

}  // namespace palpate::force_estimation
