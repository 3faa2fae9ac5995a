#pragma once

#include "raytruth/documents/json/input.hpp"
#include "raytruth/documents/transfer_files/file_map.hpp"

#include <pugixml.hpp>

#include <charconv>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace raytruth {

// Numbers and nodes of XML files. Each function throws InputError that names the file and the node.

inline double number_of(const std::string& place, std::string_view word) {
  double number = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(number))
    refuse(place, fmt::format("\"{}\"", shortened(word)), "a finite number");
  return number;
}

inline pugi::xml_document read_xml(const std::filesystem::path& file) {
  const std::string text = read_text(file.string(), "a readable XML file");
  pugi::xml_document document;
  const auto result = document.load_buffer(text.data(), text.size());
  if (!result) {
    const auto line =
        std::count(text.begin(), text.begin() + std::min<std::ptrdiff_t>(result.offset, std::ssize(text)), '\n') + 1;
    refuse(fmt::format("{}: line {}", file.string(), line), fmt::format("\"{}\"", result.description()),
           "well-formed XML");
  }
  return document;
}

inline std::string place_of(const std::filesystem::path& file, const pugi::xml_node& node) {
  return fmt::format("{}: {}", file.string(), node.path('/'));
}

inline double attribute(const std::filesystem::path& file, const pugi::xml_node& node, const char* name) {
  const std::string place = fmt::format("{}/@{}", place_of(file, node), name);
  if (node.attribute(name).empty()) refuse(place, "nothing", "a number");
  return number_of(place, node.attribute(name).value());
}

inline pugi::xml_node child_of(const std::filesystem::path& file, const pugi::xml_node& node, const char* name) {
  const pugi::xml_node child = node.child(name);
  if (!child) refuse(fmt::format("{}/{}", place_of(file, node), name), "nothing", "one");
  return child;
}

/// The nodes of this name anywhere in the document.
inline std::vector<pugi::xml_node> nodes_named(const pugi::xml_document& document, const char* name) {
  std::vector<pugi::xml_node> nodes;
  for (const auto& found : document.select_nodes(fmt::format("//{}", name).c_str())) nodes.push_back(found.node());
  return nodes;
}

}  // namespace raytruth
