// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/images/image_samples.hpp"

#include <algorithm>

#include "components/calibration/joint/model_snapshot.hpp"
#include "components/calibration/recording_phase.hpp"
#include "libs/core/error.hpp"
#include "libs/core/seconds.hpp"
#include "libs/core/text.hpp"

namespace palpate::offline {

namespace {

/// The frames to use, as indices into `images.frames`.
std::vector<std::size_t> Choose(const experiment::Recording& recording,
                                const experiment::RgbdSequence& images, std::size_t most) {
  std::vector<std::size_t> in_window;
  for (std::size_t k = 0; k < images.frames.size(); ++k) {
    const double t_s = NsToSeconds(images.frames[k].t_ns);
    const auto& window = recording.steady_window_s;
    if (!window || (t_s >= window->begin_s && t_s <= window->end_s)) in_window.push_back(k);
  }
  if (in_window.empty()) {
    throw InputError(recording.folder.string() + ": no image lies in steady_window_s");
  }
  if (recording.steady_window_s || calibration::CablesAreStill(recording)) {
    return {in_window[in_window.size() / 2]};
  }
  const std::size_t count = std::min(in_window.size(), most);
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < count; ++k) {
    chosen.push_back(in_window[count == 1 ? 0 : k * (in_window.size() - 1) / (count - 1)]);
  }
  return chosen;
}

}  // namespace

std::vector<ImageSample> SamplesOf(const experiment::Recording& recording,
                                   const experiment::RgbdSequence& images,
                                   const robot::RobotModel& model, robot::CableInput preferred,
                                   std::size_t most) {
  const std::vector<std::size_t> chosen = Choose(recording, images, most);
  std::vector<ImageSample> samples;
  for (const std::size_t index : chosen) {
    const double t_s = NsToSeconds(images.frames[index].t_ns);
    const std::string name =
        chosen.size() == 1 ? recording.name : recording.name + " at " + FormatNumber(t_s) + " s";
    samples.push_back(SampleAt(recording, images, index, name, model, preferred));
  }
  return samples;
}

ImageSample SampleAt(const experiment::Recording& recording, const experiment::RgbdSequence& images,
                     std::size_t index, const std::string& name, const robot::RobotModel& model,
                     robot::CableInput preferred) {
  experiment::CheckActuators(recording, model.CableNames(), model.ChamberNames());
  const double t_s = NsToSeconds(images.frames[index].t_ns);
  return {.images = &images,
          .index = index,
          .frame = {.name = name,
                    .cloud = {},
                    .cables = calibration::CablesAt(recording, model, preferred, t_s),
                    .loads = calibration::LoadsAt(recording, model, t_s),
                    .gravity_m_s2 =
                        experiment::BaseRotation(recording).transpose() * model.gravity_m_s2()}};
}

std::vector<Eigen::VectorXd> ShapesOf(const std::vector<ImageSample>& samples,
                                      robot::RobotModel* model) {
  const calibration::ModelSnapshot kept(*model);
  std::vector<Eigen::VectorXd> shapes_m;
  for (const ImageSample& sample : samples) {
    model->SetGravity(sample.frame.gravity_m_s2);
    fem::StaticState state = model->RestState();
    const fem::StaticResult solved = model->Solve(sample.frame.cables, sample.frame.loads, &state);
    kept.RestoreGravity();
    if (!solved.status.ok()) {
      throw RunError(sample.frame.name + ": " + solved.status.message());
    }
    shapes_m.push_back(state.x_m);
  }
  return shapes_m;
}

}  // namespace palpate::offline
