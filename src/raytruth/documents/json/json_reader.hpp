#pragma once

#include "raytruth/core/error.hpp"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace raytruth {

/// A place in a JSON document: reads what stands there, or refuses it with one line that names the file, the JSON
/// pointer, what was found and what is allowed (InputError):
///     case.json: /sampling/step: found -1; a number > 0 is allowed
class JsonReader {
 public:
  /// Reads a document; "-" is standard input. Refuses what is not JSON (RFC 8259), byte order marks, duplicate keys,
  /// numbers beyond binary64, nesting deeper than 64, objects of more than 1000 members and files beyond 1 GiB.
  static JsonReader from_file(const std::string& path);
  /// Reads JSON as other programs write it: a byte order mark, comments and commas behind the last item are passed
  /// over, as they do.
  static JsonReader from_lenient_file(const std::string& path);
  static JsonReader from_text(std::string_view text, std::string file_name);
  /// A document made from that of `origin`, whose file name messages keep.
  static JsonReader from_json(nlohmann::ordered_json document, const JsonReader& origin);

  [[nodiscard]] bool is_object() const;
  [[nodiscard]] bool is_array() const;
  [[nodiscard]] bool is_string() const;
  [[nodiscard]] bool is_null() const;
  [[nodiscard]] bool is_boolean() const;
  [[nodiscard]] bool is_number() const;

  // Reading is checking too, so the values below may be left unused.

  /// A text that is not empty.
  std::string text() const;
  /// One of the allowed words.
  std::string word(const std::vector<std::string_view>& allowed) const;
  bool boolean() const;
  /// A number in [low, high].
  double number(double low = std::numeric_limits<double>::lowest(),
                double high = std::numeric_limits<double>::max()) const;
  /// A number > 0.
  double positive_number() const;
  /// A whole number in [low, high]; 5.0 is one.
  std::int64_t integer(std::int64_t low, std::int64_t high) const;
  /// A list of numbers, at least one and at most `most`.
  std::vector<double> numbers(std::size_t most = std::numeric_limits<std::size_t>::max()) const;

  /// The member of this key. Where the object lacks it, reading the returned place refuses.
  [[nodiscard]] JsonReader at(std::string_view key) const;
  [[nodiscard]] std::optional<JsonReader> find(std::string_view key) const;
  /// The members of an object, or the items of an array with at least `least` of them.
  std::vector<std::pair<std::string, JsonReader>> members() const;
  std::vector<JsonReader> items(std::size_t least = 1) const;
  /// Refuses what is not an object, and an object that has other keys than these.
  void only(std::initializer_list<std::string_view> keys) const { only(std::span(keys.begin(), keys.size())); }
  void only(std::span<const std::string_view> keys) const;

  [[noreturn]] void refuse(std::string_view found, std::string_view allowed) const;
  /// Refuses what stands here.
  [[noreturn]] void refuse_value(std::string_view allowed) const;

  /// Calls `work`; an InputError that leaves it, which knows no place in the document, is given this one.
  template <class Work>
  auto blame_for(Work&& work) const {
    try {
      return work();
    } catch (const InputError& error) {
      throw InputError(place() + ": " + error.what());
    }
  }

  /// "FILE: /pointer".
  [[nodiscard]] std::string place() const;
  /// A path as a document states it: relative ones resolve against the document's folder.
  [[nodiscard]] std::filesystem::path resolve(const std::string& path) const;
  [[nodiscard]] const nlohmann::ordered_json& json() const;

 private:
  JsonReader(nlohmann::ordered_json document, std::string file_name);

  [[nodiscard]] JsonReader child(const nlohmann::ordered_json* value, std::string_view key) const;
  [[nodiscard]] std::string found() const;

  std::shared_ptr<const nlohmann::ordered_json> document_;
  std::string file_name_;
  const nlohmann::ordered_json* value_;  ///< null: the document lacks this place
  std::string pointer_;
};

}  // namespace raytruth
