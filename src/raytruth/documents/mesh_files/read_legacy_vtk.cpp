#include "raytruth/documents/json/input.hpp"
#include "raytruth/documents/mesh_files/mesh_file.hpp"
#include "raytruth/documents/transfer_files/file_map.hpp"

#include <fmt/format.h>
#include <boost/algorithm/string/case_conv.hpp>
#include <boost/algorithm/string/trim.hpp>

#include <algorithm>
#include <string>

namespace raytruth {

namespace {

std::size_t count(Words& words, std::size_t times = 1) {
  const std::int64_t number = words.whole();
  if (number < 0 || static_cast<std::size_t>(number) > words.most_left())
    refuse(words.place(), fmt::format("a count of {}", number), "one that the file has room for");
  return static_cast<std::size_t>(number) * times;
}

std::string upper(std::string_view word) { return boost::algorithm::to_upper_copy(std::string(word)); }

void read_cells(Words& words, MeshParts& parts) {
  const std::size_t first = count(words);
  const std::size_t second = count(words);
  Words after = words;
  if (upper(after.next()) == "OFFSETS") {  // version 5: one offset more than cells
    words = after;
    words.next();
    parts.ends = words.wholes(first);
    if (!parts.ends.empty()) parts.ends.erase(parts.ends.begin());
    if (upper(words.next()) != "CONNECTIVITY") refuse(words.place(), "no CONNECTIVITY", "one behind OFFSETS");
    words.next();
    parts.connectivity = words.wholes(second);
    return;
  }
  for (std::size_t cell = 0; cell < first; ++cell) {
    const auto corners = words.wholes(count(words));
    parts.connectivity.insert(parts.connectivity.end(), corners.begin(), corners.end());
    parts.ends.push_back(std::ssize(parts.connectivity));
  }
}

/// One attribute of points or cells; false where the word begins none.
bool read_attribute(const std::string& word, Words& words, bool is_of_cells, std::size_t tuples, MeshParts& parts) {
  if (word == "SCALARS") {
    MeshArray array{.name = std::string(words.next()), .is_of_cells = is_of_cells, .is_active = true, .values = {}};
    words.next();
    const std::string rest(boost::algorithm::trim_copy(std::string(words.line())));
    const std::size_t components = rest.empty() ? 1 : static_cast<std::size_t>(std::max(1, std::atoi(rest.c_str())));
    Words after = words;
    if (upper(after.next()) == "LOOKUP_TABLE") {
      after.next();
      words = after;
    }
    array.values = words.numbers(tuples * components);
    if (components == 1) parts.arrays.push_back(std::move(array));
    return true;
  }
  if (word == "FIELD") {
    words.next();
    const std::size_t arrays = count(words);
    for (std::size_t i = 0; i < arrays; ++i) {
      std::string name(words.next());
      if (upper(name) == "METADATA") {
        words.skip_paragraph();
        name = words.next();
      }
      const std::size_t components = count(words);
      const std::size_t rows = count(words);
      words.next();
      auto values = words.numbers(components * rows);
      if (components == 1 && rows == tuples)
        parts.arrays.push_back(
            {.name = name, .is_of_cells = is_of_cells, .is_active = false, .values = std::move(values)});
    }
    return true;
  }
  if (word == "VECTORS" || word == "NORMALS" || word == "TENSORS") {
    words.line();
    words.numbers(tuples * (word == "TENSORS" ? 9 : 3));
    return true;
  }
  if (word == "LOOKUP_TABLE") {
    words.next();
    words.numbers(count(words, 4));
    return true;
  }
  if (word == "GLOBAL_IDS" || word == "PEDIGREE_IDS") {
    words.line();
    words.numbers(tuples);
    return true;
  }
  return false;
}

}  // namespace

MeshParts read_legacy_parts(const std::filesystem::path& file, std::string& version, int& digits) {
  const std::string text = read_text(file.string(), "a readable VTK file");
  Words words(text, file.string());
  const std::string_view first = words.line();
  constexpr std::string_view magic = "# vtk DataFile Version ";
  if (!first.starts_with(magic))
    refuse(words.place(), "another first line", "\"# vtk DataFile Version 5.1\" or before");
  version = boost::algorithm::trim_copy(std::string(first.substr(magic.size())));
  const double number = std::atof(version.c_str());
  if (!(number >= 2 && number <= 5.15))
    refuse(words.place(), fmt::format("the version {}", shortened(version)), "2.0 to 5.1");
  words.line();  // the title
  if (const std::string mode = upper(words.next()); mode != "ASCII")
    refuse(words.place(), mode == "BINARY" ? "a binary file" : "neither ASCII nor BINARY",
           "ASCII (when saving in ParaView: File Type Ascii; or a .vtu file with Data Mode Ascii, compressor none)");
  MeshParts parts;
  bool has_attributes = false;
  bool is_of_cells = false;
  std::size_t tuples = 0;
  for (std::string word = upper(words.next()); !word.empty(); word = upper(words.next())) {
    if (word == "DATASET") {
      if (const std::string kind = upper(words.next()); kind != "UNSTRUCTURED_GRID")
        refuse(words.place(), fmt::format("the dataset {}", shortened(kind)), "UNSTRUCTURED_GRID");
    } else if (word == "POINTS") {
      const std::size_t points = count(words, 3);
      words.next();
      parts.coordinates = words.numbers(points);
    } else if (word == "CELLS") {
      read_cells(words, parts);
    } else if (word == "CELL_TYPES") {
      parts.types = words.wholes(count(words));
    } else if (word == "POINT_DATA" || word == "CELL_DATA") {
      has_attributes = true;
      is_of_cells = word == "CELL_DATA";
      tuples = count(words);
    } else if (word == "METADATA") {
      words.skip_paragraph();
    } else if (!read_attribute(word, words, is_of_cells, has_attributes ? tuples : ~std::size_t{0}, parts)) {
      refuse(words.place(), fmt::format("\"{}\"", shortened(word)),
             "POINTS, CELLS, CELL_TYPES, POINT_DATA, CELL_DATA, SCALARS, VECTORS, NORMALS, TENSORS and FIELD");
    }
  }
  std::stable_sort(parts.arrays.begin(), parts.arrays.end(),
                   [](const MeshArray& a, const MeshArray& b) { return a.is_of_cells < b.is_of_cells; });
  digits = words.most_digits();
  return parts;
}

}  // namespace raytruth
