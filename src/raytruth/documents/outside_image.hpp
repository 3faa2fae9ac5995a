#pragma once

#include "raytruth/documents/outside_program.hpp"
#include "raytruth/images/image.hpp"
#include "raytruth/render/scene.hpp"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>

namespace raytruth {

/// A program's image of a scene.
struct OutsideImage {
  Image image;
  std::optional<std::string> version = {};
};

/// Asks a program for the image of a scene. It reads a scene as experiments/schemas/scene.json describes it, with its
/// voxels in a .npy of binary64 whose path is absolute, its transfer function as points, its camera in full and the
/// scheme "reference"; `drawing` is what else the document says of how to render: step, shading and so on. It writes a
/// .npy of binary32 or binary64, shape (height, width, 4), row 0 on top: linear light, opacity-weighted, and the
/// opacity. Throws OutsideRefusal.
OutsideImage outside_image(const OutsideProgram& program, const Scene& scene, nlohmann::ordered_json drawing);

}  // namespace raytruth
