#pragma once

#include "raytruth/documents/json/json_reader.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"
#include "raytruth/volume/grid.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace raytruth {

/// What is to be known of a transfer function that another program's file holds.
struct TransferFileRequest {
  std::filesystem::path file = {};
  std::optional<std::string> preset = {};             ///< its name, where the file holds several
  std::optional<std::filesystem::path> opacity = {};  ///< another file, whose opacities are taken
  std::optional<std::array<double, 2>> range = {};    ///< scalars onto which the file's own range is stretched
  std::optional<double> unit_length = {};             ///< in smallest spacings, instead of the format's own
  bool ignores_gradient_opacity = false;
};

/// A transfer function for a grid, per smallest spacing, and how the file was understood.
struct FileTransfer {
  PiecewiseLinear transfer;
  nlohmann::ordered_json description;
};

/// Reads the transfer functions that people have, by the file's extension:
///
///     .json            colour maps of ParaView, presets of VolView and of ParaView Glance
///     .xml .mrml .vp   presets, scenes and volume properties of 3D Slicer
///     .tfi             Voreen
///     .itf             Inviwo
///
/// Opacity is that of a smallest spacing (VTK's unit distance 1); in files of Voreen that of 1/200, of Inviwo that of
/// 1/150 of the grid's longest side. Scalars are the data's own; in files of Voreen and Inviwo they run from 0 to 1,
/// from the data's minimum to its maximum.
///
/// Colour maps of ParaView are stretched from the data's minimum to its maximum unless they say "AbsoluteRange" or have
/// opacities. RGB is taken as linear light. Opacity that depends on the gradient is refused unless it is ignored on
/// request. Throws InputError: one line with the file and what is wrong.
FileTransfer read_transfer_file(const TransferFileRequest& request, const Grid& grid,
                                std::vector<std::string>& warnings);

}  // namespace raytruth
