#pragma once

#include <string_view>
#include <type_traits>
#include <vector>

namespace raytruth {

/// An ingredient of which nothing but its name is asked: a row of a list that has no type of its own.
struct Named {
  std::string_view name;
  std::string_view summary;
};

namespace detail {

/// A row, from a list of rows or of pointers to them.
template <class Item>
const auto& row_of_list(const Item& item) {
  if constexpr (std::is_pointer_v<Item>)
    return *item;
  else
    return item;
}

}  // namespace detail

/// The names of a list's rows, in its order.
template <class List>
std::vector<std::string_view> names_of(const List& list) {
  std::vector<std::string_view> names;
  for (const auto& item : list) names.emplace_back(detail::row_of_list(item).name);
  return names;
}

/// The row of this name; null if there is none.
template <class List>
auto find_named(const List& list, std::string_view name) -> decltype(&detail::row_of_list(*list.begin())) {
  for (const auto& item : list)
    if (detail::row_of_list(item).name == name) return &detail::row_of_list(item);
  return nullptr;
}

}  // namespace raytruth
