#include "python/document.hpp"

#include "python/transfer_function.hpp"
#include "raytruth/core/error.hpp"
#include "raytruth/core/memory_limit.hpp"
#include "raytruth/documents/read_transfer_function.hpp"
#include "raytruth/volume/files/find_volume.hpp"

#include <fmt/format.h>

#include <cmath>

namespace raytruth::python {

namespace py = pybind11;
using Json = nlohmann::ordered_json;

namespace {

/// As deep as JsonReader reads.
constexpr std::size_t most_levels = 64;

/// Makes JSON of Python's objects.
class JsonWriter {
 public:
  explicit JsonWriter(std::string name) : name_(std::move(name)) {}

  Json operator()(py::handle object, const std::string& pointer = {}, std::size_t level = 0) {
    if (level > most_levels) refuse(pointer, "nesting deeper than 64", "a document");
    if (object.is_none()) return nullptr;
    if (py::isinstance<py::bool_>(object)) return object.cast<bool>();
    if (py::isinstance<py::str>(object)) return object.cast<std::string>();
    if (py::isinstance<TransferFunction>(object))
      return transfer_function_json(object.cast<const TransferFunction&>().transfer());
    if (py::isinstance<Volume>(object)) return name_of(object.cast<const Volume&>());
    if (py::isinstance<py::dict>(object)) return members(object, pointer, level);
    if (py::isinstance<py::list>(object) || py::isinstance<py::tuple>(object)) return items(object, pointer, level);
    if (py::isinstance<py::int_>(object)) return whole(object, pointer);
    if (py::isinstance<py::float_>(object)) return number(object, pointer);
    if (py::hasattr(object, "tolist")) return (*this)(object.attr("tolist")(), pointer, level + 1);  // numpy's
    if (py::hasattr(object, "__fspath__")) return object.attr("__fspath__")().cast<std::string>();
    refuse(pointer, "an object of type " + py::str(py::type::handle_of(object).attr("__name__")).cast<std::string>(),
           "a dict, list, text, number, bool, None, array, path, Volume or TransferFunction");
  }

  std::map<std::string, std::shared_ptr<const Grid>> volumes;

 private:
  Json members(py::handle object, const std::string& pointer, std::size_t level) {
    Json json = Json::object();
    for (const auto& [key, value] : object.cast<py::dict>()) {
      if (!py::isinstance<py::str>(key)) refuse(pointer, "a key that is no text", "a text");
      const auto name = key.cast<std::string>();
      json[name] = (*this)(value, pointer + "/" + name, level + 1);
    }
    return json;
  }

  Json items(py::handle object, const std::string& pointer, std::size_t level) {
    Json json = Json::array();
    std::size_t i = 0;
    for (const py::handle item : object) json.push_back((*this)(item, fmt::format("{}/{}", pointer, i++), level + 1));
    return json;
  }

  Json whole(py::handle object, const std::string& pointer) const {
    int overflow = 0;
    const long long value = PyLong_AsLongLongAndOverflow(object.ptr(), &overflow);
    if (overflow == 0) return value;
    return number(object, pointer);
  }

  Json number(py::handle object, const std::string& pointer) const {
    const double value = PyFloat_AsDouble(object.ptr());
    if (PyErr_Occurred() != nullptr) {
      PyErr_Clear();
      refuse(pointer, "a number beyond binary64", "a finite number");
    }
    if (!std::isfinite(value)) refuse(pointer, fmt::format("{}", value), "a finite number");
    return value;
  }

  /// By which the document calls the volume: its own name, with a number where another volume has it.
  std::string name_of(const Volume& volume) {
    std::string name = volume.name();
    for (int i = 2; volumes.contains(name) && volumes.at(name) != volume.grid(); ++i)
      name = fmt::format("{} {}", volume.name(), i);
    volumes[name] = volume.grid();
    return name;
  }

  [[noreturn]] void refuse(const std::string& pointer, const std::string& found, const std::string& allowed) const {
    throw InputError(
        fmt::format("{}{}: found {}; {} is allowed", name_, pointer.empty() ? "" : ": " + pointer, found, allowed));
  }

  std::string name_;
};

}  // namespace

Document read_document(py::handle object, const std::string& name) {
  if (py::isinstance<py::str>(object)) return {JsonReader::from_file(object.cast<std::string>()), {}};
  if (py::hasattr(object, "__fspath__"))
    return {JsonReader::from_file(object.attr("__fspath__")().cast<std::string>()), {}};
  JsonWriter write(name);
  const Json json = write(object);
  return {JsonReader::from_text(json.dump(), name), std::move(write.volumes)};
}

py::object to_python(const Json& json) {
  switch (json.type()) {
    case Json::value_t::object: {
      py::dict members;
      for (const auto& [name, value] : json.items()) members[py::str(name)] = to_python(value);
      return members;
    }
    case Json::value_t::array: {
      py::list items;
      for (const Json& item : json) items.append(to_python(item));
      return items;
    }
    case Json::value_t::string:
      return py::str(json.get_ref<const std::string&>());
    case Json::value_t::boolean:
      return py::bool_(json.get<bool>());
    case Json::value_t::number_integer:
      return py::int_(json.get<std::int64_t>());
    case Json::value_t::number_unsigned:
      return py::int_(json.get<std::uint64_t>());
    case Json::value_t::number_float:
      return py::float_(json.get<double>());
    default:
      return py::none();
  }
}

VolumeAccess volume_access(const Document& document, const std::optional<std::string>& data,
                           std::optional<double> nan) {
  if (nan && !std::isfinite(*nan)) throw InputError(fmt::format("nan: found {}; a finite number is allowed", *nan));
  const std::string folders = data.value_or("");
  for (const auto& folder : absent_folders(folders_in(folders)))
    warn({fmt::format("data: {}: there is no such folder", folder.string())});
  return {
      .folders = volume_folders(folders), .nan = nan, .memory_limit = memory_limit(), .in_memory = document.volumes};
}

void warn(const std::vector<std::string>& lines) {
  const py::object category = py::module_::import("raytruth").attr("InputWarning");
  for (const std::string& line : lines)
    if (PyErr_WarnEx(category.ptr(), line.c_str(), 1) != 0) throw py::error_already_set();
}

}  // namespace raytruth::python
