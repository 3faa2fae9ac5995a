#pragma once

#include "experiments/columns.hpp"
#include "raytruth/core/chain.hpp"
#include "raytruth/schemes/samples.hpp"
#include "raytruth/statistics/order.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace raytruth {

/// How samples get closer in a study of orders: inside every cell alike, so that no interval crosses a border, or along
/// the whole ray.
enum class Regime { cells, constant };

inline constexpr std::array regimes{std::pair{Regime::cells, std::string_view("cells")},
                                    std::pair{Regime::constant, std::string_view("constant")}};

/// Steps 2^-3 to 2^-8.
inline constexpr std::size_t level_count = 6;

/// In cells or voxels.
double step_of(std::size_t level);

void sample(const Chain<3>& signal, Regime regime, std::size_t level, Samples<double>& samples);

/// Which row of a study of orders: how samples get closer, of which scheme, and at which step; none: the orders that
/// all steps show.
struct ConvergenceKeys {
  std::string regime;
  std::string scheme;
  std::optional<double> step;
};

/// Keys of the rows: `regime`, `scheme`, `part` (point or fit), `step`.
Columns<ConvergenceKeys> convergence_key_columns();

/// The order that errors at all steps show; none where fewer than two of them stand out from their radii.
struct ShownOrder {
  std::optional<FittedOrder> fit;
  std::optional<double> finest;  ///< least step in the fit
};

/// `order_NAME` and its residual and finest step. `errors` is the column that the fit is of.
Columns<ShownOrder> shown_order_columns(const std::string& name, const std::string& errors);

/// Errors by level, and how far each may be off.
struct LevelError {
  double error = 0;
  double radius = 0;
};

/// By level.
ShownOrder shown_order(std::span<const LevelError> levels);

}  // namespace raytruth
