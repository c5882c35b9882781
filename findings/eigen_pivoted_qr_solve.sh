#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
#
# Subject    Eigen 3.4.0 (Debian 12, libeigen3-dev 3.4.0-4), ColPivHouseholderQR
# Behaviour  solve() does not use rank(). It divides by each pivot up to nonzeroPivots(), and
#            setThreshold() changes rank() alone. With the default threshold, too, rank() reports a
#            dependent column that solve() then divides by: unknowns of 1e15.
# Expected   The class is documented as rank-revealing, and setThreshold() as what decides which
#            pivots count as nonzero. So solve() of a matrix of rank 3 leaves one unknown at 0.
#            CompleteOrthogonalDecomposition, made of the same factors, does use rank().
# Matters    A least-squares fit with redundant columns (three cables pulled so that one tension is
#            the sum of two) has unknowns of any size, while rank() says that this was noticed.
# Needs      g++, apt-get with package lists, dpkg
set -euo pipefail

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

apt-get -qq -o APT::Sandbox::User="$(id -un)" download libeigen3-dev=3.4.0-4
dpkg -x libeigen3-dev_*.deb root

cat >solve.cpp <<'CPP'
#include <Eigen/QR>
#include <cstdint>
#include <cstdio>

namespace {

// Uniform in -1 to 1 (a linear congruential generator: the same numbers everywhere).
double Draw() {
  static std::uint64_t state = 2026;
  state = state * 6364136223846793005u + 1442695040888963407u;
  return static_cast<double>(state >> 33) / 1073741824.0 - 1.0;
}

Eigen::MatrixXd Matrix(Eigen::Index rows, Eigen::Index columns) {
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [] { return Draw(); });
}

const char* Size(const Eigen::VectorXd& x) {
  const double largest = x.cwiseAbs().maxCoeff();
  return largest < 1e3 ? "below 1e3" : largest > 1e6 ? "above 1e6" : "between";
}

void WithThreshold() {
  Eigen::MatrixXd A = Matrix(10, 4);
  A.col(3) = A.col(0) + A.col(1) + 1e-9 * Matrix(10, 1);
  const Eigen::VectorXd b = Matrix(10, 1);
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(A);
  qr.setThreshold(1e-6);
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> cod;
  cod.setThreshold(1e-6);
  cod.compute(A);
  std::printf("threshold 1e-6, last column = sum of two + 1e-9\n");
  std::printf("  ColPivHouseholderQR: rank %d, unknowns %s\n", static_cast<int>(qr.rank()),
              Size(qr.solve(b)));
  std::printf("  CompleteOrthogonalDecomposition: rank %d, unknowns %s\n",
              static_cast<int>(cod.rank()), Size(cod.solve(b)));
}

void ByDefault() {
  int deficient = 0;
  int huge = 0;
  int huge_complete = 0;
  for (int i = 0; i < 1000; ++i) {
    Eigen::MatrixXd A = Matrix(10, 4);
    A.col(3) = A.leftCols(3) * Matrix(3, 1);
    const Eigen::VectorXd b = Matrix(10, 1);
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(A);
    deficient += qr.rank() == 3;
    huge += qr.solve(b).cwiseAbs().maxCoeff() > 1e6;
    huge_complete += A.completeOrthogonalDecomposition().solve(b).cwiseAbs().maxCoeff() > 1e6;
  }
  std::fprintf(stderr, "of 1000: rank 3: %d, unknowns above 1e6: %d\n", deficient, huge);
  std::printf("default threshold, last column = combination of three, 1000 matrices\n");
  std::printf("  ColPivHouseholderQR: rank 3 in %s, unknowns above 1e6 in %s\n",
              deficient > 990 ? "over 990" : "990 or fewer", huge > 50 ? "over 50" : "50 or fewer");
  std::printf("  CompleteOrthogonalDecomposition: unknowns above 1e6 in %d\n", huge_complete);
}

}  // namespace

int main() {
  std::printf("Eigen %d.%d.%d\n", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION);
  WithThreshold();
  ByDefault();
}
CPP
g++ -std=c++17 -O1 -ffp-contract=off -DEIGEN_DONT_VECTORIZE -isystem root/usr/include/eigen3 \
  solve.cpp -o solve

cat >expected <<'SEEN'
Eigen 3.4.0
threshold 1e-6, last column = sum of two + 1e-9
  ColPivHouseholderQR: rank 3, unknowns above 1e6
  CompleteOrthogonalDecomposition: rank 3, unknowns below 1e3
default threshold, last column = combination of three, 1000 matrices
  ColPivHouseholderQR: rank 3 in over 990, unknowns above 1e6 in over 50
  CompleteOrthogonalDecomposition: unknowns above 1e6 in 0
SEEN

./solve | tee seen
if ! diff expected seen; then
  echo "the behaviour has changed" >&2
  exit 1
fi
