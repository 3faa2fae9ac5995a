#pragma once

#include "raytruth/documents/json/json_reader.hpp"
#include "raytruth/documents/transfer_files/transfer_file.hpp"
#include "raytruth/transfer/isosurface.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

namespace raytruth {

/// What stands around a transfer function's document.
struct TransferContext {
  const TransferVolume* volume = nullptr;   ///< null: there is none
  std::optional<std::string> opacity = {};  ///< file of the command line, whose opacities are taken
  bool ignores_gradient_opacity = false;    ///< of the command line
  bool takes_isosurfaces = false;           ///< else they are refused
};

/// A transfer function, and how it was understood.
struct TransferDocument {
  PiecewiseLinear transfer;
  nlohmann::ordered_json description;
  bool is_of_another_program = false;
  std::vector<Isosurface> isosurfaces = {};
};

/// Whether a transfer function's document names another program's file. Throws InputError.
bool is_of_another_program(const JsonReader& json);

/// Reads a transfer function: points of "s", "extinction" and "color" in a list "points"; or points of "s", "opacity"
/// and "color", and "unit_length" beside the list; or, beside either of these or alone in empty space, a list
/// "isosurfaces" of "s", "opacity" and "color"; or the path of a JSON file that holds one of these; or the path of
/// another program's file, or {"file": path} with what read_transfer_file is told beside it. Adds a line to `warnings`
/// for what was mended or left out. Throws InputError.
TransferDocument read_transfer_function(const JsonReader& json, const TransferContext& context,
                                        std::vector<std::string>& warnings);

/// The points of a transfer function as scenes, cases and tables state them, `unit_length` beside opacities, and
/// isosurfaces if there are any.
nlohmann::ordered_json transfer_function_json(const PiecewiseLinear& transfer,
                                              const std::vector<Isosurface>& isosurfaces = {});

}  // namespace raytruth
