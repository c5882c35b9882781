// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/forces/estimate_plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "libs/core/error.hpp"

namespace palpate::offline {
namespace {

using experiment::Recording;
using experiment::RecordingKind;
using testing::ElementsAre;
using testing::SizeIs;

Recording Named(const std::string& name, RecordingKind kind) {
  Recording recording;
  recording.name = name;
  recording.kind = kind;
  return recording;
}

// 0: images, 1: images and markers, 2: markers, 3: neither
class EstimatePlanTest : public testing::Test {
 protected:
  EstimatePlanTest() {
    experiment_.recordings = {
        Named("a_rest", RecordingKind::kRest), Named("b_push", RecordingKind::kFree),
        Named("c_ramp", RecordingKind::kRamp), Named("d_none", RecordingKind::kHold)};
    experiment_.recordings[0].depth_images.resize(1);
    experiment_.recordings[1].clouds.resize(1);
    experiment_.recordings[1].markers.emplace();
    experiment_.recordings[2].markers.emplace();
  }
  std::string Words(const std::vector<std::string>& names, const std::string& from) const {
    std::vector<const Recording*> recordings;
    for (const std::string& name : names) {
      for (const Recording& recording : experiment_.recordings) {
        if (recording.name == name) recordings.push_back(&recording);
      }
    }
    EXPECT_EQ(recordings.size(), names.size());
    std::string words;
    for (const PlannedRecording& planned : PlanEstimates(experiment_, recordings, from)) {
      words += planned.recording->name.substr(0, 1) + ":" + ToString(planned.from) + " ";
    }
    return words;
  }
  experiment::Experiment experiment_;
};

TEST_F(EstimatePlanTest, ImagesComeBeforeMarkers) {
  EXPECT_EQ(Words({}, ""), "a:shape b:shape c:markers ");
  EXPECT_EQ(Words({"c_ramp", "b_push"}, ""), "c:markers b:shape ");
}

TEST_F(EstimatePlanTest, TheWayThatIsAskedForLeavesTheOtherOut) {
  EXPECT_EQ(Words({}, "markers"), "b:markers c:markers ");
  EXPECT_EQ(Words({}, "shape"), "a:shape b:shape ");
  EXPECT_THROW(Words({"c_ramp"}, "shape"), InputError);
  EXPECT_THROW(Words({"a_rest"}, "markers"), InputError);
}

TEST_F(EstimatePlanTest, RefusesWhatCannotBeEstimated) {
  EXPECT_THROW(Words({"d_none"}, ""), InputError);
  experiment_.recordings = {experiment_.recordings[3]};
  EXPECT_THROW(Words({}, ""), InputError);
}

TEST_F(EstimatePlanTest, NobodyTouchesTheRobotInSomeKinds) {
  for (const RecordingKind kind :
       {RecordingKind::kRest, RecordingKind::kRamp, RecordingKind::kHold,
        RecordingKind::kCoContraction, RecordingKind::kSecondSpeed, RecordingKind::kRepeat}) {
    EXPECT_TRUE(IsContactFree(Named("r", kind))) << experiment::ToString(kind);
  }
  for (const RecordingKind kind : {RecordingKind::kKnownLoad, RecordingKind::kBaseTilted,
                                   RecordingKind::kCameraMoved, RecordingKind::kFree}) {
    EXPECT_FALSE(IsContactFree(Named("r", kind))) << experiment::ToString(kind);
  }
  Recording loaded = Named("r", RecordingKind::kHold);
  loaded.loads.resize(1);
  EXPECT_FALSE(IsContactFree(loaded));
}

TEST_F(EstimatePlanTest, BiasRecordingsHaveImagesAndAreContactFree) {
  EXPECT_THAT(BiasRecordings(experiment_), ElementsAre(&experiment_.recordings[0]));
  experiment_.recordings[2].depth_images.resize(1);
  EXPECT_THAT(BiasRecordings(experiment_), SizeIs(2));
}

}  // namespace
}  // namespace palpate::offline
