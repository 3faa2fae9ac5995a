#include "raytruth/documents/transfer_files/xml_numbers.hpp"

#include <sstream>

namespace raytruth {

namespace {

/// A list that states the count of its numbers first.
std::vector<double> counted_numbers(const std::string& place, const std::string& text) {
  std::istringstream stream(text);
  std::string word;
  std::vector<double> numbers;
  while (stream >> word) numbers.push_back(number_of(place, word));
  if (numbers.empty()) refuse(place, "nothing", "a list of numbers");
  if (numbers.front() != static_cast<double>(numbers.size() - 1))
    refuse(place, fmt::format("{} numbers", numbers.size() - 1), fmt::format("{}, as it says,", numbers.front()));
  numbers.erase(numbers.begin());
  return numbers;
}

/// Whether opacity depends on the gradient: not if it is 1 everywhere.
bool depends_on_gradient(const std::string& place, const std::string& text) {
  const auto points = groups_of<2>(place, counted_numbers(place, text));
  return std::any_of(points.begin(), points.end(), [](const auto& point) { return point[1] != 1; });
}

FileMap slicer_map(const std::string& place, const std::string& opacity, const std::string& gradient,
                   const std::string& color) {
  FileMap result{.format = "3D Slicer volume property"};
  add_opacities(result.map, place + ": scalarOpacity", counted_numbers(place + ": scalarOpacity", opacity));
  add_colors(result.map, place + ": colorTransfer", counted_numbers(place + ": colorTransfer", color));
  result.has_gradient_opacity = !gradient.empty() && depends_on_gradient(place + ": gradientOpacity", gradient);
  return result;
}

}  // namespace

FileMap read_slicer_text(const TransferFileRequest& request) {
  const std::string file = request.file.string();
  std::istringstream text(read_text(file, "a readable volume property"));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);)
    if (line.find_first_not_of(" \t\r") != std::string::npos) lines.push_back(line);
  constexpr std::size_t first_list = 6;  // behind interpolation, shading and four numbers of lighting
  if (lines.size() < first_list + 3)
    refuse(file, fmt::format("{} lines", lines.size()), "six lines of one number and three lists");
  for (std::size_t i = 0; i < first_list; ++i)
    number_of(file, std::string_view(lines[i]).substr(0, lines[i].find_last_not_of(" \t\r") + 1));
  return slicer_map(file, lines[first_list], lines[first_list + 1], lines[first_list + 2]);
}

FileMap read_slicer_presets(const TransferFileRequest& request) {
  const pugi::xml_document document = read_xml(request.file);
  const auto nodes = nodes_named(document, "VolumeProperty");
  const pugi::xml_node& node = chosen(
      nodes, request, [](const pugi::xml_node& property) { return std::string(property.attribute("name").value()); });
  FileMap result = slicer_map(place_of(request.file, node), node.attribute("scalarOpacity").value(),
                              node.attribute("gradientOpacity").value(), node.attribute("colorTransfer").value());
  result.name = node.attribute("name").value();
  return result;
}

}  // namespace raytruth
