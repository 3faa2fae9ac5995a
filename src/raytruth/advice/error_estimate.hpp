#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace raytruth {

/// What of an image's error is asked for. All are of colours in linear light, but `encoded`, the largest difference of
/// sRGB values of [0, 1], of which 8 bits show steps of 1/255.
enum class ErrorKind { rmse, largest, encoded };

inline constexpr std::array<std::string_view, 3> error_kind_names{"rmse", "largest", "encoded"};

/// An image's error as a sample of its pixels tells it: what it is taken to be, and between which bounds it lies with
/// the confidence that is asked for.
struct ErrorEstimate {
  double value = 0;
  double low = 0;
  double high = 0;
};

/// The error of an image all of whose pixels' errors, or their squares for `rmse`, are known.
ErrorEstimate error_of_all(ErrorKind kind, const std::vector<double>& errors);

/// The root of the mean of squares, those of the pixels' errors. `high` is the empirical Bernstein bound (A. Maurer, M.
/// Pontil, Empirical Bernstein Bounds and Sample-Variance Penalization, COLT 2009, theorem 4),
///     mean + sqrt(2 V ln(2 / d) / n) + 7 R ln(2 / d) / (3 (n - 1)),
/// V the sample's variance and d = 1 - confidence. It asks for the range R of a square, which nobody knows: twice the
/// largest one that was seen is taken, so the bound is no proof. `low` is two standard errors below the mean.
ErrorEstimate rmse_of_sample(const std::vector<double>& squares, double confidence);

/// The largest of `population` errors of which the sample has some, by the tail of the sample's largest tenth (A.
/// L. M. Dekkers, J. H. J. Einmahl, L. de Haan, A moment estimator for the index of an extreme-value distribution,
/// Annals of Statistics 17, 1989): with the index g of the tail, the k-th largest x_k of n, and M1 the mean of ln(x_i /
/// x_k),
///     x(p) = x_k + x_k M1 (1 - min(g, 0)) ((k / (n p))^g - 1) / g
/// is exceeded with the probability p. An index that comes out too small makes this too near, so what an exponential
/// tail exceeds with that probability, x_k + ln(k / (n p)) times the mean of x_i - x_k, is taken where it is larger.
/// `value` is x(1 / population); `high` is half as much again as x((1 - confidence) / population), which the largest
/// one exceeds with the probability 1 - confidence if the tail is what it is taken for. `low` is the largest error of
/// the sample, which is certain.
ErrorEstimate largest_of_sample(std::vector<double> errors, double population, double confidence);

/// The estimate of a largest error of which one as large as `found` was found by a search uphill, not by chance. What
/// such a search has not found is taken to be no more than a tenth larger.
ErrorEstimate and_at_least(ErrorEstimate estimate, double found);

}  // namespace raytruth
