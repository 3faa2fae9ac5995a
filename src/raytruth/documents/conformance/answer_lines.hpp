#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace raytruth {

/// The lines of answers as CSV (RFC 4180). What spreadsheets make of it is read too: semicolons or tabulators between
/// fields, and decimal commas with them; a byte order mark is passed over. Throws InputError: file, line, what was
/// found, what is allowed.
class AnswerLines {
 public:
  /// A line, and where it stands.
  struct Line {
    std::string place;
    std::string text;

    [[noreturn]] void refuse(std::string_view found, std::string_view allowed) const;
  };

  /// `name` is what messages call the file; the first line must be this header, whose first field is an id.
  AnswerLines(std::string_view text, std::string name, std::vector<std::string_view> header);

  /// What is not blank behind the header.
  [[nodiscard]] const std::vector<Line>& lines() const { return lines_; }

  /// As many as the header has, the first one not empty.
  [[nodiscard]] std::vector<std::string> fields(const Line& line) const;

  /// A number; NaN where the field is empty, and an infinity beyond binary64: neither has digits.
  double number(const Line& line, std::string_view field_name, const std::string& field);

  /// Adds a line where other separators than commas were read.
  void warn_of_dialect(std::vector<std::string>& warnings) const;

 private:
  [[nodiscard]] std::vector<std::string> split(const Line& line) const;

  std::string name_;
  std::vector<std::string_view> header_;
  char separator_ = ',';
  bool has_decimal_commas_ = false;  ///< seen so far
  std::vector<Line> lines_;
};

}  // namespace raytruth
