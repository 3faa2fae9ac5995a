#pragma once

#include "raytruth/core/memory_limit.hpp"
#include "raytruth/documents/json/input.hpp"
#include "raytruth/documents/transfer_files/file_map.hpp"

#include <pugixml.hpp>

#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace raytruth {

// Numbers and nodes of XML files. Each function throws InputError that names the file and the node.

inline double number_of(const std::string& place, std::string_view word) {
  double number = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  // Programs print what binary64 cannot hold apart from 0, too: it is 0.
  const auto exponent = word.find_first_of("eE");
  if (error == std::errc::result_out_of_range && word.substr(exponent + 1).starts_with('-')) return 0;
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(number))
    refuse(place, fmt::format("\"{}\"", shortened(word)), "a finite number");
  return number;
}

/// An XML file; copies share what was read.
struct XmlFile {
  std::filesystem::path path;
  std::shared_ptr<const pugi::xml_document> document;

  /// The nodes of this name anywhere in it.
  [[nodiscard]] std::vector<pugi::xml_node> nodes_named(const char* name) const {
    std::vector<pugi::xml_node> nodes;
    for (const auto& found : document->select_nodes(fmt::format("//{}", name).c_str())) nodes.push_back(found.node());
    return nodes;
  }
};

inline XmlFile read_xml(const std::filesystem::path& file) {
  const std::string text = read_text(file.string(), "a readable XML file");
  // An element takes four bytes of text at least, and sixty-four as a node.
  const std::uint64_t bytes = 17 * text.size();
  if (bytes > always_within_memory_limit) need_memory(bytes, "an XML document", file.string());
  auto document = std::make_shared<pugi::xml_document>();
  const auto result = document->load_buffer(text.data(), text.size());
  if (!result) {
    const auto line =
        std::count(text.begin(), text.begin() + std::min<std::ptrdiff_t>(result.offset, std::ssize(text)), '\n') + 1;
    refuse(fmt::format("{}: line {}", file.string(), line), fmt::format("\"{}\"", result.description()),
           "well-formed XML");
  }
  return {file, std::move(document)};
}

inline std::string place_of(const XmlFile& file, const pugi::xml_node& node) {
  return fmt::format("{}: {}", file.path.string(), node.path('/'));
}

inline double attribute(const XmlFile& file, const pugi::xml_node& node, const char* name) {
  const std::string place = fmt::format("{}/@{}", place_of(file, node), name);
  if (node.attribute(name).empty()) refuse(place, "nothing", "a number");
  return number_of(place, node.attribute(name).value());
}

inline pugi::xml_node child_of(const XmlFile& file, const pugi::xml_node& node, const char* name) {
  const pugi::xml_node child = node.child(name);
  if (!child) refuse(fmt::format("{}/{}", place_of(file, node), name), "nothing", "one");
  return child;
}

/// The map of every node of this name, called by the node's attribute `name`.
template <class Read>
std::vector<NamedMap> maps_of(const XmlFile& file, const char* node_name, const Read& read) {
  std::vector<NamedMap> maps;
  for (const pugi::xml_node& node : file.nodes_named(node_name)) {
    const std::string name = node.attribute("name").value();
    maps.push_back({name, [file, node, name, read] {
                      FileMap map = read(file, node);
                      map.name = name;
                      return map;
                    }});
  }
  return maps;
}

}  // namespace raytruth
