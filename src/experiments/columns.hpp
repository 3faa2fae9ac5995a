#pragma once

#include "experiments/row.hpp"

#include <algorithm>
#include <concepts>
#include <functional>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace raytruth {

/// What a cell holds, from what a measure has: numbers, words, true or false; null from an optional without value.
template <class T>
Value value_of(const T& value) {
  if constexpr (std::same_as<T, bool> || std::same_as<T, Value>)
    return value;
  else if constexpr (std::integral<T>)
    return static_cast<std::int64_t>(value);
  else if constexpr (std::floating_point<T>)
    return static_cast<double>(value);
  else if constexpr (std::constructible_from<std::string, T>)
    return std::string(value);
  else
    return value ? value_of(*value) : Value();
}

/// How a record gives its cell in a column: by a member of it, or by a function of it. A function that answers
/// std::optional<Value> leaves the cell out of the row where it answers none.
template <class Record>
class CellOf {
 public:
  CellOf() = default;

  template <class Get>
  requires std::invocable<const Get&, const Record&> CellOf(
      Get get)  // NOLINT(google-explicit-constructor): columns are written as lists
      : get_([get = std::move(get)](const Record& record) -> std::optional<Value> {
          if constexpr (std::same_as<std::invoke_result_t<const Get&, const Record&>, std::optional<Value>>)
            return std::invoke(get, record);
          else
            return value_of(std::invoke(get, record));
        }) {}

  [[nodiscard]] bool is_empty() const { return get_ == nullptr; }
  std::optional<Value> operator()(const Record& record) const { return get_(record); }

 private:
  std::function<std::optional<Value>(const Record&)> get_;
};

/// A column of a measure's rows: what it means, and the cell that each record has in it. So no cell can be written
/// that is not described.
template <class Record>
struct RecordColumn {
  std::string name;
  std::string unit = {};  ///< empty for words and counts
  std::string description = {};
  bool is_key = false;      ///< the row's identity: rows of two results correspond where their keys agree
  std::string radius = {};  ///< the column that holds this one's radius; empty: exact
  /// Empty: described here, written where `written_here` stands. In a braced list it is then written as `.cell = {}`,
  /// for GCC 12 breaks off where it is left out.
  CellOf<Record> cell = {};
};

/// The columns of a measure, in the order in which its rows write them.
template <class Record>
using Columns = std::vector<RecordColumn<Record>>;

/// The place in a row of a column that the list describes elsewhere, because some rows have it earlier or later than
/// the result's list of columns does.
template <class Record>
RecordColumn<Record> written_here(std::string name, CellOf<Record> cell) {
  return {.name = std::move(name), .cell = std::move(cell)};
}

/// The cell of a column that only some records have: left out unless `is_there`.
template <class T>
std::optional<Value> cell_if(bool is_there, const T& value) {
  return is_there ? std::optional(value_of(value)) : std::nullopt;
}

template <class Record>
void append(Columns<Record>& columns, Columns<Record> more) {
  columns.insert(columns.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

/// Adds the columns of a part of the record: `get` gives the part, or an optional or a pointer; where that holds no
/// part its cells are left out.
template <class Record, class Part, class Get>
void append_part(Columns<Record>& columns, Get get, const Columns<Part>& of_part) {
  for (const RecordColumn<Part>& column : of_part) {
    RecordColumn<Record>& added = columns.emplace_back(RecordColumn<Record>{.name = column.name,
                                                                            .unit = column.unit,
                                                                            .description = column.description,
                                                                            .is_key = column.is_key,
                                                                            .radius = column.radius});
    if (column.cell.is_empty()) continue;
    added.cell = [get, cell = column.cell](const Record& record) -> std::optional<Value> {
      const auto& part = std::invoke(get, record);
      if constexpr (std::same_as<std::decay_t<decltype(part)>, Part>)
        return cell(part);
      else
        return part ? cell(*part) : std::nullopt;
    };
  }
}

/// Adds `status` and `why`, which every result describes, of records that may say why they are refused: `get` gives an
/// optional text. Rows without one are "ok".
template <class Record, class Get>
void append_refusal(Columns<Record>& columns, Get get) {
  columns.push_back(written_here<Record>("status", [get](const Record& record) -> std::optional<Value> {
    return std::invoke(get, record) ? std::optional<Value>("refused") : std::nullopt;
  }));
  columns.push_back(written_here<Record>("why", [get](const Record& record) -> std::optional<Value> {
    const auto& why = std::invoke(get, record);
    return why ? std::optional<Value>(value_of(*why)) : std::nullopt;
  }));
}

/// What a result says of the columns.
template <class Record>
std::vector<Column> descriptions_of(const Columns<Record>& columns) {
  std::vector<Column> described;
  for (const RecordColumn<Record>& column : columns)
    if (!column.description.empty())
      described.push_back({column.name, column.unit, column.description, column.is_key, column.radius});
  for (const RecordColumn<Record>& column : columns)
    if (column.description.empty() && column.name != "status" && column.name != "why" &&
        std::none_of(described.begin(), described.end(),
                     [&](const Column& other) { return other.name == column.name; }))
      throw std::logic_error("the column " + column.name + " is not described");
  return described;
}

/// The row of a record.
template <class Record>
Row row_of(const Columns<Record>& columns, const Record& record) {
  Row row;
  for (const RecordColumn<Record>& column : columns) {
    if (column.cell.is_empty()) continue;
    if (auto value = column.cell(record)) row.emplace_back(column.name, std::move(*value));
  }
  return row;
}

}  // namespace raytruth
