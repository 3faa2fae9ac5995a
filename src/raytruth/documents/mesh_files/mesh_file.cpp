#include "raytruth/documents/mesh_files/mesh_file.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/core/one_line.hpp"
#include "raytruth/documents/transfer_files/file_map.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <boost/algorithm/string/predicate.hpp>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <limits>
#include <utility>

namespace raytruth {

namespace {

constexpr int vtk_tetra = 10;

bool is_space(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

std::string_view name_of_type(std::int64_t type) {
  constexpr std::array<std::pair<int, std::string_view>, 12> names{{{1, "a vertex"},
                                                                    {3, "a line"},
                                                                    {5, "a triangle"},
                                                                    {9, "a quadrilateral"},
                                                                    {11, "a voxel"},
                                                                    {12, "a hexahedron"},
                                                                    {13, "a wedge"},
                                                                    {14, "a pyramid"},
                                                                    {24, "a quadratic tetrahedron"},
                                                                    {25, "a quadratic hexahedron"},
                                                                    {42, "a polyhedron"},
                                                                    {71, "a Lagrange tetrahedron"}}};
  for (const auto& [number, name] : names)
    if (number == type) return name;
  return "another cell";
}

const MeshArray& choose(const MeshParts& parts, const std::optional<std::string>& name, const std::string& place,
                        MeshFile& result) {
  for (const MeshArray& array : parts.arrays) result.arrays.push_back(array.name);
  if (parts.arrays.empty()) refuse(place, "no scalars", "an array of one component, of points or of cells");
  if (name) {
    for (const MeshArray& array : parts.arrays)
      if (array.name == *name) return array;
    refuse(place, fmt::format("no array \"{}\"", one_line(*name)),
           one_line(fmt::format("{}", fmt::join(result.arrays, ", "))));
  }
  const auto active = std::find_if(parts.arrays.begin(), parts.arrays.end(), [](const auto& a) { return a.is_active; });
  const MeshArray& chosen = active == parts.arrays.end() ? parts.arrays.front() : *active;
  if (parts.arrays.size() > 1)
    result.warnings.push_back(one_line(fmt::format("the array {} is taken as the scalar; the file also has others: {}",
                                                   chosen.name, fmt::join(result.arrays, ", "))));
  return chosen;
}

}  // namespace

std::string_view Words::next() {
  while (at_ < text_.size() && is_space(text_[at_])) ++at_;
  const std::size_t begin = at_;
  while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
  return text_.substr(begin, at_ - begin);
}

std::string Words::place() const {
  return fmt::format("{}: line {}", place_,
                     1 + std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(at_), '\n'));
}

double Words::number() {
  const std::string_view word = next();
  double number = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  const auto exponent = word.find_first_of("eE");
  if (error == std::errc::result_out_of_range)
    number =
        word.substr(std::min(word.size(), exponent + 1)).starts_with('-') ? 0 : std::numeric_limits<double>::infinity();
  else if (error != std::errc() || end != word.data() + word.size())
    refuse(place(), word.empty() ? "the end" : fmt::format("\"{}\"", one_line(std::string(word.substr(0, 40)))),
           "a number");
  const auto digits =
      std::count_if(word.begin(), word.begin() + static_cast<std::ptrdiff_t>(std::min(word.size(), exponent)),
                    [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; });
  most_digits_ = std::max(most_digits_, static_cast<int>(digits));
  return number;
}

std::int64_t Words::whole() {
  const std::string_view word = next();
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc() || end != word.data() + word.size())
    refuse(place(), word.empty() ? "the end" : fmt::format("\"{}\"", one_line(std::string(word.substr(0, 40)))),
           "a whole number");
  return number;
}

std::vector<double> Words::numbers(std::size_t count) {
  if (count > most_left())
    refuse(place(), fmt::format("fewer than {} numbers", count), "as many as the file announces");
  std::vector<double> result(count);
  for (double& x : result) x = number();
  return result;
}

std::vector<std::int64_t> Words::wholes(std::size_t count) {
  if (count > most_left())
    refuse(place(), fmt::format("fewer than {} numbers", count), "as many as the file announces");
  std::vector<std::int64_t> result(count);
  for (std::int64_t& x : result) x = whole();
  return result;
}

std::string_view Words::line() {
  const std::size_t begin = at_;
  at_ = std::min(text_.size(), text_.find('\n', at_));
  std::string_view line = text_.substr(begin, at_ - begin);
  if (at_ < text_.size()) ++at_;
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

void Words::skip_paragraph() {
  line();
  while (at_ < text_.size())
    if (std::all_of(text_.begin() + static_cast<std::ptrdiff_t>(at_),
                    text_.begin() + static_cast<std::ptrdiff_t>(std::min(text_.size(), text_.find('\n', at_))),
                    is_space))
      return;
    else
      line();
}

bool is_mesh_name(std::string_view file_name) {
  return boost::algorithm::iends_with(file_name, ".vtu") || boost::algorithm::iends_with(file_name, ".vtk");
}

MeshFile read_mesh(const std::filesystem::path& file, const std::optional<std::string>& array) {
  const std::string place = file.string();
  if (!is_mesh_name(place)) refuse(place, "a name of neither format", "meshes in .vtu and .vtk files");
  MeshFile result;
  MeshParts parts;
  if (boost::algorithm::iends_with(place, ".vtu")) {
    result.format = "VTU";
    parts = read_vtu_parts(file);
  } else {
    std::string version;
    int digits = 0;
    parts = read_legacy_parts(file, version, digits);
    result.format = "legacy VTK " + version;
    if (digits >= 9 && digits <= 12)
      result.warnings.emplace_back(
          "no number has more than 12 digits: VTK's writer of this format rounds to 11, its .vtu files have all 17");
  }
  TetrahedralMesh& mesh = result.mesh;
  if (parts.ends.size() != parts.types.size())
    refuse(place, fmt::format("{} cells and {} types", parts.ends.size(), parts.types.size()), "as many of both");
  mesh.points.resize(parts.coordinates.size() / 3);
  for (std::size_t i = 0; i < 3 * mesh.points.size(); ++i) mesh.points[i / 3][i % 3] = parts.coordinates[i];
  std::int64_t begin = 0;
  for (std::size_t cell = 0; cell < parts.ends.size(); ++cell) {
    const std::string where = fmt::format("{}: cell {}", place, cell);
    if (parts.types[cell] != vtk_tetra)
      refuse(where, fmt::format("the VTK type {}, {}", parts.types[cell], name_of_type(parts.types[cell])),
             "type 10, a tetrahedron, as ParaView's filter Tetrahedralize makes them,");
    const std::int64_t end = parts.ends[cell];
    if (end - begin != 4 || end > std::ssize(parts.connectivity))
      refuse(where, fmt::format("{} points", end - begin), "a tetrahedron of 4");
    auto& corners = mesh.tetrahedra.emplace_back();
    for (std::size_t k = 0; k < 4; ++k) {
      const std::int64_t point = parts.connectivity[static_cast<std::size_t>(begin) + k];
      if (point < 0 || point >= std::ssize(mesh.points))
        refuse(where, fmt::format("the point {}", point), fmt::format("0 to {}", std::ssize(mesh.points) - 1));
      corners[k] = static_cast<std::uint32_t>(point);
    }
    begin = end;
  }
  const MeshArray& chosen = choose(parts, array, place, result);
  result.array = chosen.name;
  result.is_of_cells = chosen.is_of_cells;
  (chosen.is_of_cells ? mesh.cell_scalars : mesh.scalars) = chosen.values;
  try {
    complete(mesh);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", place, error.what()));
  }
  return result;
}

}  // namespace raytruth
