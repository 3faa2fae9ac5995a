#pragma once

#include <optional>
#include <string>
#include <vector>

namespace raytruth {

/// What decides a verdict on one kind of sentence (criteria.json, the one table of them).
struct Criterion {
  std::string name;
  std::string sentence;
  std::string reason;
  std::optional<double> at_least = {};  ///< the limit of a test that states none
  std::optional<double> at_most = {};
};

/// All, in the order in which the table shows them.
const std::vector<Criterion>& criteria();

}  // namespace raytruth
