#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace raytruth {

/// A cell of a result table; the empty alternative is JSON's null.
using Value = std::variant<std::monostate, bool, std::int64_t, double, std::string>;

/// A flat record of a result, in the order in which its keys are written.
using Row = std::vector<std::pair<std::string, Value>>;

/// What a key of the rows means.
struct Column {
  std::string name;
  std::string unit;  ///< empty for words and counts
  std::string description;
  bool is_key = false;      ///< the row's identity: rows of two results correspond where their keys agree
  std::string radius = {};  ///< the column that holds this one's radius; empty: exact
};

inline void append(std::vector<Column>& columns, const std::vector<Column>& more) {
  columns.insert(columns.end(), more.begin(), more.end());
}

}  // namespace raytruth
