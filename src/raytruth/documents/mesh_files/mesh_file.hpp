#pragma once

#include "raytruth/cells/tetrahedral_mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace raytruth {

/// A mesh from a file, with what there is to say of it.
struct MeshFile {
  TetrahedralMesh mesh;
  std::string format;  ///< "VTU" or "legacy VTK 5.1"
  std::string array;   ///< the name of the scalars
  bool is_of_cells = false;
  std::vector<std::string> arrays;  ///< names of all arrays of one component, points' before cells'
  std::vector<std::string> warnings;
};

/// Whether the name is one of a mesh: .vtu or .vtk.
bool is_mesh_name(std::string_view file_name);

/// Reads the tetrahedra of a VTU file, or of a legacy VTK file of the versions 2.0 to 5.1, both as ASCII, and completes
/// them. Numbers are what the file says. `array` names the scalars; without it the file's active ones are taken,
/// points' before cells', else the first of one component. Throws InputError, with the way out for what is binary or
/// compressed.
MeshFile read_mesh(const std::filesystem::path& file, const std::optional<std::string>& array = {});

/// An array of one component, before its numbers are read.
struct MeshArray {
  std::string name;
  bool is_of_cells = false;
  bool is_active = false;
  std::vector<double> values;
};

/// What both formats hold: cells in any order of types, as lists of points.
struct MeshParts {
  std::vector<double> coordinates;
  std::vector<std::int64_t> connectivity;
  std::vector<std::int64_t> ends;  ///< of each cell in `connectivity`
  std::vector<std::int64_t> types;
  std::vector<MeshArray> arrays;
};

/// Words of a text, parted by white space.
class Words {
 public:
  Words(std::string_view text, std::string place) : text_(text), place_(std::move(place)) {}

  /// The next one; empty at the end.
  std::string_view next();
  double number();
  std::int64_t whole();
  std::vector<double> numbers(std::size_t count);
  std::vector<std::int64_t> wholes(std::size_t count);
  /// Passes over what stands before the next empty line.
  void skip_paragraph();
  /// The rest of this line, and behind it.
  std::string_view line();
  [[nodiscard]] std::string place() const;                                              ///< with the line
  [[nodiscard]] std::size_t most_left() const { return (text_.size() - at_) / 2 + 1; }  ///< words
  [[nodiscard]] int most_digits() const { return most_digits_; }

 private:
  std::string_view text_;
  std::string place_;
  std::size_t at_ = 0;
  int most_digits_ = 0;  ///< of the numbers so far
};

MeshParts read_vtu_parts(const std::filesystem::path& file);
/// `version`: as the file states it; `digits`: the most that a number has.
MeshParts read_legacy_parts(const std::filesystem::path& file, std::string& version, int& digits);

}  // namespace raytruth
