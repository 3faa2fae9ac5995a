#pragma once

#include "raytruth/core/vector3.hpp"
#include "raytruth/reference/certified.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace raytruth {

/// What a program says of a ray.
struct Answer {
  Vector3<double> color = Vector3<double>::Constant(0);
  double opacity = 0;
};

/// How many decimal digits of an answer are right: -log10(error / scale), of colour and opacity the lesser one. The
/// colour's error is its largest channel's, its scale the largest channel of the certified colour; the opacity's scale
/// is the certified opacity. Errors below the certified radius, or below 2^-53 of the scale, count as that much, which
/// caps the digits at 15.95; an error larger than the scale has none. Where the scale is 0 an error within the radius
/// has all digits, any other none. An answer that is not finite has none.
double digits_correct(const Answer& answer, const Certified& truth);

/// One vector, and what was answered.
struct ScoredVector {
  std::string id;
  std::string level;
  Certified truth;
  std::optional<Answer> answer;  ///< no answer has no digits
};

/// How good the answers of a level are.
struct LevelScore {
  std::string level;
  std::int64_t cases = 0;
  std::int64_t answered = 0;
  double digits_min = 0;
  double digits_median = 0;
  std::string worst;  ///< id of the vector with the fewest digits, the first of them
};

/// A score for every level, in the order in which levels occur, and one more for all of them together ("all").
/// There must be vectors.
std::vector<LevelScore> score(const std::vector<ScoredVector>& vectors);

/// Reads answers as CSV (RFC 4180), with the header id,r,g,b,opacity. What spreadsheets make of it is read too, with a
/// warning: semicolons or tabulators between fields, and decimal commas with them; a byte order mark is passed over. A
/// number that is not finite, or left out, is an answer without digits, with a warning. Throws InputError: file, line,
/// what was found, what is allowed.
std::map<std::string, Answer> read_answers(const std::string& path, std::vector<std::string>& warnings);

}  // namespace raytruth
