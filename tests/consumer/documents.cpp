// What an adapter or a binding writes: a case and a scene as JSON, answered as the program answers them.

#include <iostream>
#include <nlohmann/json.hpp>
#include <raytruth/documents/case.hpp>
#include <raytruth/documents/json/json_reader.hpp>

int main() {
  const auto json = raytruth::JsonReader::from_text(R"({
    "signal": {"kind": "piecewise_polynomial", "breaks": [0, 1], "coefficients": [[0, 1]]},
    "transfer_function": {"points": [{"s": 0, "extinction": 1, "color": [1, 1, 1]}]},
    "sampling": {"kind": "constant", "step": 0.25},
    "schemes": ["reference", "order1"]})",
                                                      "here");
  std::vector<std::string> warnings;
  const auto answer = raytruth::evaluate(raytruth::CaseReader({}).read(json, warnings));
  std::cout << answer.dump(2) << '\n';
  const double opacity = answer.at("reference").at("opacity");
  return opacity > 0.632 && opacity < 0.633 ? 0 : 1;
}
