#include "raytruth/transfer/opacity_convention.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/rules/rules.hpp"

#include <fmt/format.h>

#include <cmath>

namespace raytruth {

namespace {

void check_opacity(double opacity) {
  if (!(opacity >= 0 && opacity <= 1))
    throw InputError(fmt::format("found opacity {}; a number from 0 to 1 is allowed", opacity));
}

void check_positive(const char* what, double number) {
  if (!(number > 0) || !std::isfinite(number))
    throw InputError(fmt::format("found {} {}; a finite number > 0 is allowed", what, number));
}

void check_not_negative(const char* what, double number) {
  if (!(number >= 0) || !std::isfinite(number))
    throw InputError(fmt::format("found {} {}; a finite number >= 0 is allowed", what, number));
}

}  // namespace

double opacity_of(double extinction, double length) {
  check_not_negative("extinction", extinction);
  check_not_negative("length", length);
  return Rules<double>{}.absorption(extinction * length, false);
}

double extinction_of(double opacity, double length) {
  check_opacity(opacity);
  check_positive("length", length);
  return -std::log1p(-opacity) / length;
}

double corrected_opacity(double opacity, double ratio) {
  check_opacity(opacity);
  check_positive("ratio", ratio);
  return Rules<double>{}.opacity_correction(opacity, ratio);
}

double clamped_opacity(double opacity, double ratio) {
  check_opacity(opacity);
  check_positive("ratio", ratio);
  return Rules<double>{}.opacity_correction_linear(opacity, ratio);
}

}  // namespace raytruth
