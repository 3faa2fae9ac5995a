#pragma once

#include "raytruth/documents/json/json_reader.hpp"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace raytruth {

/// A crossing as a program says it.
struct AnsweredHit {
  double t = 0;
  std::int64_t surface = 0;
};

/// A hit vector, and what was answered.
struct ScoredHits {
  struct Hit {
    double t = 0;
    double radius = 0;
    std::int64_t surface = 0;
  };

  std::string id;
  std::string level;
  double length = 0;  ///< of the ray
  std::vector<Hit> truth;
  std::optional<std::vector<AnsweredHit>> answer = {};  ///< none: nothing was answered, not even that there is no hit
};

/// A ray is right where the number of its hits and the order of their surfaces are. Only then it has digits:
/// -log10 of the largest error of t over the ray's length, which counts as at least its radius and 2^-53; a ray
/// without hits has as many as there are. What else is missed and false is told by the longest sequence of surfaces
/// that both have.
struct HitScore {
  bool is_right = false;
  std::int64_t missed = 0;
  std::int64_t false_hits = 0;
  std::optional<double> digits = {};
  std::optional<double> error = {};  ///< over the length
};

HitScore score_of(const ScoredHits& vector);

/// The vectors of a document that `raytruth vectors --hits` wrote, without answers. Throws InputError.
std::vector<ScoredHits> read_scored_hits(const JsonReader& document);

/// Reads CSV with the header id,hit,t,surface: a line for each hit, `hit` counting those of a ray from 0, `surface` as
/// well; a ray that meets nothing has one line with its id alone. Throws InputError: file, line, found, allowed.
std::map<std::string, std::vector<AnsweredHit>> read_hit_answers(const std::string& path,
                                                                 std::vector<std::string>& warnings);
std::map<std::string, std::vector<AnsweredHit>> hit_answers_in(std::string_view text, const std::string& name,
                                                               std::vector<std::string>& warnings);

/// Gives the vectors their answers. Throws InputError for an id that none of them has.
void take_hit_answers(std::vector<ScoredHits>& vectors, std::map<std::string, std::vector<AnsweredHit>> answers,
                      const std::string& answers_name, const std::string& vectors_name);

/// A row for each level and for all together, and for each vector.
nlohmann::ordered_json hit_levels_json(const std::vector<ScoredHits>& vectors);
nlohmann::ordered_json scored_hits_json(const std::vector<ScoredHits>& vectors);

}  // namespace raytruth
