// What a module of another language is: a shared library around the static ones, with a function of C.

#include <nlohmann/json.hpp>
#include <raytruth/documents/case.hpp>
#include <raytruth/documents/json/json_reader.hpp>

extern "C" double certified_opacity(double extinction) {
  const nlohmann::ordered_json document{
      {"signal", {{"kind", "piecewise_polynomial"}, {"breaks", {0, 1}}, {"coefficients", {{0.0, 1.0}}}}},
      {"transfer_function",
       {{"points",
         {{{"s", 0}, {"extinction", extinction}, {"color", {1, 1, 1}}},
          {{"s", 1}, {"extinction", extinction}, {"color", {1, 1, 1}}}}}}},
      {"schemes", {"reference"}}};
  std::vector<std::string> warnings;
  const auto json = raytruth::JsonReader::from_text(document.dump(), "module");
  return raytruth::evaluate(raytruth::CaseReader({}).read(json, warnings)).at("reference").at("opacity");
}
