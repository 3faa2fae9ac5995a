#pragma once

#include "experiments/columns.hpp"
#include "experiments/row.hpp"
#include "raytruth/schemes/scheme_integral.hpp"

#include <optional>
#include <string>
#include <vector>

namespace raytruth {

/// Signed errors of colour and opacity, one of each ray, and a bound on how far any of them may be from the true one.
struct RayErrors {
  std::vector<Difference> rays;
  double radius = 0;

  void add(const Difference& error, double error_radius);
};

/// The largest magnitude among the channels.
double color_magnitude(const Difference& error);

/// Root mean squares over rays, and for the colour over channels too; 0 without rays.
double rms_opacity(const RayErrors& errors);
double rms_color(const RayErrors& errors);

/// What the errors of one quantity come to over rays: the signed mean, the root mean square, and of the magnitudes
/// median, 95th percentile and maximum.
struct QuantityErrors {
  double bias = 0;
  double rms = 0;
  double median = 0;
  double percentile_95 = 0;
  double max = 0;
};

/// Both summaries, of opacity and of colour; none without rays.
struct ErrorSummary {
  std::optional<QuantityErrors> opacity;
  std::optional<QuantityErrors> color;
  double radius = 0;  ///< bound on how far any of these may be from the true one
};

/// The errors, times `scale`.
ErrorSummary summary_of(const RayErrors& errors, double scale = 1);

/// NAME_bias, NAME_rms, NAME_p50, NAME_p95 and NAME_max for opacity and colour; and `radius`.
Columns<ErrorSummary> error_summary_columns(const std::string& unit, const std::string& of_what);

}  // namespace raytruth
