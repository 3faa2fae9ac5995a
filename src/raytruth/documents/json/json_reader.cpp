#include "raytruth/documents/json/json_reader.hpp"

#include "raytruth/core/memory_limit.hpp"
#include "raytruth/core/one_line.hpp"
#include "raytruth/documents/json/input.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace raytruth {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t deepest_nesting = 64;
constexpr std::size_t most_members = 1000;

[[noreturn]] void refuse_place(std::string_view place, std::string_view found, std::string_view allowed) {
  throw InputError(one_line(fmt::format("{}: found {}; {} is allowed", place, found, allowed)));
}

std::string escaped(std::string_view key) {
  std::string result;
  for (const char c : key) {
    if (c == '~')
      result += "~0";
    else if (c == '/')
      result += "~1";
    else
      result += c;
  }
  return result;
}

std::string suggestion(std::string_view closest) {
  return closest.empty() ? "" : fmt::format(" (perhaps {})", closest);
}

/// The text with spaces for what JSON does not allow and other programs write: a byte order mark, comments, and commas
/// behind the last item. Nothing else moves, so messages name the right places.
std::string without_lenience(std::string text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.replace(0, 3, 3, ' ');
  std::size_t comma = std::string::npos;  // the last thing that was met, if it was one
  const auto blank = [&text](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < std::min(end, text.size()); ++i)
      if (text[i] != '\n') text[i] = ' ';
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') {
      for (++i; i < text.size() && text[i] != '"'; ++i)
        if (text[i] == '\\') ++i;
      comma = std::string::npos;
    } else if (text.compare(i, 2, "//") == 0) {
      const std::size_t end = std::min(text.find('\n', i), text.size());
      blank(i, end);
      i = end - 1;
    } else if (text.compare(i, 2, "/*") == 0) {
      const std::size_t end = text.find("*/", i + 2);
      if (end == std::string::npos) return text;
      blank(i, end + 2);
      i = end + 1;
    } else if (c == ',') {
      comma = i;
    } else if (c != ' ' && c != '\t' && c != '\n' && c != '\r') {
      if ((c == ']' || c == '}') && comma != std::string::npos) text[comma] = ' ';
      comma = std::string::npos;
    }
  }
  return text;
}

/// Builds a document from the parser's events, and refuses what nlohmann's own builder lets pass.
class StrictBuilder {
 public:
  StrictBuilder(std::string_view text, const std::string& file_name) : text_(text), file_name_(file_name) {}

  Json& document() { return document_; }

  bool null() { return add(nullptr); }
  bool boolean(bool value) { return add(value); }
  bool number_integer(std::int64_t value) { return add(value); }
  bool number_unsigned(std::uint64_t value) { return add(value); }
  bool number_float(double value, const std::string& /*lexeme*/) { return add(value); }
  bool string(std::string& value) { return add(std::move(value)); }
  static bool binary(Json::binary_t& /*value*/) { return false; }
  bool start_object(std::size_t /*members*/) { return open(Json::object()); }
  bool start_array(std::size_t /*items*/) { return open(Json::array()); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }

  bool key(std::string& name) {
    take_memory(name.size() + sizeof(std::string));
    Json& object = *open_.back();
    if (object.contains(name))
      refuse_place(place(), fmt::format("the key {} twice", Json(name).dump()), "each key once");
    if (object.size() == most_members)
      refuse_place(place(), fmt::format("more than {} members", most_members), "an object of fewer members");
    member_ = &object[std::move(name)];
    return true;
  }

  bool parse_error(std::size_t position, const std::string& last_token, const Json::exception& error) {
    const auto before = text_.substr(0, position > 0 ? position - 1 : 0);
    const auto line = std::count(before.begin(), before.end(), '\n') + 1;
    const auto column = before.size() - (before.rfind('\n') + 1) + 1;
    // nlohmann's sentence is "[ID] ... - what it met; what it expected", or "[ID] what it met".
    std::string what = error.what();
    const auto dash = what.find(" - ");
    what = what.substr(dash == std::string::npos ? what.find("] ") + 2 : dash + 3);
    what = what.substr(0, what.find(';'));
    const auto tail = last_token.size() > 40 ? "..." + last_token.substr(last_token.size() - 40) : last_token;
    refuse_place(fmt::format("{}: line {}, column {}", file_name_, line, column),
                 what + (tail.empty() ? "" : fmt::format(" near '{}'", tail)), "JSON as RFC 8259 defines it");
  }

 private:
  /// Lists grow by doubling, and an empty list or object is an allocation of its own too.
  void take_memory(std::size_t bytes) {
    memory_ += 2 * (bytes + sizeof(Json));
    if (memory_ <= std::max(memory_limit(), always_within_memory_limit)) return;
    refuse_place(place(), fmt::format("a document that needs more than {} bytes of memory", memory_limit()),
                 "what the memory limit holds, which --memory-limit SIZE or RAYTRUTH_MEMORY_LIMIT sets,");
  }

  Json* insert(Json value) {
    take_memory(value.is_string()       ? value.get_ref<const std::string&>().size() + sizeof(std::string)
                : value.is_structured() ? sizeof(std::vector<Json>)
                                        : 0);
    if (open_.empty()) {
      document_ = std::move(value);
      return &document_;
    }
    Json& parent = *open_.back();
    if (parent.is_array()) {
      parent.push_back(std::move(value));
      return &parent.back();
    }
    *member_ = std::move(value);
    return member_;
  }

  bool add(Json value) {
    insert(std::move(value));
    return true;
  }

  bool open(Json value) {
    if (open_.size() == deepest_nesting)
      refuse_place(place(), "nesting deeper than 64", "nesting of at most 64 objects and arrays");
    open_.push_back(insert(std::move(value)));
    return true;
  }

  bool close() {
    open_.pop_back();
    return true;
  }

  /// The innermost open object or array.
  [[nodiscard]] std::string place() const {
    std::string pointer;
    for (std::size_t i = 1; i < open_.size(); ++i) {
      const Json& parent = *open_[i - 1];
      // The open item is always the last one.
      pointer += '/' + (parent.is_array() ? std::to_string(parent.size() - 1) : escaped(std::prev(parent.end()).key()));
    }
    return file_name_ + ": " + (pointer.empty() ? "/" : pointer);
  }

  std::string_view text_;
  const std::string& file_name_;
  Json document_;
  std::vector<Json*> open_;
  std::uint64_t memory_ = 0;
  Json* member_ = nullptr;
};

}  // namespace

JsonReader::JsonReader(Json document, std::string file_name)
    : document_(std::make_shared<const Json>(std::move(document))),
      file_name_(std::move(file_name)),
      value_(document_.get()) {}

JsonReader JsonReader::from_file(const std::string& path) {
  return from_text(read_text(path, "a readable JSON file"), input_name(path));
}

JsonReader JsonReader::from_lenient_file(const std::string& path) {
  return from_text(without_lenience(read_text(path, "a readable JSON file")), input_name(path));
}

JsonReader JsonReader::from_text(std::string_view text, std::string file_name) {
  if (text.starts_with("\xEF\xBB\xBF")) refuse_place(file_name, "a byte order mark", "UTF-8 without one");
  StrictBuilder builder(text, file_name);
  Json::sax_parse(text, &builder);
  return {std::move(builder.document()), std::move(file_name)};
}

JsonReader JsonReader::from_json(Json document, const JsonReader& origin) {
  return {std::move(document), origin.file_name_};
}

bool JsonReader::is_object() const { return value_ != nullptr && value_->is_object(); }
bool JsonReader::is_array() const { return value_ != nullptr && value_->is_array(); }
bool JsonReader::is_string() const { return value_ != nullptr && value_->is_string(); }
bool JsonReader::is_null() const { return value_ != nullptr && value_->is_null(); }
bool JsonReader::is_boolean() const { return value_ != nullptr && value_->is_boolean(); }
bool JsonReader::is_number() const { return value_ != nullptr && value_->is_number(); }

std::string JsonReader::text() const {
  if (!is_string() || json().get_ref<const std::string&>().empty()) refuse_value("a text that is not empty");
  return json().get<std::string>();
}

std::string JsonReader::word(const std::vector<std::string_view>& allowed) const {
  const std::string list =
      allowed.size() == 1 ? std::string(allowed[0]) : fmt::format("one of {}", fmt::join(allowed, ", "));
  if (!is_string()) refuse_value(list);
  auto word = json().get<std::string>();
  if (std::find(allowed.begin(), allowed.end(), word) == allowed.end())
    refuse(found() + suggestion(closest_word(word, allowed)), list);
  return word;
}

bool JsonReader::boolean() const {
  if (!is_boolean()) refuse_value("true or false");
  return json().get<bool>();
}

double JsonReader::number(double low, double high) const {
  constexpr double lowest = std::numeric_limits<double>::lowest();
  constexpr double highest = std::numeric_limits<double>::max();
  const double value = is_number() ? json().get<double>() : low;
  if (is_number() && low <= value && value <= high) return value;
  refuse_value(low == lowest && high == highest ? "a number"
               : high == highest                ? fmt::format("a number >= {}", low)
               : low == lowest                  ? fmt::format("a number <= {}", high)
                                                : fmt::format("a number from {} to {}", low, high));
}

double JsonReader::positive_number() const {
  if (!is_number() || !(json().get<double>() > 0)) refuse_value("a number > 0");
  return json().get<double>();
}

std::int64_t JsonReader::integer(std::int64_t low, std::int64_t high) const {
  const auto is_exact = [this] {
    if (!is_number()) return false;
    if (json().is_number_unsigned()) return json().get<std::uint64_t>() <= std::numeric_limits<std::int64_t>::max();
    if (json().is_number_integer()) return true;
    const auto value = json().get<double>();
    return value == std::floor(value) && -0x1p63 <= value && value < 0x1p63;
  };
  if (is_exact()) {
    const auto value = json().get<std::int64_t>();
    if (low <= value && value <= high) return value;
  }
  refuse_value(fmt::format("a whole number from {} to {}", low, high));
}

std::vector<double> JsonReader::numbers(std::size_t most) const {
  if (!is_array() || json().empty() || json().size() > most)
    refuse_value(most == std::numeric_limits<std::size_t>::max() ? "a list of at least one number"
                                                                 : fmt::format("a list of 1 to {} numbers", most));
  std::vector<double> values;
  values.reserve(json().size());
  for (std::size_t i = 0; i < json().size(); ++i) {
    const Json& item = json()[i];
    // Places are made for the item that is refused only: there may be millions.
    values.push_back(item.is_number() ? item.get<double>() : child(&item, std::to_string(i)).number());
  }
  return values;
}

JsonReader JsonReader::at(std::string_view key) const {
  if (!is_object()) refuse_value("an object");
  const auto member = json().find(key);
  return child(member == json().end() ? nullptr : &*member, key);
}

std::optional<JsonReader> JsonReader::find(std::string_view key) const {
  const JsonReader member = at(key);
  return member.value_ == nullptr ? std::nullopt : std::optional(member);
}

std::vector<std::pair<std::string, JsonReader>> JsonReader::members() const {
  if (!is_object()) refuse_value("an object");
  std::vector<std::pair<std::string, JsonReader>> result;
  for (const auto& [key, value] : json().items()) result.emplace_back(key, child(&value, key));
  return result;
}

std::vector<JsonReader> JsonReader::items(std::size_t least) const {
  if (!is_array() || json().size() < least)
    refuse_value(least == 0 ? "a list" : fmt::format("a list of at least {}", least));
  std::vector<JsonReader> result;
  result.reserve(json().size());
  for (std::size_t i = 0; i < json().size(); ++i) result.push_back(child(&json()[i], std::to_string(i)));
  return result;
}

void JsonReader::only(std::span<const std::string_view> keys) const {
  for (const auto& [key, member] : members())
    if (std::find(keys.begin(), keys.end(), key) == keys.end())
      member.refuse("an unknown key" + suggestion(closest_word(key, keys)),
                    (keys.size() == 1 ? "only " : "one of ") + fmt::format("{}", fmt::join(keys, ", ")));
}

void JsonReader::refuse(std::string_view found, std::string_view allowed) const {
  refuse_place(place(), found, allowed);
}

void JsonReader::refuse_value(std::string_view allowed) const { refuse(found(), allowed); }

std::string JsonReader::place() const { return one_line(file_name_ + ": " + (pointer_.empty() ? "/" : pointer_)); }

std::filesystem::path JsonReader::resolve(const std::string& path) const {
  return std::filesystem::path(file_name_).parent_path() / path;
}

const Json& JsonReader::json() const {
  if (value_ == nullptr) refuse_value("a value");
  return *value_;
}

JsonReader JsonReader::child(const Json* value, std::string_view key) const {
  JsonReader place = *this;
  place.value_ = value;
  place.pointer_ += '/' + escaped(key);
  return place;
}

std::string JsonReader::found() const {
  if (value_ == nullptr) return "nothing";
  if (value_->is_object()) return fmt::format("an object of {} members", value_->size());
  if (value_->is_array()) return fmt::format("a list of {} items", value_->size());
  return shortened(value_->dump());
}

}  // namespace raytruth
