// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

namespace palpate::force_estimation {

/// Quantile of the standard normal distribution, 0 <= probability <= 1 (Acklam's rational
/// approximation, 1e-9). Always finite: 0 and 1 count as the numbers next to them (-37.5 and 8.2),
/// as 1 - chance is 1 for a chance below 1e-16.
double NormalQuantile(double probability);

/// Quantile of the chi-squared distribution with `degrees` >= 1 degrees of freedom: exact for one
/// and two, else Wilson and Hilferty's cube root, good to 2 % for probabilities from 0.5 to 0.999.
/// 0 <= probability <= 1, 1 as above.
double ChiSquaredQuantile(double probability, int degrees);

/// Half-width of a 95 % interval in standard deviations.
inline constexpr double kSigmas95 = 1.959963984540054;

}  // namespace palpate::force_estimation
