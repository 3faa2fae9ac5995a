#pragma once

#include "raytruth/documents/json/json_reader.hpp"
#include "raytruth/tables/look_up.hpp"
#include "raytruth/tables/quadratic_gray_table.hpp"
#include "raytruth/tables/second_order.hpp"
#include "raytruth/tables/table_builder.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace raytruth {

/// The table of psi (tables/partial_pre_integration.hpp), which no transfer function takes part in.
struct PartialPreIntegration {};

/// A table of the quadratic gray-value model.
struct QuadraticGrayAsked {
  /// Light by the gradient of the opacity instead of colours.
  struct Lit {
    GradientTable which = GradientTable::diffuse;
    bool is_corrected = true;
    double exponent = 1;
    std::vector<double> v = {0};  ///< one table for each; of highlights alone
  };

  const QuadraticGrayBuilder* builder = nullptr;
  RadiusAxis radius = {};
  std::optional<Lit> lit = {};
};

/// A case of `raytruth table`; experiments/schemas/table.json describes it.
struct TableCase {
  std::variant<const TableBuilder*, SecondOrderMethod, QuadraticGrayAsked, PartialPreIntegration> builder;
  std::optional<PiecewiseLinear> transfer;  ///< none: partial pre-integration needs none
  nlohmann::ordered_json transfer_description =
      {};  ///< of another program's file; null: the points are of this program
  Emission emission = Emission::associated;
  TableAxes axes;
  TableFormat format;
  JsonReader json;
};

/// Adds a line to `warnings` for what of a transfer function was mended or left out. Throws InputError.
TableCase read_table_case(const JsonReader& json, std::vector<std::string>& warnings);

/// A table's numbers in C order, and what is known of it.
struct MadeTable {
  std::vector<std::size_t> shape;
  std::vector<double> values;              ///< not rounded to the format yet
  nlohmann::ordered_json axes;             ///< what each of them means
  nlohmann::ordered_json error;            ///< of look-ups in the format's numbers, against proven values
  nlohmann::ordered_json radius = {};      ///< of a quadratic table: its axis; else null
  std::optional<double> last_scalar = {};  ///< of the last entry, where that is not the range's end
};

/// By the builder, in binary32 where `table_for_format` allows it.
MadeTable make_table(const TableCase& asked);

/// What a renderer's author wants to know of the table, beside it; `name` is what its file is called.
nlohmann::ordered_json table_description(const TableCase& asked, const MadeTable& table, const std::string& name);

/// How many of the table's numbers its format cannot hold, so that they are clamped.
std::int64_t clamped_numbers(const TableCase& asked, const MadeTable& table);

// A table that was made for the case elsewhere, as by a shader.

MadeTable judged(const TableCase& asked, const TableBuilder& builder, const Table<double>& table);
MadeTable judged(const TableCase& asked, const Table3<float>& table);

}  // namespace raytruth
