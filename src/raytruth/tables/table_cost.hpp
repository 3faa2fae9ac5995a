#pragma once

#include <cstddef>
#include <cstdint>

namespace raytruth {

/// What building a table takes, in closed form: tests hold it against an arithmetic that counts.
struct TableCost {
  std::int64_t composites = 0;    ///< products of two slabs
  std::int64_t exponentials = 0;  ///< opacities made of an extinction and a length
};

}  // namespace raytruth
