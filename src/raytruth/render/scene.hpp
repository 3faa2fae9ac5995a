#pragma once

#include "raytruth/deformation/lattice_proof.hpp"
#include "raytruth/render/camera.hpp"
#include "raytruth/schemes/radius_axis.hpp"
#include "raytruth/shading/gooch.hpp"
#include "raytruth/shading/lighting.hpp"
#include "raytruth/shading/slab_shading.hpp"
#include "raytruth/signals/border.hpp"
#include "raytruth/signals/field_kind.hpp"
#include "raytruth/signals/point_gradient.hpp"
#include "raytruth/skipping/occupied_blocks.hpp"
#include "raytruth/tables/look_up.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/isoslab.hpp"
#include "raytruth/transfer/isosurface.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"
#include "raytruth/volume/grid.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace raytruth {

class TetrahedralField;

/// How a table is read between its entries.
enum class TableFilter { nearest, linear };

inline constexpr std::array<std::string_view, 2> table_filter_names{"nearest", "linear"};

/// A pre-integration table from which the slabs of `order1`, or the parabolas of `order2` and of the quadratic
/// gray-value model, are read.
struct SceneTable {
  /// A name of catalogue::table_builders, or of catalogue::second_order_builders or catalogue::quadratic_gray_builders.
  std::string builder = "exact";
  int iterations = 64;                    ///< of a builder that takes them
  std::optional<RadiusAxis> radius = {};  ///< of a quadratic table; none: its builder's
  std::size_t size = 256;
  TableFormat format = table_formats[1];
  TableFilter filter = TableFilter::linear;
  bool in_binary64 = false;  ///< also where binary32 is faster
};

/// Blocks that are skipped where their min-max ranges are clear.
struct EmptySpace {
  std::int64_t block = 8;
  BlockBounds bounds = BlockBounds::corrected;
};

/// How virtual samples have normals: their own gradient's, or that of a curve through the gradients, or through the
/// normals, of the true samples around them (Lee 2010, section 3.1). A curve's vector is normalised.
enum class VirtualNormals { own, catmull_rom, catmull_rom_unit, linear, linear_unit };

inline constexpr std::array<std::string_view, 5> virtual_normals_names{"own", "catmull_rom", "catmull_rom_unit",
                                                                       "linear", "linear_unit"};

/// How a scene is lit.
struct SceneShading {
  const Shading* method = nullptr;  ///< of catalogue::shadings(): the light inside a slab from the normals at its ends;
                                    ///< null: every point has its own normal
  Lighting lighting = {};  ///< `light` points to the light, in world coordinates; `half` is made for every pixel
  std::optional<Gooch> gooch = {};  ///< instead of ambient, diffuse and specular light
  bool is_along_gradient = false;   ///< whether normals are +grad s / |grad s|, not -grad s / |grad s|
  GradientKind gradient = GradientKind::voxels;
  VirtualNormals virtual_normals = VirtualNormals::own;  ///< of schemes that look virtual samples up
};

/// An image to be made. Lengths are in smallest spacings of the grid: extinctions are per such a length, steps so long.
struct Scene {
  Grid grid = {};
  /// In place of the grid, which then is one voxel of size 1 that nobody looks at: world coordinates are the mesh's.
  std::shared_ptr<const TetrahedralField> mesh = {};
  FieldKind field = FieldKind::trilinear;
  Border border = Border::half_voxel;
  PiecewiseLinear transfer;
  Emission emission = Emission::associated;
  Camera camera = {};
  /// This, or one of catalogue::integral_schemes, or, with isosurfaces, of catalogue::surface_schemes.
  std::string scheme = "reference";
  std::optional<double> step = {};  ///< of samples; none: at cells' borders and midpoints
  std::optional<SceneTable> table = {};
  std::optional<SceneShading> shading = {};
  double opaque = std::numeric_limits<double>::infinity();  ///< rays end where their opacity reaches this
  std::optional<EmptySpace> empty_space = {};
  /// Whether the radii of `reference` without shading are for the camera's rays as they are meant, not as CameraView
  /// rounds them. Schemes see rounded rays: what they are off by is told best for these.
  bool covers_camera = false;
  std::vector<Isosurface> isosurfaces = {};  ///< beside the transfer function's matter
  /// What the volume is seen through; null: nothing. Object coordinates are voxels times the spacing.
  std::shared_ptr<const Deformation> deformation = {};
  double surface_tolerance = 0;  ///< of the scheme `threshold`, in scalars
  Isoslab isoslab = {};          ///< of the schemes of isoslabs
};

}  // namespace raytruth
