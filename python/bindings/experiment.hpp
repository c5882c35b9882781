// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <pybind11/pybind11.h>

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "libs/experiment/experiment.hpp"

namespace palpate::python {

/// A recording of an experiment, its tables as dense arrays. NaN: not seen, or an empty field.
class Recording {
 public:
  Recording(std::shared_ptr<const experiment::Experiment> experiment, std::size_t index);

  const experiment::Experiment& experiment() const { return *experiment_; }
  std::size_t index() const { return index_; }  ///< in its experiment
  const experiment::Recording& data() const { return experiment_->recordings[index_]; }

  const Eigen::VectorXd& marker_t_s() const { return marker_t_s_; }  ///< [frames]
  /// [3 markers x frames] as measured, m, in the recording's frame.
  const Eigen::MatrixXd& markers_m() const { return markers_m_; }
  const Eigen::VectorXd& actuation_t_s() const { return actuation_t_s_; }  ///< [rows]
  const Eigen::MatrixXd& actuation() const { return actuation_; }          ///< [rows x columns]

 private:
  std::shared_ptr<const experiment::Experiment> experiment_;
  std::size_t index_;
  Eigen::VectorXd marker_t_s_, actuation_t_s_;
  Eigen::MatrixXd markers_m_, actuation_;
};

/// Images and clouds of a recording, and its camera.
void BindImages(pybind11::module_& module,
                pybind11::class_<Recording, std::shared_ptr<Recording>>& recording);

}  // namespace palpate::python
