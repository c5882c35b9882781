// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/contacts/assignment.hpp"

#include <limits>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"

namespace palpate::perception {

namespace {

/// Rows and columns count from 0 here; kFree: an unassigned column.
constexpr int kFree = -1;

/// Shortest augmenting paths with potentials (Kuhn, Munkres; Jonker and Volgenant 1987).
class Assignment {
 public:
  explicit Assignment(const Eigen::MatrixXd& cost)
      : cost_(cost),
        row_price_(Eigen::VectorXd::Zero(cost.rows())),
        column_price_(Eigen::VectorXd::Zero(cost.cols())),
        row_of_column_(static_cast<std::size_t>(cost.cols()), kFree) {}

  /// Gives `row` a column; rows before it may get another one than they had.
  void Add(int row) {
    const auto columns = static_cast<std::size_t>(cost_.cols());
    distance_.assign(columns, std::numeric_limits<double>::infinity());
    came_from_.assign(columns, kFree);
    done_.assign(columns, 0);
    int column = kFree;
    for (int from = row; from != kFree; from = row_of_column_[At(column)]) {
      Relax(from, column);
      column = Nearest();
      Pay(row, distance_[At(column)]);
      done_[At(column)] = 1;
    }
    Augment(row, column);
  }

  std::vector<int> ColumnsOfRows() const {
    std::vector<int> columns(static_cast<std::size_t>(cost_.rows()), kFree);
    for (std::size_t column = 0; column < row_of_column_.size(); ++column) {
      const int row = row_of_column_[column];
      if (row != kFree) columns[At(row)] = static_cast<int>(column);
    }
    return columns;
  }

 private:
  void Relax(int row, int over_column) {
    for (std::size_t column = 0; column < done_.size(); ++column) {
      const auto c = ToIndex(column);
      const double reduced = cost_(row, c) - row_price_[row] - column_price_[c];
      if (done_[column] != 0 || reduced >= distance_[column]) continue;
      distance_[column] = reduced;
      came_from_[column] = over_column;
    }
  }

  int Nearest() const {
    int nearest = kFree;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t column = 0; column < done_.size(); ++column) {
      if (done_[column] != 0 || distance_[column] >= least) continue;
      least = distance_[column];
      nearest = static_cast<int>(column);
    }
    PALPATE_CHECK(nearest != kFree, cost_);
    return nearest;
  }

  /// The path's rows and columns change their prices so that its next step costs nothing.
  void Pay(int first_row, double step) {
    row_price_[first_row] += step;
    for (std::size_t column = 0; column < done_.size(); ++column) {
      if (done_[column] == 0) {
        distance_[column] -= step;
        continue;
      }
      row_price_[row_of_column_[column]] += step;
      column_price_[ToIndex(column)] -= step;
    }
  }

  void Augment(int row, int column) {
    while (true) {
      const int before = came_from_[At(column)];
      const bool first = before == kFree;
      row_of_column_[At(column)] = first ? row : row_of_column_[At(before)];
      if (first) return;
      column = before;
    }
  }

  const Eigen::MatrixXd& cost_;
  Eigen::VectorXd row_price_;
  Eigen::VectorXd column_price_;
  std::vector<int> row_of_column_;
  std::vector<double> distance_;
  std::vector<int> came_from_;  ///< column before this one on the path
  std::vector<char> done_;
};

}  // namespace

std::vector<int> AssignRows(const Eigen::MatrixXd& cost) {
  PALPATE_CHECK(cost.rows() <= cost.cols(), cost.rows(), cost.cols());
  Assignment assignment(cost);
  for (int row = 0; row < cost.rows(); ++row) assignment.Add(row);
  return assignment.ColumnsOfRows();
}

}  // namespace palpate::perception
