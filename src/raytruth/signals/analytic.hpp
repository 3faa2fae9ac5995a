#pragma once

#include "raytruth/core/chain.hpp"

#include <array>
#include <functional>
#include <string_view>
#include <vector>

namespace raytruth {

/// A signal given by a formula on [0, length], for convergence studies: it has no cells and no data.
struct AnalyticSignal {
  std::string_view name;
  std::string_view character;
  double length;
  std::array<double, 1> breaks;  ///< where the formula changes, in (0, length); 0: nowhere
  double (*value)(double t);
};

/// The test signals, values in [0, 1] unless their character says otherwise, one length unit to a voxel.
const std::vector<AnalyticSignal>& analytic_signals();

inline constexpr double expansion_tolerance = 0x1p-44;

/// The signal as a chain of polynomials of degree 9: every stretch between breaks is halved until the interpolating
/// polynomial through ten Chebyshev points meets the formula, at the eleven points between and around them, to
/// `expansion_tolerance` of the largest value seen at 65 points. Formulas round t and their phases; a finer tolerance
/// would chase that noise. Below 2^-20 of the length a stretch is taken as it is. Throws InputError for a formula that
/// is not finite.
Chain<9> expand(const std::function<double(double)>& value, const std::vector<double>& breaks, double length);
Chain<9> expand(const AnalyticSignal& signal);

}  // namespace raytruth
