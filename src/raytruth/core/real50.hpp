#pragma once

#include "raytruth/core/real.hpp"

#include <boost/multiprecision/cpp_bin_float.hpp>

namespace raytruth {

/// 50 decimal digits: the arithmetic in which formulas are judged.
using Real50 = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<50>, boost::multiprecision::et_off>;

}  // namespace raytruth
