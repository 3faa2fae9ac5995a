#pragma once

#include "raytruth/core/error.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <tuple>

namespace raytruth {

/// No generated field has more nodes along an axis: 2048^3 numbers are 64 GiB.
inline constexpr std::int64_t largest_generated_size = 2048;

/// A number that says how to generate a field: its name in documents, where it stands in the field's type, whose
/// initializer is its default, and the least and largest that is allowed.
template <class Field, class Number>
struct FieldOption {
  std::string_view name;
  Number Field::*member;
  Number least;
  Number most;
};

/// An option out of its range.
class FieldOptionError : public InputError {
 public:
  template <class Number>
  FieldOptionError(std::string_view its_option, Number found, Number least, Number most)
      : InputError(fmt::format("{} {}; {} to {} is allowed", its_option, found, least, most)), option(its_option) {}

  std::string option;  ///< its name
};

/// Throws FieldOptionError.
template <class Field>
void check_options(const Field& field) {
  const auto check_one = [&field](const auto& option) {
    const auto value = field.*option.member;
    if (!(option.least <= value && value <= option.most))
      throw FieldOptionError(option.name, value, option.least, option.most);
  };
  std::apply([&check_one](const auto&... option) { (check_one(option), ...); }, Field::options());
}

}  // namespace raytruth
