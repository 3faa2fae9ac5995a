#pragma once

#include "python/volume.hpp"
#include "raytruth/documents/json/json_reader.hpp"
#include "raytruth/documents/volume_source.hpp"

#include <pybind11/pybind11.h>
#include <nlohmann/json.hpp>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace raytruth::python {

/// A document as Python gives it: the path of a JSON file; or a dict or list, in which numpy's arrays and numbers,
/// paths and TransferFunction objects stand for the JSON that says the same, and Volume objects for the names in
/// `volumes`.
struct Document {
  JsonReader json;
  std::map<std::string, std::shared_ptr<const Grid>> volumes;
};

/// `name` is what messages call a document that is no file. Throws InputError for what has no JSON.
Document read_document(pybind11::handle object, const std::string& name);

/// Dicts, lists, texts, numbers, True, False and None.
pybind11::object to_python(const nlohmann::ordered_json& json);

/// The volumes of a document, and those of the folders of `data` ("A:B"), RAYTRUTH_DATA and the system.
VolumeAccess volume_access(const Document& document, const std::optional<std::string>& data,
                           std::optional<double> nan = {});

/// Hands the lines to Python's `warnings`, as raytruth.InputWarning. Throws where Python is told to take them as
/// errors.
void warn(const std::vector<std::string>& lines);

}  // namespace raytruth::python
