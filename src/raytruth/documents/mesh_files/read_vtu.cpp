#include "raytruth/documents/mesh_files/mesh_file.hpp"
#include "raytruth/documents/transfer_files/xml_numbers.hpp"

#include <fmt/format.h>

#include <string>

namespace raytruth {

namespace {

std::size_t count_of(const XmlFile& file, const pugi::xml_node& node, const char* name) {
  const double count = attribute(file, node, name);
  if (!(count >= 0) || count != std::floor(count) || count > 0x1p32)
    refuse(fmt::format("{}/@{}", place_of(file, node), name), fmt::format("{}", count), "a whole number >= 0");
  return static_cast<std::size_t>(count);
}

Words words_of(const XmlFile& file, const pugi::xml_node& array) {
  const std::string place = fmt::format("{} ({})", place_of(file, array), array.attribute("Name").value());
  const std::string format = array.attribute("format").value();
  if (format != "ascii")
    refuse(place, fmt::format("the format \"{}\"", shortened(format)),
           "\"ascii\" (when saving in ParaView: Data Mode Ascii, compressor none)");
  return {array.text().get(), place};
}

pugi::xml_node array_named(const XmlFile& file, const pugi::xml_node& owner, const char* name) {
  for (const pugi::xml_node& array : owner.children("DataArray"))
    if (std::string_view(array.attribute("Name").value()) == name) return array;
  refuse(place_of(file, owner), fmt::format("no DataArray \"{}\"", name), "one");
}

/// Appends the scalars of a piece; all pieces have the same arrays.
void read_arrays(const XmlFile& file, const pugi::xml_node& owner, bool is_of_cells, std::size_t count,
                 MeshParts& parts) {
  const std::string_view active = owner.attribute("Scalars").value();
  for (const pugi::xml_node& array : owner.children("DataArray")) {
    const auto components = array.attribute("NumberOfComponents");
    if (!components.empty() && components.as_int() > 1) continue;
    const std::string name = array.attribute("Name").value();
    const auto values = words_of(file, array).numbers(count);
    const auto known = std::find_if(parts.arrays.begin(), parts.arrays.end(), [&](const MeshArray& other) {
      return other.name == name && other.is_of_cells == is_of_cells;
    });
    MeshArray& to = known == parts.arrays.end() ? parts.arrays.emplace_back() : *known;
    to.name = name;
    to.is_of_cells = is_of_cells;
    to.is_active = name == active;
    to.values.insert(to.values.end(), values.begin(), values.end());
  }
}

}  // namespace

MeshParts read_vtu_parts(const std::filesystem::path& path) {
  const XmlFile file = read_xml(path);
  const pugi::xml_node root = file.document->child("VTKFile");
  const std::string type = root.attribute("type").value();
  if (type != "UnstructuredGrid")
    refuse(path.string(), root ? fmt::format("a VTK file of the type \"{}\"", shortened(type)) : "no node VTKFile",
           "UnstructuredGrid");
  MeshParts parts;
  std::vector<MeshArray> of_cells;
  for (const pugi::xml_node& piece : child_of(file, root, "UnstructuredGrid").children("Piece")) {
    const std::size_t points = count_of(file, piece, "NumberOfPoints");
    const std::size_t cells = count_of(file, piece, "NumberOfCells");
    const auto first_point = std::ssize(parts.coordinates) / 3;
    const auto first_corner = std::ssize(parts.connectivity);
    const auto coordinates =
        words_of(file, child_of(file, child_of(file, piece, "Points"), "DataArray")).numbers(3 * points);
    parts.coordinates.insert(parts.coordinates.end(), coordinates.begin(), coordinates.end());
    const pugi::xml_node owner = child_of(file, piece, "Cells");
    std::int64_t last = 0;
    for (const std::int64_t end : words_of(file, array_named(file, owner, "offsets")).wholes(cells))
      parts.ends.push_back(first_corner + (last = end));
    if (last < 0) refuse(place_of(file, owner), fmt::format("the offset {}", last), "one >= 0");
    for (const std::int64_t point :
         words_of(file, array_named(file, owner, "connectivity")).wholes(static_cast<std::size_t>(last)))
      // One outside its own piece is left outside of all, for what checks them to name its cell.
      parts.connectivity.push_back(point < 0 || point >= static_cast<std::int64_t>(points) ? -1 - std::abs(point)
                                                                                           : first_point + point);
    const auto types = words_of(file, array_named(file, owner, "types")).wholes(cells);
    parts.types.insert(parts.types.end(), types.begin(), types.end());
    read_arrays(file, piece.child("PointData"), false, points, parts);
    read_arrays(file, piece.child("CellData"), true, cells, parts);
  }
  std::stable_sort(parts.arrays.begin(), parts.arrays.end(),
                   [](const MeshArray& a, const MeshArray& b) { return a.is_of_cells < b.is_of_cells; });
  for (const MeshArray& array : parts.arrays)
    if (array.values.size() != (array.is_of_cells ? parts.types.size() : parts.coordinates.size() / 3))
      refuse(path.string(), fmt::format("an array \"{}\" that not all pieces have", shortened(array.name)),
             "the same arrays in each");
  return parts;
}

}  // namespace raytruth
