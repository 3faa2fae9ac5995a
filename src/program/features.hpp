#pragma once

#include <string>

namespace raytruth {

/// What this program was built with, and what of it this machine runs: lines without a newline behind the last one.
std::string features();

}  // namespace raytruth
