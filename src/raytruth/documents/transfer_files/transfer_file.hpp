#pragma once

#include "raytruth/documents/json/json_reader.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"
#include "raytruth/volume/grid.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace raytruth {

/// Whether the scalars of a file are the data's own, or are stretched from the file's range onto the data's.
enum class ScalarChoice { as_stated, stretched };

/// What is to be known of a transfer function that another program's file holds.
struct TransferFileRequest {
  std::filesystem::path file = {};
  std::optional<std::string> preset = {};             ///< its name, where the file holds several
  std::optional<std::filesystem::path> opacity = {};  ///< another file, whose opacities are taken
  std::optional<std::string> opacity_preset = {};     ///< its name there
  std::optional<std::array<double, 2>> range = {};    ///< scalars onto which the file's own range is stretched
  std::optional<ScalarChoice> scalars = {};           ///< instead of the program's own habit
  std::optional<double> unit_length = {};             ///< in smallest spacings, instead of the format's own
  bool ignores_gradient_opacity = false;
};

/// What files measure scalars and lengths by.
struct TransferVolume {
  std::array<double, 2> range;  ///< of the data
  double smallest_spacing;      ///< in world units
  double longest_side;          ///< in world units
};

TransferVolume transfer_volume(const Grid& grid);

/// A transfer function per smallest spacing, and how the file was understood.
struct FileTransfer {
  PiecewiseLinear transfer;
  nlohmann::ordered_json description;
};

/// Reads the transfer functions that people have, by the file's extension, in small or capital letters, and by what is
/// in it:
///
///     .json            colour maps and presets of ParaView, presets of VolView and of ParaView Glance
///     .xml             colour maps of ParaView; presets of 3D Slicer
///     .mrml .vp .vp.json   scenes and volume properties of 3D Slicer
///     .tfi             Voreen
///     .itf             Inviwo
///
/// Lengths. Opacity is that of a world unit, VTK's unit distance, unless the file says another one; in files of Voreen
/// that of 1/200, of Inviwo that of 1/150 of the volume's longest side. Where there is no volume (null) a voxel's side
/// is a world unit, and files of Voreen and Inviwo are refused unless a unit length is asked for.
///
/// Scalars. They are the data's own in files of 3D Slicer, and in those of VolView and ParaView Glance unless these say
/// "AbsoluteRange": false. In files of Voreen and Inviwo they run from 0 to 1, from the data's minimum to its maximum.
/// Colour maps of ParaView are stretched over the data, the colours from their first to their last scalar and the
/// opacities from theirs, as it does by default; but not if they say "AbsoluteRange": true, nor, with opacities, if
/// these cover the data. Opacities of another file have scalars of their own.
///
/// RGB is taken as linear light. Points are sorted; opacities and channels that rounding put outside [0, 1] are
/// clamped; what programs write for two points at one scalar is a jump: a warning tells of each. Opacity that depends
/// on the gradient is refused unless it is ignored on request. What is left out is named in the description. Throws
/// InputError: one line with the file and what is wrong.
FileTransfer read_transfer_file(const TransferFileRequest& request, const TransferVolume* volume,
                                std::vector<std::string>& warnings);

/// A transfer function of a file, before one is chosen.
struct TransferListing {
  std::string name;
  std::string problem = {};  ///< why it cannot be read; empty: it can
  std::size_t colors = 0;    ///< points
  std::size_t opacities = 0;
  std::array<double, 2> range = {};  ///< of its scalars
};

/// All transfer functions of a file. Throws InputError.
std::vector<TransferListing> transfer_functions_in(const std::filesystem::path& file);

/// Whether JSON of another program is what the file holds, not points of this one's own. Throws InputError.
bool is_transfer_file(const std::filesystem::path& file);

}  // namespace raytruth
