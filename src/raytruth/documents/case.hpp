#pragma once

#include "raytruth/cells/tetrahedral_field.hpp"
#include "raytruth/core/chain.hpp"
#include "raytruth/deformation/deformed_ray.hpp"
#include "raytruth/documents/json/json_reader.hpp"
#include "raytruth/documents/mesh_source.hpp"
#include "raytruth/documents/outside_program.hpp"
#include "raytruth/documents/surface_numbers.hpp"
#include "raytruth/documents/volume_source.hpp"
#include "raytruth/reference/arb_integral.hpp"
#include "raytruth/reference/surface_hits.hpp"
#include "raytruth/schemes/sampling.hpp"
#include "raytruth/signals/analytic.hpp"
#include "raytruth/signals/border.hpp"
#include "raytruth/signals/piecewise_polynomial.hpp"
#include "raytruth/signals/signal_error_bound.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/isosurface.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace raytruth {

/// A ray for `eval`; experiments/schemas/case.json describes its JSON.
struct Case {
  JsonReader json;
  std::optional<Sampling> sampling;  ///< none: the reference alone is asked for
  std::vector<std::string> schemes;  ///< of the catalogue, of surfaces too, or "reference"
  std::optional<PiecewiseLinear> transfer;
  nlohmann::ordered_json transfer_description =
      {};  ///< of another program's file; null: the points are of this program
  Emission emission = Emission::associated;
  std::variant<Chain<3>, Chain<largest_degree>> signal = {};
  SignalError signal_error = {};                                                    ///< of the chain
  std::variant<PreciseChain<3>, PreciseChain<largest_degree>> precise_signal = {};  ///< where there is no formula
  std::variant<std::monostate, MarschnerLobbRay, AnalyticSignal> formula = {};  ///< that the chain only approximates
  std::vector<Isosurface> isosurfaces = {};
  SurfaceNumbers surface_numbers = {};
  Surroundings surroundings = {};               ///< of a ray through a volume
  std::optional<Border> border = {};            ///< of the volume, if there is one
  std::optional<MeshRay> mesh_ray = {};         ///< of a ray through tetrahedra
  std::optional<DeformedSignal> deformed = {};  ///< of a ray through a deformed volume; `signal` is its chain
  std::vector<OutsideProgram> programs = {};    ///< named among the schemes; `evaluate` leaves them out
};

/// Reads cases one after the other; keeps the volume that was read last, for the cases of a list often share it.
class CaseReader {
 public:
  explicit CaseReader(VolumeAccess volumes) : volumes_(std::move(volumes)) {}

  /// Adds a line to `warnings` for what of a transfer function or a volume was mended or left out. Throws InputError.
  Case read(const JsonReader& json, std::vector<std::string>& warnings);

 private:
  void read_trilinear(const JsonReader& json, Case& result, std::vector<std::string>& warnings);
  void read_tricubic(const JsonReader& json, Case& result, std::vector<std::string>& warnings);
  void read_tetrahedra(const JsonReader& json, Case& result, std::vector<std::string>& warnings);
  const Grid& read_volume_of(const JsonReader& signal, std::vector<std::string>& warnings);

  VolumeAccess volumes_;
  std::string last_volume_;  ///< which one it is; empty: none
  Grid grid_;
  nlohmann::ordered_json last_mesh_ = {};  ///< what the last signal said of its mesh
  SourcedMesh mesh_ = {};
};

/// What `eval` answers. Throws InputError for more than 10^7 samples.
nlohmann::ordered_json evaluate(const Case& ray);

}  // namespace raytruth
