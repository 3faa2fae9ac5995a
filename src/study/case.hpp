#pragma once

#include "core/chain.hpp"
#include "signals/piecewise_polynomial.hpp"
#include "study/experiment.hpp"
#include "study/json_reader.hpp"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace raytruth {

/// A ray for `eval`; experiments/schemas/case.json describes its JSON.
struct Case {
  JsonReader json;
  std::variant<Chain<3>, Chain<largest_degree>> signal;
  Sampling sampling;
  std::vector<std::string> schemes;  ///< of the catalogue, or "reference"
};

/// Reads cases one after the other; keeps the volume that was read last, for the cases of a list often share it.
class CaseReader {
 public:
  explicit CaseReader(std::vector<std::filesystem::path> folders) : folders_(std::move(folders)) {}

  /// Throws InputError.
  Case read(const JsonReader& json);

  /// One line each.
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  Chain<3> read_trilinear(const JsonReader& json);
  Chain<largest_degree> read_tricubic(const JsonReader& json);
  const Grid& read_volume_of(const JsonReader& signal);

  std::vector<std::filesystem::path> folders_;
  std::vector<std::string> warnings_;
  std::string last_volume_;  ///< which one it is; empty: none
  Grid grid_;
};

/// What `eval` answers. Throws InputError for more than 10^7 samples.
nlohmann::ordered_json evaluate(const Case& ray);

}  // namespace raytruth
