#pragma once

#include "raytruth/core/error.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <cstddef>
#include <optional>

namespace raytruth::python {

/// While it lives, work is done on so many threads; 0: on all cores.
class Threads {
 public:
  /// Throws InputError for a negative number.
  explicit Threads(int count) {
    if (count < 0)
      throw InputError(fmt::format("threads: found {}; a number from 1 on, or 0 for all, is allowed", count));
    if (count > 0) limit_.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count));
  }

 private:
  std::optional<tbb::global_control> limit_;
};

}  // namespace raytruth::python
