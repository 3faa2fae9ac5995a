#pragma once

#include "raytruth/core/vector3.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/transfer/emission.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace raytruth {

/// What a program says of a ray.
struct Answer {
  Vector3<double> color = Vector3<double>::Constant(0);
  double opacity = 0;
};

/// How far an answer is from the certified one. Decimal digits that are right: -log10(error / scale). The colour's
/// error is its largest channel's, its scale the largest channel of the certified colour; the opacity's scale is the
/// certified opacity. Errors below the certified radius, or below 2^-53 of the scale, count as that much, which caps
/// the digits at 15.95; an error larger than the scale has none. Where the scale is 0 an error within the radius has
/// all digits, any other none. What is not finite has no digits.
struct AnswerScore {
  double color_error = 0;  ///< absolute; not finite where the answer is not, as the next one
  double opacity_error = 0;
  double color_digits = 0;
  double opacity_digits = 0;

  // The worse one of colour and opacity.
  [[nodiscard]] double digits() const { return std::min(color_digits, opacity_digits); }
  [[nodiscard]] double error() const { return std::max(color_error, opacity_error); }
};

AnswerScore score_of(const Answer& answer, const Certified& truth);

/// One vector, and what was answered.
struct ScoredVector {
  std::string id;
  std::string level;
  Certified truth;
  std::optional<Answer> answer;  ///< none: it counts in no digits
  Emission emission = Emission::associated;
};

/// How good the colours, or the opacities, of a level are.
struct PartScore {
  std::optional<double> digits_min;
  std::optional<double> digits_median;
  std::optional<double> error_max;  ///< absolute, of what is finite
};

/// How good the answers of a level are: over the vectors that were answered, so nothing where none was.
struct LevelScore {
  std::string level;
  std::int64_t cases = 0;
  std::int64_t answered = 0;
  std::int64_t not_finite = 0;  ///< of the answers: they have no digits, and no error
  std::optional<double> digits_min;
  std::optional<double> digits_median;
  std::optional<double> error_mean;  ///< absolute, of the larger one of colour and opacity, of what is finite
  std::optional<std::string> worst;  ///< id of the vector with the fewest digits, the first of them
  PartScore color;
  PartScore opacity;
};

/// A score for every level, over what was answered, in the order in which levels occur, and one more for all of them
/// together ("all"). There must be vectors.
std::vector<LevelScore> score(const std::vector<ScoredVector>& vectors);

/// Reads answers as CSV (RFC 4180), with the header id,r,g,b,opacity. What spreadsheets make of it is read too, with a
/// warning: semicolons or tabulators between fields, and decimal commas with them; a byte order mark is passed over. A
/// number that is not finite, or left out, is an answer without digits, with a warning. Throws InputError: file, line,
/// what was found, what is allowed.
std::map<std::string, Answer> read_answers(const std::string& path, std::vector<std::string>& warnings);

/// Reads a file's text likewise; `name` is what messages call it.
std::map<std::string, Answer> answers_in(std::string_view text, const std::string& name,
                                         std::vector<std::string>& warnings);

}  // namespace raytruth
